#!/bin/sh
# embed.sh FILE...: C source of the table GLSL_FILES, the texts as bytes.  GLSL
# is ASCII: whatever else comments hold becomes a dash.
echo '#include "glsl.h"'
i=0
for file; do
  i=$((i + 1))
  echo "static const char TEXT_$i[] = {"
  LC_ALL=C tr '\200-\377' '-' <"$file" | od -An -v -tx1 |
    sed 's/\([0-9a-f][0-9a-f]\)/0x\1,/g'
  echo '0};'
done
echo 'const glsl_file GLSL_FILES[] = {'
i=0
for file; do
  i=$((i + 1))
  echo "  {\"$(basename "$file")\", TEXT_$i},"
done
echo '  {0, 0}};'
