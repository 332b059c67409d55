#!/usr/bin/env bash
# Other people's cases, one folder of recordings each, as a table: what the diagnosis says of them.
#   tests/bench/gap_cases.sh ROBOT.xml FOLDER...       each with CSV or MCAP recordings of one robot
# Diagnoses go to erp_runs/gap_cases/<name of the folder>.
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

line() {  # the rest of the first line that begins with a word
  sed -n "s/^$1 *//p" "$2" | head -n "${3:-1}" | paste -sd ';' | tr '|' '/'
}

echo "| case | verdict | where | which | or as well | how far | free run | s |"
echo "|---|---|---|---|---|---|---|---|"
for folder in "$@"; do
  name=$(basename "$folder")
  mkdir -p "$out/$name"
  began=$(date +%s)
  "$erp" gap diagnose --robot "$robot" --real "$folder"/*.{csv,mcap} --out "$out/$name" \
    >"$out/$name/said" 2>&1 || [ $? -ge 3 ] || echo "$name: failed, see $out/$name/said" >&2
  said=$out/$name/said
  echo "| $name | $(line verdict "$said") | $(line where "$said") | $(line which "$said" 3) |" \
    "$(line 'or as well' "$said" 3) | $(line 'how far' "$said") | $(line 'free run' "$said") |" \
    "$(($(date +%s) - began)) |"
done
