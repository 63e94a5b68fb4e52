"""A plane detonation of TNT and the Taylor wave behind it."""

import numpy as np

import methods
from case import Case, Error, Study
from cases import support

import _blast

LENGTH = 100.0
TNT = _blast.TNT


class Detonation(Case):
    name = "detonation"
    title = "Plane detonation"
    about = """TNT (JWL, programmed burn) lit along a wall, 100 mm long, until the front has run through 90 mm: the set-up
and the exact solution, CJ state and Taylor wave, of [validation.md](validation.md), in a column of one cell with the usual
two particles along each axis of a cell. Error: mean over the matter of the pressure's error (means over the layers of a
cell), over the mean exact pressure."""
    errors = {"pressure": Error("L1 error of pressure, %", ".1f", 100), "velocity": Error("L1 error of velocity, %", ".1f", 100, order=False),
              "peak": Error("peak pressure, %", "+.1f", 100, order=False), "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"two particles": Study("two particles along a cell, factor 0.4.", (50, 100, 200, 400), 0.4),
               "four particles": Study("four particles along a cell, factor 0.4.", (25, 50, 100, 200), 0.4, splits=(4,),
                                       methods=lambda: [*methods.flip(), *methods.product(("QuadraticBSpline",), ("APIC", "AFLIP"),
                                                                                          ("MUSL", "USF"))]),
               "averaged": Study('two particles along a cell, with `Volumetric averaging="cell"`.', (50, 100, 200), 0.4,
                                 methods=methods.leading),
               "time": Study("100 cells, time step falling.", (100,), (0.9, 0.4, 0.2), axis="factor", methods=methods.leading)}
    plotted = ("two particles",)

    def methods(self):
        return list(dict.fromkeys([*methods.every_scheme(), *methods.product(("QuadraticBSpline", "CubicBSpline", "cpGIMP"),
                                                                             ("APIC", "AFLIP"), ("MUSL", "USF")),
                                   *methods.every_transfer(("QuadraticBSpline",))]))

    def scene(self, point):
        h = LENGTH / point.cells
        charge = support.block("charge", (0, 0, 0), (LENGTH, h, h), h / point.split, "TNT")
        end = 0.9 * LENGTH / TNT["D"]
        text = support.scene([charge], _blast.column(0, LENGTH + 4 * h, h, "20"),
                             support.solution(end, point.factor, support.averages(point)),
                             [_blast.explosive()], support.pictures(end / 8, ["pres", "density"]))
        return text.replace("</PeneBlast>", _blast.lit_at(0.0) + "</PeneBlast>")

    def measure(self, point, folder):
        states, exact, h = support.States(folder), _blast.Products(), LENGTH / point.cells
        cell = np.floor(states.column("x", 0) / h).astype(int)

        def means(name, which=-1):
            return np.bincount(cell, states.column(name, which)) / np.bincount(cell)

        way, p, u = exact.taylor_wave()
        x, time = means("x"), states.times[-1]
        inside = x < TNT["D"] * time
        exact_p, exact_u = (np.where(inside, np.interp(x / time, way, values), 0) for values in (p, u))
        late = range(3 * len(states.times) // 4, len(states.times))
        peak = np.mean([means("pres", which).max() for which in late])
        return {"pressure": np.abs(means("pres") - exact_p).mean() / np.abs(exact_p).mean(),
                "velocity": np.abs(means("velocity_0") - exact_u).mean() / np.abs(exact_u).mean(),
                "peak": peak / exact.p_cj - 1, "drift": support.drift(folder)}


CASE = Detonation()
