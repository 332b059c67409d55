#!/usr/bin/env bash
# Diagnoses your own recordings, one folder per case, and prints a table of the results.
#   tests/bench/gap_cases.sh ROBOT.xml FOLDER...       FOLDER: CSV or MCAP recordings of one robot
# Writes the diagnoses to erp_runs/gap_cases/<name of the folder>.
set -euo pipefail
shopt -s nullglob
erp=$(cd "$(dirname "$0")/../.." && pwd)/build/release/bin/erp
out=erp_runs/gap_cases
if [ $# -lt 2 ]; then
  echo "usage: tests/bench/gap_cases.sh ROBOT.xml FOLDER..." >&2
  exit 2
fi
robot=$1
shift

text_after() {  # prints the text after label $1 in file $2, for the first $3 lines with that label (default 1)
  sed -n "s/^$1 *//p" "$2" | head -n "${3:-1}" | paste -sd ';' | tr '|' '/'
}

echo "| case | verdict | location | cause | equivalent | gap closure | free run | s |"
echo "|---|---|---|---|---|---|---|---|"
for folder in "$@"; do
  name=$(basename "$folder")
  mkdir -p "$out/$name"
  begin_s=$(date +%s)
  "$erp" gap diagnose --robot "$robot" --real "$folder"/*.{csv,mcap} --out "$out/$name" \
    >"$out/$name/output" 2>&1 || [ $? -ge 3 ] || echo "$name: failed, see $out/$name/output" >&2
  output=$out/$name/output
  echo "| $name | $(text_after verdict "$output") | $(text_after location "$output") | $(text_after cause "$output" 3) |" \
    "$(text_after equivalent "$output" 3) | $(text_after 'gap closure' "$output") | $(text_after 'free run' "$output") |" \
    "$(($(date +%s) - begin_s)) |"
done
