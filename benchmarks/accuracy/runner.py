"""Runs one point with mpm_run, on one rank and one thread, and measures it."""

import json
import shutil
import signal
import xml.etree.ElementTree as ElementTree

from common import results, timed_run

import methods
from case import Unmeasurable

LIMIT = 900  # seconds of a run; none takes as long that does not hang
DONE, REFUSED, FAILED = "done", "refused", "failed"
COLUMNS = ("study", "shape", "transfer", "scheme", "cells", "split", "factor", "status", "particles", "steps", "seconds")


def scene_of(case, point):
    root = ElementTree.fromstring(case.scene(point).encode())
    methods.choose(root, point.method)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode")


def loop_seconds(summary, processor, wall):
    """The loop without output, in seconds of the processor: seconds by the clock, less the share of the run in which
    other programs had the processor."""
    spent = summary["wall_seconds"]
    return (spent["loop"] - spent["output"]) * min(1.0, processor / wall)


def run(case, point, out, keep=False):
    """The row of the point: its columns, its errors where it was done, `note` where it was not."""
    folder = out / "runs" / point.key.replace("/", "-")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    file = folder / "case.xmp"
    file.write_text(scene_of(case, point))
    for name, text in case.files(point).items():
        (folder / name).write_text(text)
    code, said, processor, wall = timed_run.execute(file, folder, LIMIT)
    method = point.method
    row = {"study": point.study, "shape": method.shape, "transfer": method.transfer, "scheme": method.scheme,
           "cells": point.cells, "split": point.split, "factor": point.factor, "status": DONE, "particles": "",
           "steps": "", "seconds": "", **dict.fromkeys(case.errors, ""), "note": ""}
    try:
        if code == 0:
            summary = json.loads((folder / "case.summary.json").read_text())
            row.update(particles=summary["particles"], steps=summary["steps"],
                       seconds=loop_seconds(summary, processor, wall))
            row.update({name: float(value) for name, value in case.measure(point, folder).items()})
        elif code in (2, 3):
            row.update(status=REFUSED if code == 2 else FAILED, note=results.reason(said))
        elif code == -signal.SIGKILL:
            row.update(status=FAILED, note=f"killed after {LIMIT} s")
        else:
            raise SystemExit(f"{point.key}: mpm_run ended with exit code {code}\n{said}\nThe input is {file}")
    except Unmeasurable as why:
        row.update(status=FAILED, note=str(why))
    finally:
        if not keep and code in (0, 2, 3):
            shutil.rmtree(folder, ignore_errors=True)
    return row
