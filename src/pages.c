// pages.c

// For madvise, which POSIX does not have.
#define _DEFAULT_SOURCE

#include "pages.h"

#include <stdint.h>
#include <sys/mman.h>
#include <unistd.h>

// Fewer bytes are not worth a system call.
enum { PAGES_WORTH_IT = 1 << 16 };

void pages_expect(void *p, size_t bytes) {
#ifdef MADV_POPULATE_WRITE
  if (bytes < PAGES_WORTH_IT) return;
  uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
  uintptr_t from = ((uintptr_t)p + page - 1) / page * page;
  uintptr_t to = ((uintptr_t)p + bytes) / page * page;
  madvise((void *)from, to - from, MADV_POPULATE_WRITE);
#else
  (void)p;
  (void)bytes;
#endif
}
