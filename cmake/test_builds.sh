#!/bin/sh
# test_builds.sh [BUILD...]: tests that test.sh does not cover, each in its own build:
#   minimal                the first command of the README; what that build lacks is refused by name
#   sanitize               all unit tests with clang under the address and undefined-behaviour sanitizers, with vectors of
#                          two, warnings as errors, every file with its own includes; one shape function of each kind
# and, if named:
#   sanitize-all           as sanitize, with all shape functions
#   lanes1, lanes2, lanes4 the unit tests of core and physics without vectors, and with vectors of two and four
#   clang                  as sanitize, with the widest vectors and without sanitizers
#   race                   data races between the threads of a rank
set -eu
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- minimal sanitize

report=""
for build in "$@"; do
  echo "test_builds.sh: $build"
  start=$(date +%s)
  case $build in
    lanes*)
      sh cmake/build.sh "$build" test_core test_physics
      built=$(date +%s)
      ctest --preset "$build" -j "$(nproc)" -R '^unit\.(core|oracle.*|physics)$'
      ;;
    minimal)
      sh cmake/taylor_bar.sh
      built=$(date +%s)
      /usr/bin/python3 tests/builds/minimal.py
      ;;
    race)
      sh cmake/build.sh "$build" race_programs
      built=$(date +%s)
      cmake --build --preset "$build" --target race
      ;;
    *)
      sh cmake/build.sh "$build" unit_programs
      built=$(date +%s)
      ctest --preset "$build" -j "$(nproc)" -L unit
      ;;
  esac
  report="$report
  $build: built in $((built - start)) s, tested in $(($(date +%s) - built)) s"
done
echo "test_builds.sh: passed$report"
