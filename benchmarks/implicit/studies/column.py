"""A column that its weight compacts."""

import numpy as np

import scenes
import study
from run_one import Run

HEIGHT, DENSITY, GRAVITY = 50.0, 80.0, 10.0
WEIGHT = DENSITY * GRAVITY * HEIGHT  # stress at the bottom
YOUNG = {"soft": 1e4, "firm": 1e6}
LOAD_STEPS = {"soft": 40, "firm": 10}
FEW = {"soft": (8, 2, 1), "firm": (1,)}  # load steps of implicit runs
PERIODS = {"short": 1.5, "long": 4.0}  # of an explicit run, in periods of the slowest wave


def stretch(young, depth):
    """Of a layer at this depth below the top of the column at rest before loading: a neo-Hookean solid with Poisson's
    ratio 0 in uniaxial strain has the stress mu (F - 1/F)."""
    load = DENSITY * GRAVITY * depth / (0.5 * young)
    return 0.5 * (np.sqrt(load * load + 4) - load)


def place(young, first):
    """Where a particle comes to rest that began at the height `first`."""
    heights = np.linspace(0, HEIGHT, 20001)
    f = stretch(young, HEIGHT - heights)
    steps = 0.5 * (f[1:] + f[:-1]) * np.diff(heights)
    return np.interp(first, heights, np.concatenate([[0], np.cumsum(steps)]))


def period(young):
    return 4 * HEIGHT / (young / DENSITY) ** 0.5


class Column(study.Study):
    name = "column"
    title = "Column under its weight"
    about = f"""AMPLE's column (Coombs and Augarde, Adv. Eng. Softw. 139 (2020) 102748): height {HEIGHT:g}, density
{DENSITY:g}, Poisson's ratio 0, the force per volume grows in load steps to {DENSITY * GRAVITY:g}. *soft*: E = 10 kPa, the
top sinks by 68 % of the height; *firm*: E = 1 MPa, as on AMPLE's page, by 2 %. Neo-Hookean, one cell wide between symmetry
planes, eight particles per cell. Exact: the stress in a layer is the weight above it. *stress*: the sum over the particles
of |sigma - exact| V0, over the weight's stress at the bottom and the body's volume, as AMPLE's; *place*: root mean square
of the error of height, over the column's. *implicit*: with {LOAD_STEPS["soft"]} (soft) or {LOAD_STEPS["firm"]} (firm)
load steps; *implicit n*: with n. In a single step the particles have not left their places in the cells, where they began: there
is no error of quadrature, and splines converge with second order. The explicit runs are damped near
critically (`DynamicRelax`), their load grows in the first half of {' or '.join(f'{v:g}' for v in PERIODS.values())} periods
of the slowest wave.

AMPLE's page (https://wmcoombs.github.io/tests) reports an order of about 1 for GIMP on the firm column, and no convergence
for linear functions."""
    labels = ("body", "steps by", "shape", "cells")
    measured = ("stress", "place")

    def runs(self):
        found = []
        for body in YOUNG:
            for shape in scenes.SHAPES:
                for cells in (16, 32, 64, 128):
                    quick = body == "firm" and shape in ("linear", "uGIMP", "QuadraticBSpline") and cells <= 32
                    found.append(self.one(body, "implicit", shape, cells, quick))
            for shape in ("uGIMP", "QuadraticBSpline", "CPDI2"):
                for cells in (16, 32, 64, 128):
                    for length in PERIODS:
                        found.append(self.one(body, f"explicit {length}", shape, cells,
                                              body == "firm" and length == "short" and cells <= 32))
        for body in YOUNG:
            for shape in ("uGIMP", "QuadraticBSpline", "CPDI2"):
                for steps in FEW[body]:
                    found += [self.one(body, f"implicit {steps}", shape, cells, False) for cells in (16, 32, 64, 128, 256)]
            found += [self.one(body, f"explicit {length}", "CPDI2", 256, False) for length in PERIODS]
        return found

    @staticmethod
    def one(body, by, shape, cells, quick):
        young, h = YOUNG[body], HEIGHT / cells
        if "implicit" in by:
            end, load = 1.0, f"-{GRAVITY}*t"
            steps = LOAD_STEPS[body] if by == "implicit" else int(by.split()[1])
            solution = scenes.implicit(end, end / steps)
        else:
            end = PERIODS[by.split()[1]] * period(young)
            load = f"-{GRAVITY}*{study.smooth_growth(end / 2)}"
            solution = scenes.explicit(end, damping=4 * np.pi / period(young))
        column = scenes.block("column", (0, 0, 0), (h, h, HEIGHT), h / 2, more=f'<BodyForce bz="{load}"/>')
        text = scenes.scene([column], scenes.grid(shape, (0, 0, 0), (h, h, HEIGHT), "222220", h), solution,
                            [scenes.neo_hookean(young, 0.0, DENSITY)], scenes.pictures(end))

        def measure(result):
            first = result.column("z", 0)
            off = result.column("SigmaZ") + DENSITY * GRAVITY * (HEIGHT - first)
            moved = result.column("z") - place(young, first)
            return {"stress": np.abs(off).mean() / WEIGHT, "place": np.sqrt((moved**2).mean()) / HEIGHT}

        return Run({"body": body, "steps by": by, "shape": shape, "cells": cells}, text, measure, quick)

    def block(self, rows):
        text = []
        for body in study.values(rows, "body"):
            mine = study.where(rows, body=body)
            for name in self.measured:
                text.append(f"**{body}**: error of {name} over the cells along the height\n\n"
                            + study.convergence(mine, name, "cells", ("steps by", "shape")))
            text.append(study.against_explicit(mine, self.measured))
        return "\n\n".join(t for t in text if t)


STUDY = Column()
