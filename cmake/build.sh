#!/bin/sh
# build.sh PRESET [TARGET...]: installs what is missing, configures and builds build/PRESET, or only these targets of it.
set -eu
cd "$(dirname "$0")/.."
preset=$1
shift

sh cmake/setup.sh

# A compiler at work may take 1.5 GB; on machines with many cores and little memory, memory is the limit.
jobs=$(nproc)
memory_kb=$(awk '/^MemAvailable/ { print $2 }' /proc/meminfo)
fitting=$((memory_kb / 1500000))
[ "$fitting" -ge 1 ] || fitting=1
[ "$jobs" -le "$fitting" ] || jobs=$fitting

cmake --preset "$preset"
cmake --build --preset "$preset" -j "$jobs" ${1:+--target "$@"}
