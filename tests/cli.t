#!/bin/sh
# What the command line accepts and refuses: every option that help prints is
# parsed, every exit code is what the manual says, every refusal names what is
# right.
. tests/tap.sh
cd "$T" || exit 1
write_obj a.obj

exits 2 "no command is a usage error" "$facet"
says "facet render" "and lists the commands"
exits 0 "--version" "$facet" --version
exits 0 "--help" "$facet" --help
exits 0 "render --help" "$facet" render --help
exits 0 "bench --help" "$facet" bench --help
exits 0 "help --man" "$facet" help --man
if command -v man >/dev/null && command -v groff >/dev/null; then
  man --warnings -l "$T/out" >"$T/page" 2>"$T/err"
  if [ -s "$T/page" ] && [ ! -s "$T/err" ]; then pass "the manual page is well formed"
  else fail "the manual page is well formed"; fi
else skip "the manual page is well formed" "no man"; fi

"$facet" help render >"$T/out"
ok "help shows the default" grep -q "samples a pixel" "$T/out"
ok "of numbers" sh -c 'tr -s " \n" " " <out | grep -q "without it (default: 64)"'

# Every option of every command, with every word that it offers.  The file is
# not there, so exit 3 says that the command line itself was fine.
for command in render merge view info compare ibl "bench load" "bench rays" "bench raster" "bench ibl" "bench error"; do
  # shellcheck disable=SC2086
  "$facet" help $command >"$T/help" || fail "help $command"
  wrong= count=0 operands=missing.obj
  [ "$command" = compare ] && operands="missing.png missing.png"
  [ "$command" = merge ] && operands="missing.part -o x.png"
  [ "$command" = ibl ] && operands="missing.hdr -o ibl"
  [ "$command" = "bench ibl" ] && operands=missing.hdr
  sed -n 's/^  \(-., \)\?--\([a-z-]*\) \?\([^ ]*\).*/\2 \3/p' "$T/help" >"$T/flags"
  while read -r flag argument; do
    [ "$flag" = help ] && continue
    case $argument in
    N|K|SECONDS|REL|S|STOPS|T|DEG) values=1 ;;
    X,Y,Z) values=1,-2,.5e1 ;;
    I/N) values="1/1 0/3 3/3 2/1000000" ;;
    WxH) values=8x4 ;;
    "frosted[=RADIUS]") values="frosted frosted=3" ;;
    N,...) values="1 4,16" ;;
    WxH,...) values="8x4 8x4,16x8,1x1" ;;
    X0,Y0,X1,Y1) values=0,0,4,4 ;;
    "FILE|R,G,B|none") values="1,1,1 none x.hdr" ;;
    FILE|NAME|OUT.png|REF-VARIANCE.pfm) values=x.png ;;
    "") values=- ;;
    *) values=$(echo "$argument" | tr '|' ' ') ;;
    esac
    for value in $values; do
      for form in "--$flag $value" "--$flag=$value"; do
        [ "$value" = - ] && form="--$flag"
        case $flag in
        aov|checkpoint) form="$form --engine path" ;;
        every|resume) form="$form --engine path --checkpoint c.part" ;;
        shard) form="$form --engine path -o x.part" ;;
        format) [ "$command $value" = "render part" ] && form="$form --engine path" ;;
        esac
        # shellcheck disable=SC2086
        "$facet" $command $form $operands >"$T/out" 2>"$T/err"
        [ $? = 3 ] || wrong="$wrong $form"
        count=$((count + 1))
      done
    done
  done <"$T/flags"
  if [ -z "$wrong" ] && [ "$count" -gt 5 ]; then
    pass "$command: every option of help is parsed ($count command lines)"
  else fail "$command: not parsed:$wrong"; fi
done

exits 3 "-j4 -qv: joined value, bundled switches" "$facet" render -j4 -qv missing.obj
exits 3 "-- ends the options" "$facet" render -- -x.obj
exits 0 "the last one wins" "$facet" render a.obj -q --msaa 9 -r 8x8 -r 5x4 --msaa 1 -o l.png
"$facet" info --json l.png >out.json
ok "and decides the size" grep -q '"width": 5, "height": 4' out.json

refused=0 accepted=
for words in "--spp 3x" "--spp 0" "--spp -1" "--spp 1e3" "--spp 1.5" "--spp=" \
  "--spp 99999999999999999999" "--fov 0" "--fov 180" "--fov nan" "--fov inf" \
  "--fov 0x10" "--fov 1e999" "--fov 40deg" "-r 10" "-r 10x" "-r 10x10x10" \
  "-r 0x10" "-r 65536x10" "-r 10,10" "--eye 1,2" "--eye 1,2,3,4" "--eye 1,,3" \
  "--eye 1,2,3," "--eye a,b,c" "--crop 0,0,4" "--crop 0,0,4,4,4" \
  "--crop -1,0,4,4" "--msaa 0" "--gl opengl" "--pbr-model phong" "--aov normal,,depth" "--aov normal," "--aov norm" \
  "--time 0" "--time -1" "--error 0" "--seed -1" "-j 0" "-j 1.5" "-j" \
  "--threads=x" "--depth 12" "--tonemap filmic" "--up-axis X" "--strict=1" \
  "--shard 3" "--shard 3/2" "--shard -1/2" "--shard 1/0" "--shard 1/2/3" \
  "--shard 1/2x" "--shard /" "--every -1" "--resume=1" "--checkpoint" \
  "--lights maybe" "--exposure bright" "--crease 181" "--nonsense" "-Z" "-qZ" \
  "--output --json" "--spp"; do
  # shellcheck disable=SC2086
  "$facet" render a.obj $words >"$T/out" 2>"$T/err"
  if [ $? = 2 ] && [ -s "$T/err" ] && [ ! -s "$T/out" ]; then refused=$((refused + 1))
  else accepted="$accepted; $words"; fi
done
if [ -z "$accepted" ]; then pass "$refused wrong values are refused"
else fail "refused with exit 2$accepted"; fi

nearest() { # WORDS NEAREST
  # shellcheck disable=SC2086
  exits 2 "facet $1 is refused" "$facet" $1
  says "$2" "and names $2"
}
nearest "rendr a.obj" "'render'"
nearest "render a.obj --spq 3" "--spp"
nearest "render a.obj --resolutoin=3x3" "--resolution"
nearest "render a.obj --shading albdo" "albedo"
nearest "compare --metrics mae a b" "--metric"
nearest "bench lod a.obj" "bench load"
nearest "a.obj" "facet render a.obj"
for later in "render a.obj --format exr"; do
  # shellcheck disable=SC2086
  "$facet" $later >"$T/out" 2>"$T/err"
  [ $? = 2 ] && grep -q "not in this version" "$T/err" || { fail "$later"; continue; }
  words=${later##* --}
  "$facet" help render | grep -q -- "--${words%% *} .*${words#* }" && fail "help offers $later"
done
pass "what is to come is refused as such, and not in help"

exits 2 "no operand" "$facet" render
exits 2 "too many operands" "$facet" render a.obj b.obj
exits 2 "merge without a target" "$facet" merge a.part
exits 2 "a shard of the raster engine" "$facet" render a.obj --shard 1/2
says "--shard needs --engine path" "which has no samples to deal out"
exits 2 "a shard as a picture" "$facet" render a.obj --engine path --shard 1/2 -o x.png
exits 2 "a shard that goes where samples help" "$facet" render a.obj --engine path --shard 1/2 --error 0.1
exits 2 "--resume from nothing" "$facet" render a.obj --engine path --resume
exits 2 "--every without a checkpoint" "$facet" render a.obj --engine path --every 3
exits 2 "an unknown suffix" "$facet" render a.obj -o x.xyz
exits 2 "-o - without --format" "$facet" render a.obj -o -
exits 2 "-o - with --json" "$facet" render a.obj -o - --format png --json
exits 2 "variance without paths" "$facet" render a.obj --aov variance
says "--engine path" "and who has it"
exits 2 "a crop outside of the picture" "$facet" render a.obj -r 8x8 --crop 0,0,9,8
exits 2 "an empty crop" "$facet" render a.obj -r 8x8 --crop 3,0,3,8
exits 2 "a camera that does not exist" "$facet" render a.obj --camera nobody
exits 2 "eye and target in one place" "$facet" render a.obj --eye 1,1,1 --target 1,1,1
exits 3 "a missing file" "$facet" render missing.obj
says "missing.obj" "is named"
exits 3 "a missing environment" "$facet" render a.obj --env missing.hdr
exits 4 "a missing folder" "$facet" render a.obj -o missing/x.png
mkdir folder.png
exits 4 "a folder as output" "$facet" render a.obj -o folder.png
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n' >bad.obj
exits 3 "a malformed file" "$facet" render bad.obj
says "bad.obj:4" "is said with its line"

# Standard output that breaks.
"$facet" help render >/dev/full 2>"$T/err"
if [ $? = 4 ]; then pass "help on a full disk"; else fail "help on a full disk"; fi
"$facet" info a.obj >&- 2>"$T/err"
if [ $? = 4 ]; then pass "info on closed output"; else fail "info on closed output"; fi
{ "$facet" render a.obj -r 640x480 -q -o - --format pfm; echo $? >code; } |
  head -c 10 >/dev/null 2>&1
if [ "$(cat code)" = 4 ]; then pass "a reader that leaves"; else fail "a reader that leaves"; fi

# On a terminal, which script(1) plays.
if script -qec true /dev/null </dev/null >/dev/null 2>&1; then
  tty() { TERM=${term-xterm} script -qec "$*" /dev/null </dev/null >"$T/out" 2>&1; }
  escape=$(printf '\033')
  tty "$facet" render missing.obj
  ok "colours on a terminal" grep -q "$escape\[1;31m" "$T/out"
  for plain in "NO_COLOR=1 $facet render missing.obj" "TERM=dumb $facet render missing.obj" \
    "$facet render --no-color missing.obj"; do
    tty "env $plain"
    if grep -q missing.obj "$T/out" && ! grep -q "$escape" "$T/out"
    then pass "none with ${plain%% *}"; else fail "none with ${plain%% *}"; fi
  done
  tty "$facet" render a.obj -o - --format png
  ok "no picture to a terminal" grep -q "will not write a picture to a terminal" "$T/out"
  tty "$facet" render --engine path a.obj -r 64x48 --spp 4 -o tty.png
  ok "a bar on a terminal" grep -q "samples/s" "$T/out"
  tty env TERM=dumb "$facet" render --engine path a.obj -r 64x48 --spp 4 -o tty.png
  if grep -q "tty.png: 64x48" "$T/out" && ! grep -q "samples/s\|$escape" "$T/out"
  then pass "none on a dumb one"; else fail "none on a dumb one"; fi
else skip "terminals" "no script(1)"; fi
"$facet" render --engine path a.obj -r 64x48 --spp 4 -o log.png 2>"$T/err"
if [ "$(wc -l <"$T/err")" = 1 ] && grep -q '^log.png: 64x48, 4 spp, .* s, 3 triangles, no warnings$' "$T/err"
then pass "one line in a log"; else fail "one line in a log"; fi
"$facet" render -q a.obj -r 64x48 -o log.png 2>"$T/err"
if [ ! -s "$T/err" ]; then pass "-q says nothing"; else fail "-q says nothing"; fi
finish
