#!/usr/bin/env bash
# Graphs of launch/ whose robot is as robot.xml says: a recording of each must show no gap.
#   tests/bench/gap_graphs.sh                every graph whose components move the robot, its whole motion
#   tests/bench/gap_graphs.sh arm 10s        one graph, this long
# puller_follower_twin is not among them: its limb grasps 0.2 kg that robot.xml does not have.
# A line per graph: what `erp gap where` says of its recording. Ends with 1 if a gap is named.
set -uo pipefail
cd "$(dirname "$0")/../.."
erp=build/release/bin/erp
out=${ERP_GAP_GRAPHS:-erp_runs/gap_graphs}
mkdir -p "$out"

# graph                    its whole motion
graphs="
arm                        45s
babble                     60s
calibration_tour           107s
computed_force             29s
computed_force_estimated   29s
computed_force_learnt      29s
ecce1                      40s
ecce2                      40s
ecce3                      40s
ecce4                      40s
experience                 60s
force_step                 5s
hinge_rig                  30s
joint_motion               60s
leg                        27s
motion_capture             45s
pendulum                   30s
puller_follower            30s
puller_follower_seven      30s
sensorimotor               60s
seven_dof                  40s
synergy                    30s
twin_joint                 30s
"
[ $# -eq 2 ] && graphs="$1 $2"

gaps=0
printf '%-26s %-6s %-9s %s\n' graph length judged says
while read -r graph length; do
  [ -n "$graph" ] || continue
  robot=$(sed -n 's/.*<graph [^>]*robot="\.\.\/\([^"]*\)".*/\1/p' "launch/$graph.xml")
  if ! $erp launch "launch/$graph.xml" --lockstep --for "$length" --out "$out/$graph" >"$out/$graph.log" 2>&1; then
    printf '%-26s %-6s %-9s %s\n' "$graph" "$length" - "did not run: $out/$graph.log"
    gaps=1
    continue
  fi
  recording=$(find "$out/$graph" -name '*.mcap' | head -1)
  $erp gap where --robot "$robot" --real "$recording" >"$out/$graph.where" 2>&1
  code=$?
  says=$(grep '^the gap is in\|^the bus is late' "$out/$graph.where") && gaps=1 || says="no gap"
  case $code in 0) judged=yes ;; 5) judged=little ;; *) judged="exit $code"; says="$out/$graph.where"; gaps=1 ;; esac
  printf '%-26s %-6s %-9s %s\n' "$graph" "$length" "$judged" "$says"
done <<<"$graphs"
exit $gaps
