#!/usr/bin/env bash
# Checks that recordings of the graphs in launch/ show no gap. The simulated robot equals robot.xml.
#   tests/bench/gap_graphs.sh                complete motions of every graph whose components move the robot
#   tests/bench/gap_graphs.sh arm 10s        one graph, with this duration
# puller_follower_twin is excluded: its limb is loaded with 0.2 kg that robot.xml does not contain.
# Prints one line per graph with the result of `erp gap where`. Exits with 1 if there is a gap.
set -uo pipefail
cd "$(dirname "$0")/../.."
erp=build/release/bin/erp
out=${ERP_GAP_GRAPHS:-erp_runs/gap_graphs}
mkdir -p "$out"

# graph                    duration of its motion
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
printf '%-26s %-6s %-10s %s\n' graph length evaluated result
while read -r graph length; do
  [ -n "$graph" ] || continue
  robot=$(sed -n 's/.*<graph [^>]*robot="\.\.\/\([^"]*\)".*/\1/p' "launch/$graph.xml")
  if ! $erp launch "launch/$graph.xml" --lockstep --for "$length" --out "$out/$graph" >"$out/$graph.log" 2>&1; then
    printf '%-26s %-6s %-10s %s\n' "$graph" "$length" - "failed: $out/$graph.log"
    gaps=1
    continue
  fi
  recording=$(find "$out/$graph" -name '*.mcap' | head -1)
  $erp gap where --robot "$robot" --real "$recording" >"$out/$graph.where" 2>&1
  code=$?
  result=$(grep '^the gap is in\|^the bus is late' "$out/$graph.where") && gaps=1 || result="no gap"
  case $code in 0) evaluated=yes ;; 5) evaluated=no ;; *) evaluated="exit $code"; result="$out/$graph.where"; gaps=1 ;; esac
  printf '%-26s %-6s %-10s %s\n' "$graph" "$length" "$evaluated" "$result"
done <<<"$graphs"
exit $gaps
