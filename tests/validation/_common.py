"""What the validations share: where they write, timed runs, tables."""

import argparse
import csv
import datetime
import os
import pathlib
import platform
import re
import resource
import shutil
import sys

ROOT = pathlib.Path(os.environ.get("MPM_SOURCE", pathlib.Path(__file__).parents[2])).resolve()
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "benchmarks/taylor_bar")]

import _mpm  # noqa: E402: found by the line above


def arguments(description, name):
    """A parser with --out, the folder for results (default out/validation/NAME)."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/validation" / name)
    return parser


def run(folder, text, job="case", may_fail=False):
    """Runs the scene on one rank and thread in `folder`, which is emptied first. The processor's seconds that it took:
    unlike those on the clock they hardly depend on what else the machine does. None after a numerical failure, where
    that is an answer too."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    case = folder / f"{job}.xmp"
    case.write_text(text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    outcome = _mpm.run([case, "--output-dir", folder], timeout=None)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if may_fail and outcome.code == _mpm.NUMERICAL_FAILURE:
        return None
    if outcome.code != _mpm.DONE:
        raise SystemExit(f"{case}: {outcome}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def machine():
    try:
        cpu = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text()).group(1)
    except (OSError, AttributeError):
        cpu = platform.processor()
    return f"{cpu}, {os.cpu_count()} cores, {platform.system()}, {datetime.date.today()}"


def cell(value, how):
    """A number that a row does not have, not-a-number, is a dash."""
    return "–" if value != value else format(value, how)


def write(folder, name, rows, columns):
    """NAME.csv and NAME.md; columns: {key: (heading, format)} for the Markdown, all keys go into the CSV."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / f"{name}.csv", "w", newline="") as file:
        out = csv.DictWriter(file, list(max(rows, key=len)), lineterminator="\n")
        out.writeheader()
        out.writerows({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)
    lines = ["| " + " | ".join(heading for heading, _ in columns.values()) + " |", "|" + " --- |" * len(columns)]
    lines += ["| " + " | ".join(cell(row[key], how) for key, (_, how) in columns.items()) + " |" for row in rows]
    (folder / f"{name}.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines), flush=True)


class Verdict:
    """Collects what misses its target; at the end prints it and leaves with 1."""

    def __init__(self):
        self.missed = []

    def expect(self, holds, what):
        if not holds:
            self.missed.append(what)

    def finish(self):
        for what in self.missed:
            print(f"MISSED {what}")
        raise SystemExit(1 if self.missed else 0)
