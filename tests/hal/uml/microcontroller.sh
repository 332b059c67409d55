#!/bin/bash
# microcontroller.sh BIN_DIR ECU_ELF SOURCE_DIR: a complete graph with an emulated microcontroller.
#
# The ECU's bare-metal program runs in QEMU. One of its serial lines is connected by slcan to a kernel in
# user-mode Linux, where it is a real CAN device. The other line connects its converters. The graph runs in
# that kernel: gateway, plant, controllers, logger, and the robot's simulator. In lockstep every recorded row
# must equal, bit by bit, the row recorded with the ECU as a process of this machine.
set -u
bin=$1 elf=$2 source=$3
here=$(dirname "$(realpath "$0")")
. "$here/same_rows.sh"
exchange=$(mktemp -d)
started=()
# KILL, because an emulator that waits for its serial line may ignore TERM; no process has files to clean up.
trap 'kill -KILL "${started[@]}" 2> /dev/null; wait; rm -rf "$exchange"' EXIT
export ERP_DOMAIN=$((1 + $$ % 200))
bus=udp:239.255.42.1:$((20000 + 16 * ERP_DOMAIN)) converters=$((24000 + ERP_DOMAIN))

# run OUT SETTING…: runs the graph and prints its export.
cat > "$exchange/run" << RUN
#!/bin/bash
cd "$source"
bin="$bin"
. "$here/same_rows.sh"
out=\$1 && shift
launch_graph launch/force_step.xml "\$out" --device can "\$@" && print_recording "\$out/force_step.mcap"
RUN
cat > "$exchange/guest" << GUEST
#!/bin/bash
slcand -F -o -c -s8 ../run/ttyS0 slcan0 > /run/slcand.txt 2>&1 &
for try in {1..50}; do ip link show slcan0 > /run/link.txt 2>&1 && break; sleep 0.1; done
ip link set slcan0 txqueuelen 100 up || { cat /run/slcand.txt; exit 1; }
"$exchange/run" /run/out --set gateway.bus=socketcan:slcan0 --set sim.converter_lines=/run/ttyS1
GUEST
chmod +x "$exchange/run" "$exchange/guest"

with_process() {
  rm -rf "$exchange/out"
  "$bin/ecu" --robot "$source/configs/hinge_rig/robot.xml" --bus "$bus" \
    --converters 127.0.0.1:$converters > "$exchange/ecu.txt" 2>&1 &
  local ecu=$!
  started+=($ecu)
  "$exchange/run" "$exchange/out" --set gateway.bus="$bus" --set sim.converter_port=$converters \
    > "$exchange/process"
  kill $ecu && wait $ecu 2> /dev/null
}

# Time is counted in instructions, so that a stall of the machine is not detected as a hang of the program.
with_microcontroller() {
  "$source/firmware/board/cortex_m/identity.sh" 0 3 1 7 > "$exchange/identity.bin"
  qemu-system-arm -M netduinoplus2 -icount shift=3 -display none -monitor none -kernel "$elf" \
    -device loader,file="$exchange/identity.bin",addr=0x080E0000,force-raw=on \
    -chardev pty,id=bus -serial chardev:bus -chardev pty,id=converters -serial chardev:converters \
    > "$exchange/qemu.txt" 2>&1 < /dev/null &
  local qemu=$!
  started+=($qemu)
  for try in {1..50}; do
    [ "$(grep -cs /dev/pts "$exchange/qemu.txt")" = 2 ] && break
    sleep 0.1
  done
  ERP_UML_SERIAL=$(grep -o '/dev/pts/[0-9]*' "$exchange/qemu.txt" | xargs) \
    "$here/run_in_uml.sh" "$exchange/guest" > "$exchange/guest.txt" 2>&1
  kill -KILL $qemu && wait $qemu 2> /dev/null
}

for attempt in $attempts; do
  with_process
  printf 'around a process, attempt %d: ' "$attempt"
  is_complete "$exchange/process" && break
done
[ $? = 0 ] || { cat "$exchange/process"; exit 1; }

for attempt in $attempts; do
  with_microcontroller
  printf 'around the microcontroller, attempt %d: ' "$attempt"
  same_rows "$exchange/process" "$exchange/guest.txt"
  case $? in 0) exit 0 ;; 1) break ;; esac
  tail -n 5 "$exchange/guest.txt"
done
cat "$exchange/guest.txt"
exit 1
