#!/bin/sh
# Every unit test again under AddressSanitizer and UndefinedBehaviorSanitizer,
# with the long loops shortened (FACET_QUICK).
set -- build/address-undefined/tests/test_*[!.od]
echo "1..$#"
n=0
for t; do
  case $t in *.o|*.d) continue ;; esac
  n=$((n + 1))
  if FACET_QUICK=1 CMOCKA_MESSAGE_OUTPUT=TAP "$t" >build/sanitize.log 2>&1
  then echo "ok $n - $(basename "$t")"
  else echo "not ok $n - $(basename "$t")"; tail -30 build/sanitize.log | sed 's/^/# /'; fi
done
