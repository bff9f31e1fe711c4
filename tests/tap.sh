# tap.sh — read by the shell tests: a folder of their own, and TAP.

case ${FACET:=build/facet} in
/*) facet=$FACET ;;
*) facet=$(pwd)/$FACET ;;
esac
[ -x "$facet" ] || { echo "Bail out! there is no $facet"; exit 1; }
root=$(pwd)
assets=${FACET_ASSETS:-../shared/assets}
T=$(mktemp -d)
trap 'chmod -R u+w "$T"; rm -rf "$T"' EXIT
n=0

pass() { n=$((n + 1)); echo "ok $n - $1"; }
skip() { n=$((n + 1)); echo "ok $n - $1 # SKIP $2"; }
# What went wrong: the name, then what the program said.
fail() {
  n=$((n + 1))
  echo "not ok $n - $1"
  head -5 "$T/said" "$T/err" "$T/out" 2>/dev/null | sed 's/^/# /'
}
# ok NAME COMMAND...: the command succeeds; $T/out and $T/err stay as they are.
ok() {
  title=$1
  shift
  if "$@" >"$T/said" 2>&1; then pass "$title"; else fail "$title"; fi
}
# exits CODE NAME COMMAND...: the command ends with that exit status; its
# output is in $T/out and $T/err.
exits() {
  want=$1 title=$2
  shift 2
  rm -f "$T/said"
  "$@" >"$T/out" 2>"$T/err"
  got=$?
  if [ "$got" = "$want" ]; then pass "$title"
  else fail "$title (exit $got, not $want)"; fi
}
# says TEXT NAME: the last command said so on stderr.
says() {
  if grep -qF -- "$1" "$T/err"; then pass "$2"; else fail "$2"; fi
}
# out_of_memory KB NAME COMMAND...: with so little of it, exit status 5 and why.
# A sanitizer reserves more addresses than there is memory.
out_of_memory() {
  if [ -n "$FACET_SANITIZED" ]; then skip "$2" "not under a sanitizer"; return; fi
  kb=$1 title=$2
  shift 2
  exits 5 "$title" sh -c "ulimit -v $kb; exec \"\$@\"" - "$@"
  says "out of memory" "is said"
}
# signals PID FIELD: those signals of a process, as a number.
signals() {
  bits=$(sed -n "s/^$2:[^0-9a-f]*/0x/p" "/proc/$1/status")
  echo $((${bits:-0}))
}
# renders PID: wait until a render has begun, which catches SIGTERM then; and
# SIGUSR1 before, as no shell of ours does.
renders() {
  for _ in $(seq 300); do
    [ $(($(signals "$1" SigCgt) & 0x4200)) = $((0x4200)) ] && return
    sleep 0.1
  done
}
# stop_twice PID: SIGINT, and SIGTERM when that has arrived.
stop_twice() {
  kill -INT "$1"
  for _ in $(seq 300); do
    sleep 0.1
    [ $(($(signals "$1" ShdPnd) & 2)) = 0 ] && break
  done
  kill -TERM "$1"
}
finish() { echo "1..$n"; }

# A quad and a triangle, at the given path.
write_obj() {
  cat >"$1" <<'END'
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
v 0 1 0
f 4 3 2 1
f 1 3 5
END
}
