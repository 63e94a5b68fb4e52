#!/bin/sh
# Installs the packages for building, testing and plotting on Debian 12. Does nothing if all are installed.
set -eu

packages="build-essential g++ cmake ninja-build ccache git pkg-config
  libopenmpi-dev openmpi-bin libhdf5-openmpi-dev hdf5-tools libmetis-dev petsc-dev libopenblas0-serial
  libeigen3-dev catch2 libxml2-dev libcli11-dev libfmt-dev libmuparser-dev nlohmann-json3-dev zlib1g-dev
  python3 python3-numpy python3-matplotlib python3-h5py python3-sympy
  clang-14 libomp-14-dev libclang-rt-14-dev clang-format-14"

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "setup.sh: this is not a Debian-like system. Install the counterparts of these packages yourself:" >&2
  echo $packages >&2
  exit 1
fi

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || status=""
  [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

root=""
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup.sh: not root, and there is no sudo. Ask an administrator for: apt-get install$missing" >&2
    exit 1
  fi
  root="sudo"
fi

echo "setup.sh: installing$missing"
$root apt-get update
$root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
