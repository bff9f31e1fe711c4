// cmd_info_part.c

#include "cmd_info_part.h"

#include "part.h"

#include <string.h>

// Samples of a pixel that there are, on average.
static double samples_a_pixel(const part *p) {
  shard s = part_shard(p);
  size_t pixels = shard_pixels(&s);
  return pixels > 0 ? (double)p->tally.samples / (double)pixels : 0;
}

// The lines of the key as members.
static void json_key(json *j, const char *key) {
  json_open(j, "key", '{');
  while (*key != 0) {
    char name[32], value[128];
    size_t n = strcspn(key, " \n"), line = strcspn(key, "\n");
    snprintf(name, sizeof name, "%.*s", (int)n, key);
    snprintf(value, sizeof value, "%.*s", (int)(line > n ? line - n - 1 : 0),
             key + n + (line > n));
    json_text(j, name, value);
    key += line + (key[line] != 0);
  }
  json_close(j, '{');
}

static void print_json_part(const part *p, const char *path) {
  const film_box *w = &p->window;
  const int box[4] = {w->x0, w->y0, w->x1, w->y1};
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "file", path);
  json_text(&j, "format", "part");
  json_count(&j, "width", (unsigned long long)p->width);
  json_count(&j, "height", (unsigned long long)p->height);
  json_open(&j, "window", '[');
  for (int i = 0; i < 4; i++)
    json_count(&j, NULL, (unsigned long long)box[i]);
  json_close(&j, '[');
  json_count(&j, "shard", (unsigned long long)part_shard_name(p));
  json_count(&j, "shards", (unsigned long long)p->shards);
  json_count(&j, "tiles", p->tile_count);
  json_number(&j, "samples_a_pixel", samples_a_pixel(p));
  json_count(&j, "spp", p->spp);
  json_flag(&j, "complete", p->complete);
  json_count(&j, "non_finite", p->tally.non_finite);
  json_key(&j, p->key);
  json_close(&j, '{');
  json_end(&j);
}

static void print_text_part(const part *p, const char *path) {
  printf("%s\npart of a picture, shard %d/%d, %zu tiles, %.6g samples a pixel, "
         "%s\n%s",
         path, part_shard_name(p), p->shards, p->tile_count, samples_a_pixel(p),
         p->complete ? "finished" : "not finished", p->key);
}

int info_part(const options *o, const char *path) {
  arena mem = {0};
  part p;
  error err;
  int code = EXIT_DONE;
  if (!part_read_head(&p, path, &mem, &err))
    code = cmd_fail(o, EXIT_INPUT, "%s", err.text);
  else if (o->value[OPT_JSON].given)
    print_json_part(&p, path);
  else
    print_text_part(&p, path);
  arena_free(&mem);
  return code;
}
