#!/bin/bash
# check.sh TRANSITIONS: proves the model ecu.pml on the state machine that TRANSITIONS prints, and that
# each rule it leans on is needed: without it the proof must fail. Debian: spin gcc.
set -u
here=$(dirname "$(realpath "$0")") transitions=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# Makes the verifier; the sed expression, if any, takes a rule away.
verifier() {
  "$transitions" | sed "${1:-}" > transitions.pml
  sed "${1:-}" "$here/ecu.pml" > ecu.pml
  spin -a ecu.pml > spin.out && cc -O2 "${@:2}" -o pan pan.c || { cat spin.out; exit 1; }
}

errors() { sed -n 's/.*errors: \([0-9]*\).*/\1/p' pan.out; }

holds() {  # what, arguments of the verifier
  ./pan -m1000000 -w26 "${@:2}" > pan.out
  if [ "$(errors)" != 0 ] || grep -q 'too small\|out of memory' pan.out; then
    cat pan.out
    echo "FAILED: $1"
    exit 1
  fi
  echo "$1: $(sed -n 's/^ *\([0-9]*\) states, stored.*/\1/p' pan.out) states, holds"
}

fails() {  # what is taken away, how
  verifier "$2" -DSAFETY -DNOCLAIM
  cmp -s "$here/ecu.pml" ecu.pml && "$transitions" | cmp -s - transitions.pml &&
    { echo "FAILED: nothing was taken away for: $1"; exit 1; }
  ./pan -m1000000 -w26 > pan.out
  [ "$(errors)" = 1 ] || { cat pan.out; echo "FAILED: the proof does not need: $1"; exit 1; }
  echo "without $1: found wrong, as it should be"
}

verifier '' -DSAFETY -DNOCLAIM
holds "asserts, no deadlock"
verifier ''
holds "comes to run" -a -N comes_to_run
holds "stays running" -a -N stays_running
fails "the watchdog" 's/since >= WATCHDOG -> trip(SILENCE)/since >= WATCHDOG -> skip/'
fails "dropping late commands" 's/^#define LATE 6.*/#define LATE 8/'
fails "the latch of a fault" 's/state == FAULT && event == ARM -> state = FAULT/state == FAULT \&\& event == ARM -> state = ARMED/'
fails "naming the fault that is cleared" 's/state == FAULT && f.fault == fault/state == FAULT/'
fails "arming at rest" 's/state == IDLE && event == SETPOINT -> state = IDLE/state == IDLE \&\& event == SETPOINT -> state = RUNNING/'
