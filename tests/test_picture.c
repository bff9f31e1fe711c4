// test_picture.c — whole picture files: recognised, read safely, written
// whole.

#include "picture.h"
#include "picture_head.h"

#include "pictures.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

// Every test works in a new folder, with a small picture at hand.
typedef struct place {
  char old[4096], folder[64];
  arena mem;
  image im;
  error err;
} place;

static int enter(void **state) {
  place *p = calloc(1, sizeof *p);
  strcpy(p->folder, "/tmp/facet-test-XXXXXX");
  if (getcwd(p->old, sizeof p->old) == NULL || mkdtemp(p->folder) == NULL ||
      chdir(p->folder) != 0)
    return -1;
  p->im = test_image(&p->mem, 20, 10);
  *state = p;
  return 0;
}

// The number of names in the folder; removes them all when asked.
static int names_here(bool wipe) {
  int count = 0;
  DIR *d = opendir(".");
  for (struct dirent *e = readdir(d); e != NULL; e = readdir(d)) {
    if (strcmp(e->d_name, ".") == 0 || strcmp(e->d_name, "..") == 0) continue;
    count++;
    if (wipe) remove(e->d_name);
  }
  closedir(d);
  return count;
}

static int leave(void **state) {
  place *p = *state;
  names_here(true);
  if (chdir(p->old) != 0) return -1;
  rmdir(p->folder);
  arena_free(&p->mem);
  free(p);
  return 0;
}

// Write a few bytes to a file.
static void put_file(const char *path, const char *bytes, size_t n) {
  FILE *f = fopen(path, "wb");
  fwrite(bytes, 1, n, f);
  fclose(f);
}

// A file still holds these words and nothing else.
static bool holds(const char *path, const char *words) {
  blob b = blob_read(path);
  bool same = b.size == strlen(words) && memcmp(b.bytes, words, b.size) == 0;
  free(b.bytes);
  return same;
}

// Formats go by the last suffix in any case, or by a bare name.
static void formats_by_name(void **state) {
  (void)state;
  assert_int_equal(picture_format_of("a/b.c/x.PnG"), PICTURE_PNG);
  assert_int_equal(picture_format_of("x.png.pfm"), PICTURE_PFM);
  assert_int_equal(picture_format_of("hdr"), PICTURE_HDR);
  assert_int_equal(picture_format_of("x.pic"), PICTURE_HDR);
  assert_int_equal(picture_format_of("x.JPEG"), PICTURE_JPEG);
  assert_int_equal(picture_format_of("x.jpg"), PICTURE_JPEG);
  assert_int_equal(picture_format_of(".tga"), PICTURE_TGA);
  assert_int_equal(picture_format_of("a.png/x"), PICTURE_UNKNOWN);
  assert_int_equal(picture_format_of("x.pn"), PICTURE_UNKNOWN);
  assert_int_equal(picture_format_of("x."), PICTURE_UNKNOWN);
  assert_int_equal(picture_format_of(""), PICTURE_UNKNOWN);
}

// A picture comes back from each format that is written, whatever its name
// says: the content decides.
static void content_decides(void **state) {
  place *p = *state;
  const picture_format formats[] = {PICTURE_PNG, PICTURE_PFM, PICTURE_HDR};
  const float loss[] = {0.0045f, 0, 0.004f};  // half a code at 255
  for (int k = 0; k < 3; k++) {
    image back;
    assert_true(picture_write(&p->im, "a.jpg", formats[k], 8, &p->err));
    if (!picture_read_linear(&back, "a.jpg", &p->mem, NULL, &p->err))
      fail_msg("%s", p->err.text);
    for (int i = 0; i < 200; i++)
      assert_true(vec3_peak(vec3_abs(
                      vec3_sub(back.pixels[i], p->im.pixels[i]))) <= loss[k]);
  }
  assert_int_equal(names_here(false), 1);
}

// What is no regular file, or no picture, is refused at once with the path
// and the reason; a pipe without a writer does not block.
static void only_regular_files(void **state) {
  place *p = *state;
  picture out;
  assert_int_equal(mkfifo("pipe.png", 0600), 0);
  put_file("empty.png", "", 0);
  put_file("text.png", "a thousand words", 16);
  const char *paths[] = {".",         "/dev/zero", "pipe.png",
                         "empty.png", "text.png",  "none.png"};
  const char *words[] = {"folder", "device",       "pipe",
                         "empty",  "expected PNG", "No such file"};
  for (int i = 0; i < 6; i++) {
    assert_false(picture_read(&out, paths[i], &p->mem, NULL, &p->err));
    assert_ptr_equal(strstr(p->err.text, paths[i]), p->err.text);
    assert_non_null(strstr(p->err.text, words[i]));
  }
}

// Light that cannot be is repaired on reading, and said once.
static void repairs_are_counted(void **state) {
  place *p = *state;
  p->im.pixels[0] = (vec3){NAN, -1, INFINITY};
  p->im.pixels[7] = (vec3){-INFINITY, -0.0f, 2};
  assert_true(picture_write(&p->im, "a.pfm", PICTURE_PFM, 8, &p->err));
  report r = {.mem = &p->mem};
  image back;
  assert_true(picture_read_linear(&back, "a.pfm", &p->mem, &r, &p->err));
  assert_true(back.pixels[0].x == 0 && back.pixels[0].y == 0);
  assert_true(back.pixels[0].z == 3.40282347e38f);
  assert_true(back.pixels[7].x == 0 && back.pixels[7].z == 2);
  assert_int_equal(r.warnings, 1);
  assert_non_null(strstr(r.first->text, "a.pfm: 2 of 200 pixels"));
}

// A failed write says why, and leaves the old file and no other.
static void old_file_survives(void **state) {
  place *p = *state;
  put_file("a.png", "old", 3);
  // A limit on the size of files stands in for a full disk.
  struct rlimit before, small = {100, RLIM_INFINITY};
  getrlimit(RLIMIT_FSIZE, &before);
  small.rlim_max = before.rlim_max;
  signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
  const picture_format formats[] = {PICTURE_PNG, PICTURE_PFM, PICTURE_HDR};
  for (int k = 0; k < 3; k++) {
    bool ok = picture_write(&p->im, "a.png", formats[k], 8, &p->err);
    if (ok) setrlimit(RLIMIT_FSIZE, &before);
    assert_false(ok);
    assert_string_equal(p->err.text,
                        "a.png: cannot be written: File too large");
  }
  setrlimit(RLIMIT_FSIZE, &before);
  assert_true(holds("a.png", "old"));
  assert_false(picture_write(&p->im, "a.png", PICTURE_JPEG, 8, &p->err));
  assert_non_null(strstr(p->err.text, "expected .png, .pfm or .hdr"));
  assert_true(holds("a.png", "old"));
  assert_false(picture_write(&p->im, "no/a.png", PICTURE_PNG, 8, &p->err));
  assert_false(picture_write(&p->im, ".", PICTURE_PNG, 8, &p->err));
  assert_non_null(strstr(p->err.text, "Is a directory"));
  assert_int_equal(names_here(false), 1);
}

// What is no regular file is written directly.  A pipe of our own goes first:
// only code that left it a pipe may be let near the devices of the machine,
// which a renamed file would replace.
static void devices_are_written(void **state) {
  place *p = *state;
  struct stat st;
  static uint8_t bytes[65536];
  assert_int_equal(mkfifo("pipe.pfm", 0600), 0);
  int fd = open("pipe.pfm", O_RDONLY | O_NONBLOCK);
  assert_true(picture_write(&p->im, "pipe.pfm", PICTURE_PFM, 8, &p->err));
  assert_true(lstat("pipe.pfm", &st) == 0 && S_ISFIFO(st.st_mode));
  assert_int_equal(read(fd, bytes, sizeof bytes), 14 + 200 * 12);
  assert_memory_equal(bytes, "PF\n20 10\n-1.0\n", 14);
  close(fd);
  assert_int_equal(names_here(false), 1);
  const picture_format formats[] = {PICTURE_PNG, PICTURE_PFM, PICTURE_HDR};
  for (int k = 0; k < 3; k++) {
    assert_true(picture_write(&p->im, "/dev/null", formats[k], 8, &p->err));
    assert_false(picture_write(&p->im, "/dev/full", formats[k], 8, &p->err));
    assert_string_equal(
        p->err.text, "/dev/full: cannot be written: No space left on device");
  }
  assert_true(stat("/dev/null", &st) == 0 && S_ISCHR(st.st_mode));
}

// A link stays a link, also one that dangles or leads elsewhere by a relative
// path; a circle of links is an error.
static void links_stay_links(void **state) {
  place *p = *state;
  struct stat st;
  assert_int_equal(mkdir("there", 0700), 0);
  assert_int_equal(symlink("to.png", "there/link.png"), 0);
  assert_int_equal(symlink("there/link.png", "link.png"), 0);
  for (int turn = 0; turn < 2; turn++) {  // the target is new, then old
    assert_true(picture_write(&p->im, "link.png", PICTURE_PNG, 8, &p->err));
    assert_true(lstat("link.png", &st) == 0 && S_ISLNK(st.st_mode));
    assert_true(lstat("there/link.png", &st) == 0 && S_ISLNK(st.st_mode));
    assert_true(lstat("there/to.png", &st) == 0 && S_ISREG(st.st_mode));
  }
  assert_int_equal(symlink("b.png", "a.png"), 0);
  assert_int_equal(symlink("a.png", "b.png"), 0);
  assert_false(picture_write(&p->im, "a.png", PICTURE_PNG, 8, &p->err));
  assert_int_equal(names_here(false), 4);
  assert_int_equal(remove("there/link.png") | remove("there/to.png"), 0);
}

// A new file gets the usual permissions, an old one keeps its own.
static void permissions_are_kept(void **state) {
  place *p = *state;
  struct stat st;
  mode_t mask = umask(027);
  assert_true(picture_write(&p->im, "a.png", PICTURE_PNG, 8, &p->err));
  umask(mask);
  assert_true(stat("a.png", &st) == 0 && (st.st_mode & 07777) == 0640);
  chmod("a.png", 0604);
  assert_true(picture_write(&p->im, "a.png", PICTURE_PNG, 8, &p->err));
  assert_true(stat("a.png", &st) == 0 && (st.st_mode & 07777) == 0604);
}

// A name of the greatest length that the system allows can be written.
static void long_names(void **state) {
  place *p = *state;
  char name[256];
  memset(name, 'x', 255);
  strcpy(name + 251, ".png");
  assert_true(picture_write(&p->im, name, PICTURE_PNG, 8, &p->err));
  assert_int_equal(names_here(false), 1);
}

// "-" is standard output.
static void standard_output(void **state) {
  place *p = *state;
  fflush(stdout);
  int keep = dup(STDOUT_FILENO);
  int fd = open("out.pfm", O_WRONLY | O_CREAT, 0600);
  dup2(fd, STDOUT_FILENO);
  bool ok = picture_write(&p->im, "-", PICTURE_PFM, 8, &p->err);
  dup2(keep, STDOUT_FILENO);
  close(keep);
  close(fd);
  image back;
  assert_true(ok);
  assert_true(picture_read_linear(&back, "out.pfm", &p->mem, NULL, &p->err));
  assert_memory_equal(back.pixels, p->im.pixels, 200 * sizeof(vec3));
}

// Three numbers behind `key` in the entry of the collection's list that
// begins at `entry`.
static bool three_numbers(const char *entry, const char *key, double out[3]) {
  const char *end = strstr(entry, "\"opencv\"");
  const char *at = strstr(entry, key);
  if (at == NULL || end == NULL || at > end) return false;
  char *c = strchr(strstr(at, "\": "), '[') + 1;
  for (int i = 0; i < 3; i++)
    out[i] = strtod(c, &c), c++;
  return true;
}

// Compare the mean of one file of the collection with the mean that other
// programs found; returns whether there was one.
static bool check_mean(const char *folder, const char *name,
                       const char *entry) {
  arena mem = {0};
  error err;
  picture p;
  double want[3], got[3] = {0};
  bool hdr = strstr(name, ".hdr") != NULL;
  if (!three_numbers(entry, hdr ? "\"mean_rgb\"" : "\"mean_rgb8\"", want))
    return false;
  const char *path = arena_format(&mem, "%s/%s", folder, name);
  if (!picture_read(&p, path, &mem, NULL, &err)) fail_msg("%s", err.text);
  image im = p.is_linear ? p.linear : image_from_pixmap(&mem, &p.stored, false);
  picture_head head;
  if (!picture_head_read(&head, path, &err)) fail_msg("%s", err.text);
  assert_true(head.width == im.width && head.height == im.height);
  double n = (double)im.width * im.height, unit = p.is_linear ? 1 : 255;
  for (int i = 0; i < im.width * im.height; i++) {
    got[0] += unit * (double)im.pixels[i].x / n;
    got[1] += unit * (double)im.pixels[i].y / n;
    got[2] += unit * (double)im.pixels[i].z / n;
  }
  // The list is rounded to 0.001; JPEG decoders may differ by their rounding,
  // and 16 bits were cut to 8 in the list.
  double tolerance = hdr                           ? 1e-6 * want[0]
                     : strstr(name, ".jp") != NULL ? 1
                     : p.stored.depth == 16        ? 0.6
                                                   : 0.0006;
  for (int c = 0; c < 3; c++)
    if (!(fabs(got[c] - want[c]) <= tolerance))
      fail_msg("%s: mean of channel %d is %.4f, expected %.4f", name, c, got[c],
               want[c]);
  arena_free(&mem);
  return true;
}

// A head tells the sides that reading finds, of every kind that is written
// here; what has none is refused, and what is cut short behind it is not.
static void heads_tell_the_size(void **state) {
  place *p = *state;
  const char *names[] = {"a.png", "a.pfm", "a.hdr"};
  const picture_format formats[] = {PICTURE_PNG, PICTURE_PFM, PICTURE_HDR};
  picture_head h;
  for (int i = 0; i < 3; i++) {
    assert_true(picture_write(&p->im, names[i], formats[i], 8, &p->err));
    assert_true(picture_head_read(&h, names[i], &p->err));
    assert_true(h.width == 20 && h.height == 10);
    assert_int_equal(truncate(names[i], 160), 0);
    assert_true(picture_head_read(&h, names[i], &p->err));
    assert_int_equal(truncate(names[i], 5), 0);
    assert_false(picture_head_read(&h, names[i], &p->err));
    assert_non_null(strstr(p->err.text, names[i]));
    assert_int_equal(truncate(names[i], 0), 0);
    assert_false(picture_head_read(&h, names[i], &p->err));
  }
  assert_false(picture_head_read(&h, "none.png", &p->err));
  names_here(true);
}

// The head of a JPEG may come late: here after 40 segments of 60,000 bytes.
static void heads_may_come_late(void **state) {
  place *p = *state;
  static const unsigned char start[] = {0xff, 0xd8};
  static const unsigned char extra[] = {0xff, 0xe1, 60000 >> 8, 60000 & 255};
  static const unsigned char frame[] = {0xff, 0xc2, 0, 11, 8, 1, 44, 3, 32, 1};
  FILE *f = fopen("late.jpg", "wb");
  assert_non_null(f);
  fwrite(start, 1, sizeof start, f);
  for (int i = 0; i < 40; i++) {
    fwrite(extra, 1, sizeof extra, f);
    for (int k = 2; k < 60000; k++)
      putc(0, f);
  }
  fwrite(frame, 1, sizeof frame, f);
  fclose(f);
  picture_head h;
  assert_true(picture_head_read(&h, "late.jpg", &p->err));
  assert_true(h.width == 800 && h.height == 300);
  names_here(true);
}

// Real files of many programs have the means that other readers find.
static void means_of_a_collection(void **state) {
  (void)state;
  place *p = *state;
  const char *env = getenv("FACET_ASSETS");
  const char *folder =
      env != NULL ? env : arena_format(&p->mem, "%s/../shared/assets", p->old);
  blob list = blob_read(arena_format(&p->mem, "%s/expected.json", folder));
  if (list.size == 0) {
    print_message("# SKIP no collection of pictures in FACET_ASSETS\n");
    return;
  }
  int count = 0;
  const char *at = strstr((char *)list.bytes, "\"images\":");
  const char *kinds[] = {".png\"", ".jpg\"", ".jpeg\"", ".tga\"", ".hdr\""};
  for (; at != NULL && *at != '\0'; at++) {
    if (at[0] != '"') continue;
    const char *end = strchr(at + 1, '"');
    for (int k = 0; end != NULL && k < 5; k++) {
      size_t n = strlen(kinds[k]);
      if ((size_t)(end - at) <= n || memcmp(end + 1 - n, kinds[k], n) != 0)
        continue;
      const char *name = arena_text(&p->mem, at + 1, (size_t)(end - at) - 1);
      if (end[1] == ':') count += check_mean(folder, name, end);
    }
    at = end;
    if (at == NULL) break;
  }
  free(list.bytes);
  print_message("# %d pictures of the collection\n", count);
  assert_true(count >= 70);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, enter, leave)

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(formats_by_name),
      IN_FOLDER(content_decides),
      IN_FOLDER(only_regular_files),
      IN_FOLDER(repairs_are_counted),
      IN_FOLDER(old_file_survives),
      IN_FOLDER(devices_are_written),
      IN_FOLDER(links_stay_links),
      IN_FOLDER(permissions_are_kept),
      IN_FOLDER(long_names),
      IN_FOLDER(standard_output),
      IN_FOLDER(heads_tell_the_size),
      IN_FOLDER(heads_may_come_late),
      IN_FOLDER(means_of_a_collection),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
