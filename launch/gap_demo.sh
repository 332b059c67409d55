#!/usr/bin/env bash
# From a fresh clone to a diagnosis: hides an effect in the hinge rig, records it, identifies it, adds
# it to the model and shows the gap closure. Optional argument: seed that selects the hidden effect.
#   gap_demo.sh [SEED]
set -euo pipefail
cd "$(dirname "$0")/.."

launch/dependencies.sh build
[ -f build/release/build.ninja ] || cmake --preset release -DERP_TESTS=OFF >/dev/null
cmake --build --preset release

out=erp_runs/gap_demo robot=configs/hinge_rig/robot.xml
rm -rf "$out"
build/release/bin/erp gap blind make --robot "$robot" --cases 1 --seed "${1:-4}" \
  --out "$out/case" --truth "$out/truth.json"
verdict=0
build/release/bin/erp gap diagnose --robot "$robot" --real "$out"/case/case_0001/*.csv \
  --out "$out" || verdict=$?
echo "hidden effect:"
sed -n '/"hidden"/,$p' "$out/truth.json" | grep -E '": [^[{]' | grep -v '"stage"'
[ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || xdg-open "$out/report.html" 2>/dev/null || true
exit "$verdict"
