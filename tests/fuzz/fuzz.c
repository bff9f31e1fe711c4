// fuzz.c — one target for libFuzzer: cc -DTARGET=target_obj ...

#include "targets.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  return TARGET(data, size);
}
