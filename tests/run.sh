#!/usr/bin/env bash
# The test command: installs what is missing, builds, runs every test.
#   tests/run.sh           everything, on the release build
#   tests/run.sh asan      the same under address and undefined-behaviour sanitizers
#   tests/run.sh tsan      the same under the thread sanitizer
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}

launch/dependencies.sh test
cmake --preset "$preset" -DERP_TESTS=ON >/dev/null
cmake --build --preset "$preset"
ctest --preset "$preset" --output-on-failure -j2
