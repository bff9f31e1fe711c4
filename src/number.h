// number.h — decimal text to float, correctly rounded and fast.

#ifndef NUMBER_H
#define NUMBER_H

// Parse the longest decimal float at p, before end: sign, digits with or
// without a point, exponent; or inf, infinity, nan in any case.  Returns the
// first byte after it, or NULL when there is no number at p.  The value is the
// float nearest to the decimal, ties to even: bit for bit what strtof gives in
// the C locale, in any locale.
const char *number_float(const char *p, const char *end, float *out);

// Parse a decimal integer with sign.  NULL when there is none or it does not
// fit 64 bits.
const char *number_int(const char *p, const char *end, long long *out);

#endif
