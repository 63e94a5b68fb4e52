"""A plane shock in copper: the jump conditions."""

import methods
from case import Case, Error, Study
from cases import support

import _cases

LENGTH = 100.0


class PlaneShock(Case):
    name = "plane_shock"
    title = "Plane shock in copper"
    about = """A copper bar (`Null`, Mie-Grueneisen about a linear Hugoniot) in uniaxial strain hits a wall at 1000 m/s; the
set-up is that of [validation.md](validation.md), with two particles along a cell. Error: of the plateau's energy, from the
jump conditions. *Ripple*: scatter of the pressure on the plateau, over the pressure; *overshoot*: of the stress at the
front."""
    errors = {"energy": Error("error of energy, %", ".2f", 100, order=False), "pressure": Error("error of pressure, %", ".2f", 100, order=False),
              "speed": Error("error of shock speed, %", ".2f", 100, order=False), "ripple": Error("ripple, %", ".2f", 100, order=False),
              "overshoot": Error("overshoot, %", ".1f", 100, order=False), "width": Error("front, cells", ".1f", order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"cells": Study("cells along the bar, factor 0.4.", (50, 100, 200, 400), 0.4)}

    def methods(self):
        return methods.short()

    @staticmethod
    def shock(point):
        return _cases.Shock(1000.0, cell=LENGTH / point.cells, length=LENGTH, split=point.split, factor=point.factor)

    def scene(self, point):
        return self.shock(point).text()

    def measure(self, point, folder):
        found = self.shock(point).measure(folder)
        error = found["error"]
        return {"energy": abs(error["e"]), "pressure": abs(error["p"]), "speed": abs(error["Us"]), "ripple": found["ripple"],
                "overshoot": found["overshoot"], "width": found["width"], "drift": support.drift(folder)}


CASE = PlaneShock()
