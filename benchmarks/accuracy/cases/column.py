"""A column that its weight compacts to half its height."""

import numpy as np

import derive
import methods
from case import Case, Error, Study
from cases import support

SOLID = derive.Solid(1.0, 0.3, 1.0)
HEIGHT, SHARE, DAMPING, RAMP, END = 1.0, 0.5, 3.0, 8.0, 16.0
DEPTHS = np.linspace(0, HEIGHT, 4001)  # of layers, below the top


def stretches(gravity, below):
    """Stretch of layers under the weight of what is above them, by bisection of the law in uniaxial strain."""
    low, high = np.full_like(below, 1e-3), np.ones_like(below)
    for _ in range(60):
        f = 0.5 * (low + high)
        stress = SOLID.shear * (f - 1 / f) + SOLID.lame * np.log(f) / f
        too_soft = stress > -SOLID.density * gravity * below
        low, high = np.where(too_soft, low, f), np.where(too_soft, f, high)
    return 0.5 * (low + high)


def mean(values):
    return (0.5 * (values[1:] + values[:-1])).mean()


def gravity():
    """That under which the column has half its height."""
    low, high = 0.0, 100.0
    for _ in range(60):
        g = 0.5 * (low + high)
        low, high = (g, high) if mean(stretches(g, DEPTHS)) > SHARE else (low, g)
    return g


class Column(Case):
    name = "column"
    title = "Column under its weight"
    about = """A neo-Hookean column (E = 1, Poisson's ratio 0.3, density 1, height 1) between symmetry planes, which its
weight compacts to half its height: gravity grows smoothly to t = 8, damped (`DynamicRelax`), to t = 16, when the column
rests. The exact solution integrates the law in uniaxial strain. Error: root mean square of the particles' place, over the
height; *stress*: of the vertical stress, over its largest value; *velocity*: the largest that is left, over the speed of
waves: what particles that rest ought not to have."""
    errors = {"place": Error("error of place"), "stress": Error("error of stress"),
              "velocity": Error("velocity left", ".1e", order=False)}
    studies = {"cells": Study("cells along the first height, factor 0.4.", (8, 16, 32, 64), 0.4),
               "particles": Study("four particles along a cell.", (8, 16, 32), 0.4, splits=(4,), methods=methods.leading),
               "averaged": Study('with `Volumetric averaging="cell"`.', (8, 16, 32, 64), 0.4, methods=methods.leading),
               "time": Study("32 cells, time step falling.", (32,), (0.9, 0.4, 0.2), axis="factor", methods=methods.leading)}
    plotted = ("cells",)

    def methods(self):
        return methods.short()

    def scene(self, point):
        h = HEIGHT / point.cells
        weight = f'<BodyForce bz="-{gravity()!r}*if(t&lt;{RAMP},(t/{RAMP})^2*(3-2*t/{RAMP}),1)"/>'
        column = support.block("column", (0, 0, 0), (h, h, HEIGHT), h / point.split, "solid", weight)
        more = f'<DynamicRelax damping="{DAMPING}"/>' + support.averages(point)
        return support.scene([column], support.grid((0, 0, 0), (h, h, HEIGHT), "222220", h),
                             support.solution(END, point.factor, more), [support.material("solid", SOLID.density, SOLID.law)],
                             support.pictures(END, ["SigmaZ"]))

    def measure(self, point, folder):
        states, g = support.States(folder), gravity()
        first = states.column("z", 0)
        f = stretches(g, HEIGHT - DEPTHS)  # over the height from the bottom
        place = np.concatenate([[0], np.cumsum(0.5 * (f[1:] + f[:-1]) * np.diff(DEPTHS))])
        off = states.column("z") - np.interp(first, DEPTHS, place)
        weight = SOLID.density * g * (HEIGHT - first)
        return {"place": support.rms(off[:, None]) / HEIGHT,
                "stress": support.rms((states.column("SigmaZ") + weight)[:, None]) / weight.max(),
                "velocity": float(np.abs(states.column("velocity_2")).max()) / SOLID.wave_speed}


CASE = Column()
