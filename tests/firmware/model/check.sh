#!/bin/bash
# check.sh TRANSITIONS: verifies the model ecu.pml with the state machine that TRANSITIONS prints. Then it removes
# one rule at a time and checks that the verification fails. Debian: spin gcc.
set -u
here=$(dirname "$(realpath "$0")") transitions=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# Builds the verifier; the sed expression, if any, removes a rule. Optimizing it takes longer than running it.
verifier() {
  "$transitions" | sed "${1:-}" > transitions.pml
  sed "${1:-}" "$here/ecu.pml" > ecu.pml
  spin -a ecu.pml > spin.out && cc -O0 "${@:2}" -o pan pan.c || { cat spin.out; exit 1; }
}

errors() { sed -n 's/.*errors: \([0-9]*\).*/\1/p' pan.out; }

holds() {  # name, arguments of the verifier
  ./pan -m1000000 -w24 "${@:2}" > pan.out
  if [ "$(errors)" != 0 ] || grep -q 'too small\|out of memory' pan.out; then
    cat pan.out
    echo "FAILED: $1"
    exit 1
  fi
  echo "$1: $(sed -n 's/^ *\([0-9]*\) states, stored.*/\1/p' pan.out) states, holds"
}

fails() {  # removed rule, sed expression
  verifier "$2" -DSAFETY -DNOCLAIM
  cmp -s "$here/ecu.pml" ecu.pml && "$transitions" | cmp -s - transitions.pml &&
    { echo "FAILED: the sed expression changed nothing for: $1"; exit 1; }
  ./pan -m1000000 -w24 > pan.out
  [ "$(errors)" = 1 ] || { cat pan.out; echo "FAILED: the verification passes without: $1"; exit 1; }
  echo "without $1: error found, as expected"
}

verifier '' -DSAFETY -DNOCLAIM
holds "asserts, no deadlock"
verifier ''
holds "starts running" -a -N comes_to_run
holds "keeps running" -a -N stays_running
fails "the watchdog" 's/since >= WATCHDOG -> trip(SILENCE)/since >= WATCHDOG -> skip/'
fails "dropping outdated commands" 's/^#define LATE 6.*/#define LATE 8/'
fails "the latch of a fault" 's/state == FAULT && event == ARM -> state = FAULT/state == FAULT \&\& event == ARM -> state = ARMED/'
fails "naming the fault that is cleared" 's/state == FAULT && f.fault == fault/state == FAULT/'
fails "arming at rest" 's/state == IDLE && event == SETPOINT -> state = IDLE/state == IDLE \&\& event == SETPOINT -> state = RUNNING/'
