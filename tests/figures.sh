#!/bin/sh
# figures.sh SLUG: say for each picture that `make chapter-N` wrote whether it
# equals the book's.  "same": the same bytes; "close": within the tolerance of
# chapters/README.md (mean 0.5/255, 99.9 % of pixels within 4/255).  Exit 1
# when one differs or is missing on either side.
set -u
facet=${FACET:-build/facet}
book=chapters/$1/images made=build/figures/$1 bad=0
for path in "$made"/*.png "$book"/*.png; do
  [ -e "$path" ] || continue
  name=$(basename "$path")
  [ "$path" = "$book/$name" ] && [ -e "$made/$name" ] && continue
  if [ ! -e "$made/$name" ]; then verdict="not made"; bad=1
  elif [ ! -e "$book/$name" ]; then verdict="new (not in the book)"; bad=1
  elif cmp -s "$made/$name" "$book/$name"; then verdict=same
  elif "$facet" compare -q --metric mae --fail 0.00196 "$made/$name" "$book/$name" \
    && "$facet" compare -q --metric p99.9 --fail 0.01569 "$made/$name" "$book/$name"
  then verdict=close
  else verdict="DIFFERENT"; bad=1
  fi
  printf '%-40s %s\n' "$made/$name" "$verdict"
done
exit $bad
