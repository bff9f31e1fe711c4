// glyph.h — letters as strokes of a pen.

#ifndef GLYPH_H
#define GLYPH_H

// Units of the grid on which letters are drawn: the base line, the height of
// an x, that of a capital, and the room between two letters.
enum { GLYPH_BASE = 4, GLYPH_X = 12, GLYPH_CAPITAL = 16, GLYPH_GAP = 3 };

// The strokes of a character: points as pairs of digits, x to the right and y
// upwards, each digit 0-9 or a-g for 10-16; a space lifts the pen.  What is not
// printable ASCII is drawn as a question mark.
const char *glyph_strokes(char c);

// The number that a digit of those pairs stands for.
int glyph_digit(char c);

// Units from the left edge of one letter to that of the next.
int glyph_advance(char c);

#endif
