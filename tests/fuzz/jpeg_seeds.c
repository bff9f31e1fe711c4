// jpeg_seeds.c — the seeds that only an encoder can make:
//   jpeg_seeds FOLDER writes FOLDER/grey, colour, progressive and restarts.

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

// A flavour of JPEG.
typedef struct flavour {
  const char *name;
  int width, height, channels, sampling;  // of chroma, 1 or 2
  bool progressive;
  unsigned restart;  // blocks between markers, 0: none
} flavour;

static const flavour FLAVOURS[] = {
    {"grey", 9, 7, 1, 1, false, 0},
    {"colour", 17, 9, 3, 2, false, 0},
    {"progressive", 10, 8, 3, 1, true, 0},
    {"restarts", 33, 8, 3, 1, false, 1},
};

static void write_flavour(const flavour *k, FILE *f) {
  struct jpeg_compress_struct jpeg;
  struct jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  jpeg_stdio_dest(&jpeg, f);
  jpeg.image_width = (JDIMENSION)k->width;
  jpeg.image_height = (JDIMENSION)k->height;
  jpeg.input_components = k->channels;
  jpeg.in_color_space = k->channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 60, TRUE);
  jpeg.optimize_coding = TRUE;
  jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor =
      k->sampling;
  jpeg.restart_interval = k->restart;
  if (k->progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < k->height; y++) {
    JSAMPLE row[256];
    for (int i = 0; i < k->width * k->channels; i++)
      row[i] = (JSAMPLE)(i * 9 + y * 31);
    JSAMPROW at = row;
    jpeg_write_scanlines(&jpeg, &at, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
}

int main(int argc, char **argv) {
  for (size_t i = 0; i < sizeof FLAVOURS / sizeof *FLAVOURS; i++) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", argc > 1 ? argv[1] : ".",
             FLAVOURS[i].name);
    FILE *f = fopen(path, "wb");
    if (f == NULL) return 1;
    write_flavour(&FLAVOURS[i], f);
    if (fclose(f) != 0) return 1;
  }
  return 0;
}
