# To be sourced. Two recordings of one graph in lockstep must hold the same rows, bit by bit.

# On a busy machine a guest kernel may not finish in time, and a logger may miss a message (it counts
# them): a recording has three attempts to be complete. A row that differs is a failure at once.
goes="1 2 3"

# launched GRAPH OUT SETTING…: runs it for one second. Its messages begin with a blank, unlike a row.
launched() {
  local graph=$1 out=$2 && shift 2
  set -o pipefail
  "$bin/erp" launch "$graph" --lockstep --for 1s --out "$out" --ready-timeout 5min "$@" < /dev/null 2>&1 |
    sed -u 's/^/ /'
}

# recorded FILE: a recording's rows, and how many messages it lacks.
recorded() {
  "$bin/erp" log info "$1" | awk '$2 ~ /^erp\/msg\// { lacks += $(NF - 2) } END { print "lacks", lacks }'
  "$bin/erp" log export "$1"
}

rows() { tr -d '\r' < "$1" | grep -a '^[0-9]'; }

# whole SAID: whether the output of `recorded` is a complete recording; an export shows an older value for
# missing messages.
whole() {
  local lacks count
  lacks=$(tr -d '\r' < "$1" | sed -n 's/^lacks //p')
  count=$(rows "$1" | wc -l)
  echo "$count of 500 rows recorded, ${lacks:-all} messages missing"
  [ "${lacks:-1}" = 0 ] && [ "$count" = 500 ]
}

# same_rows REFERENCE SAID: 0 if the rows are the same, 1 if they differ, 2 if SAID is not whole.
same_rows() {
  whole "$2" || return 2
  local different
  different=$(diff <(rows "$1") <(rows "$2")) && return 0
  echo "$(grep -c '^>' <<< "$different") rows differ, the first of the reference (<) and of the other (>):"
  grep -m1 '^<' <<< "$different"
  grep -m1 '^>' <<< "$different"
  return 1
}
