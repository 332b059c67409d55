# To be sourced. Two recordings of one graph in lockstep must hold the same rows, bit by bit.

# launched GRAPH OUT SETTING…: one second of it. What it says begins with a blank, unlike a row.
launched() {
  local graph=$1 out=$2 && shift 2
  set -o pipefail
  "$bin/erp" launch "$graph" --lockstep --for 1s --out "$out" --patience 5min "$@" < /dev/null 2>&1 |
    sed -u 's/^/ /'
}

# recorded FILE: a recording's rows, and how many messages it lacks.
recorded() {
  "$bin/erp" log info "$1" | awk '$2 ~ /^erp\/msg\// { lacks += $(NF - 2) } END { print "lacks", lacks }'
  "$bin/erp" log export "$1"
}

# same_rows REFERENCE SAID: 0 if the rows are the same, 1 if they differ, 2 if SAID, which a slow guest
# has printed, is no full recording: for what it lacks an export shows an older value.
same_rows() {
  local reference=$1.rows said=$2.rows
  grep '^[0-9]' "$1" > "$reference"
  tr -d '\r' < "$2" | grep -a '^[0-9]' > "$said"
  local lacks rows different
  lacks=$(tr -d '\r' < "$2" | sed -n 's/^lacks //p')
  rows=$(wc -l < "$said")
  different=$(grep -Fxvcf "$reference" "$said")
  echo "$rows of 500 rows recorded, ${lacks:-all} messages missing, $different rows differ"
  [ "${lacks:-1}" = 0 ] && [ "$rows" = 500 ] || return 2
  [ "$different" = 0 ]
}
