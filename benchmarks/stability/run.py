#!/usr/bin/env python3
"""Measures everything that docs/stability.md reports and writes its tables: the largest steps (limits.py), the scenes that strain
the method (verdicts.py), inputs of users (user_inputs.py), and the energy over 100,000 steps (long_runs.py); some hours on a core.

  run.py               everything
  run.py PART ...      of limits, verdicts, user_inputs and long_runs; each of these scripts also measures a part of its own"""

import argparse
import pathlib
import subprocess
import sys

FLUID = ("--scene", "fluid", "--scheme", "MUSL")
# What each part runs, with --docs.
PARTS = {"limits": [(), (*FLUID, "--transfer", "PIC", "APIC", "TPIC", "AFLIP", "XPIC", "FMPM"), (*FLUID, "--mass", "consistent")],
         "verdicts": [(), ("--course",), ("--fracture",)], "user_inputs": [()], "long_runs": [()]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    options = parser.parse_args()
    unknown = [part for part in options.parts if part not in PARTS]
    if unknown:
        parser.error(f"no part {unknown[0]}; choose from {', '.join(PARTS)}")
    for part in options.parts or PARTS:
        for words in PARTS[part]:
            print(f"{part}.py --docs", *words, flush=True)
            subprocess.run([sys.executable, pathlib.Path(__file__).with_name(f"{part}.py"), "--docs", *words], check=True)


if __name__ == "__main__":
    main()
