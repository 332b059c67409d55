#!/usr/bin/env bash
# From a fresh clone to a simulated run: installs missing packages, builds, runs the hinge rig in the
# simulator under force control, and writes a recording and a plot. Optional argument: duration.
#   quickstart.sh [20s]
set -euo pipefail
cd "$(dirname "$0")/.."

launch/dependencies.sh build
[ -f build/release/build.ninja ] || cmake --preset release -DERP_TESTS=OFF >/dev/null
cmake --build --preset release

out=erp_runs/quickstart
rm -rf "$out"
build/release/bin/erp launch launch/hinge_rig.xml --for "${1:-20s}" --out "$out"
build/release/bin/erp log plot "$out/hinge_rig.mcap" --out "$out/hinge_rig.png" \
  --title "hinge_rig under force control: measured and desired"
cat <<END

Tension control of two antagonistic muscles at 500 Hz, simulated with the ECU firmware.
RMS errors below 2 N are good: the desired tensions are between 5 and 40 N and change by up to 24 N/s. Larger errors mean
that the computer was busy. This affects runs in real time, but not runs with --lockstep.
  recording  $out/hinge_rig.mcap      (Foxglove and PlotJuggler open it)
  plot       $out/hinge_rig.png
Next:
  export PATH=\$PWD/build/release/bin:\$PATH
  erp launch launch/arm.xml --lockstep --for 45s       # an arm of 11 muscles moves through 15 poses
  erp gap where --robot configs/hinge_rig/robot.xml --real $out/hinge_rig.mcap     # compares it with its model
  erp new controller my_controller ../my_controller    # a controller of your own, with a test
END
