#!/bin/bash
# laws.sh ELF COMPARE: runs the control laws on an emulated Cortex-M4 and compares the results with this machine's.
set -o pipefail
timeout 60 qemu-system-arm -M netduinoplus2 -display none -monitor none -serial none \
  -semihosting-config enable=on,target=native -kernel "$1" 2>&1 < /dev/null | "$2"
