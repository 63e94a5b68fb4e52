"""Common parts of the attacks: command lines, folders, the loop over numbered cases, and the comparison of the files of
two runs."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))

import _mpm  # noqa: E402
import _resume  # noqa: E402

TIMES = ("wall_seconds", "particle_steps_per_second", "peak_memory_bytes", "ranks", "threads", "bytes_per_particle")


def trials(default):
    """The command line: [trials] [seed]."""
    return (int(sys.argv[1]) if len(sys.argv) > 1 else default), (int(sys.argv[2]) if len(sys.argv) > 2 else 1)


class Ground:
    """A folder for all trials; it stays when something went wrong."""

    def __init__(self, name):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix=f"mpm-{name}-"))
        self.faults = 0

    def fault(self, trial, what):
        self.faults += 1
        print(f"FAULT in trial {trial}: {what}\n      kept in {self.folder}", flush=True)

    def end(self):
        if self.faults == 0:
            shutil.rmtree(self.folder)
        print(f"{self.faults} fault(s)")
        sys.exit(self.faults > 0)


def numbered(kind, judge, count, description, prepare=lambda top: ""):
    """The main program of an attack by numbered cases, which a number and a seed determine; returns the exit code.

    `judge(number, seed, folder)` makes and runs a case, and returns its kind of end, for the table at the end, and what
    is wrong with it, or an empty text. `prepare(top)` is called before, with the folder of all cases, and returns a
    reason to stop, or an empty text."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help=f"number of the first {kind}")
    parser.add_argument("--only", type=int, help=f"run only this {kind}")
    parser.add_argument("--keep", help="folder in which inputs and results are kept")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    top = pathlib.Path(options.keep or tempfile.mkdtemp(prefix=f"mpm-{kind}s-"))
    numbers = [options.only] if options.only is not None else range(options.first, options.first + options.count)
    reason = prepare(top)
    if reason:
        print(reason)
        return 1
    ends, failures = {}, []

    def one(number):
        folder = top / f"{number}"
        try:
            return number, *judge(number, options.seed, folder)
        finally:
            if not options.keep:
                shutil.rmtree(folder, ignore_errors=True)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for number, end, wrong in pool.map(one, numbers):
            ends[end] = ends.get(end, 0) + 1
            if wrong:
                failures.append(number)
                print(f"--- {kind} {number} of seed {options.seed}: {wrong}", flush=True)
    if not options.keep:
        shutil.rmtree(top, ignore_errors=True)
    print(", ".join(f"{cases} {end}" for end, cases in sorted(ends.items())))
    if failures:
        print(f"{len(failures)} of {len(numbers)} failed; repeat one with: {pathlib.Path(sys.argv[0]).name} "
              f"--seed {options.seed} --only {failures[0]} --keep FOLDER")
    return 1 if failures else 0


# What a run leaves -------------------------------------------------------------------------------------------------


def arrays_of_piece(path):
    """The arrays of a .vtu file, row by row."""
    data = path.read_bytes()
    start = data.index(b'<AppendedData encoding="raw">')
    at = data.index(b"_", start) + 1
    points = int(re.search(rb'NumberOfPoints="(\d+)"', data[:start]).group(1))
    found = {}
    for match in re.finditer(rb'<DataArray type="(\w+)" Name="(\w+)" NumberOfComponents="(\d+)" format="appended" '
                             rb'offset="(\d+)"/>', data[:start]):
        kind, name, width, offset = match.groups()
        if name in (b"connectivity", b"offsets", b"types"):
            continue
        values = numpy.frombuffer(data, kind.decode().lower(), points * int(width), at + int(offset) + 8)
        found[name.decode()] = values.reshape(points, int(width))
    return found


def picture(index):
    """What the pieces of a .pvtu file hold together, in the order of identities."""
    pieces = [arrays_of_piece(index.parent / name) for name in re.findall(r'<Piece Source="(.*?)"/>', index.read_text())]
    whole = {name: numpy.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}
    order = numpy.argsort(whole["id"][:, 0])
    return {name: values[order].tobytes() for name, values in whole.items()}


def left_by(folder):
    """Everything that a run has left and that another run of the same case must leave, too: name to value."""
    folder = pathlib.Path(folder)
    found = {name: _resume.rows(folder / name) for name in ("case.sta", "case_curv.dat")}
    found["case.h5part"] = _resume.states(folder / "case.h5part")
    found["case.pvd"] = re.findall("<DataSet .*/>", (folder / "case.pvd").read_text())
    for line in found["case.pvd"]:
        index = re.search(' file="(.*?)"', line).group(1)
        found[index] = picture(folder / index)
    facts = json.loads((folder / "case.summary.json").read_text())
    found["case.summary.json"] = {key: value for key, value in facts.items() if key not in TIMES}
    found["case.out"] = re.findall(r"^state .*", (folder / "case.out").read_text(errors="replace"), re.MULTILINE)[-1:]
    return found


def differences(folder, other):
    ours, theirs = left_by(folder), left_by(other)
    return sorted(name for name in ours.keys() | theirs.keys() if ours.get(name) != theirs.get(name))
