// fuzz.c — one target for libFuzzer or AFL++: cc -DTARGET=target_obj ...

#include "targets.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  return TARGET(data, size);
}

// AFL++ changes inputs by itself.
#ifndef __AFL_COMPILER
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t room);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room,
                               unsigned seed);

// What libFuzzer would do, and three times in four the checksums too.
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room,
                               unsigned seed) {
  size = LLVMFuzzerMutate(data, size, room);
  if (seed % 4 == 0) return size;
  mend_png(data, size);
  mend_part(data, size);
  return size;
}
#endif
