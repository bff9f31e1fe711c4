#!/bin/sh
# The listings of the chapters are the source, every definition is explained
# once, and none is used before it is explained.
echo 1..1
if python3 chapters/weave.py check >build/book.log 2>&1
then echo "ok 1 - book"
else echo "not ok 1 - book"; sed 's/^/# /' build/book.log; fi
