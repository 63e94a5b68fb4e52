"""A block under its weight, over the number of unknowns: iterations, where the time goes, and memory."""

import re

import scenes
import study
from run_one import Run

# Cells per edge, by shape and ranks.
CELLS = {("linear", 1): (14, 20, 31, 68), ("linear", 2): (14, 20, 31, 68), ("QuadraticBSpline", 1): (12, 28, 46, 66),
         ("QuadraticBSpline", 2): (12, 28, 66)}
QUICK = ("linear", (14, 20))
LOAD = 0.01  # weight per area over Young's modulus
PARTS = {"structure": "structure of the matrix", "residuals": "residuals", "assembly": "Jacobians",
         "set-up": "preconditioner or factors", "solve": "linear systems"}


def spent(log):
    """{part: seconds of Newton's method, mean over the ranks}, from the log's table."""
    return {part: float(re.search(rf"^  {words} +[\d.]+ +([\d.]+)", log, re.MULTILINE).group(1)) for part, words in PARTS.items()}


def measure(result):
    peak = result.summary["peak_memory_bytes"]["sum"]
    return {**spent(result.log), "per unknown": peak / max(s.unknowns for s in result.steps),
            "per particle": peak / result.summary["particles"]}


class Size(study.Study):
    name = "size"
    title = "From 1e4 to 1e6 unknowns"
    about = f"""A neo-Hookean cube on a fixed face, from rest to equilibrium under its weight ({LOAD:g} of Young's modulus per area)
in one load step; 8 particles per cell. Targets: from 1e4 to 1e6 unknowns the linear iterations at most double, on 1 and 2 ranks;
1e6 unknowns in less than 10 minutes. *linear*: iterations of all Newton steps. *structure* to *solve*: shares in
the time of Newton's method, per cent, means over the ranks. *seconds*: of the processor per rank, for the whole load step. Peak memory of all
ranks, in bytes: of small runs mostly that of the libraries."""
    labels = ("shape", "ranks", "cells")
    measured = (*PARTS, "per unknown", "per particle")

    def runs(self):
        return [self.run(shape, ranks, n) for (shape, ranks), cells in CELLS.items() for n in cells]

    @staticmethod
    def run(shape, ranks, cells):
        h = 1 / cells
        # Room for shape functions beside free faces.
        grid = scenes.grid(shape, (-4 * h, -4 * h, 0), (1 + 4 * h, 1 + 4 * h, 1 + 4 * h), "000010", h)
        text = scenes.scene([scenes.block("block", (0, 0, 0), (1, 1, 1), h / 2)], grid,
                            scenes.implicit(1.0, 1.0, children=f'<Gravity ax="0" ay="0" az="{-LOAD}"/>'),
                            [scenes.neo_hookean(1.0, 0.3, 1.0)])
        return Run({"shape": shape, "ranks": ranks, "cells": cells}, text, measure, shape == QUICK[0] and cells in QUICK[1],
                   ranks=ranks)

    def block(self, rows):
        lines = []
        for row in rows:
            line = [row["shape"], f"{row['ranks']:g}"]
            if study.done(row):
                whole = sum(row[part] for part in PARTS)
                line += [*(f"{row[k]:.0f}" for k in ("unknowns", "newton", "linear")),
                         *(f"{100 * row[part] / whole:.0f}" for part in PARTS), f"{row['seconds']:.3g}",
                         *(f"{row[k]:.0f}" for k in ("per unknown", "per particle"))]
            else:
                line += [row["status"], *["–"] * (5 + len(PARTS))]
            lines.append(line)
        text = study.table(["shape", "ranks", "unknowns", "Newton", "linear", *PARTS, "seconds", "per unknown", "per particle"], lines)
        failed = study.failures(rows)
        return text + (f"\n\nNot done:\n\n{failed}" if failed else "")


STUDY = Size()
