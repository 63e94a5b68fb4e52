"""An elastic cube that turns a hundred times: angular momentum and energy."""

import numpy as np

import derive
import methods
from case import Case, Error, Study, Unmeasurable
from cases import support

SOLID = derive.Solid(1.0, 0.3, 1.0)
TURNS, HALF, ROOM = {"ten turns": 10, "hundred turns": 100}, 0.5, 3.0
RATE = 0.2 / HALF  # the middles of the faces move at a fifth of the speed of waves in a bar


class SpinningCube(Case):
    name = "spinning_cube"
    title = "Spinning cube"
    about = """A neo-Hookean cube (E = 1, Poisson's ratio 0.3, density 1, edge 1) spins freely about z, its faces at a fifth of sqrt(E/rho),
for ten and for a hundred turns: every particle crosses cells all the time. Error: the angular momentum of the particles' velocities
lost, over the first. Affine transfers hold a part of it, of the order of the cell size squared, in the matrices C, which start at
zero: that part counts as lost here. *Kinetic*: what is left of the kinetic energy; the elastic stretch by the rotation takes a few per
cent of it."""
    errors = {"momentum": Error("angular momentum lost, %", ".2e", 100, order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False),
              "kinetic": Error("kinetic energy left, %", ".1f", 100, order=False)}
    studies = {"ten turns": Study("cells along an edge, factor 0.5.", (3, 4, 6, 8), 0.5),
               "hundred turns": Study("the same.", (2, 3, 4, 5), 0.5)}
    plotted = ("ten turns",)

    def methods(self):
        return methods.short()

    def excluded(self, method):
        return "it damps the rotation within a few turns" if method.transfer == "PIC" else None

    def scene(self, point):
        h = 2 * HALF / point.cells
        cube = support.block("cube", (-HALF,) * 3, (2 * HALF,) * 3, h / point.split, "solid",
                             f'<InitialVelocity vx="{-RATE!r}*y" vy="{RATE!r}*x" vz="0"/>')
        room = h * np.ceil(ROOM / h)
        return support.scene([cube], support.grid((-room,) * 3, (room,) * 3, "000000", h),
                             support.solution(TURNS[point.study] * 2 * np.pi / RATE, point.factor),
                             [support.material("solid", SOLID.density, SOLID.law)], "")

    def measure(self, point, folder):
        summary = support.summary(folder)
        lost = (point.cells * point.split) ** 3 - summary["particles"]
        if lost:
            raise Unmeasurable(f"{lost} particles have left the grid")
        layer = (np.arange(point.cells * point.split) + 0.5) / (point.cells * point.split) - HALF
        inertia = 2 * (layer**2).mean() * SOLID.density
        energy = summary["energy"]
        return {"momentum": abs(summary["angular_momentum"][2] / (inertia * RATE) - 1), "drift": energy["relative_drift"],
                "kinetic": energy["kinetic"] / energy["initial_total"]}


CASE = SpinningCube()
