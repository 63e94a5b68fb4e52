#!/usr/bin/env python3
"""Energy of an elastic block after 100,000 steps, with every shape function and scheme, and every transfer with quadratic splines.

  long_runs.py                     every scene with every method; half an hour on two cores; every transfer, named, takes hours
  long_runs.py --scene NAME ...    these scenes; --shape, --scheme, --transfer choose methods alike
  long_runs.py --docs              as above, and docs/stability/long_runs.csv and the table of docs/stability.md, where rows that
                                   were not measured stay
  long_runs.py --tables            the table of docs/stability.md from that file, without a run

A free block of 4 x 4 x 4 cells with 8 particles in each, askew in the grid, vibrates in its longest modes along the three
axes for 100,000 times 0.9 h/c, c the speed of longitudinal waves: with a limit k of the step (docs/stability.md) in 100,000/k
steps. The scenes differ in the speed of its ends and in artificial viscosity:

  small    0.1 % of c, without viscosity: particles stay in their cells
  large    3 % of c, without viscosity: particles cross faces of cells, some in every period
  viscous  3 % of c, with the default viscosity, whose heat counts as internal energy

*drift*: of the energy balance, over the initial energy, from the mean of the first tenth of the rows of the status file to that of
the last tenth: what is lost within the first tenth is no part of it. The program's defaults otherwise, with a factor of 0.9."""

import argparse
import concurrent.futures
import math
import os
import pathlib
import sys
import tempfile

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / part) for part in ("benchmarks", "tests/system")]

from common import results  # noqa: E402: found by the line above
from accuracy import methods  # noqa: E402
from limits import Refused  # noqa: E402: from this folder
import _mpm  # noqa: E402
import numpy as np  # noqa: E402

PAGE = results.ROOT / "docs/stability.md"
TABLE = results.ROOT / "docs/stability/long_runs.csv"
STEPS, FACTOR = 100000, 0.9
SCHEMES = methods.choices("Solution", "algorithm")
YOUNG, POISSON = 1000.0, 0.3  # density 1, cells of 1
WAVE = math.sqrt(YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON)))
# Speed of the block's ends over that of waves, and attributes of the material.
INVISCID = 'bq1="0" bq2="0"'
SCENES = {"small": (0.001, INVISCID), "large": (0.03, INVISCID), "viscous": (0.03, "")}


def scene(name, method, steps, factor):
    lower, size = (3.1, 3.2, 3.3), 4
    share, viscosity = SCENES[name]
    speed = [f"{share * WAVE!r}*cos(pi*({axis}-{low})/{size})" for axis, low in zip("xyz", lower)]
    end = steps * FACTOR / WAVE
    law = f'type="IsoElastic" Young="{YOUNG!r}" Poisson="{POISSON!r}" {viscosity}'
    text = _mpm.scene([_mpm.block("block", lower, (size,) * 3, speed, 0.5, "soft")], _mpm.grid((0, 0, 0), (10, 10, 10)),
                      _mpm.solution(repr(end), method.scheme, factor), [_mpm.material("soft", 1.0, law)])
    root = methods.ElementTree.fromstring(text.encode())
    methods.choose(root, method)
    return methods.ElementTree.tostring(root, encoding="unicode")


def measure(name, method, steps=STEPS, factor=FACTOR):
    """A row of the table; Refused for a method that the program refuses."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "case.xmp").write_text(scene(name, method, steps, factor))
        done = _mpm.run([folder / "case.xmp", "--output-dir", folder], timeout=6000)
        if done.code == 2:
            raise Refused(results.reason(done.err))
        row = {"scene": name, "shape": method.shape, "scheme": method.scheme, "transfer": method.transfer, "code": done.code,
               "steps": _mpm.summary(folder)["steps"], "drift": ""}
        if done.code == 0:
            drift = np.array(_mpm.table(folder / "case.sta")["relative_drift"])[1:]  # without the start
            tenth = len(drift) // 10
            if tenth > 0:  # else all particles have left the grid
                row["drift"] = float(drift[-tenth:].mean() - drift[:tenth].mean())
        return row


def wanted(options):
    if options.transfer or options.shape or options.scheme:
        return methods.product(options.shape or methods.shapes(), options.transfer or ("FLIP",), options.scheme or ("MUSL",))
    return list(dict.fromkeys([*methods.product(some_schemes=SCHEMES), *methods.every_transfer(("QuadraticBSpline",))]))


def table(rows):
    """Drift by method, with columns for each scene."""
    by_method = {}
    for row in rows:
        by_method.setdefault((row["shape"], row["scheme"], row["transfer"]), {})[row["scene"]] = row
    columns = {name: (lambda m, i=i: m[0][i], "") for i, name in enumerate(("shape", "scheme", "transfer"))}

    def of(name, key, scale):
        def value(method):
            row = method[1].get(name)
            if row is None:
                return None
            return "stops" if row["code"] != 0 else "leaves" if row["drift"] == "" else scale * row[key]
        return value

    for name in SCENES:
        columns[f"{name}: steps"] = (of(name, "steps", 1), ".0f")
        columns[f"{name}: drift, %"] = (of(name, "drift", 100), "+.2g")
    return results.markdown(list(by_method.items()), columns)


KEYS = ("scheme", "transfer", "shape", "scene")


def on_file():
    return results.read(TABLE)[1] if TABLE.exists() else []


def merged(old, new):
    """The rows on file with these in the place of the same ones, in the order of the program's lists and of the scenes."""
    rows = {tuple(row[key] for key in KEYS): row for row in [*old, *new]}
    lists = SCHEMES, methods.transfers(), methods.shapes(), list(SCENES)
    return [rows[key] for key in sorted(rows, key=lambda key: [names.index(word) for names, word in zip(lists, key)])]


def tables():
    """The block of the page that the file keeps."""
    return {"long runs": table(on_file())}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--shape", nargs="+", choices=methods.shapes())
    parser.add_argument("--scheme", nargs="+", choices=SCHEMES)
    # argparse breaks a usage line at the brackets of FMPM(5).
    parser.add_argument("--transfer", nargs="+", choices=methods.transfers(), metavar="TRANSFER", help=", ".join(methods.transfers()))
    parser.add_argument("--steps", type=int, default=STEPS)
    parser.add_argument("--factor", type=float, default=FACTOR, help="of the critical step; the time stays the same")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--docs", action="store_true", help="write docs/stability/long_runs.csv and the table of docs/stability.md")
    parser.add_argument("--tables", action="store_true", help="write the table of docs/stability.md from the file")
    options = parser.parse_args()
    if options.tables:
        return results.refresh(PAGE, tables())
    points = [(name, method) for method in wanted(options) for name in options.scene]
    rows, refused = [], {}

    def measured(point):
        try:
            return measure(*point, options.steps, options.factor)
        except Refused as refusal:
            refused[str(point[1])] = refusal
            return None

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for row in filter(None, pool.map(measured, points)):
            rows.append(row)
            print(", ".join(f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()), flush=True)
    if not rows:
        parser.error("the program refuses all of these; " + "; ".join(f"{method}: {refusal}" for method, refusal in refused.items()))
    if options.docs:
        results.write(TABLE, merged(on_file(), rows))
        results.refresh(PAGE, tables())


if __name__ == "__main__":
    main()
