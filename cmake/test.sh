#!/bin/sh
# test.sh [ctest option...]: installs what is missing, builds with assertions and passes the whole test suite.
set -eu
cd "$(dirname "$0")/.."

sh cmake/build.sh audit
ctest --preset audit -j "$(nproc)" "$@"
