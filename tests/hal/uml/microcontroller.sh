#!/bin/bash
# microcontroller.sh BIN_DIR ECU_ELF SOURCE_DIR: a complete graph with an emulated microcontroller.
#
# The ECU's bare-metal program runs in QEMU. One of its serial lines speaks slcan to a kernel in
# user-mode Linux, where it is a real CAN device; the other has its converters. In that kernel runs
# the graph: gateway, plant, controllers, logger, and the robot's simulator. In lockstep every row it
# records must be what it is when the ECU is a process of this machine, bit by bit.
set -u
bin=$1 elf=$2 source=$3
here=$(dirname "$(realpath "$0")")
. "$here/same_rows.sh"
exchange=$(mktemp -d)
started=()
# KILL: they leave nothing behind, and an emulator that waits for its serial line may ignore TERM.
trap 'kill -KILL "${started[@]}" 2> /dev/null; wait; rm -rf "$exchange"' EXIT
export ERP_DOMAIN=$((1 + $$ % 200))
bus=udp:239.255.42.1:$((20000 + 16 * ERP_DOMAIN)) converters=$((24000 + ERP_DOMAIN))

# run OUT SETTING…: the graph, and its export.
cat > "$exchange/run" << RUN
#!/bin/bash
cd "$source"
bin="$bin"
. "$here/same_rows.sh"
out=\$1 && shift
launched launch/force_step.xml "\$out" --device can "\$@" && recorded "\$out/force_step.mcap"
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

# Time is counted in instructions: a stalled machine does not look like a hanging program.
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

for go in $goes; do
  with_process
  printf 'around a process, go %d: ' "$go"
  whole "$exchange/process" && break
done
[ $? = 0 ] || { cat "$exchange/process"; exit 1; }

for go in $goes; do
  with_microcontroller
  printf 'around the microcontroller, go %d: ' "$go"
  same_rows "$exchange/process" "$exchange/guest.txt"
  case $? in 0) exit 0 ;; 1) break ;; esac
  tail -n 5 "$exchange/guest.txt"
done
cat "$exchange/guest.txt"
exit 1
