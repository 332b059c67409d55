#!/bin/bash
# run_in_uml.sh PROGRAM [ARGUMENT…]: runs a program under a kernel that has CAN.
#
# Most build machines and all containers lack AF_CAN. User-mode Linux is a kernel in a process; it
# needs no privileges. The program runs as root and has read-only access to the files of this machine. The virtual
# CAN interfaces vcan0 and vcan1 (classic), vcan3 and vcan4 (CAN FD) are up, and vcan2 is down. The kernel has
# slcan, can-gw, tbf and netem. The exit status of the program is returned.
# Time limit 300 s, or ERP_UML_SECONDS: then the kernel is ended, because it may hang on a busy machine.
# With ERP_UML_SERIAL="/dev/pts/N /dev/pts/M" these terminals are its serial lines /run/ttyS0, ttyS1.
# Debian: user-mode-linux kmod iproute2 can-utils gcc. Sanitizers other than UBSan do not run in it.
set -u
[ $# -ge 1 ] || { echo "usage: run_in_uml.sh PROGRAM [ARGUMENT…]" >&2; exit 2; }
for tool in linux.uml insmod ip cansend cc; do
  PATH=$PATH:/usr/sbin:/sbin command -v "$tool" > /dev/null && continue
  echo "run_in_uml.sh: no $tool; apt-get install user-mode-linux kmod iproute2 can-utils gcc" >&2
  exit 1
done

exchange=$(mktemp -d /var/tmp/erp_uml.XXXXXX) || exit 1
uml=
trap '[ -z "$uml" ] || kill -KILL -- "-$uml" 2> /dev/null; rm -rf "$exchange"' EXIT
trap 'exit 143' TERM
trap 'exit 130' INT
printf '%q ' "$@" > "$exchange/command"

# The first and only process of the guest.
cat > "$exchange/init" << 'INIT'
#!/bin/bash
export PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin
exchange=$(dirname "$0")
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t tmpfs tmpfs /run
mknod /run/ttyS0 c 4 64
mknod /run/ttyS1 c 4 65
mkdir -p /dev/pts /dev/shm
mount -t devpts -o ptmxmode=666 devpts /dev/pts
mount -t tmpfs tmpfs /dev/shm
[ -e /dev/ptmx ] || ln -s pts/ptmx /dev/ptmx
mount -t hostfs none "$exchange" -o "$exchange"
modules=/usr/lib/uml/modules/$(uname -r)/kernel
for module in net/can/can net/can/can-raw net/can/can-gw drivers/net/can/dev/can-dev \
  "drivers/net/can/vcan echo=1" drivers/net/can/slcan/slcan net/sched/sch_tbf net/sched/sch_netem; do
  set -- $module
  insmod "$modules/$1.ko" $2 || echo "run_in_uml.sh: no kernel module $1"
done
echo 8388608 | tee /proc/sys/net/core/rmem_max > /proc/sys/net/core/rmem_default  # the guest reads slowly
ip link set lo up
for interface in vcan0 vcan1 vcan2 vcan3 vcan4; do
  ip link add "$interface" type vcan
  ip link set "$interface" txqueuelen 1000
done
for interface in vcan0 vcan1 vcan2; do ip link set "$interface" mtu 16; done
for interface in vcan0 vcan1 vcan3 vcan4; do ip link set "$interface" up; done
bash -c "TMPDIR=/run exec $(cat "$exchange/command")" < /dev/null
echo $? > "$exchange/status"
sync
echo o > /proc/sysrq-trigger
sleep 60
INIT
chmod +x "$exchange/init"

registers=$exchange/register_state.so  # described in register_state.c
cc -shared -fPIC -O2 -o "$registers" "$(dirname "$0")/register_state.c" || exit 1

lines=() && for terminal in ${ERP_UML_SERIAL:-}; do lines+=("ssl${#lines[@]}=tty:$terminal"); done

# A separate process group: the kernel's processes end neither with it nor on SIGTERM.
PATH=$PATH:/usr/sbin:/sbin LD_PRELOAD=$registers setsid linux.uml mem=256M \
  root=/dev/root rootfstype=hostfs rootflags=/ ro quiet loglevel=3 uml_dir="$exchange" umid=guest con=null con0=null,fd:1 ssl=null \
  "${lines[@]}" \
  init="$exchange/init" < /dev/null &
uml=$!
timeout_s=${ERP_UML_SECONDS:-300}
while kill -0 "$uml" 2> /dev/null && ((SECONDS < timeout_s)); do sleep 0.2; done
status=$(cat "$exchange/status" 2> /dev/null)
[ -n "$status" ] || { echo "run_in_uml.sh: the guest did not end within $timeout_s s" >&2; exit 1; }
exit "$status"
