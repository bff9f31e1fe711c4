// jpeg.c

#include "jpeg.h"

#include "file.h"

#include <jerror.h>
#include <jpeglib.h>
#include <setjmp.h>

// Huffman codes need a bit for each block of 8 x 8 samples, so that a byte
// cannot stand for more pixels than this.  Source: ITU-T T.81, F.1.2.1: every
// block's DC coefficient has a code.
enum { HUFFMAN_MAX_PIXELS = 8 * 64 };

// A progressive file may repaint all of the picture with every few bytes.  Real
// ones do so about ten times, and have some bits for each block.
enum { MAX_SCANS = 200, MAX_BYTE_WORK = 8192, FREE_WORK = 1 << 28 };

// One file in work.  manager comes first: libjpeg hands its address back.
typedef struct jpeg_job {
  struct jpeg_error_mgr manager;
  jmp_buf back;
  struct jpeg_decompress_struct jpeg;
  struct jpeg_progress_mgr progress;
  arena scratch;
  pixmap map;
  uint64_t file_bytes;
  char problem[JMSG_LENGTH_MAX];
} jpeg_job;

// libjpeg's last word: keep it and leave.
static _Noreturn void jpeg_failed(j_common_ptr jpeg) {
  jpeg_job *job = (jpeg_job *)jpeg->err;
  job->manager.format_message(jpeg, job->problem);
  longjmp(job->back, 1);
}

// Level -1 is a warning: the data is damaged or ends early, and libjpeg would
// paint the rest grey.  Spare bytes between two segments and odd version
// numbers are warned of too, but harm nobody: cameras write them.  Other levels
// trace.
static void jpeg_said(j_common_ptr jpeg, int level) {
  int code = jpeg->err->msg_code;
  bool harmless = code == JWRN_EXTRANEOUS_DATA || code == JWRN_JFIF_MAJOR ||
                  code == JWRN_ADOBE_XFORM;
  if (level < 0 && !harmless) jpeg_failed(jpeg);
}

// Leave with our own words.
static _Noreturn void jpeg_refuse(jpeg_job *job, const char *why) {
  snprintf(job->problem, sizeof job->problem, "%s", why);
  longjmp(job->back, 1);
}

// Called now and then while libjpeg works.
static void jpeg_watch(j_common_ptr jpeg) {
  jpeg_job *job = (jpeg_job *)jpeg->err;
  if (job->jpeg.input_scan_number > MAX_SCANS)
    jpeg_refuse(job, "it has more than 200 scans");
  uint64_t work = (uint64_t)job->jpeg.input_scan_number *
                  job->jpeg.image_width * job->jpeg.image_height;
  if (work > FREE_WORK && work / MAX_BYTE_WORK > job->file_bytes)
    jpeg_refuse(job, "it repaints the picture too often for its length");
}

// Refuse what would cost more memory than its bytes can be worth.
static void jpeg_check_size(jpeg_job *job) {
  uint64_t w = job->jpeg.image_width, h = job->jpeg.image_height;
  if (w > IMAGE_MAX_SIDE || h > IMAGE_MAX_SIDE)
    jpeg_refuse(job, "a side is longer than 65535 pixels");
  if (job->jpeg.num_components == 4)
    jpeg_refuse(job, "it is in CMYK, expected grey or RGB");
  if (job->jpeg.arith_code) jpeg_refuse(job, "arithmetic coding is not read");
  if (w * h / HUFFMAN_MAX_PIXELS > job->file_bytes)
    jpeg_refuse(job, "the file is too short for its width and height");
}

// Read all into job.  Errors leave by longjmp.
static void jpeg_decode(jpeg_job *job, FILE *f) {
  struct jpeg_decompress_struct *jpeg = &job->jpeg;
  jpeg_create_decompress(jpeg);
  job->progress.progress_monitor = jpeg_watch;
  jpeg->progress = &job->progress;
  jpeg_stdio_src(jpeg, f);
  jpeg_read_header(jpeg, TRUE);
  jpeg_check_size(job);
  bool grey = jpeg->jpeg_color_space == JCS_GRAYSCALE;
  jpeg->out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
  // The slow transform is the accurate one, the same on every machine.
  jpeg->dct_method = JDCT_ISLOW;
  jpeg_start_decompress(jpeg);
  pixmap *map = &job->map;
  *map = (pixmap){(int)jpeg->output_width, (int)jpeg->output_height,
                  jpeg->output_components, 8, NULL};
  size_t row = (size_t)map->width * (size_t)map->channels;
  uint8_t *bytes = arena_alloc(&job->scratch, (size_t)map->height, row);
  map->samples = bytes;
  while (jpeg->output_scanline < jpeg->output_height) {
    JSAMPROW to = bytes + jpeg->output_scanline * row;
    jpeg_read_scanlines(jpeg, &to, 1);
  }
  jpeg_finish_decompress(jpeg);
}

// The place that longjmp comes back to.
static bool jpeg_try_decode(jpeg_job *job, FILE *f) {
  if (setjmp(job->back) != 0) return false;
  jpeg_decode(job, f);
  return true;
}

bool jpeg_load(pixmap *out, FILE *f, const char *name, arena *mem, error *err) {
  jpeg_job job = {.file_bytes = file_left(f)};
  job.jpeg.err = jpeg_std_error(&job.manager);
  job.manager.error_exit = jpeg_failed;
  job.manager.emit_message = jpeg_said;
  bool ok = jpeg_try_decode(&job, f);
  jpeg_destroy_decompress(&job.jpeg);
  if (ok) {
    arena_adopt(mem, &job.scratch);
    *out = job.map;
    return true;
  }
  arena_free(&job.scratch);
  return fail(err, "%s: not a whole JPEG file: %s", name, job.problem);
}
