"""Two elastic discs that collide and fly apart."""

import derive
import methods
from case import Case, Error, Study
from cases import support

SOLID = derive.Solid(1000.0, 0.3, 1000.0)
RADIUS, SPEED, END, ROOM = 0.2, 0.1, 3.0, 1.0


def published():
    """Those whose rebound or loss J. A. Nairn gives, and the same with the quadratic spline."""
    return [*methods.product(("linear",), some_schemes=methods.schemes()), methods.Method("QuadraticBSpline"),
            *methods.product(("linear", "QuadraticBSpline"), methods.FEW)]


class CollidingDiscs(Case):
    name = "colliding_discs"
    title = "Colliding discs"
    about = """Two elastic discs (E = 1000, Poisson's ratio 0.3, density 1000, radius 0.2; plane strain) with centres at
(0.3, 0.3) and (0.7, 0.7) run into each other at 0.1 (1, 1), after D. Sulsky, Z. Chen and H. L. Schreyer (1994), here with
the law `NeoHookean` and without artificial viscosity. They touch through the shared grid. Error: energy lost at t = 3, over
the first. *Rebound*: the relative velocity of the centres after and before, which converges to the share that is not left in
vibrations."""
    errors = {"loss": Error("energy lost or gained, %", ".2f", 100, order=False), "rebound": Error("rebound", ".3f", order=False)}
    studies = {"cells": Study("cells along the box of length 1, factor 0.5.", (10, 20, 40, 80), 0.5),
               "four particles": Study("the same with four particles along a cell.", (10, 20, 40), 0.5, splits=(4,), methods=published),
               "time": Study("20 cells, time step falling.", (20,), (0.5, 0.2, 0.1), axis="factor", methods=published)}
    plotted = ("cells",)

    def methods(self):
        return [*methods.short(), *methods.product(("linear", "QuadraticBSpline"), methods.FEW)]  # Nairn's order

    def scene(self, point):
        h = ROOM / point.cells
        dp = h / point.split
        discs = "".join(
            f'<Body name="{name}" material="solid" type="Cylinder"><Geometry x0="{at}" y0="{at}" z0="0" dp_bottom="{dp!r}" '
            f'dp_top="{dp!r}" Bottom_Outer_Radius="{RADIUS}" Top_Outer_Radius="{RADIUS}" height="{h!r}"/>'
            f'<InitialVelocity vx="{v}" vy="{v}" vz="0"/></Body>' for name, at, v in (("lower", 0.3, SPEED), ("upper", 0.7, -SPEED)))
        return support.scene([discs], support.grid((0, 0, 0), (ROOM, ROOM, h), "000022", h), support.solution(END, point.factor),
                             [support.material("solid", SOLID.density, SOLID.law)], "")

    def measure(self, point, folder):
        summary = support.summary(folder)
        lower, upper = (body["velocity"][0] for body in summary["bodies"])
        return {"loss": abs(summary["energy"]["relative_drift"]), "rebound": (upper - lower) / (2 * SPEED)}


CASE = CollidingDiscs()
