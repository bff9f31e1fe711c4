// digest.h — many bytes as one number, which is another one when a byte is.

#ifndef DIGEST_H
#define DIGEST_H

#include <stddef.h>
#include <stdint.h>

// The number to begin with.
#define DIGEST_START UINT64_C(0x66616365742e3136)

// The digest of what d stands for, followed by n bytes and by their number.
// Any change of bytes that lie in one word of eight changes it, and others do
// but for one in 2^64.  It is for accidents: who wants two texts of the same
// digest can make them.
uint64_t digest_add(uint64_t d, const void *bytes, size_t n);

#endif
