#!/usr/bin/env bash
# Installs missing packages, builds, and runs every test.
#   tests/run.sh           everything, on the release build
#   tests/run.sh sim/gap   the tests of one folder
#   tests/run.sh faults    injects every fault twenty times into running graphs and measures the reaction times
#   tests/run.sh soak      runs a graph for half an hour and kills its processes at random
#   tests/run.sh fuzz [S]  every fuzzer for S seconds, by default 600 (ctest runs all fuzzers for 60 s in total)
#   tests/run.sh asan      everything under the address and undefined-behaviour sanitizers
#   tests/run.sh tsan      everything under the thread sanitizer
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
folder=
case $preset in
  faults | soak) preset=release ;;
  release | asan | tsan | fuzz) ;;
  *)
    [ -d "tests/$preset" ] || {
      echo "tests/run.sh: no folder tests/$preset; give a folder below tests, or faults, soak, fuzz, asan, tsan" >&2
      exit 2
    }
    folder=${preset%/} preset=release
    ;;
esac

launch/dependencies.sh test
if [ "$preset" = fuzz ]; then
  tests/fuzz/run.sh build
  exec tests/fuzz/run.sh "${2:-600}"
fi
cmake --preset "$preset" -DERP_TESTS=ON >/dev/null
if [ -n "$folder" ]; then
  label=("-L" "^$folder\$")
  mapfile -t targets < <(ctest --preset "$preset" -N "${label[@]}" | sed -n 's/^ *Test *#[0-9]*: //p')
  [ ${#targets[@]} -gt 0 ] || { echo "tests/run.sh: no test in tests/$folder" >&2; exit 2; }
  cmake --build --preset "$preset" --target "${targets[@]}"
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
grep -ahE '^not evaluated' "$log/LastTest.log" || true  # the computer stalled during these checks
[ $failed = 0 ] || for test in $(cut -d: -f2 "$log/LastTestsFailed.log"); do
  printf '\nlast output of %s:\n' "$test"
  sed -n "/ Testing: $test\$/,/^<end of output>/p" "$log/LastTest.log" | tail -n 12
done
exit $failed
