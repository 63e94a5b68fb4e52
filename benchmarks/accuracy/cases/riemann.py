"""Riemann problems of an ideal gas: Sod's tube, density ratio 10, pressure ratio 1e5."""

import dataclasses

import numpy as np

import methods
from case import Case, Error, Study
from cases import support

import _blast

GAMMA, LENGTH = 1.4, 1.0


@dataclasses.dataclass(frozen=True)
class Tube:
    """States (density, velocity, pressure) on both sides of the middle, and the end of the run."""

    left: tuple
    right: tuple
    end: float
    about: str


TUBES = {
    "sod": Tube((1.0, 0.0, 1.0), (0.125, 0.0, 0.1), 0.2, "(density, pressure) (1, 1) and (0.125, 0.1), to t = 0.2."),
    "ratio 10": Tube((1.0, 0.0, 1.0), (0.1, 0.0, 0.1), 0.2, "(1, 1) and (0.1, 0.1), to t = 0.2: masses of particles differ tenfold at "
                                                            "the contact."),
    "strong": Tube((1.0, 0.0, 1000.0), (1.0, 0.0, 0.01), 0.012, "(1, 1000) and (1, 0.01), to t = 0.012: a pressure ratio of 1e5."),
}


class Riemann(Case):
    name = "riemann"
    title = "Riemann problems"
    about = """An ideal gas (gamma 1.4; `Null` with `Polynomial`, c4 = c5 = 0.4, default viscosity) in a tube of length 1, a
column of one cell between symmetry planes. Error: the mean over the tube of the absolute error of the density (means over
the matter of a first cell), over its largest exact value; the exact solution is Riemann's. *Overshoot*: by how much the
largest velocity of a layer of particles exceeds that between the waves."""
    errors = {"density": Error("L1 error of density, %", ".2f", 100), "overshoot": Error("overshoot of velocity, %", ".1f", 100, order=False),
              "pressure": Error("L1 error of pressure, %", ".2f", 100, order=False),
              "velocity": Error("L1 error of velocity, %", ".2f", 100, order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {
        "sod": Study(TUBES["sod"].about, (50, 100, 200, 400), 0.4, quick=(50, 100, 200)),
        "ratio 10": Study(TUBES["ratio 10"].about, (50, 100, 200, 400), 0.4),
        "strong": Study(TUBES["strong"].about, (50, 100, 200, 400), 0.4),
        "particles": Study("Sod's tube with four particles along a cell.", (50, 100, 200, 400), 0.4, splits=(4,), methods=methods.flip),
    }
    plotted = ("sod", "ratio 10", "strong")

    def methods(self):
        return list(dict.fromkeys([*methods.every_scheme(), *methods.every_transfer(),
                                   *methods.product(("QuadraticBSpline", "CubicBSpline"), ("APIC", "AFLIP"), ("USF", "USL"))]))

    @staticmethod
    def tube(point):
        return TUBES.get(point.study, TUBES["sod"])

    def scene(self, point):
        h, tube, g = LENGTH / point.cells, self.tube(point), GAMMA - 1
        bodies, materials = [], []
        for name, lower, state in (("left", 0.0, tube.left), ("right", 0.5 * LENGTH, tube.right)):
            equation = ('<EquationOfState type="Polynomial" c0="0" c1="0" c2="0" c3="0" '
                        f'c4="{g!r}" c5="{g!r}" c6="0" E0="{state[2] / g!r}"/>')
            materials.append(support.material(name, state[0], 'type="Null"', equation))
            bodies.append(support.block(name, (lower, 0, 0), (0.5 * LENGTH, h, h), h / point.split, name))
        return support.scene(bodies, support.grid((0, 0, 0), (LENGTH, h, h), "222222", h), support.solution(tube.end, point.factor),
                             materials, support.pictures(tube.end, ["pres", "density"]))

    def measure(self, point, folder):
        states, tube = support.States(folder), self.tube(point)
        first, size = states.column("x", 0), LENGTH / point.cells
        layer = np.rint(first / size * point.split - 0.5).astype(int)
        cell = layer // point.split
        found = {}
        for name, column in (("x", "x"), ("rho", "density"), ("v", "velocity_0"), ("p", "pres")):
            values = states.column(column)
            found[name] = np.bincount(cell, values) / np.bincount(cell)
            if name == "v":
                fastest = (np.bincount(layer, values) / np.bincount(layer)).max()
        way = (found["x"] - 0.5 * LENGTH) / states.times[-1]
        exact = _blast.riemann(tube.left, tube.right, GAMMA)(way)
        between = exact["v"].max()
        length = np.abs(np.gradient(found["x"]))
        error = {name: (np.abs(found[name] - exact[name]) * length).sum() / length.sum() / np.abs(exact[name]).max()
                 for name in ("rho", "p", "v")}
        return {"density": error["rho"], "overshoot": fastest / between - 1, "pressure": error["p"], "velocity": error["v"],
                "drift": support.drift(folder)}


CASE = Riemann()
