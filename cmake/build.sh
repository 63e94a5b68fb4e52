#!/bin/sh
# build.sh PRESET [TARGET...]: installs missing packages, configures and builds build/PRESET, or only these targets.
set -eu
cd "$(dirname "$0")/.."
preset=$1
shift

sh cmake/setup.sh

# A compiler process may need 1.5 GB; with many cores and little memory, memory limits the number of jobs.
jobs=$(nproc)
memory_kb=$(awk '/^MemAvailable/ { print $2 }' /proc/meminfo)
fitting=$((memory_kb / 1500000))
[ "$fitting" -ge 1 ] || fitting=1
[ "$jobs" -le "$fitting" ] || jobs=$fitting

cmake --preset "$preset"
cmake --build --preset "$preset" -j "$jobs" ${1:+--target "$@"}
