#!/usr/bin/env bash
# Installs, from Debian's own packages, what building and testing need; asks for sudo only if it must.
#   dependencies.sh build | test
set -euo pipefail

build=(git ca-certificates g++ gcc make cmake ninja-build pkg-config cyclonedds-dev cyclonedds-tools
  libbullet-dev libeigen3-dev libtinyxml2-dev libspdlog-dev libcli11-dev zlib1g-dev libzstd-dev
  libceres-dev libssl-dev libsocketcan-dev nlohmann-json3-dev libopencv-imgproc-dev libopencv-imgcodecs-dev gnuplot-nox
  libpagmo-dev libfuzzylite-dev)
test=(libopenmpi-dev openmpi-bin catch2 libbenchmark-dev libmujoco-dev libcgal-dev libcollada-dom-dev libboost-filesystem-dev libxml2-utils user-mode-linux kmod iproute2 can-utils
  nodejs npm procps spin gcovr gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm clang-16 libclang-rt-16-dev)

wanted=("${build[@]}")
[ "${1:-build}" = test ] && wanted+=("${test[@]}")

# A command that is already there, from wherever, serves as well as Debian's package of it.
missing=()
for package in "${wanted[@]}"; do
  case $package in
    nodejs) command -v node >/dev/null && continue ;;
    npm | git | cmake | g++ | gcc) command -v "$package" >/dev/null && continue ;;
  esac
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "need root to install: ${missing[*]}" >&2; exit 1; }
  root=(sudo)
fi
echo "installing ${#missing[@]} Debian packages: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${root[@]}" apt-get update -qq
"${root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
