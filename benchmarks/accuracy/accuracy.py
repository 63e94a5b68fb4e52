"""Error against run time: cases with exact or converged solutions, over shapes, transfers, schemes and resolutions.

  accuracy.py run                     every case; more than an hour on two free cores with --jobs 2
  accuracy.py run --case riemann      this case only; --shape, --transfer, --scheme, --study choose alike
  accuracy.py run --every             with every shape, transfer and scheme: many hours
  accuracy.py run --quick             about three minutes of the processor: the coarse grids of some studies
  accuracy.py list                    cases, studies and methods
  accuracy.py point KEY               measures one point again; KEY as `list --points` prints it
  accuracy.py tables                  tables and plots from the CSV files alone

For each case OUT/CASE.csv and CASE.png, and all tables in OUT/accuracy.md. Measured rows replace those of the same point
and leave the others. --docs: the CSV files are those of docs/accuracy, and the tables of docs/accuracy.md,
docs/choosing.md and docs/methods.md are renewed."""

import argparse
import concurrent.futures
import datetime
import os
import pathlib
import platform
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import choosing  # noqa: E402: from this folder
import methods  # noqa: E402
import runner  # noqa: E402
import tables  # noqa: E402
from cases import CASES  # noqa: E402
from common import results  # noqa: E402: from benchmarks

DOCS = results.ROOT / "docs/accuracy"
PAGE = results.ROOT / "docs/accuracy.md"
CHOICE = results.ROOT / "docs/choosing.md"
METHODS = results.ROOT / "docs/methods.md"


def machine():
    try:
        processor = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text()).group(1)
    except (OSError, AttributeError):
        processor = platform.processor()
    return f"{processor}, {os.cpu_count()} cores, {datetime.date.today()}"


# Choice ----------------------------------------------------------------------------------------------------------


def refuse(kind, name, there_is):
    results.refuse(f"{kind} '{name}' does not exist; there is: {', '.join(there_is)}")


def chosen(kind, names, there_is):
    for name in names or ():
        if name not in there_is:
            refuse(kind, name, there_is)
    return list(names or there_is)


def selected(options):
    """{case: its points} that the options choose."""
    cases = chosen("case", options.case, list(CASES))
    shapes = chosen("shape", options.shape, methods.shapes())
    transfers = chosen("transfer", options.transfer, methods.transfers())
    schemes = chosen("scheme", options.scheme, methods.schemes())
    studies = chosen("study", options.study, list(dict.fromkeys(s for name in cases for s in CASES[name].studies)))
    found, there_is = {}, {}
    for name in cases:
        of_studies = [p for p in CASES[name].points(options.quick, options.every) if p.study in studies]
        there_is.update({f"{name} {p.method}": p.method.shape for p in of_studies})
        points = [p for p in of_studies if p.method.shape in shapes and p.method.transfer in transfers and p.method.scheme in schemes]
        if points:
            found[name] = points
    if not found:
        with_shape = [words for words, shape in there_is.items() if shape in shapes]
        of_any_case = dict.fromkeys(f"{name}: {p.study}" for name, case in CASES.items() for p in case.points(options.quick))
        results.refuse(f"no point has all of these; there is: {', '.join(with_shape or there_is or of_any_case)}")
    return found


PARTS = "case", "study", "shape", "transfer", "scheme", "cells", "particles along a cell", "factor"


def find(key):
    """The case and the point of this key; refuses what does not exist by its name."""
    words = key.split("/")
    if len(words) != len(PARTS):
        results.refuse(f"point '{key}': expected {'/'.join(PARTS)}")
    if words[0] not in CASES:
        refuse("case", words[0], CASES)
    case = CASES[words[0]]
    if words[1] not in case.studies:
        refuse("study", words[1], case.studies)
    for kind, word, there_is in zip(PARTS[2:5], words[2:5], (methods.shapes(), methods.transfers(), methods.schemes())):
        if word not in there_is:
            refuse(kind, word, there_is)
    method = methods.Method(*words[2:5])
    if case.excluded(method):
        there_are = sorted({str(m) for m in case.methods_of(words[1], every=True)})
        results.refuse(f"{case.name} leaves out {method}: {case.excluded(method)}; there is: {', '.join(there_are)}")
    points = [*case.points_of(words[1], method), *case.points_of(words[1], method, quick=True)]
    for point in points:
        if point.key == key:
            return case, point
    refuse("point", key, dict.fromkeys(p.key for p in points))


# Runs ------------------------------------------------------------------------------------------------------------


def row_text(case, point, row):
    if row["status"] != runner.DONE:
        return f"{point.key}: {row['status']}: {row['note']}"
    errors = ", ".join(f"{name} {row[name]:.3g}" for name in case.errors)
    return f"{point.key}: {errors}; {row['steps']} steps, {row['seconds']:.3g} s"


def measure(case, points, options):
    """Rows of the points. A method that the program refuses once is not tried at every resolution."""
    refused = set()

    def one(point):
        if point.method in refused:
            return None
        row = runner.run(case, point, options.plots, options.keep)
        if row["status"] == runner.REFUSED:
            refused.add(point.method)
        print(row_text(case, point, row), file=sys.stderr, flush=True)
        return row

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        return [row for row in pool.map(one, points) if row is not None]


def run(options):
    for name, points in selected(options).items():
        case, path, rows = CASES[name], options.out / f"{name}.csv", []
        earlier = tables.read(path)
        for study in dict.fromkeys(p.study for p in points):  # what is measured is on disk when the next one begins
            rows += measure(case, [p for p in points if p.study == study], options)
            tables.write(case, path, rows, [machine(), f"jobs at a time {options.jobs}"], earlier)
    render(options)


def blocks_of(folder):
    """{name: Markdown} of every CSV file in the folder, and what the program refused; and the rows by case."""
    rows_of, blocks = {}, {}
    for name, case in CASES.items():
        path = folder / f"{name}.csv"
        if path.exists():
            head, rows_of[name] = tables.read(path)
            blocks[name] = tables.case_block(case, rows_of[name]) + f"\n\nMeasured on {'; '.join(head)}."
    blocks["pressure"] = tables.pressure_block(rows_of)
    blocks["refused"] = tables.refusal_block(rows_of)
    return blocks, rows_of


def render(options):
    """Tables and plots of every CSV file in the folder."""
    blocks, rows_of = blocks_of(options.out)
    options.plots.mkdir(parents=True, exist_ok=True)
    for name, rows in rows_of.items():
        tables.plot(CASES[name], rows, options.plots / f"{name}.png")
    if options.docs:
        results.refresh(PAGE, blocks)
        results.refresh(CHOICE, choosing.blocks(CASES, rows_of))
        results.refresh(METHODS, {"scatter": tables.scatter_block(rows_of)})
        print(PAGE, CHOICE, METHODS, sep="\n")
        return
    text = "# Accuracy\n"
    for name, block in blocks.items():
        text += f"\n## {CASES[name].title if name in CASES else name.capitalize()}\n\n{block}\n"
        if (options.plots / f"{name}.png").exists():
            text += f"\n![]({name}.png)\n"
    (options.out / "accuracy.md").write_text(text)
    print(options.out / "accuracy.md")


def one_point(options):
    case, point = find(options.key)
    row = runner.run(case, point, options.plots, options.keep)
    if options.keep:
        print(f"{'files':<12} {options.plots / 'runs' / point.key.replace('/', '-')}")
    if row["status"] == runner.REFUSED:
        results.refuse(row_text(case, point, row))
    for name, value in row.items():
        if value != "":
            print(f"{name:<12} {value:.6g}" if isinstance(value, float) else f"{name:<12} {value}")


def show(options):
    if options.points:
        for points in selected(options).values():
            print("\n".join(p.key for p in points))
        return
    for name, points in selected(options).items():
        print(f"{name}: {CASES[name].title}; {len(points)} points")
        for study in CASES[name].studies:
            print(f"  {study}")
    for kind, there_is in (("shape", methods.shapes()), ("transfer", methods.transfers()), ("scheme", methods.schemes())):
        print(f"{kind}: {' '.join(there_is)}")


def arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=("run", "list", "point", "tables"))
    parser.add_argument("key", nargs="?", help="with point: CASE/STUDY/SHAPE/TRANSFER/SCHEME/CELLS/SPLIT/FACTOR")
    for word in ("case", "study", "shape", "transfer", "scheme"):
        parser.add_argument(f"--{word}", nargs="+", metavar=word.upper())
    parser.add_argument("--every", action="store_true", help="every shape with every transfer and scheme, in every study")
    parser.add_argument("--quick", action="store_true", help="coarse grids of some studies; about three minutes of the processor")
    parser.add_argument("--points", action="store_true", help="with list: the key of every point")
    parser.add_argument("--keep", action="store_true", help="leave the files of the runs in OUT/runs")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time; above 1 they disturb each other's times a little")
    parser.add_argument("--out", type=pathlib.Path, help="default: build/accuracy; with --docs: docs/accuracy")
    parser.add_argument("--docs", action="store_true", help="refresh docs/accuracy and docs/accuracy.md")
    options = parser.parse_args(words)
    if (options.command == "point") != (options.key is not None):
        parser.error("the command point needs a key, the others take none")
    if options.quick and options.every:
        parser.error("--quick has few methods; leave --every away")
    if options.docs and options.out:
        parser.error("--docs says where the results go; leave --out away")
    pictures = results.ROOT / "build/accuracy"
    options.out = options.out or (DOCS if options.docs else pictures)
    options.plots = pictures if options.docs else options.out
    return options


def main(words=None):
    options = arguments(words)
    {"run": run, "list": show, "point": one_point, "tables": render}[options.command](options)


if __name__ == "__main__":
    main()
