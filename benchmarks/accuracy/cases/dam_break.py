"""A column of water that collapses, against the experiment of Martin and Moyce."""

import numpy as np

import methods
from case import Case, Error, Study
from cases import support

SIDE, GRAVITY, DENSITY = 0.05715, 9.81, 1000.0  # m (2 1/4 inches), kg
SOUND = 20.0  # ten times the fastest flow; the water's own would only make the steps shorter
FRONT = 0.995  # part of the mass that has not passed the front: drops that fly ahead are not it

# J. C. Martin and W. J. Moyce, An experimental study of the collapse of liquid columns on a rigid horizontal plane,
# Phil. Trans. R. Soc. Lond. A 244 (1952) 312, table 2 (n^2 = 2, a = 2 1/4 inches), as codes for free surfaces quote it:
# T = n t sqrt(g/a), and Z, the place of the front over a.
TIMES = np.array([0.41, 0.84, 1.19, 1.43, 1.63, 1.83, 1.98, 2.20, 2.32, 2.51, 2.65, 2.83, 2.98, 3.11, 3.33])
PLACES = np.array([1.11, 1.22, 1.44, 1.67, 1.89, 2.11, 2.33, 2.56, 2.78, 3.00, 3.22, 3.44, 3.67, 3.89, 4.11])
WATER = support.material(
    "water", DENSITY, 'type="Null" mu="1e-3"',
    f'<EquationOfState type="Polynomial" c0="0" c1="{DENSITY * SOUND**2}" c2="0" c3="0" c4="0" c5="0" c6="0"/>')
UNIT = (SIDE / (2 * GRAVITY)) ** 0.5


class DamBreak(Case):
    name = "dam_break"
    title = "Dam break"
    about = """A column of water, 2 1/4 inches wide and twice as high, between symmetry planes collapses (`Null`, sound speed
20 m/s, viscosity of water): the place of the front against the experiment of J. C. Martin and W. J. Moyce (1952, table 2).
Error: mean relative error of the front's place over the 15 times of the table. The front is where all but 0.5 % of the mass
is behind it. The experiment's gate took time to open, and the real floor holds the water back: all computed fronts are
faster, and the error does not go to zero."""
    errors = {"front": Error("mean error of the front, %", ".1f", 100, order=False),
              "last": Error("front at the end, over a (experiment 4.11)", ".2f", order=False),
              "scatter": Error("pressure noise at half time, % of rho g a", ".1f", 100, order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"cells": Study("cells along the column's width, factor 0.4.", (4, 8, 12, 16), 0.4, fine=(32,),
                              fine_methods=tuple(methods.product(("linear", "SGMP", "QuadraticBSpline")))),
               "particles": Study("four particles along a cell.", (4, 8, 12), 0.4, splits=(4,), methods=methods.leading),
               "averaged": Study('with `Volumetric averaging="cell"`.', (4, 8, 12, 16), 0.4, methods=methods.leading),
               "time": Study("12 cells, time step falling.", (12,), (0.9, 0.4, 0.2), axis="factor", methods=methods.leading)}
    plotted = ("cells",)

    def methods(self):
        return methods.short()

    def scene(self, point):
        h = SIDE / point.cells
        water = support.block("water", (0, 0, 0), (SIDE, h, 2 * SIDE), h / point.split, "water")
        more = f'<Gravity ax="0" ay="0" az="-{GRAVITY}"/>' + support.averages(point)
        return support.scene([water], support.grid((0, 0, 0), (8 * SIDE, h, 3 * SIDE), "202220", h),
                             support.solution(TIMES[-1] * UNIT, point.factor, more),
                             [WATER],
                             support.pictures(float(TIMES[-1] * UNIT / 90), ["pres"]))

    def measure(self, point, folder):
        states = support.States(folder)
        fronts = [np.quantile(states.column("x", which), FRONT) for which in range(len(states.times))]
        found = np.interp(TIMES * UNIT, states.times, fronts) / SIDE
        return {"front": float(np.abs(found / PLACES - 1).mean()), "last": found[-1],
                "scatter": self.scatter(states, SIDE / point.cells), "drift": support.drift(folder)}

    @staticmethod
    def scatter(states, h):
        """Standard deviation of the pressure inside a cell, over the cells with four particles or more."""
        half = len(states.times) // 2
        cell = np.floor(support.places(states, half)[:, [0, 2]] / h).astype(int) @ [1, 100000]
        off, count = support.off_mean_of_cell(states.column("pres", half), cell)
        return support.rms(off[count >= 4, None]) / (DENSITY * GRAVITY * SIDE)


CASE = DamBreak()
