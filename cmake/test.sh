#!/bin/sh
# test.sh [ctest option...]: installs missing packages, builds with assertions and runs the whole test suite.
set -eu
cd "$(dirname "$0")/.."

sh cmake/build.sh audit
ctest --preset audit -j "$(nproc)" "$@"
