#!/bin/bash
# One real window of facet view, on a screen of its own.  A busy machine may
# take its time: the test waits for what it wants to see and never for a while,
# and gives a key again where a press fell between two looks at the keyboard.
. tests/tap.sh
scene=$root/scenes/materials.scene
cd "$T" || exit 1

give_up() { # REASON
  skip "a window" "$1"
  finish
  exit
}
for tool in Xvfb xdotool; do
  command -v $tool >/dev/null || give_up "no $tool"
done
env -u DISPLAY -u WAYLAND_DISPLAY "$facet" view -q "$scene" 2>err
if grep -q "cannot load" err && ! ldconfig -p | grep -q libglfw.so.3; then
  give_up "no libglfw3"
fi

# until_true SECONDS COMMAND...: try it four times a second.
until_true() {
  tries=$(($1 * 4))
  shift
  while ! "$@" 2>/dev/null; do
    tries=$((tries - 1))
    [ $tries -gt 0 ] || return 1
    sleep 0.25
  done
}

# A server that nobody looks at any more starts anew, unless told not to, and
# turns away who comes just then.
Xvfb -displayfd 3 -screen 0 640x480x24 -nolisten tcp -noreset 3>display 2>xvfb.log &
server=$!
viewer=
trap 'kill $viewer $server 2>/dev/null; chmod -R u+w "$T"; rm -rf "$T"' EXIT
until_true 60 test -s display
DISPLAY=:$(cat display)
export DISPLAY
"$facet" view "$scene" -r 160x100 2>said.txt >p.txt &
viewer=$!

# Without a window manager nobody gives the focus but us, and only a window
# that can be seen takes it.
seen() { w=$(xdotool search --onlyvisible --name facet | head -n 1) && [ -n "$w" ]; }
focused() { xdotool windowfocus "$w" && [ "$(xdotool getwindowfocus)" = "$w" ]; }
if ! until_true 120 seen; then
  cp said.txt said
  fail "a window opens"
  finish
  exit
fi
until_true 30 focused
said_more() { [ "$(grep -c ': written' said.txt)" -gt "$written" ]; }
save() { # NAME: F12, and the picture that it wrote gets this name
  written=$(grep -c ': written' said.txt)
  xdotool key F12
  until_true 60 said_more
  mv "$(sed -n 's/.*\(materials-[0-9]*\.png\): written.*/\1/p' said.txt | tail -n 1)" "$1"
}
# changes WHAT COMMAND...: after the command the picture is another.
changes() {
  what=$1
  shift
  for _ in 1 2 3 4 5 6; do
    "$@"
    save after.png
    "$facet" compare --fail 0.002 before.png after.png >out 2>err
    code=$?
    [ $code = 0 ] || break
  done
  mv after.png before.png
  if [ $code = 1 ]; then pass "in the window $what"
  else fail "in the window $what (compare says $code)"; fi
}
hold() { xdotool keydown "$1"; sleep 0.5; xdotool keyup "$1"; }
turn() { xdotool mousemove_relative 2 1; sleep 0.3; xdotool mousemove_relative 60 10; }
thrice() { xdotool key "$1" key "$1" key "$1"; }
once() { xdotool key "$1"; }

save before.png
ok "F12 saves a picture that is not black" python3 - <<P
import json, subprocess
i = json.loads(subprocess.check_output(["$facet", "info", "--json", "before.png"]))
assert i["width"] == 160 and min(i["max"]) > 0.3, i
P
changes "W flies" hold w
changes "the mouse turns" turn
changes "Shift frosts" once Shift_L
changes "Shift clears" once Shift_L
for key in s a d q z; do changes "$key flies" hold $key; done
for key in 2 4 1 3; do changes "$key shows" thrice $key; done
changes "0 shows" once 0
once h
ok "H shows the keys" until_true 60 grep -q "^mouse  *turns" said.txt
xdotool windowsize "$w" 400 200 # and the rest goes on
changes "Space traces paths" once space
samples() { xdotool getwindowname "$w" | grep -q "samples a pixel"; }
ok "the title counts samples" until_true 60 samples
once p
ok "p prints a command" until_true 60 grep -q "^facet render .*--engine=path" p.txt
once Escape
gone() { ! kill -0 $viewer; }
until_true 60 gone || kill -9 $viewer
ok "Escape closes it" wait $viewer
finish
