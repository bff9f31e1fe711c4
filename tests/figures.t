#!/bin/sh
# `make chapter-N` makes the pictures of the book.
set -- ${CHAPTERS:-1 2 3 4 5 8 9}
echo "1..$#"
k=0
for n; do
  k=$((k + 1))
  slug=$(basename chapters/"$(printf %02d "$n")"-*)
  mkdir -p "build/figures/$slug"
  rm -f "build/figures/$slug"/*.png
  if "build/release/chapter-$n" "build/figures/$slug" >"build/figures-$n.log" 2>&1 &&
    tests/figures.sh "$slug" >>"build/figures-$n.log"
  then echo "ok $k - $slug"
  else echo "not ok $k - $slug"; sed 's/^/# /' "build/figures-$n.log"; fi
done
