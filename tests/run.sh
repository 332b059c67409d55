#!/usr/bin/env bash
# The test command: installs what is missing, builds, runs every test.
#   tests/run.sh           everything, on the release build
#   tests/run.sh sim/gap   one room: builds its tests and runs them
#   tests/run.sh faults    every fault injected twenty times into running graphs, and timed
#   tests/run.sh soak      half an hour of a graph of which processes are killed at random
#   tests/run.sh fuzz      every fuzzer for 600 s, or for the seconds given next; ctest gives all of them 60
#   tests/run.sh asan      the same under address and undefined-behaviour sanitizers
#   tests/run.sh tsan      the same under the thread sanitizer
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
room=
case $preset in
  faults | soak) preset=release ;;
  release | asan | tsan | fuzz) ;;
  *)
    [ -d "tests/$preset" ] || {
      echo "tests/run.sh: no room tests/$preset; give a folder below tests, or faults, soak, fuzz, asan, tsan" >&2
      exit 2
    }
    room=${preset%/} preset=release
    ;;
esac

launch/dependencies.sh test
if [ "$preset" = fuzz ]; then
  tests/fuzz/run.sh build
  exec tests/fuzz/run.sh "${2:-600}"
fi
cmake --preset "$preset" -DERP_TESTS=ON >/dev/null
if [ -n "$room" ]; then
  label=("-L" "^$room\$")
  mapfile -t names < <(ctest --preset "$preset" -N "${label[@]}" | sed -n 's/^ *Test *#[0-9]*: //p')
  [ ${#names[@]} -gt 0 ] || { echo "tests/run.sh: no test in tests/$room" >&2; exit 2; }
  cmake --build --preset "$preset" --target "${names[@]}"
  exec ctest --preset "$preset" --output-on-failure -j2 "${label[@]}"
fi
cmake --build --preset "$preset"
if [ "${1:-}" = faults ]; then
  build/release/tests/erp_faults
  exec tests/hal/uml/run_in_uml.sh "$PWD/build/release/tests/socketcan_test"
fi
[ "${1:-}" = soak ] && exec build/release/tests/erp_soak
failed=0
log=build/$preset/Testing/Temporary
ctest --preset "$preset" --output-on-failure -j2 || failed=$?
grep -ahE '^not evaluated' "$log/LastTest.log" || true  # the computer stalled: no failure, but reported
[ $failed = 0 ] || for test in $(cut -d: -f2 "$log/LastTestsFailed.log"); do
  printf '\nlast output of %s:\n' "$test"
  sed -n "/ Testing: $test\$/,/^<end of output>/p" "$log/LastTest.log" | tail -n 12
done
exit $failed
