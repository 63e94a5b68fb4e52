"""A cantilever that a dead load at its end bends far."""

import functools

import numpy as np

import scenes
import study
from run_one import Run

LENGTH, DEPTH, YOUNG, DENSITY = 10.0, 1.0, 12e6, 1000.0
STIFFNESS = YOUNG * DEPTH**3 / 12  # against bending, of a beam of unit width; Poisson's ratio is 0
LOAD = 3 * STIFFNESS / LENGTH**2
LOADED = 0.5  # length of the end over which the load is spread
FREQUENCY = 1.8751**2 * (STIFFNESS / (DENSITY * DEPTH)) ** 0.5 / LENGTH**2  # of the first mode, radians
PERIODS = 1.5  # of an explicit run, in periods of the first mode


def beam(end, loaded, axial, shear, points=4000):
    """Place (x, y) at the arc length `end` of a beam whose axis stretches by axial force/`axial` and shears by shear
    force/`shear` (Reissner, ZAMP 23 (1972) 795; infinite: the elastica), under the dead load -LOAD in y spread over the
    last `loaded`. Integrated from the clamp by midpoints, the moment there by bisection so that the end carries none."""
    s = (np.arange(points) + 0.5) * LENGTH / points
    step = LENGTH / points
    force = -LOAD * np.clip((LENGTH - s) / loaded, 0, 1)  # that the part beyond s carries

    def shoot(moment):
        angle, x, y, path = 0.0, 0.0, 0.0, []
        for f in force:
            middle = angle + 0.5 * step * moment / STIFFNESS
            c, n = np.cos(middle), np.sin(middle)
            stretch, slide = 1 + f * n / axial, f * c / shear
            dx, dy = stretch * c - slide * n, stretch * n + slide * c
            angle += step * (moment - 0.5 * step * dx * f) / STIFFNESS
            moment -= step * dx * f
            x, y = x + step * dx, y + step * dy
            path.append((x, y))
        return moment, path

    low, high = -LOAD * LENGTH, 0.0  # of the moment
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if shoot(middle)[0] < 0 else (low, middle)
    path = np.array(shoot(0.5 * (low + high))[1])
    return np.array([np.interp(end, s + step / 2, path[:, a]) for a in range(2)])


@functools.cache
def elastica():
    return beam(LENGTH, LOADED, np.inf, np.inf)


@functools.cache
def with_shear():
    return beam(LENGTH, LOADED, YOUNG * DEPTH, 5 / 6 * 0.5 * YOUNG * DEPTH)


class Cantilever(study.Study):
    name = "cantilever"
    title = "Cantilever, large rotation"
    labels = ("steps by", "shape", "along a cell", "cells")
    measured = ("tip", "elastica", "angle")

    @property
    def about(self):
        x, y = elastica()
        xs, ys = with_shear()
        apart = 100 * np.hypot(x - xs, y - ys) / np.hypot(LENGTH - x, y)
        return f"""A beam of length {LENGTH:g} and depth {DEPTH:g} in plane strain (E = 12 MPa as in AMPLE's beam, Poisson's
ratio 0), clamped at x = 0 by a fixed face, under the dead load P = 3 EI/L2 in 20 load steps (`BodyForce` on the particles
that began in the last {LOADED:g}). The explicit runs have the transfer
AFLIP and the default artificial viscosity and are damped critically in the first mode (`DynamicRelax`); their load grows in the
first half of {PERIODS:g} of its periods. (With FLIP the beam creeps: four splines over the depth, factors 0.3, 0.45, 0.6 and 0.8:
tip 2.4, 4.6, 14 and 26 % off.) The elastica's end, with the same load, moves to ({x:.4f}, {y:.4f}); with the stretch
and the shear of Reissner's beam to ({xs:.4f}, {ys:.4f}), {apart:.2f} % of the displacement away from that. *tip*: distance
of the end of the axis from that of Reissner's beam, over the beam's displacement; *elastica*: from the elastica's. Cells:
over the depth."""

    def runs(self):
        found = []
        for shape in ("linear", "uGIMP", "QuadraticBSpline", "CubicBSpline", "CPDI2"):
            for cells in (2, 4, 8) if shape in ("uGIMP", "QuadraticBSpline", "CPDI2") else (2, 4):
                found.append(self.one("implicit", shape, 2, cells, shape == "QuadraticBSpline" and cells == 2))
        for shape in ("QuadraticBSpline", "CPDI2"):
            for cells in (2, 4):
                found.append(self.one("implicit", shape, 3, cells, False))
        for shape in ("uGIMP", "QuadraticBSpline"):
            found += [self.one("explicit", shape, 2, cells, shape == "QuadraticBSpline" and cells == 2) for cells in (2, 4, 8)]
        return found

    @staticmethod
    def one(by, shape, split, cells, quick):
        h = DEPTH / cells
        below = np.ceil(0.75 * LENGTH / h) * h
        if by == "implicit":
            end, growth = 1.0, "t"
            solution = scenes.implicit(end, 1 / 20)
        else:
            end = PERIODS * 2 * np.pi / FREQUENCY
            growth = study.smooth_growth(end / 2)
            solution = scenes.explicit(end, damping=2 * FREQUENCY, transfer="AFLIP")
        load = f"-{LOAD / (LOADED * DEPTH * DENSITY)!r}*{growth}*if(X&gt;{LENGTH - LOADED!r},1,0)"
        beam_ = scenes.block("beam", (0, 0, 0), (LENGTH, DEPTH, h), h / split, more=f'<BodyForce by="{load}"/>')
        text = scenes.scene([beam_], scenes.grid(shape, (0, -below, 0), (LENGTH + 2, DEPTH + 1, h), "100022", h),
                            solution, [scenes.neo_hookean(YOUNG, 0.0, DENSITY, viscous=by != "implicit")], scenes.pictures(end))

        def measure(result):
            first = [result.column(a, 0) for a in "xyz"]
            now = [result.column(a) for a in "xyz"]
            if len(now[0]) < len(first[0]):
                return {**dict.fromkeys(Cantilever.measured, float("nan")), "note": f"{len(first[0]) - len(now[0])} particles left the grid"}
            # The end of the axis: linear extrapolation from the two last rows of particles next to the axis.
            dp = h / split

            def row(at):
                near = (np.abs(first[0] - at) < 0.1 * dp) & (np.abs(first[1] - DEPTH / 2) < 0.6 * dp)
                return np.array([now[a][near].mean() - (DEPTH / 2 if a == 1 else 0) for a in range(2)])

            last, before = row(LENGTH - dp / 2), row(LENGTH - 1.5 * dp)
            tip = last + 0.5 * (last - before)
            off = {"tip": with_shear(), "elastica": elastica()}
            moved = np.hypot(LENGTH - with_shear()[0], with_shear()[1])
            return {**{name: np.hypot(*(tip - exact)) / moved for name, exact in off.items()},
                    "angle": np.degrees(np.arctan2(*(last - before)[::-1]))}

        return Run({"steps by": by, "shape": shape, "along a cell": split, "cells": cells}, text, measure, quick)

    def block(self, rows):
        text = [f"*{name}*, per cent\n\n" + study.convergence(rows, name, "cells", ("steps by", "shape", "along a cell"), ".2f", 100)
                for name in ("tip", "elastica")]
        finest = max(study.values(rows, "cells"))
        lines = [[r["steps by"], r["shape"], f"{r['steps']:g}", study.shown(r, "tip", ".2f", 100), f"{r['seconds']:.2g}"]
                 for r in rows if study.done(r) and r["cells"] == finest and r["along a cell"] == 2]
        text.append(f"With {finest:g} cells over the depth\n\n"
                    + study.table(["steps by", "shape", "steps", "tip, %", "seconds"], lines))
        failed = study.failures(rows)
        return "\n\n".join(text) + (f"\n\nNot done:\n\n{failed}" if failed else "")


STUDY = Cantilever()
