#!/bin/sh
# What `make install` puts down works from there, with no source tree near: the
# program, a manual page for each command, completions for three shells, the
# scenes; and `make uninstall` takes all of it away.
. tests/tap.sh
inst="$T/a root" # with a blank, as somebody's will have
unset MAKEFLAGS MAKELEVEL
tree() { (cd "$inst" && find . ! -type d | LC_ALL=C sort); }
ok "make install" make -s install DESTDIR="$inst" PREFIX=/usr
facet="$inst/usr/bin/facet"
share="$inst/usr/share"
cd "$T" || exit 1

# The program, alone.
env -i HOME="$T" PATH=/usr/bin:/bin "$facet" render "$share/facet/scenes/cornell.scene" \
  --engine path -r 24x24 --spp 4 -q >"$T/out" 2>"$T/err"
ok "the installed program renders by paths" test -s cornell.png
mv cornell.png path.png
ok "the same picture as in its source tree" sh -c "\"$root/build/facet\" render \
  '$root/scenes/cornell.scene' --engine path -r 24x24 --spp 4 -q && cmp cornell.png path.png"
rm cornell.png
if env -i HOME="$T" PATH=/usr/bin:/bin "$facet" render "$share/facet/scenes/cornell.scene" \
  -r 24x24 -q >"$T/out" 2>"$T/err"; then ok "and by OpenGL, its shaders in it" test -s cornell.png
elif grep -q "no OpenGL\|OSMesa" "$T/err"; then skip "and by OpenGL" "there is none"
else fail "and by OpenGL, its shaders in it"; fi

# The manual.
commands=$("$facet" help | sed -n 's/^  facet \(\([a-z]\+ \)\+\)[A-Z[].*/\1/p' | sed 's/ *$//; s/ /-/g')
plain() { sed 's/\\-/-/g; s/\\(rs/\\/g; s/\\(aq/'"'"'/g; s/\\&//g' "$1"; }
flags() { sed -n "s/^$1"'\(-., \)\?--\([a-z0-9-]*\).*/\2/p' | LC_ALL=C sort; }
missing= unequal= untidy= unknown= pages=0
"$facet" help --man | cmp -s - "$share/man/man1/facet.1" || missing=" facet.1"
for c in $commands; do "$facet" help "$(echo "$c" | sed 's/-.*//')" $(echo "$c" | sed -n 's/.*-//p'); done |
  flags "  " | sort -u >all.flags
for c in $commands; do
  page="$share/man/man1/facet-$c.1"
  [ -s "$page" ] || { missing="$missing facet-$c.1"; continue; }
  pages=$((pages + 1))
  # shellcheck disable=SC2046
  "$facet" help $(echo "$c" | tr - ' ') | flags "  " >help.flags
  plain "$page" | flags ".B " >page.flags
  { [ -s page.flags ] && cmp -s help.flags page.flags; } || unequal="$unequal $c"
  for f in $(plain "$page" | grep -o -- '--[a-z][a-z0-9-]*' | sort -u); do
    [ "$f" = --version ] || grep -qx -- "${f#--}" all.flags || unknown="$unknown $c:$f"
  done
done
if [ -z "$missing" ] && [ "$pages" -gt 9 ]; then pass "a page for facet and each of $pages commands"
else fail "a page for each command, but for$missing"; fi
if [ -z "$unequal" ]; then pass "each lists the options of help, which cli.t feeds to the parser"
else fail "options of help and manual differ:$unequal"; fi
plain "$share/man/man1/facet.1" | flags ".B " | sort -u >page.flags
grep -vx "help\|no-color" all.flags >most.flags
ok "facet(1) has those of all" cmp most.flags page.flags
if [ -z "$unknown" ]; then pass "every --word of the pages is an option"
else fail "no such option:$unknown"; fi
for title in NAME SYNOPSIS DESCRIPTION COMMANDS "EXIT STATUS" SIGNALS FILES ENVIRONMENT LIMITS EXAMPLES "SEE ALSO"; do
  grep -qx ".SH $title" "$share/man/man1/facet.1" || untidy="$untidy $title"
done
if [ -z "$untidy" ]; then pass "facet(1) has all sections"; else fail "no section:$untidy"; fi
if command -v man >/dev/null && command -v groff >/dev/null; then
  for page in "$share"/man/man1/*; do
    MANROFFSEQ='' MANWIDTH=80 man --warnings -l "$page" 2>&1 >/dev/null | sed "s,^,$page: ,"
  done >"$T/err"
  if [ -s "$T/err" ]; then fail "the pages are well formed"; else pass "the pages are well formed"; fi
else skip "the pages are well formed" "no man"; fi

# Examples, of files that are not there, and of no cache: they get as far as
# that.
export XDG_CACHE_HOME="$T/cache"
mkdir empty && cd empty || exit 1
refused= count=0
{ for c in $commands; do
  # shellcheck disable=SC2046
  "$facet" help $(echo "$c" | tr - ' ') | sed -n '/^Examples:/,$s/^  facet //p'; done; } >../lines
while read -r line; do
  # shellcheck disable=SC2086
  "$facet" $line >/dev/null 2>"$T/err"
  got=$?
  count=$((count + 1))
  case $line,$got in help*,0 | cache*,0 | *,3) ;; *) refused="$refused; $line ($got)" ;; esac
done <../lines
if [ -z "$refused" ] && [ "$count" -gt 15 ]; then pass "$count examples are understood"
else fail "examples$refused"; fi
if [ -z "$(ls -A)" ]; then pass "and write nothing"; else fail "and write nothing"; fi
cd .. || exit 1

# Completions, by the shells themselves.
bash_file="$share/bash-completion/completions/facet"
typed() { # WORD...: what bash offers for the last one
  bash -c 'source "$1"; shift; COMP_WORDS=(facet "$@"); COMP_CWORD=$#
    _facet 2>/dev/null; echo "${COMPREPLY[*]}"' - "$bash_file" "$@"
}
offers() { # SHELL WANT GOT
  if [ "$2" = "$3" ]; then pass "$1: $2"; else echo "$3" >"$T/said"; fail "$1: $2"; fi
}
if command -v bash >/dev/null; then
  offers bash "render" "$(typed ren)"
  offers bash "--env --env-rotate --env-scale" "$(typed render --env)"
  offers bash "raster path auto" "$(typed render --engine "")"
  offers bash "path" "$(typed render --engine = pa)"
  offers bash "normal,depth normal,normal" "$(typed render --aov normal, | tr ' ' '\n' | sort | head -3 | tail -2 | paste -sd ' ')"
  offers bash "load rays raster error ibl" "$(typed bench "")"
  offers bash "" "$(typed render --fov "")"
  offers bash "" "$(typed render "")"
  wrong=
  for c in $commands; do
    # shellcheck disable=SC2046
    typed $(echo "$c" | tr - ' ') -- | tr ' ' '\n' | sed 's/^--//' | LC_ALL=C sort >bash.flags
    # shellcheck disable=SC2046
    "$facet" help $(echo "$c" | tr - ' ') | flags "  " | cmp -s - bash.flags || wrong="$wrong $c"
  done
  if [ -z "$wrong" ]; then pass "bash: all options of all commands"; else fail "bash:$wrong"; fi
else skip "bash" "not installed"; fi
if command -v zsh >/dev/null; then
  offers zsh "raster path auto" "$(zsh -fc '
    _arguments() { print -rl -- "$@" }
    words=(facet render "") CURRENT=3
    source "$1"' - "$share/zsh/site-functions/_facet" | sed -n 's/.*:engine:(\(.*\))$/\1/p')"
else skip "zsh" "not installed"; fi
if command -v fish >/dev/null; then
  ask() { HOME="$T" fish --no-config -c "source $share/fish/vendor_completions.d/facet.fish
    complete -C '$1'" | cut -f 1 | paste -sd ' '; }
  share=$(echo "$share" | sed 's/ /\\ /g')
  offers fish "auto path raster" "$(ask 'facet render --engine ')"
  offers fish "error ibl load raster rays" "$(ask 'facet bench ' | tr ' ' '\n' | sort | paste -sd ' ')"
  offers fish "--engine" "$(ask 'facet view --eng')"
else skip "fish" "not installed"; fi

cd "$root" || exit 1
rm -f "$T/said"
ok "make uninstall" make -s uninstall DESTDIR="$inst" PREFIX=/usr
if [ -z "$(tree)" ]; then pass "leaves nothing"; else tree >"$T/said"; fail "leaves nothing"; fi
finish
