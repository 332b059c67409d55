#!/usr/bin/env bash
# From a fresh clone to a moving robot: installs what is missing, builds, runs the hinge rig in the
# simulator under force control, and leaves a recording and a plot.
set -euo pipefail
cd "$(dirname "$0")/.."

launch/dependencies.sh build
[ -f build/release/build.ninja ] || cmake --preset release -DERP_TESTS=OFF >/dev/null
cmake --build --preset release

out=erp_runs/quickstart
rm -rf "$out"
build/release/bin/erp launch launch/hinge_rig.xml --for "${1:-20s}" --out "$out"
build/release/bin/erp log plot "$out/hinge_rig.mcap" --out "$out/hinge_rig.png" \
  --title "hinge_rig under force control: measured, and what was asked for"
echo "recording: $out/hinge_rig.mcap    plot: $out/hinge_rig.png"
