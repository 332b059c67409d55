#!/bin/bash
# graph_over_socketcan.sh BIN_DIR SOURCE_DIR GRAPH: a whole graph, closed over the kernel's CAN.
#
# In user-mode Linux the gateway and the simulated robot behind it speak over vcan0, and vcan1 if the
# robot has a second bus; outside, the same graph runs without a bus. In lockstep every row they record must be the same, bit by bit.
# That kernel is so slow that its logger may miss messages (it counts them): rows that are missing
# there are no difference, but a hundred must be there, and the last one.
set -u
bin=$1 source=$2 graph=$3
here=$(dirname "$(realpath "$0")")
exchange=$(mktemp -d)
trap 'rm -rf "$exchange"' EXIT
export ERP_DOMAIN=$((1 + $$ % 200))

# Runs the graph and prints its export.
cat > "$exchange/run" << RUN
#!/bin/bash
cd "$source"
"$bin/erp" launch launch/$graph.xml --lockstep --for 1s --out "\$TMPDIR/out" "\$@" \
  < /dev/null > "\$TMPDIR/said" 2>&1 || { cat "\$TMPDIR/said"; exit 1; }
"$bin/erp" log export "\$TMPDIR/out/$graph.mcap"
RUN
chmod +x "$exchange/run"

TMPDIR=$exchange "$exchange/run" > "$exchange/without" 2>&1
[ "$(wc -l < "$exchange/without")" = 501 ] || { cat "$exchange/without"; exit 1; }

# On a busy machine that kernel may come to nothing within the launcher's minute: it gets three goes.
# A row that differs is a failure at once.
for go in 1 2 3; do
  "$here/run_in_uml.sh" "$exchange/run" --device can \
    --set gateway.bus=socketcan:vcan0 --set sim.bus=socketcan:vcan0 > "$exchange/guest" 2>&1
  tr -d '\r' < "$exchange/guest" | grep -a '^[0-9]' > "$exchange/within"
  rows=$(wc -l < "$exchange/within")
  different=$(grep -Fxvcf "$exchange/without" "$exchange/within")
  echo "$graph over vcan, go $go: $rows of 500 rows recorded, $different differ from the run without a bus"
  [ "$different" = 0 ] || break
  [ "$rows" -ge 100 ] &&
    [ "$(tail -n 1 "$exchange/within")" = "$(tail -n 1 "$exchange/without")" ] && exit 0
done
cat "$exchange/guest"
exit 1
