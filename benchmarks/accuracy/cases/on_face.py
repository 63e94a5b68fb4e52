"""Particles exactly on the faces, edges and corners of cells."""

import numpy as np

import derive
import methods
from case import Case, Error, Study
from cases import support

SOLID = derive.Solid(1.0, 0.3, 1.0)
RATE = 0.05
EDGE, CORE, END = 20, 4, 1.0


class OnFace(Case):
    name = "on_face"
    title = "Particles on faces, edges and corners"
    about = """A block with one particle to a node, each exactly on a corner of cells, or on an edge, or on a face, in a
homogeneous motion v = a x: its stretch has the same exact value for every shape that reproduces linear fields. Error: root
mean square of the stress error in the core, which no wave has reached, over the stress. Linear functions have two gradients
there: a particle on a face takes that of the cell that it counts to. Two particles per cell and axis, a quarter of a cell
beside the faces, are the reference (*beside*)."""
    errors = {"stress": Error("error of stress", ".1e", order=False), "noise": Error("velocity noise", ".1e", order=False)}
    studies = {name: Study(text, (1,), 0.4, splits=(1,), quick=(1,) if name in ("corner", "beside") else ()) for name, text in (
        ("corner", "particles on the corners of cells."), ("edge", "on the middles of edges."),
        ("face", "on the middles of faces."), ("beside", "in the middles of cells."))}
    plotted = ("corner",)

    def methods(self):
        return methods.every_scheme()

    def scene(self, point):
        on = {"corner": 3, "edge": 2, "face": 1, "beside": 0}[point.study]
        lower = [6 - 0.5 if a < on else 6.0 for a in range(3)]
        middle = [v + EDGE / 2 for v in lower]
        speed = ['{}="{!r}*({}-{!r})"'.format(f"v{a}", RATE, a, m) for a, m in zip("xyz", middle)]
        body = support.block("block", lower, (EDGE,) * 3, 1.0, "solid", f"<InitialVelocity {' '.join(speed)}/>")
        return support.scene([body], support.grid((0, 0, 0), (EDGE + 12,) * 3, "000000", 1), support.solution(END, point.factor),
                             [support.material("solid", SOLID.density, SOLID.law)], support.pictures(END, support.STRESSES))

    def measure(self, point, folder):
        states = support.States(folder)
        first, end = support.places(states, 0), states.times[-1]
        middle = 0.5 * (first.min(axis=0) + first.max(axis=0))
        core = np.abs(first - middle).max(axis=1) <= 0.5 * CORE
        wanted = support.neo_hookean((1 + RATE * end) * np.eye(3)[None], SOLID)
        off = support.stresses(states)[core] - wanted
        noise = (support.velocities(states) - RATE * (first - middle))[core]
        return {"stress": support.rms(off) / wanted[0, 0, 0],
                "noise": support.rms(noise) / (wanted[0, 0, 0] / SOLID.density / SOLID.wave_speed)}


CASE = OnFace()
