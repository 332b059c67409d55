#!/bin/bash
# identity.sh ECU CHANNELS ANALOG_INPUTS SERIAL > identity.bin
# Writes the page described in identity.h, for address 0x080E0000. Bit k of CHANNELS and of
# ANALOG_INPUTS is set if the board has number k.
set -eu
[ $# -eq 4 ] || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
byte() { printf "\\x$(printf %02x $(($1 & 255)))"; }
printf ECU1
byte "$1" && byte "$2" && byte "$3" && byte 0
for shift in 0 8 16 24; do byte $(($4 >> shift)); done
