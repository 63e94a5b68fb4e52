"""A plate that an explosive has driven off and that flies: how much the pressure of particles scatters inside a cell."""

import functools

import numpy as np

import methods
from case import Case, Error, Study  # first: it says where the next ones are

import _blast
import _cases
from cases import rest, support

CHARGE, PLATE = 50.0, 9.0
LATE = 3  # of the last pictures
PICTURES = 12
FINE = {"fine": (75, 100), "fine_methods": tuple(methods.leading())}  # the plate of 9 mm is whole particles thick with multiples of 25


@functools.cache
def sandwich():
    return _blast.Sandwich(CHARGE * _blast.TNT["density"] / (PLATE * _cases.COPPER["density"]), thickness=CHARGE)


@functools.cache
def velocity():
    """Of the plate at the end, by zones that move with the matter."""
    return sandwich().lagrange()


def mean_pressure(reached):
    """Of the plate over the run, by its momentum: half of what drives it, since its rear face is free."""
    return 0.5 * _cases.COPPER["density"] * PLATE * reached / sandwich().end


class FlyingPlate(Case):
    name = "flying_plate"
    title = "Pressure in a flying plate"
    about = f"""{CHARGE:g} mm of TNT lit at their free face drive a copper plate (`Null`) of {PLATE:g} mm off, the sandwich of
[validation.md](validation.md#plate-driven-by-an-explosive), here in a column of one cell with eight particles in a cell. At the end the gas has
expanded, and the plate flies through more than ten times its thickness with next to no pressure. The scatter is the standard deviation of the
particles' pressure inside a cell, in the mean of the last {LATE} of {PICTURES} pictures, over the plate's mean pressure in the run, which follows
from its momentum (0.6 GPa). *Velocity*: of the plate, against zones that move with the matter. *averaged*, *relaxed*: as in
[Pressure at rest](#pressure-at-rest)."""
    errors = {"scatter": Error("pressure inside a cell, % of the mean", ".1f", 100, order=False),
              "velocity": Error("velocity, %", "+.1f", 100, order=False), "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"plate": Study("cells along the explosive, factor 0.5.", (25, 50), 0.5, **FINE),
               "plate_averaged": Study("the same, averaged.", (25, 50), 0.5, **FINE),
               "plate_relaxed": Study("averaged and relaxed.", (25, 50), 0.5, **FINE),
               "plate_relaxed_1": Study('with `relaxation="1"`.', (25, 50), 0.5, **FINE)}

    def methods(self):
        return rest.CASE.methods()

    def scene(self, point):
        h, end = CHARGE / point.cells, sandwich().end
        bodies = [support.block("TNT", (0, 0, 0), (CHARGE, h, h), h / point.split, "TNT"),
                  support.block("plate", (CHARGE, 0, 0), (PLATE, h, h), h / point.split, "copper")]
        averages = support.averages(point, 1 if point.study.endswith("1") else rest.RELAXATION)
        left, right = (h * np.ceil(share * _blast.TNT["D"] * end / h) for share in (2, 0.5))
        text = support.scene(bodies, _blast.column(float(-left), float(CHARGE + PLATE + right), h, "00"),
                             support.solution(end, point.factor, averages),
                             [_blast.explosive(), _cases.copper('type="Null"')], support.pictures(end / PICTURES, ["pres"]))
        return text.replace("</PeneBlast>", _blast.lit_at(0.0) + "</PeneBlast>")

    def measure(self, point, folder):
        states, h = _cases.States(folder), CHARGE / point.cells
        ours = states.column("x", 0) > CHARGE
        scatter = []
        for which in range(len(states.times) - LATE, len(states.times)):
            x, p = (states.column(name, which)[ours] for name in ("x", "pres"))
            scatter.append(support.rms(support.off_mean_of_cell(p, np.floor(x / h).astype(int))[0][:, None]))
        reached = support.summary(folder)["bodies"][1]["velocity"][0]
        return {"scatter": np.mean(scatter) / mean_pressure(reached), "velocity": reached / velocity() - 1,
                "drift": support.drift(folder)}


CASE = FlyingPlate()
