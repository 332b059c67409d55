#!/usr/bin/env bash
# Installs the Debian packages for building or testing that are missing. Uses sudo unless run as root.
#   dependencies.sh build | test | docs
set -euo pipefail

build=(git ca-certificates g++ gcc make cmake ninja-build pkg-config cyclonedds-dev cyclonedds-tools
  libbullet-dev libeigen3-dev libtinyxml2-dev libspdlog-dev libcli11-dev zlib1g-dev libzstd-dev
  libceres-dev libssl-dev libsocketcan-dev nlohmann-json3-dev libopencv-imgproc-dev libopencv-imgcodecs-dev gnuplot-nox
  libpagmo-dev libfuzzylite-dev)
test=(libopenmpi-dev openmpi-bin catch2 libbenchmark-dev libmujoco-dev libcgal-dev libcollada-dom-dev libboost-filesystem-dev libxml2-utils user-mode-linux kmod iproute2 can-utils
  groff-base nodejs npm procps spin gcovr gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm clang-16 libclang-rt-16-dev)

docs=(doxygen graphviz)

required=("${build[@]}")
case ${1:-build} in
  build) ;;
  test) required+=("${test[@]}" "${docs[@]}") ;;
  docs) required+=("${docs[@]}") ;;
  *) echo "dependencies.sh: unknown set \"$1\"; give build, test or docs" >&2; exit 2 ;;
esac

# If a command exists that was installed in another way, its Debian package is not installed.
missing=()
for package in "${required[@]}"; do
  case $package in
    nodejs) command -v node >/dev/null && continue ;;
    npm | git | cmake | g++ | gcc) command -v "$package" >/dev/null && continue ;;
  esac
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "cannot install without root or sudo; run as root: apt-get install ${missing[*]}" >&2; exit 1; }
  root=(sudo)
fi
echo "installing ${#missing[@]} Debian packages: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${root[@]}" apt-get update -qq
"${root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
