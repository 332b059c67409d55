#!/usr/bin/env bash
# Measures the duration of a diagnosis for robots with an increasing number of actuators, with a hidden effect of the
# library and with a law outside the library. Each diagnosis runs on one thread, on all cores and on
# two MPI processes. Each case has 4 recordings of 25 s. There is no free run.
#   tests/bench/gap_time.sh                    every robot; takes hours
#   tests/bench/gap_time.sh hinge_rig leg      these robots
# Writes cases to erp_runs/gap_time. Run it on an idle machine and compare only ratios within a line.
set -euo pipefail
cd "$(dirname "$0")/../.."
erp=build/release/bin/erp
out=${ERP_GAP_TIME:-erp_runs/gap_time}

seconds_of() {  # command...: prints its wall time in s; its output goes to the log
  local begin_ns end_ns
  begin_ns=$(date +%s%N)
  "$@" >>"$out/log" 2>&1 || [ $? -ge 3 ]
  end_ns=$(date +%s%N)
  awk -v ns=$((end_ns - begin_ns)) 'BEGIN {printf "%.0f", 1e-9 * ns}'
}

measure() {  # robot kind
  local robot=configs/$1/robot.xml cases=$out/$1_$2
  [ -d "$cases" ] || $erp gap blind make --robot "$robot" --kind "$2" --cases 1 --seed 397001 \
    --recordings 4 --seconds 25 --out "$cases" --truth "$cases.json" >>"$out/log" 2>&1
  local diagnose=("$erp" gap diagnose --robot "$robot" --real "$cases"/case_0001/*.csv --no-free-run)
  local one_thread_s all_threads_s two_processes_s
  one_thread_s=$(seconds_of "${diagnose[@]}" --threads 1)
  all_threads_s=$(seconds_of "${diagnose[@]}")
  two_processes_s=$(seconds_of mpirun --allow-run-as-root --oversubscribe -n 2 "${diagnose[@]}" --threads 1)
  echo "| $1 | $($erp model info "$robot" | awk '$1 == "actuators" {print $2}') | $2 | $one_thread_s | $all_threads_s | $two_processes_s |"
}

mkdir -p "$out"
echo "| robot | actuators | hidden | 1 thread, s | $(nproc) threads, s | 2 MPI processes, 1 thread each, s |"
echo "|---|---|---|---|---|---|"
for robot in ${*:-hinge_rig leg arm seven_dof ecce4}; do
  for kind in single outside; do measure "$robot" "$kind"; done
done
