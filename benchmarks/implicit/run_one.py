"""Runs one scene with mpm_run, one thread per rank, and measures it."""

import dataclasses
import functools
import json
import re
import shutil
import signal
import sys

from common import results, timed_run

sys.path.append(str(results.ROOT / "tests/system"))

import _cases  # noqa: E402: from tests/system
import _mpm  # noqa: E402

LIMIT = 600  # seconds of a run; none takes as long that does not hang
DONE, FAILED, REFUSED = "done", "failed", "refused"
COMMON = ("status", "particles", "steps", "unknowns", "newton", "linear", "cuts", "seconds")


@dataclasses.dataclass(frozen=True)
class Run:
    """`labels`: what tells the run from the study's others, {column: value}. `measure`: a function of the Result that
    returns {column: number or text}. `options`: for PETSc, where {folder} is that of the run. `files`: {name: text} beside the scene."""

    labels: dict
    scene: str
    measure: object
    quick: bool = False
    options: tuple = ()
    files: dict = dataclasses.field(default_factory=dict)
    ranks: int = 1

    @property
    def key(self):
        return "-".join(str(v).replace(" ", "_").replace("/", "_") for v in self.labels.values())


@dataclasses.dataclass(frozen=True)
class Step:
    """An implicit step, as the log states it."""

    length: float
    unknowns: int
    norms: tuple  # of the residual of its first solution, from the first guess on
    newton: int  # iterations of all solutions
    linear: int
    cuts: int  # times that it was taken again, shorter


def steps_of(log):
    found = []
    line = (r"^implicit +step \d+: time \S+, length (\S+); (\d+) unknowns; residual ([^;]*); (\d+) linear iterations(.*)$")
    for length, unknowns, norms, linear, more in re.findall(line, log, re.MULTILINE):
        solutions = [tuple(map(float, each.split())) for each in norms.split("|")]
        found.append(Step(float(length), int(unknowns), solutions[0], sum(len(s) - 1 for s in solutions), int(linear),
                          more.count("; shortened")))
    return found


class Result:
    """What a run has left in its folder."""

    def __init__(self, folder):
        self.folder = folder
        self.summary = json.loads((folder / "case.summary.json").read_text())
        self.log = (folder / "case.out").read_text()
        self.steps = steps_of(self.log)

    @functools.cached_property
    def states(self):
        return _cases.States(self.folder)

    def column(self, name, which=-1):
        return self.states.column(name, which)

    @functools.cached_property
    def energies(self):
        """Rows of the .sta file, as arrays by column name."""
        return _cases.status(self.folder)


def run(one, out, keep=False):
    """The row of a run: its labels, what it cost, what was measured, `note` where it was not done."""
    folder = out / "runs" / one.key
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    file = folder / "case.xmp"
    file.write_text(one.scene)
    for name, text in one.files.items():
        (folder / name).write_text(text)
    code, said, processor, wall = timed_run.execute(file, folder, LIMIT, [o.replace("{folder}", str(folder)) for o in one.options],
                                                    one.ranks)
    row = {**one.labels, **dict.fromkeys(COMMON, ""), "status": DONE, "note": ""}
    if code == 0:
        result = Result(folder)
        spent, steps = result.summary["wall_seconds"], result.steps
        # Of the processor: seconds by the clock, less the share in which other programs had the processor.
        seconds = (spent["loop"] - spent["output"]) * min(1.0, processor / one.ranks / wall)
        row.update(particles=result.summary["particles"], steps=result.summary["steps"], seconds=seconds)
        if steps:
            row.update(unknowns=max(s.unknowns for s in steps), newton=sum(s.newton for s in steps),
                       linear=sum(s.linear for s in steps), cuts=sum(s.cuts for s in steps))
        row.update({name: value if isinstance(value, str) else float(value) for name, value in one.measure(result).items()})
    elif code in (2, 3):
        row.update(status=REFUSED if code == 2 else FAILED, note=results.reason(said)[:200])
    elif code == -signal.SIGKILL:
        row.update(status=FAILED, note=f"killed after {LIMIT} s")
    else:
        raise SystemExit(f"{one.key}: mpm_run ended with exit code {code}\n{said}\nThe input is {file}")
    if not keep:
        shutil.rmtree(folder, ignore_errors=True)
    return row
