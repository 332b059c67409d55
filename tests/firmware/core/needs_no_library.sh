#!/bin/sh
# Checks that the firmware calls only itself and functions that a compiler may insert: memory copies.
set -eu
library=$1
defined=$(nm --defined-only "$library" | awk 'NF == 3 && $2 ~ /[TDRB]/ {print $3}' | sort -u)
needed=$(nm --undefined-only "$library" | awk 'NF == 2 {print $2}' | sort -u |
  grep -vE '^(memcpy|memset|memmove|_GLOBAL_OFFSET_TABLE_|__(asan|ubsan|tsan|gcov|stack_chk)_.*)$' || true)
status=0
for symbol in $needed; do
  echo "$defined" | grep -qx "$symbol" || { echo "firmware/core needs $symbol"; status=1; }
done
[ -n "$defined" ] || { echo "no symbols read from $library"; status=1; }
exit $status
