#!/bin/sh
# src/README.md, the map, names each module once and in the Makefile's order;
# the README's table of chapters names each chapter's folder; and the top level
# holds what the README says and no more.
: "${MODULES:?run by make test}"
echo 1..3

map=$(sed -n 's/^| `\([a-z0-9_]*\)` | .*/\1/p' src/README.md)
if [ "$map" = "$(echo "$MODULES" | tr -s ' ' '\n')" ]; then echo "ok 1 - map"
else
  echo "not ok 1 - map"
  echo "$MODULES" | tr -s ' ' '\n' >build/map.modules
  echo "$map" | diff build/map.modules - | sed 's/^/# /'
fi

bad=
for folder in chapters/[0-9]*/; do
  grep -qF "($folder" README.md || bad="$bad $folder"
done
if [ -z "$bad" ]; then echo "ok 2 - chapters"
else echo "not ok 2 - chapters"; echo "# not in README.md:$bad"; fi

if top=$(git ls-files 2>/dev/null) && [ -n "$top" ]; then
  top=$(echo "$top" | sed 's,/.*,,' | grep -v '^[.]' | LC_ALL=C sort -u | tr '\n' ' ')
  want="Makefile README.md chapters debian scenes shaders src tests "
  if [ "$top" = "$want" ]; then echo "ok 3 - top level"
  else echo "not ok 3 - top level"; echo "# $top"; fi
else echo "ok 3 - top level # SKIP no git clone"
fi
