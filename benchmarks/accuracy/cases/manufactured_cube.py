"""A unit cube that a body force drives through an axis-aligned motion."""

import numpy as np
import sympy as sp

import derive
import methods
from case import Case, Error, Study
from cases import support
from derive import T, X, Y, Z

AMPLITUDES = {"cube": (sp.Rational(1, 10), sp.Rational(2, 25), -sp.Rational(1, 10)),
              "slab": (sp.Rational(1, 10), -sp.Rational(2, 25), sp.Integer(0)),
              "mild slab": (sp.Rational(1, 50), -sp.Rational(2, 125), sp.Integer(0))}
END, PICTURES, HALF = 1.0, 4, 2  # the picture of number HALF is where the stress is measured
SOLID = derive.Solid(1.0, 0.3, 1.0)
GROWTH = sp.Rational(13, 5) * T * (1 - T**2)  # 0 at 0 and 1, about 1 at 0.58; no acceleration at 0


def displacements(kind):
    return [size * sp.sin(sp.pi * at) * GROWTH for size, at in zip(AMPLITUDES[kind], (X, Y, Z))]


def growth(time):
    return 2.6 * time * (1 - time**2)


def displacement(kind, first, time):
    return np.array(AMPLITUDES[kind], float) * np.sin(np.pi * first) * growth(time)


def stretches(kind, first, time):
    return 1 + np.pi * np.array(AMPLITUDES[kind], float) * np.cos(np.pi * first) * growth(time)


def kind_of(point):
    return point.study.split(",")[0]


class ManufacturedCube(Case):
    name = "manufactured_cube"
    title = "Manufactured motion of the unit cube"
    about = """A neo-Hookean cube (E = 1, Poisson's ratio 0.3, density 1) between symmetry planes moves by u_i = A_i sin(pi
X_i) 2.6 t (1 - t^2), A = (0.1, 0.08, -0.1), to t = 1: stretches of 0.69 to 1.31, and particles that cross cells, more than
three of them with 32 cells. The *slab* is one cell thick, with A = (0.1, -0.08, 0), the *mild slab* with a fifth of it. The
body force is derived with SymPy ([derive.py](../benchmarks/accuracy/derive.py)) and stands in the input file as an
expression. Error: the largest over four times of the root mean square over the particles of the displacement's error, over
the largest A. *Stress*: the same of the Cauchy stress at t = 0.5, over its largest value. The program evaluates the
expressions twice in a step of MUSL, which takes most of the loop's time here: look at other cases for what separates the
methods in time."""
    errors = {"displacement": Error("error of displacement"), "stress": Error("error of stress"),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {
        "cube, steps as cells": Study("time step proportional to the cells (factor 0.4), as a user would refine.", (4, 8, 12, 16), 0.4,
                                      fine=(32,), fine_methods=tuple(methods.product(("cpGIMP", "QuadraticBSpline")))),
        "slab, fine steps": Study("time step proportional to the square of the cells (factor 3.2/cells), so that the error in time, of "
                                  "first order, does not hide the order in space.", (4, 8, 16, 32), lambda n: 3.2 / n, quick=(4, 8, 16),
                                  methods=lambda: [*methods.flip(), *methods.every_transfer(("QuadraticBSpline", "CubicBSpline"))]),
        "slab, four particles": Study("the same with four particles along a cell.", (4, 8, 12, 16), lambda n: 3.2 / n, splits=(4,),
                                      methods=lambda: [*methods.flip(), *methods.product(("QuadraticBSpline",), ("APIC", "TPIC"))],
                                      fine=(32,), fine_methods=(*methods.product(("QuadraticBSpline", "CubicBSpline")),
                                                                *methods.product(("QuadraticBSpline",), ("APIC", "TPIC")))),
        "slab, six particles": Study("the same with six.", (4, 8, 16, 32), lambda n: 3.2 / n, splits=(6,),
                                     methods=lambda: methods.product(("QuadraticBSpline",), ("FLIP", "APIC"))),
        "mild slab, fine steps": Study("a fifth of the motion, stretches of 0.94 to 1.06: where crossing disturbs less.", (4, 8, 16, 32),
                                       lambda n: 3.2 / n, methods=lambda: [*methods.flip(), *methods.product(("QuadraticBSpline",
                                                                                                  "CubicBSpline"), ("APIC",))]),
        "slab, time": Study("16 cells, time step falling.", (16,), (0.8, 0.4, 0.2, 0.1, 0.05), axis="factor",
                            methods=lambda: methods.product(("QuadraticBSpline", "CubicBSpline"), some_schemes=methods.schemes())),
        "slab, six particles, time": Study("the same with 16 cells, with half the step.", (16,), (0.2, 0.1), splits=(6,), axis="factor",
                                           methods=lambda: methods.product(("QuadraticBSpline",), ("FLIP", "APIC"))),
    }

    def methods(self):
        return methods.short()

    def scene(self, point):
        h = 1 / point.cells
        moved = displacements(kind_of(point))
        force = derive.along_axes(moved, SOLID)
        start = [sp.diff(u, T).subs(T, 0) for u in moved]
        loads = '<InitialVelocity vx="{}" vy="{}" vz="{}"/>'.format(*map(derive.written, start))
        loads += '<BodyForce bx="{}" by="{}" bz="{}"/>'.format(*map(derive.written, force))
        size = (1, 1, h if kind_of(point).endswith("slab") else 1)
        return support.scene([support.block("cube", (0, 0, 0), size, h / point.split, "solid", loads)],
                             support.grid((0, 0, 0), size, "222222", h), support.solution(END, point.factor),
                             [support.material("solid", SOLID.density, SOLID.law)],
                             support.pictures(END / PICTURES, support.STRESSES))

    def measure(self, point, folder):
        states, kind = support.States(folder), kind_of(point)
        first = support.places(states, 0)
        worst = 0.0
        for which in range(1, len(states.times)):
            moved = support.places(states, which) - first
            worst = max(worst, support.rms(moved - displacement(kind, first, states.times[which])))
        f = np.zeros((len(first), 3, 3))
        f[:, range(3), range(3)] = stretches(kind, first, states.times[HALF])
        exact = support.neo_hookean(f, SOLID)
        stress = support.rms(support.stresses(states, HALF) - exact) / np.abs(exact).max()
        return {"displacement": worst / float(max(AMPLITUDES[kind])), "stress": stress, "drift": support.drift(folder)}


CASE = ManufacturedCube()
