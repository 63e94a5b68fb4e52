"""Implicit steps: errors against exact or published solutions, and run times, with explicit runs beside them.

  implicit.py run                     every study; about half an hour on one core
  implicit.py run --study column      this study only; --shape SHAPE chooses alike
  implicit.py run --quick             two to three minutes of the processor: the coarse grids of some studies
  implicit.py list                    studies, and the key of every run
  implicit.py tables                  the tables from the CSV files alone

For each study OUT/STUDY.csv, and all tables in OUT/implicit.md. Measured rows replace those of the same labels and leave
the others; a row is written as soon as its run ends, so that an interrupted study keeps what it has measured. --docs: the
tables of docs/implicit_results.md are renewed too."""

import argparse
import concurrent.futures
import csv
import datetime
import os
import pathlib
import platform
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from common import results  # noqa: E402: from benchmarks

import run_one  # noqa: E402: from this folder
from studies import STUDIES  # noqa: E402

PAGE = results.ROOT / "docs/implicit_results.md"


def machine():
    try:
        processor = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text()).group(1)
    except (OSError, AttributeError):
        processor = platform.processor()
    return f"{processor}, one core of {os.cpu_count()}, {datetime.date.today()}"


def refuse(kind, name, there_is):
    results.refuse(f"{kind} '{name}' does not exist; there is: {', '.join(there_is)}")


def runs_of(names, quick):
    """Each of these studies and its runs, all or the quick ones."""
    for name in names:
        yield name, [r for r in STUDIES[name].runs() if r.quick or not quick]


def labels_of(names, quick):
    """The studies that have such runs, with their shapes."""
    return dict.fromkeys(f"{name} {r.labels.get('shape', '')}".strip() for name, runs in runs_of(names, quick) for r in runs)


def chosen(options):
    """{study: its runs} that the options choose."""
    for name in options.study or ():
        if name not in STUDIES:
            refuse("study", name, STUDIES)
    found = {}
    for name, runs in runs_of(options.study or STUDIES, options.quick):
        if options.shape:
            there_is = dict.fromkeys(r.labels["shape"] for r in STUDIES[name].runs() if "shape" in r.labels)
            for shape in options.shape:
                if there_is and shape not in there_is:
                    refuse(f"{name}: shape", shape, there_is)
            runs = [r for r in runs if r.labels.get("shape") in options.shape]
        if runs:
            found[name] = runs
    if not found:
        there_is = labels_of(options.study or STUDIES, options.quick) or labels_of(STUDIES, options.quick)
        results.refuse(f"no run has all of these; there is: {', '.join(there_is)}")
    return found


# Runs ------------------------------------------------------------------------------------------------------------


def identity(row, labels):
    return tuple(str(results.number(str(row[name]))) for name in labels)


def write(study, path, rows, head):
    """Rows of this run, of the same labels that of the median time, and those that the file had and this run did not measure, in
    the order of the study's runs."""
    kept = {identity(r, study.labels): r for r in results.read(path)[1]} if path.exists() else {}
    repeats = {}
    for row in sorted(rows, key=lambda r: r["seconds"] or 0.0):
        repeats.setdefault(identity(row, study.labels), []).append(row)
    kept.update({key: same[len(same) // 2] for key, same in repeats.items()})
    places = {identity(r.labels, study.labels): i for i, r in enumerate(study.runs())}
    rows = [kept[key] for key in sorted(kept, key=lambda key: places.get(key, 0)) if key in places]
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part")
    with open(part, "w", newline="") as file:
        file.writelines(f"# {line}\n" for line in head)
        out = csv.DictWriter(file, study.columns, lineterminator="\n", restval="", extrasaction="ignore")
        out.writeheader()
        for row in rows:
            out.writerow({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in row.items()})
    part.replace(path)


def run(options):
    for name, runs in chosen(options).items():
        def measured(one, name=name):
            row = run_one.run(one, options.out, options.keep)
            found = {k: row[k] for k in STUDIES[name].measured if k in row}
            said = row["note"] or ", ".join(f"{k} {v if isinstance(v, str) else format(v, '.4g')}" for k, v in found.items())
            print(f"{name} {one.key}: {row['status']}: {said}; {row['steps']} steps, {row['newton']} iterations, "
                  f"{row['seconds'] or 0:.3g} s", file=sys.stderr, flush=True)
            return row

        rows = []
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            waiting = [pool.submit(measured, one) for one in runs * options.repeat]
            try:
                for ended in concurrent.futures.as_completed(waiting):
                    rows.append(ended.result())
                    write(STUDIES[name], options.out / f"{name}.csv", rows, [machine()])
            except BaseException:
                for one in waiting:
                    one.cancel()
                raise
    render(options)


def blocks_of(folder):
    """{study: Markdown} of every CSV file in the folder."""
    blocks = {}
    for name, study in STUDIES.items():
        path = folder / f"{name}.csv"
        if path.exists():
            head, rows = results.read(path)
            blocks[name] = f"{study.about.strip()}\n\n{study.block(rows)}\n\nMeasured on {'; '.join(head)}."
    return blocks


def render(options):
    blocks = blocks_of(options.out)
    text = "# Implicit steps\n" + "".join(f"\n## {STUDIES[name].title}\n\n{block}\n" for name, block in blocks.items())
    (options.out / "implicit.md").write_text(text)
    print(options.out / "implicit.md")
    if options.docs:
        results.refresh(PAGE, blocks)
        print(PAGE)


def show(options):
    for name, runs in chosen(options).items():
        print(f"{name}: {STUDIES[name].title}; {len(runs)} runs")
        for one in runs:
            print(f"  {one.key}")


def arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=("run", "list", "tables"))
    for word in ("study", "shape"):
        parser.add_argument(f"--{word}", nargs="+", metavar=word.upper())
    parser.add_argument("--quick", action="store_true", help="coarse grids of some studies; two to three minutes of the processor")
    parser.add_argument("--keep", action="store_true", help="leave the files of the runs in OUT/runs")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time; above 1 they disturb each other's times a little")
    parser.add_argument("--repeat", type=int, default=1, help="the list of runs so many times over; of each run the median time")
    parser.add_argument("--out", type=pathlib.Path, default=results.ROOT / "build/implicit", help="default: build/implicit")
    parser.add_argument("--docs", action="store_true", help="renew the tables of docs/implicit_results.md")
    return parser.parse_args(words)


def main(words=None):
    options = arguments(words)
    {"run": run, "list": show, "tables": render}[options.command](options)


if __name__ == "__main__":
    main()
