#!/bin/bash
# graph_over_socketcan.sh BIN_DIR SOURCE_DIR GRAPH: runs a complete graph over the kernel's CAN.
#
# In user-mode Linux the gateway and the simulated robot use vcan0, and vcan1 if the robot has a second
# bus; outside of it the same graph runs without a bus. In lockstep all recorded rows must be identical, bit by
# bit.
set -u
bin=$1 source=$2 graph=$3
here=$(dirname "$(realpath "$0")")
. "$here/same_rows.sh"
exchange=$(mktemp -d)
trap 'rm -rf "$exchange"' EXIT
export ERP_DOMAIN=$((1 + $$ % 200))

# Runs the graph and prints its export.
cat > "$exchange/run" << RUN
#!/bin/bash
cd "$source"
bin="$bin"
. "$here/same_rows.sh"
launch_graph launch/$graph.xml "\$TMPDIR/out" "\$@" && print_recording "\$TMPDIR/out/$graph.mcap"
RUN
chmod +x "$exchange/run"

for attempt in $attempts; do
  rm -rf "$exchange/out"
  TMPDIR=$exchange "$exchange/run" > "$exchange/without" 2>&1
  printf '%s without a bus, attempt %d: ' "$graph" "$attempt"
  is_complete "$exchange/without" && break
done
[ $? = 0 ] || { cat "$exchange/without"; exit 1; }

for attempt in $attempts; do
  "$here/run_in_uml.sh" "$exchange/run" --device can \
    --set gateway.bus=socketcan:vcan0 --set sim.bus=socketcan:vcan0 > "$exchange/guest" 2>&1
  printf '%s over vcan, attempt %d: ' "$graph" "$attempt"
  same_rows "$exchange/without" "$exchange/guest"
  case $? in 0) exit 0 ;; 1) break ;; esac
  tail -n 5 "$exchange/guest"
done
cat "$exchange/guest"
exit 1
