#!/usr/bin/env bash
# Builds the fuzzers (preset fuzz) and runs them on the corpus.
#   run.sh build                builds them
#   run.sh SECONDS [TARGET …]   runs each target for SECONDS; default: all targets
# New inputs go to build/fuzz/corpus, failing inputs to build/fuzz/finds.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$PWD/build/fuzz

# Print the location of undefined behaviour.
export UBSAN_OPTIONS=print_stacktrace=1

build() {
  cmake --preset fuzz >/dev/null
  cmake --build --preset fuzz -j2
}

# Dictionary of an XML target: the names in its schema.
dictionary_of() {
  local xsd=interfaces/schema/$1.xsd
  [ -f "$xsd" ] || return 0
  grep -oE '(name|value)="[A-Za-z_0-9]+"' "$xsd" | sed 's/.*="/"/' | sort -u > "$build/$1.dict"
  echo "-dict=$build/$1.dict"
}

fuzz() {
  local target=$1 seconds=$2 new_inputs=$build/corpus/$1 log=$build/$1.log
  local seeds=("tests/fuzz/corpus/$target") broken=tests/interfaces/broken/$target
  [ -d "$broken" ] && seeds+=("$broken")
  mkdir -p "$new_inputs" "$build/finds"
  TMPDIR=$(mktemp -d -p "$([ -d /dev/shm ] && echo /dev/shm || echo /tmp)")
  export TMPDIR
  local status=0
  # shellcheck disable=SC2046  # unquoted: without a dictionary there must be no argument
  "$build/tests/fuzz_$target" -max_total_time="$seconds" -timeout=5 -rss_limit_mb=1024 \
    -print_final_stats=1 -artifact_prefix="$build/finds/$target-" $(dictionary_of "$target") \
    "$new_inputs" "${seeds[@]}" > "$log" 2>&1 || status=$?
  rm -rf "$TMPDIR"
  if [ "$status" -ne 0 ]; then
    tail -60 "$log"
    echo "$target: failed; reproduce it with build/fuzz/tests/fuzz_$target FILE"
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
