"""A block that a platen compresses slowly to half its height."""

import numpy as np

import scenes
import study
from run_one import Run

YOUNG, POISSON, DENSITY = 1000.0, 0.3, 1.0
HEIGHT, SHARE = 1.0, 0.5
SHEAR = YOUNG / (2 * (1 + POISSON))
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
WAVE = ((LAME + 2 * SHEAR) / DENSITY) ** 0.5
STRESS = SHEAR * (SHARE - 1 / SHARE) + LAME * np.log(SHARE) / SHARE
EXPLICIT_SPEEDS = (0.03, 0.003)  # of the platen, over that of waves
PERIOD = 2 * HEIGHT / WAVE  # of the slowest wave between fixed ends
RELAXED = {"relaxed short": 1.5, "relaxed long": 4.0}  # whole time, in periods; studies/relaxation.py
FEW = (3, 1)  # steps of implicit runs
LAYERS = 1 / 8  # of the height, next to the platen, that `below` leaves out


class Platen(study.Study):
    name = "platen"
    title = "Slow compression by a platen"
    about = f"""A neo-Hookean block (E = {YOUNG:g}, Poisson's ratio {POISSON:g}, density {DENSITY:g}, height {HEIGHT:g})
between symmetry planes, two by two cells wide, is compressed to half its height by a rigid body with `PrescribedVelocity`.
Exact: uniform strain, the vertical stress is {STRESS:.1f}. *stress*: root mean square of the error of the vertical stress
over its exact value; *below*: without the particles that began in the upper eighth; *place*: root mean square of the error
of height over the height. *implicit*: a step moves the platen by half a cell, so that its face is inside cells in
every second step; *implicit n*: n steps; the block sticks to it. *contact n*: n steps, the platen is in contact without friction. In the explicit
runs it is in contact, and moves at the stated part of the speed of waves, {WAVE:.1f}; the slower it is, the smaller the forces of
inertia, and the longer the run. Dynamic relaxation is shorter: the study below."""
    labels = ("steps by", "shape", "cells")
    measured = ("stress", "below", "place")

    def runs(self):
        found = []
        for shape in scenes.SHAPES:
            for cells in (8, 16, 32, 64):
                found.append(self.one("implicit", shape, cells,
                                      shape in ("linear", "QuadraticBSpline") and cells <= 16))
        for shape in scenes.SHAPES[1:]:
            for steps in FEW:
                for cells in (8, 16, 32, 64):
                    found.append(self.one(f"implicit {steps}", shape, cells, shape == "QuadraticBSpline" and cells <= 16))
        for steps in FEW:
            for cells in (8, 16, 32, 64):
                found.append(self.one(f"implicit contact {steps}", "QuadraticBSpline", cells, cells <= 16))
        for shape in ("uGIMP", "QuadraticBSpline"):
            for by in map("{:g}".format, EXPLICIT_SPEEDS):
                for cells in (8, 16, 32, 64):
                    found.append(self.one(f"explicit {by}", shape, cells, cells <= 16 and by == f"{EXPLICIT_SPEEDS[0]:g}"))
        return found

    @staticmethod
    def one(by, shape, cells, quick):
        h, (kind, _, how) = HEIGHT / cells, by.partition(" ")
        way = (1 - SHARE) * HEIGHT
        if kind == "implicit":
            end = way
            solution = scenes.implicit(end, end / (int(how.split()[-1]) if how else cells))
            velocity = -1.0
        elif how in RELAXED:
            end = RELAXED[how] * PERIOD
            solution = scenes.explicit(end, damping=4 * np.pi / PERIOD)
            velocity = f"-{way!r}*{study.smooth_speed(end / 2)}"
        else:
            end = way / (float(how) * WAVE)
            solution = scenes.explicit(end)
            velocity = -float(how) * WAVE
        text = scenes.pressed_block(shape, h, HEIGHT, velocity, kind == "explicit" or "contact" in how, solution,
                                    [scenes.neo_hookean(YOUNG, POISSON, DENSITY), scenes.rigid()],
                                    scenes.pictures(end, ("SigmaZ", "body")))

        def measure(result):
            mine = result.column("z", 0) < HEIGHT
            first, now, stress = (v[mine] for v in (result.column("z", 0), result.column("z"), result.column("SigmaZ")))
            off, low = stress / STRESS - 1, first < (1 - LAYERS) * HEIGHT
            return {"stress": np.sqrt((off**2).mean()), "below": np.sqrt((off[low]**2).mean()),
                    "place": np.sqrt(((now - SHARE * first)**2).mean()) / HEIGHT}

        return Run({"steps by": by, "shape": shape, "cells": cells}, text, measure, quick)

    def block(self, rows):
        text = [f"Error of {name} over the cells along the height\n\n"
                + study.convergence(rows, name, "cells", ("steps by", "shape")) for name in self.measured]
        text.append(study.against_explicit(rows, self.measured))
        return "\n\n".join(text)


STUDY = Platen()
