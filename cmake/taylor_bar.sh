#!/bin/sh
# taylor_bar.sh [RANKS]: installs missing packages, builds the programs with the features that this case needs, runs the
# copper Taylor bar (default: 2 ranks) in out/taylor_bar and compares it with the experiment.
set -eu
cd "$(dirname "$0")/.."
ranks=${1:-2}

sh cmake/build.sh minimal mpm_run mpm_check

# Root in a container and more ranks than cores are normal here. Single-copy messages need ptrace permission, which
# containers lack.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none
export OMP_NUM_THREADS="${OMP_NUM_THREADS:-1}"

rm -rf out/taylor_bar
mpirun --oversubscribe --bind-to none -n "$ranks" build/minimal/bin/mpm_run --output-dir out/taylor_bar \
  benchmarks/taylor_bar/taylor_bar.xmp
/usr/bin/python3 benchmarks/taylor_bar/report.py out/taylor_bar
