// glyph.c

#include "glyph.h"

// The printable characters of ASCII, from space to tilde.
static const char *const strokes[] = {
    "",                                     // space
    "0g08 0405",                            // !
    "0g0d 3g3d",                            // "
    "242g 646g 0888 0c8c",                  // #
    "8e6e2e0c2a6a88662608 4g44",            // $
    "048g 0g2g2d0d0g 6787848464 6764",      // %
    "841d1e2g4g5e5d090624447589",           // &
    "0g0d",                                 // '
    "3g0c0834",                             // (
    "0g3c3804",                             // )
    "3f39 0d6b 0b6d",                       // *
    "0868 3b35",                            // +
    "1502",                                 // ,
    "0858",                                 // -
    "0405",                                 // .
    "026g",                                 // /
    "24060e2g4g6e664424",                   // 0
    "0d3g34 0464",                          // 1
    "0d0e2g4g6e6c0464",                     // 2
    "0e2g4g6e6c4a2a 4a6866442406",          // 3
    "444g0868",                             // 4
    "6g0g0b4b6966442406",                   // 5
    "5g2e0b06244466694b2b09",               // 6
    "0g6g24",                               // 7
    "2a0c0e2g4g6e6c4a2a0806244466684a",     // 8
    "1445696e4g2g0e0b29496b",               // 9
    "0405 0b0c",                            // :
    "1b1c 1502",                            // ;
    "6c0864",                               // <
    "0a6a 0666",                            // =
    "0c6804",                               // >
    "0e2g4g6e6c3a38 3435",                  // ?
    "6424060e2g6g8e886759 5c3c2a2948595c",  // @
    "044g84 1777",                          // A
    "040g5g7e7c5a0a 5a88866404",            // B
    "8e6g2g0e06246486",                     // C
    "040g5g8d875404",                       // D
    "8g0g0484 0a6a",                        // E
    "8g0g04 0a6a",                          // F
    "8e6g2g0e062464868a5a",                 // G
    "040g 848g 0a8a",                       // H
    "040g",                                 // I
    "6g66442406",                           // J
    "040g 8g09 2b84",                       // K
    "0g0474",                               // L
    "040g468g84",                           // M
    "040g848g",                             // N
    "24060e2g6g8e866424",                   // O
    "040g6g8e8b6909",                       // P
    "24060e2g6g8e866424 5883",              // Q
    "040g6g8e8b6909 4984",                  // R
    "8e6g2g0e0c2a6a8886642406",             // S
    "0g8g 4g44",                            // T
    "0g062464868g",                         // U
    "0g448g",                               // V
    "0g245e84ag",                           // W
    "048g 0g84",                            // X
    "0g4a8g 4a44",                          // Y
    "0g8g0484",                             // Z
    "3g0g0232",                             // [
    "0g62",                                 // backslash
    "0g3g3202",                             // ]
    "0c3g6c",                               // ^
    "0282",                                 // _
    "0g2d",                                 // `
    "6c64 6a4c2c0a06244466",                // a
    "0g04 0a2c4c6a66442406",                // b
    "6a4c2c0a06244466",                     // c
    "6g64 6a4c2c0a06244466",                // d
    "08686a4c2c0a06244466",                 // e
    "5g4g2e24 0c4c",                        // f
    "6c62402001 6a4c2c0a06244466",          // g
    "0g04 0a2c4c6a64",                      // h
    "040c 0f0g",                            // i
    "2c2200 2f2g",                          // j
    "0g04 6c07 2964",                       // k
    "0g04",                                 // l
    "0c04 0a2c3c5a54 5a7c8caaa4",           // m
    "0c04 0a2c4c6a64",                      // n
    "24060a2c4c6a664424",                   // o
    "0c00 0a2c4c6a66442406",                // p
    "6c60 6a4c2c0a06244466",                // q
    "0c04 0a2c4c5b",                        // r
    "6b4c2c0a284866442405",                 // s
    "2g264454 0c5c",                        // t
    "0c06244466 6c64",                      // u
    "0c346c",                               // v
    "0c244b648c",                           // w
    "046c 0c64",                            // x
    "0c34 6c2000",                          // y
    "0c6c0464",                             // z
    "4g2f2a09282342",                       // {
    "0g02",                                 // |
    "0g2f2a49282302",                       // }
    "082a4769",                             // ~
};

const char *glyph_strokes(char c) {
  return strokes[c < ' ' || c > '~' ? '?' - ' ' : c - ' '];
}

int glyph_digit(char c) {
  return c <= '9' ? c - '0' : c - 'a' + 10;
}

int glyph_advance(char c) {
  const char *s = glyph_strokes(c);
  if (*s == 0) return 4 + GLYPH_GAP;
  int width = 0;
  for (; *s != 0; s++) {
    if (*s == ' ') continue;
    int x = glyph_digit(*s++);
    if (x > width) width = x;
  }
  return width + GLYPH_GAP;
}
