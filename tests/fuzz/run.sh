#!/usr/bin/env bash
# Builds the fuzzers (preset fuzz) and runs them on the kept corpus.
#   run.sh build                builds them
#   run.sh SECONDS [TARGET …]   runs each for so long; without a name, all of them
# What they learn goes to build/fuzz/corpus, what they find to build/fuzz/finds.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$PWD/build/fuzz

# Undefined behaviour ends a run, with its place; tests are many processes, so no core files.
export UBSAN_OPTIONS=print_stacktrace=1

build() {
  cmake --preset fuzz >/dev/null
  cmake --build --preset fuzz -j2
}

# The words of an XML target: what its schema names.
dictionary_of() {
  local xsd=interfaces/schema/$1.xsd
  [ -f "$xsd" ] || return 0
  grep -oE '(name|value)="[A-Za-z_0-9]+"' "$xsd" | sed 's/.*="/"/' | sort -u > "$build/$1.dict"
  echo "-dict=$build/$1.dict"
}

fuzz() {
  local target=$1 seconds=$2 learnt=$build/corpus/$1 log=$build/$1.log
  local kept=("tests/fuzz/corpus/$target") broken=tests/interfaces/broken/$target
  [ -d "$broken" ] && kept+=("$broken")
  mkdir -p "$learnt" "$build/finds"
  TMPDIR=$(mktemp -d -p "$([ -d /dev/shm ] && echo /dev/shm || echo /tmp)")
  export TMPDIR
  local status=0
  # shellcheck disable=SC2046  # no dictionary is no argument
  "$build/tests/fuzz_$target" -max_total_time="$seconds" -timeout=5 -rss_limit_mb=1024 \
    -print_final_stats=1 -artifact_prefix="$build/finds/$target-" $(dictionary_of "$target") \
    "$learnt" "${kept[@]}" > "$log" 2>&1 || status=$?
  rm -rf "$TMPDIR"
  if [ "$status" -ne 0 ]; then
    tail -60 "$log"
    echo "$target: a find; reproduce it with build/fuzz/tests/fuzz_$target FILE"
  else
    echo "$target: $(grep -oE 'cov: [0-9]+ ft: [0-9]+' "$log" | tail -1)," \
      "$(grep -oE 'number_of_executed_units: *[0-9]+' "$log" | grep -oE '[0-9]+$') runs in $seconds s"
  fi
  return "$status"
}

[ $# -ge 1 ] || { sed -n '2,5s/^# //p' "$0"; exit 1; }
[ "$1" = build ] && { build; exit; }
seconds=$1
shift
[ $# -gt 0 ] || set -- $(ls tests/fuzz/corpus)
failed=0
for target; do fuzz "$target" "$seconds" || failed=1; done
exit "$failed"
