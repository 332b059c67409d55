#!/bin/bash
# graph_over_socketcan.sh BIN_DIR SOURCE_DIR: a whole graph, closed over the kernel's CAN.
#
# In user-mode Linux the gateway and the simulated robot behind it speak over vcan0; outside, the
# same graph runs without a bus. In lockstep both must record the same, bit by bit.
set -u
bin=$1 source=$2
here=$(dirname "$(realpath "$0")")
exchange=$(mktemp -d)
trap 'rm -rf "$exchange"' EXIT
export ERP_DOMAIN=$((1 + $$ % 200))

# Runs the graph and prints how many rows its export has, and their sum.
cat > "$exchange/run" << RUN
#!/bin/bash
cd "$source"
"$bin/erp" launch launch/force_step.xml --lockstep --for 1s --out "\$TMPDIR/out" "\$@" \
  < /dev/null > "\$TMPDIR/said" 2>&1 || { cat "\$TMPDIR/said"; exit 1; }
"$bin/erp" log export "\$TMPDIR/out/force_step.mcap" > "\$TMPDIR/export.csv" || exit 1
echo "rows \$(wc -l < "\$TMPDIR/export.csv") sum \$(sha256sum < "\$TMPDIR/export.csv")"
RUN
chmod +x "$exchange/run"

TMPDIR=$exchange "$exchange/run" > "$exchange/without" 2>&1
"$here/run_in_uml.sh" "$exchange/run" --device can \
  --set gateway.bus=socketcan:vcan0 --set sim.bus=socketcan:vcan0 > "$exchange/within" 2>&1
for side in without within; do
  tr -d '\r' < "$exchange/$side" | grep -a '^rows' > "$exchange/$side.sum" || cat "$exchange/$side"
  echo "$side a CAN bus: $(cat "$exchange/$side.sum")"
done
grep -q '^rows 501 ' "$exchange/without.sum" && cmp "$exchange/without.sum" "$exchange/within.sum"
