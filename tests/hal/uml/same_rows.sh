# To be sourced. Compares two recordings of one graph in lockstep: their rows must be identical bit by bit.

# On a busy machine a guest kernel may not finish in time, and a logger may miss messages, which it counts. A
# recording therefore has three attempts to be complete. A differing row fails without a further attempt.
attempts="1 2 3"

# launch_graph GRAPH OUT SETTING…: runs the graph for one second. Its messages begin with a blank, unlike a row.
launch_graph() {
  local graph=$1 out=$2 && shift 2
  set -o pipefail
  "$bin/erp" launch "$graph" --lockstep --for 1s --out "$out" --ready-timeout 5min "$@" < /dev/null 2>&1 |
    sed -u 's/^/ /'
}

# print_recording FILE: prints the number of missing messages of a recording, and its rows.
print_recording() {
  "$bin/erp" log info "$1" | awk '$2 ~ /^erp\/msg\// { lacks += $(NF - 2) } END { print "lacks", lacks }'
  "$bin/erp" log export "$1"
}

rows() { tr -d '\r' < "$1" | grep -a '^[0-9]'; }

# is_complete OUTPUT: true if the output of `print_recording` is a complete recording. An export shows older values
# for missing messages.
is_complete() {
  local lacks count
  lacks=$(tr -d '\r' < "$1" | sed -n 's/^lacks //p')
  count=$(rows "$1" | wc -l)
  echo "$count of 500 rows recorded, ${lacks:-all} messages missing"
  [ "${lacks:-1}" = 0 ] && [ "$count" = 500 ]
}

# same_rows REFERENCE OUTPUT: 0 if the rows are the same, 1 if they differ, 2 if OUTPUT is not complete.
same_rows() {
  is_complete "$2" || return 2
  local different
  different=$(diff <(rows "$1") <(rows "$2")) && return 0
  echo "$(grep -c '^>' <<< "$different") rows differ, the first of the reference (<) and of the other (>):"
  grep -m1 '^<' <<< "$different"
  grep -m1 '^>' <<< "$different"
  return 1
}
