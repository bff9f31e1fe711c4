// cmd_view_say.c

#include "cmd_view_say.h"

#include <string.h>
#include <unistd.h>

// A word for the shell: quoted where it has characters that mean something.
static const char *shell_word(const char *text, arena *mem) {
  const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                      "0123456789_./,:=+-@%";
  if (*text != 0 && text[strspn(text, plain)] == 0) return text;
  const char *quoted = "'";
  for (; *text != 0; text++)
    quoted = *text == '\'' ? arena_format(mem, "%s'\\''", quoted)
                           : arena_format(mem, "%s%c", quoted, *text);
  return arena_format(mem, "%s'", quoted);
}

// " --eye X,Y,Z", with as many digits as it takes to read the same floats.
static void print_triple(const char *name, vec3 v) {
  printf(" --%s=%.9g,%.9g,%.9g", name, (double)v.x, (double)v.y, (double)v.z);
}

// Whether the line says this by what is seen, not by how the viewer began.
static bool is_replaced(option_id id) {
  static const option_id replaced[] = {OPT_CAMERA, OPT_EYE,  OPT_TARGET,
                                       OPT_UP,     OPT_FOV,  OPT_RESOLUTION,
                                       OPT_ENGINE, OPT_POST, OPT_QUIET};
  for (size_t i = 0; i < sizeof replaced / sizeof *replaced; i++)
    if (replaced[i] == id) return true;
  return false;
}

// The options of the command line that render has, too.
static void print_options(const options *o, arena *mem) {
  for (int i = 0; i < OPTION_COUNT; i++) {
    const option *a = &option_table[i];
    const option_value *v = &o->value[i];
    if (!v->given || (a->commands & CMD_RENDER) == 0 ||
        is_replaced((option_id)i))
      continue;
    printf(" --%s", a->name);
    if (a->kind != OPTION_SWITCH) printf("=%s", shell_word(v->text, mem));
  }
}

void view_print_command(const options *o, const view_state *s, int width,
                        int height, arena *mem) {
  const camera *c = &s->look.camera;
  printf("facet render %s", shell_word(o->operands[0], mem));
  print_options(o, mem);
  printf(" -r %dx%d --engine=%s", width, height, s->paths ? "path" : "raster");
  print_triple("eye", c->eye);
  print_triple("target", c->target);
  print_triple("up", c->up);
  printf(" --fov=%.9g", (double)c->fov_deg);
  if (s->frosted) {
    const char *pane = o->value[OPT_POST].text;
    printf(" --post=%s", pane != NULL ? pane : "frosted");
  }
  if (s->look.metallic != 0 || s->look.roughness != 0 || s->look.only_rough)
    printf("  # without keys 0 to 4: metallic %+.1f, roughness %+.1f%s",
           (double)(VIEW_STEP * (float)s->look.metallic),
           (double)(VIEW_STEP * (float)s->look.roughness),
           s->look.only_rough ? ", others hidden" : "");
  putchar('\n');
  fflush(stdout);
}

void view_print_keys(void) {
  fprintf(stderr, "%-8s%s\n", "mouse", "turns");
  for (int i = 0; i < VIEW_KEY_COUNT; i++)
    fprintf(stderr, "%-8s%s\n", VIEW_KEYS[i].name, VIEW_KEYS[i].meaning);
}

void view_say_written(const char *path) {
  fprintf(stderr, "%s: written\n", path);
}

const char *view_title(const char *scene_path, int spp, arena *mem) {
  const char *slash = strrchr(scene_path, '/');
  const char *name = slash == NULL ? scene_path : slash + 1;
  if (spp == 0) return arena_format(mem, "%s - facet (H: keys)", name);
  return arena_format(mem, "%s, %d sample%s a pixel - facet (H: keys)", name,
                      spp, spp == 1 ? "" : "s");
}

const char *view_free_name(const char *scene_path, arena *mem) {
  const char *stem =
      strcmp(scene_path, "-") == 0 ? "stdin" : cmd_stem(mem, scene_path);
  for (int i = 1;; i++) {
    const char *name = arena_format(mem, "%s-%d.png", stem, i);
    if (access(name, F_OK) != 0) return name;
  }
}
