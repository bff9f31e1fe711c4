#!/bin/sh
# What is kept from run to run: the picture is the same with and without, a
# damaged file is made anew, two processes do each other no harm, the folder
# stays within its limit.
. tests/tap.sh
XDG_CACHE_HOME=$T/cache
export XDG_CACHE_HOME
folder=$XDG_CACHE_HOME/facet
${CC:-cc} -O1 tests/bench/make_mesh.c -lm -o "$T/make_mesh"
"$T/make_mesh" ball 52000 >"$T/ball.obj"
"$T/make_mesh" streets 60000 >"$T/streets.obj"

# draw NAME OUT OPTIONS...: a small picture by paths; what --json says is in
# $T/OUT.json.
draw() {
  mesh=$1 out=$2
  shift 2
  "$facet" render "$T/$mesh.obj" --engine path -r 48x32 --spp 2 -q --json \
    -o "$T/$out.png" "$@" >"$T/$out.json"
}
came() { grep -q "\"from_cache\": $2" "$T/$1.json"; }
same() { cmp "$T/$1.png" "$T/$2.png"; }
kept() { find "$folder" -name "$1" 2>/dev/null | wc -l | tr -d ' '; }

draw ball without --no-cache
ok "--no-cache leaves nothing behind" test ! -e "$folder"
draw ball first
ok "the first run builds" came first false
draw ball second -j 3
ok "the second one reads" came second true
ok "built, kept or read: the same picture" \
  sh -c 'cmp "$1/first.png" "$1/without.png" && cmp "$1/first.png" "$1/second.png"' - "$T"
members='"(cost|nodes|parts|depth|dropped|bytes)": [0-9.]*'
ok "and the same is said of the tree" sh -c \
  'a=$(grep -oE "$2" "$1/first.json"); test -n "$a" && test "$a" = "$(grep -oE "$2" "$1/second.json")"' \
  - "$T" "$members"
sed 's/^v 0.0/v 0.1/' "$T/ball.obj" >"$T/other.obj"
draw other other
ok "another mesh is not taken for it" came other false

# Few rays: no triangle is cut; many: some are.  Either is kept by itself.
draw streets few
draw streets many -r 1600x1200 --spp 1 --crop 0,0,40,40
draw streets many-plain -r 1600x1200 --spp 1 --crop 0,0,40,40 --no-cache
ok "a tree with cut triangles is another tree" came many false
ok "which has parts" sh -c '! grep -q "\"parts\": 0," "$1/many.json"' - "$T"
draw streets few-again
draw streets many-again -r 1600x1200 --spp 1 --crop 0,0,40,40
ok "each comes back for its number of rays" \
  sh -c 'grep -q "parts\": 0,.*from_cache\": true" "$1/few-again.json" &&
         grep -q "parts\": [1-9].*from_cache\": true" "$1/many-again.json"' \
  - "$T"
ok "with its picture" sh -c 'cmp "$1/few.png" "$1/few-again.png" &&
  cmp "$1/many.png" "$1/many-again.png" &&
  cmp "$1/many.png" "$1/many-plain.png"' - "$T"

# A dome of 51,200 triangles, exactly convex.
awk 'BEGIN { n = 161
  for (j = 0; j < n; j++) for (i = 0; i < n; i++)
    printf "v %d %.6f %d\n", i - 80, -((i - 80)^2 + (j - 80)^2) / 64, 80 - j
  for (j = 1; j < n; j++) for (i = 1; i < n; i++) {
    a = (j - 1) * n + i
    printf "f %d %d %d\nf %d %d %d\n", a, a + 1, a + n, a + 1, a + n + 1, a + n }
}' >"$T/dome.obj"

# Patches: looked for where the rays repay it, kept with the tree, and no
# reason to write it again; another picture for nobody.
"$facet" cache clear >"$T/out"
has() { grep -q "\"patches\": $2" "$T/$1.json"; }
draw dome few
ok "few rays look for no patches" has few false
draw dome many -r 1600x1200 --spp 1 --crop 0,0,40,40
ok "many do" sh -c 'grep -q "patches\": true.*from_cache\": true" "$1"' - \
  "$T/many.json"
cp "$folder"/tree-*.bin "$T/with"
draw dome few-again
ok "then few have them too" has few-again true
ok "of the same file" cmp "$folder"/tree-*.bin "$T/with"
draw dome all --no-skip
ok "--no-skip looks at everything" has all false
draw dome many-plain -r 1600x1200 --spp 1 --crop 0,0,40,40 --no-cache
draw dome many-all -r 1600x1200 --spp 1 --crop 0,0,40,40 --no-cache --no-skip
ok "and all pictures are the same" sh -c 'cmp "$1/few.png" "$1/few-again.png" &&
  cmp "$1/few.png" "$1/all.png" && cmp "$1/many.png" "$1/many-plain.png" &&
  cmp "$1/many.png" "$1/many-all.png"' - "$T"
rm "$folder"/tree-*.bin

# Damage of all kinds: a byte of the head, of the facts, of a node, of the last
# triangle; cut short; nothing left; too long.
"$facet" cache clear >"$T/out"
draw ball first
file=$(ls "$folder"/tree-*.bin)
cp "$file" "$T/whole"
size=$(wc -c <"$T/whole" | tr -d ' ')
for at in 3 9 25 41 200 5000 $((size - 7)); do
  cp "$T/whole" "$file"
  printf '\377' | dd of="$file" bs=1 seek="$at" conv=notrunc 2>"$T/dd"
  cmp -s "$file" "$T/whole" && printf '\1' |
    dd of="$file" bs=1 seek="$at" conv=notrunc 2>"$T/dd"
  draw ball hurt
  ok "byte $at is wrong: built, the same picture, and kept again" \
    sh -c 'grep -q "from_cache\": false" "$1/hurt.json" &&
           cmp "$1/hurt.png" "$1/without.png" && cmp "$1/whole" "$2"' \
    - "$T" "$file"
done
for part in 0 100 "$((size / 2))"; do
  head -c "$part" "$T/whole" >"$file"
  draw ball hurt
  ok "only $part bytes are left: the same" \
    sh -c 'cmp "$1/hurt.png" "$1/without.png" && cmp "$1/whole" "$2"' \
    - "$T" "$file"
done
cat "$T/whole" "$T/whole" >"$file"
draw ball hurt
ok "it is too long: the same" cmp "$T/whole" "$file"
rm "$file"
mkdir "$file"
ok "a folder in its place: the same picture" draw ball hurt
ok "byte for byte" same hurt without
rmdir "$file"
mkfifo "$file"
ok "a pipe in its place does not block" timeout 100 "$facet" render \
  "$T/ball.obj" --engine path -r 48x32 --spp 2 -q -o "$T/hurt.png"
ok "and gives way" cmp "$T/whole" "$file"
rm -f "$file"
FACET_CACHE_MIB=0 draw ball off
ok "FACET_CACHE_MIB=0 keeps nothing" test "$(kept '*.bin')" = 0
XDG_CACHE_HOME=/dev/null
draw ball nowhere
ok "no place for a cache is no error" same nowhere without
XDG_CACHE_HOME=$T/cache

# 500 KiB or 1000, as the shell counts: enough for the picture.
ok "a limit of the shell is no error" sh -c 'ulimit -f 1000
  "$1" render "$2/ball.obj" --engine path -r 48x32 --spp 2 -q -o "$2/hurt.png"' \
  - "$facet" "$T"
ok "nor is anything left of what did not fit" test "$(kept '*tree*')" = 0
ok "and the picture is there" same hurt without
case $FACET_SANITIZED in
*thread*) skip "whose own limit is one" "ThreadSanitizer writes a file before facet starts" ;;
*) ok "whose own limit is one" sh -c 'ulimit -f 0
  "$1" render "$2/ball.obj" --engine path -r 48x32 -q --no-cache -o "$2/no.png"
  test $? = 4 && test ! -e "$2/no.png"' - "$facet" "$T" ;;
esac

# Six at once, none of which finds a file at its start.
for i in 1 2 3 4 5 6; do draw ball "at$i" -j 1 & done
wait
ok "six processes at once: six equal pictures" sh -c \
  'for i in 1 2 3 4 5 6; do cmp "$1/at$i.png" "$1/without.png" || exit 1; done' \
  - "$T"
ok "and one whole file" cmp "$T/whole" "$file"
ok "without anything half-written beside it" test "$(kept '.*')" = 0

# Both kinds share the limit; a tree takes 2.3 MB, the light of an environment
# 0.8 MB and more.
"$facet" render "$root/scenes/garden.obj" -r 32x32 --env "$root/scenes/sky.hdr" \
  -q -o "$T/sky.png" 2>"$T/err" && light=yes || light=no
if [ $light = yes ]; then
  ok "show lists both kinds" sh -c '"$2" cache >"$1/out" &&
    grep -q "^tree .*s ago .*triangles, ball.obj" "$1/out" &&
    grep -q "^ibl .*environment of 1024x512" "$1/out"' - "$T" "$facet"
else
  skip "show lists both kinds" "no OpenGL"
fi
"$facet" cache show --json >"$T/cache.json"
if command -v python3 >"$T/out"; then
  ok "--json: the total is that of the files, and of the disk" python3 -c '
import json, os, sys
d = json.load(open(sys.argv[1]))
on_disk = sum(os.path.getsize(os.path.join(d["folder"], f["name"]))
              for f in d["files"])
assert d["files"] and d["bytes"] == on_disk
assert d["bytes"] == sum(f["bytes"] for f in d["files"])
assert d["limit"] == 256 << 20
assert all(0 <= f["age"] < 600 and f["for"] for f in d["files"])
' "$T/cache.json"
else
  skip "--json: the total is that of the files" "no python3"
fi
touch -d '2 hours ago' "$folder"/ibl-* 2>"$T/err"
touch -d '1 hour ago' "$file"
FACET_CACHE_MIB=5 draw other other
ok "beyond the limit the oldest goes, of whatever kind" \
  sh -c 'test -z "$(find "$2" -name "ibl-*")" && test -f "$1"' - "$file" "$folder"
touch -d '1 hour ago' "$file"
FACET_CACHE_MIB=5 draw ball used
FACET_CACHE_MIB=5 draw streets few
ok "reading a file makes it young" test -f "$file"
ok "which the one before it was not" test "$(kept 'tree-*')" = 2
FACET_CACHE_MIB=1 draw other other
ok "what is too large alone pushes nothing out" test -f "$file"
exits 2 "cache wants to know what it knows" "$facet" cache tidy
says "expected show or clear" "and says so"
exits 0 "clear" "$facet" cache clear
ok "says how much" grep -q "2 files removed, [45] MiB" "$T/out"
ok "and leaves nothing" test "$(kept '*')" = 1
exits 0 "show of nothing" "$facet" cache
exits 0 "clear of nothing" "$facet" cache clear
finish
