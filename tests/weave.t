#!/bin/sh
# The weaver itself, on a small book in a temporary folder: a sound book
# passes, and each way to depart from it is reported.
echo 1..12
dir=$(mktemp -d) && trap 'rm -rf "$dir"' EXIT
k=0

# A book of two chapters and two modules.
fresh() {
  rm -rf "$dir"/*
  mkdir -p "$dir/src" "$dir/tests" "$dir/chapters/09-one" "$dir/chapters/10-two"
  cp chapters/weave.py "$dir/chapters/"
  cat >"$dir/src/low.h" <<'END'
// low.h — a type and a constant.

#ifndef LOW_H
#define LOW_H

// So many.
#define MANY 3

// A size.
typedef struct size {
  int width;
} size;

#endif
END
  cat >"$dir/src/low.c" <<'END'
// low.c

// Twice x, or high(x) as a comment may say.
static int twice(int x) {
  return 2 * x;
}

// The width; "high(" in a string, a field and a variable are no uses.
int low(size s) {
  const char *text = "high(1)";
  int high = s.width;
  return twice(high) + (text != 0);
}
END
  cat >"$dir/src/high.c" <<'END'
// high.c

// Above.
int high(size s) {
  return low(s) + MANY;
}
END
  cat >"$dir/chapters/09-one/README.md" <<'END'
# 9. One

[`src/low.h`](../../src/low.h)
```c
```

[`src/low.c`](../../src/low.c) `twice`, `low`
```c
```
END
  cat >"$dir/chapters/10-two/README.md" <<'END'
# 10. Two

[`src/high.c`](../../src/high.c) `high`
```c
```
END
  weave update
}

weave() {
  python3 "$dir/chapters/weave.py" "$@" >"$dir/log" 2>&1
}

verdict() { # GOOD NAME
  k=$((k + 1))
  if [ "$1" = yes ]; then echo "ok $k - $2"
  else echo "not ok $k - $2"; sed 's/^/# /' "$dir/log"; fi
}

# The check says nothing but what the pattern matches, or nothing at all.
reports() { # NAME PATTERN
  if weave check; then verdict no "$1"; return; fi
  if grep -q "$2" "$dir/log" && ! grep -qv "$2" "$dir/log"
  then verdict yes "$1"; else verdict no "$1"; fi
}

fresh
weave check && verdict yes "a sound book" || verdict no "a sound book"
grep -q '^  return low(s) + MANY;$' "$dir/chapters/10-two/README.md" &&
  verdict yes "update fills listings" || verdict no "update fills listings"

sed -i 's/2 \* x/x + x/' "$dir/src/low.c"
reports "a drifted listing" '09-one/README.md:[0-9]*: listing has drifted'
weave update 10
reports "update of another chapter leaves it" 'listing has drifted'
weave update 9 && weave check && verdict yes "update of the chapter" ||
  verdict no "update of the chapter"

printf '\n// New.\nint fresh(void) {\n  return 1;\n}\n' >>"$dir/src/high.c"
reports "an unexplained definition" 'src/high.c:[0-9]*: fresh is in no chapter'

fresh
sed -i 's/return twice(high)/return twice(high) + high(s)/' "$dir/src/low.c"
weave update
reports "a name used early" '09-one/README.md:[0-9]*: uses high, first'

fresh
cat >>"$dir/chapters/10-two/README.md" <<'END'

[`src/low.h`](../../src/low.h)
```c
```
END
weave update
reports "a file listed twice" 'listed already in .*09-one.*: MANY, size$'

fresh
sed -i 's/`twice`, `low`/`twice`, `none`/' "$dir/chapters/09-one/README.md"
weave check
grep -q 'src/low.c does not define none' "$dir/log" &&
  verdict yes "a name that is not there" || verdict no "a name that is not there"

fresh
printf '\n```c\nreturn 3 * x;\n```\n' >>"$dir/chapters/09-one/README.md"
reports "an invented quotation" 'block is not in the source'

fresh
printf '\n```c\nreturn 2 * x;\n```\n\n```c sketch\nwhatever\n```\n' \
  >>"$dir/chapters/09-one/README.md"
weave check && verdict yes "a true quotation and a sketch" ||
  verdict no "a true quotation and a sketch"

fresh
mkdir "$dir/chapters/09-one/images"
: >"$dir/chapters/09-one/images/x.png"
echo '[gone](../../src/gone.c)' >>"$dir/chapters/09-one/README.md"
reports "a dead link and a lost image" 'dead link\|shown nowhere'
