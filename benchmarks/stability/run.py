#!/usr/bin/env python3
"""Measures everything that docs/stability.md reports and writes its tables: the largest steps (limits.py), the scenes that strain
the method (verdicts.py), and the energy over 100,000 steps (long_runs.py); some three hours on a core.

  run.py               everything
  run.py PART ...      of limits, verdicts and long_runs; each of these scripts also measures a part of its own"""

import argparse
import pathlib
import subprocess
import sys

PARTS = ("limits", "verdicts", "long_runs")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    options = parser.parse_args()
    unknown = [part for part in options.parts if part not in PARTS]
    if unknown:
        parser.error(f"no part {unknown[0]}; choose from {', '.join(PARTS)}")
    for part in options.parts or PARTS:
        print(f"{part}.py --docs", flush=True)
        subprocess.run([sys.executable, pathlib.Path(__file__).with_name(f"{part}.py"), "--docs"], check=True)


if __name__ == "__main__":
    main()
