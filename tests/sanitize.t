#!/bin/sh
# Every unit test again under AddressSanitizer and UndefinedBehaviorSanitizer,
# with the long loops shortened (FACET_QUICK).  Leaks of Mesa's own are not ours.
set -- tests/test_*.c
echo "1..$#"
export LSAN_OPTIONS=suppressions=tests/leaks.supp:print_suppressions=0
n=0
for source; do
  n=$((n + 1))
  name=$(basename "$source" .c)
  if FACET_QUICK=1 CMOCKA_MESSAGE_OUTPUT=TAP \
    "build/address-undefined/tests/$name" >build/sanitize.log 2>&1
  then echo "ok $n - $name"
  else echo "not ok $n - $name"; tail -30 build/sanitize.log | sed 's/^/# /'; fi
done
