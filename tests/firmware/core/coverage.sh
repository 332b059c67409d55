#!/bin/sh
# coverage.sh PROGRAM OBJECTS SOURCE OUT: runs the tests on instrumented firmware and reports its line and
# branch coverage; fails below 95 %. Debian: gcovr.
set -eu
find "$2" -name '*.gcda' -delete
"$1" > "$4.log" || { cat "$4.log"; exit 1; }
gcovr --root "$3" --object-directory "$2" --filter "$3/firmware/core/" --exclude-throw-branches \
  --txt - --print-summary --branches --fail-under-line 95 --fail-under-branch 95 "$2"
