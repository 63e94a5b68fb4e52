"""A cantilever that a dead load at its end bends far."""

import functools

import numpy as np

import scenes
import study
from run_one import Run

LENGTHS, DEPTH, YOUNG, DENSITY = (10.0, 30.0), 1.0, 12e6, 1000.0
STIFFNESS = YOUNG * DEPTH**3 / 12  # against bending, of a beam of unit width; Poisson's ratio is 0
BENDING = 3.0  # load times length squared over that
LOADED = 0.5  # length of the end over which the load is spread
PERIODS = 1.5  # of an explicit run, in periods of the first mode


def load_of(length):
    return BENDING * STIFFNESS / length**2


def frequency(length):
    """Of the first mode, radians."""
    return 1.8751**2 * (STIFFNESS / (DENSITY * DEPTH)) ** 0.5 / length**2


def beam(length, loaded, axial, shear, points=4000):
    """Place (x, y) of the end of a beam whose axis stretches by axial force/`axial` and shears by shear
    force/`shear` (Reissner, ZAMP 23 (1972) 795; infinite: the elastica), under the dead load -load_of(length) in y spread
    over the last `loaded`. Integrated from the clamp by midpoints, the moment there by bisection so that the end carries none."""
    s = (np.arange(points) + 0.5) * length / points
    step = length / points
    force = -load_of(length) * np.clip((length - s) / loaded, 0, 1)  # that the part beyond s carries

    def shoot(moment):
        angle, x, y = 0.0, 0.0, 0.0
        for f in force:
            middle = angle + 0.5 * step * moment / STIFFNESS
            c, n = np.cos(middle), np.sin(middle)
            stretch, slide = 1 + f * n / axial, f * c / shear
            dx, dy = stretch * c - slide * n, stretch * n + slide * c
            angle += step * (moment - 0.5 * step * dx * f) / STIFFNESS
            moment -= step * dx * f
            x, y = x + step * dx, y + step * dy
        return moment, (x, y)

    low, high = -load_of(length) * length, 0.0  # of the moment
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if shoot(middle)[0] < 0 else (low, middle)
    return np.array(shoot(0.5 * (low + high))[1])


@functools.cache
def elastica(length):
    return beam(length, LOADED, np.inf, np.inf)


@functools.cache
def with_shear(length):
    return beam(length, LOADED, YOUNG * DEPTH, 5 / 6 * 0.5 * YOUNG * DEPTH)


class Cantilever(study.Study):
    name = "cantilever"
    title = "Cantilever, large rotation"
    labels = ("length", "steps by", "shape", "along a cell", "cells")
    measured = ("tip", "elastica", "angle")

    @property
    def about(self):
        short, slender = LENGTHS
        apart = {}
        for length in LENGTHS:
            (x, y), (xs, ys) = elastica(length), with_shear(length)
            apart[length] = 100 * np.hypot(x - xs, y - ys) / np.hypot(length - x, y)
        (x, y), (xs, ys) = elastica(short), with_shear(short)
        return f"""Beams of depth {DEPTH:g} in plane strain (E = 12 MPa as in AMPLE's beam, Poisson's
ratio 0), {short:g} and {slender:g} long, clamped at x = 0 by a fixed face, under the dead load P = 3 EI/L2 in 20 load steps (`BodyForce`
on the particles that began in the last {LOADED:g}). The explicit runs have the transfer
AFLIP and the default artificial viscosity and are damped critically in the first mode (`DynamicRelax`); their load grows in the
first half of {PERIODS:g} of its periods. (With FLIP the beam creeps: four splines over the depth, factors 0.3, 0.45, 0.6 and 0.8:
tip 2.4, 4.6, 14 and 26 % off.) With the same load the end of the elastica of length {short:g} moves to ({x:.4f}, {y:.4f}); with the
stretch and the shear of Reissner's beam to ({xs:.4f}, {ys:.4f}), {apart[short]:.2f} % of the displacement away from that, so that a solid cannot
come closer to the elastica. Of the slender beam both are within {apart[slender]:.2f} %: there the elastica is the measure. *elastica*:
distance of the end of the axis from the elastica's, over the beam's displacement; *tip*: from that of Reissner's beam. Cells:
over the depth."""

    def runs(self):
        found, (short, slender) = [], LENGTHS
        splines, finest = "QuadraticBSpline", ("uGIMP", "QuadraticBSpline", "CPDI2")
        for shape in ("linear", "uGIMP", splines, "CubicBSpline", "CPDI2"):
            for cells in (2, 4, 8) if shape in finest else (2, 4):
                found.append(self.one(short, "implicit", shape, 2, cells, shape == splines and cells == 2))
        found += [self.one(short, "implicit", shape, 3, cells) for shape in (splines, "CPDI2") for cells in (2, 4)]
        for shape in ("uGIMP", splines):
            found += [self.one(short, "explicit", shape, 2, cells, shape == splines and cells == 2) for cells in (2, 4, 8)]
        for shape in finest:
            found += [self.one(slender, "implicit", shape, 2, cells, shape == splines and cells <= 4) for cells in (2, 4, 8)]
        found += [self.one(slender, "implicit", shape, 3, cells) for shape in (splines, "CPDI2") for cells in (2, 4)]
        found += [self.one(slender, "explicit", splines, 2, cells) for cells in (2, 4)]
        return found

    @staticmethod
    def one(length, by, shape, split, cells, quick=False):
        h = DEPTH / cells
        below = np.ceil(0.75 * length / h) * h
        if by == "implicit":
            end, growth = 1.0, "t"
            solution = scenes.implicit(end, 1 / 20)
        else:
            end = PERIODS * 2 * np.pi / frequency(length)
            growth = study.smooth_growth(end / 2)
            solution = scenes.explicit(end, damping=2 * frequency(length), transfer="AFLIP")
        load = f"-{load_of(length) / (LOADED * DEPTH * DENSITY)!r}*{growth}*if(X&gt;{length - LOADED!r},1,0)"
        beam_ = scenes.block("beam", (0, 0, 0), (length, DEPTH, h), h / split, more=f'<BodyForce by="{load}"/>')
        text = scenes.scene([beam_], scenes.grid(shape, (0, -below, 0), (length + 2, DEPTH + 1, h), "100022", h),
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

            last, before = row(length - dp / 2), row(length - 1.5 * dp)
            tip = last + 0.5 * (last - before)
            off = {"tip": with_shear(length), "elastica": elastica(length)}
            moved = np.hypot(length - with_shear(length)[0], with_shear(length)[1])
            return {**{name: np.hypot(*(tip - exact)) / moved for name, exact in off.items()},
                    "angle": np.degrees(np.arctan2(*(last - before)[::-1]))}

        return Run({"length": length, "steps by": by, "shape": shape, "along a cell": split, "cells": cells}, text, measure, quick)

    def block(self, rows):
        text = []
        for length in study.values(rows, "length"):
            mine = study.where(rows, length=length)
            text += [f"**Length {length:g}**: *{name}*, per cent\n\n"
                     + study.convergence(mine, name, "cells", ("steps by", "shape", "along a cell"), ".2f", 100)
                     for name in ("elastica", "tip")]
        lines = []
        for row in rows:
            same = study.where(rows, length=row["length"], **{"steps by": row["steps by"]})
            if study.done(row) and row["cells"] == max(study.values(same, "cells")) and row["along a cell"] == 2:
                lines.append([f"{row['length']:g}", row["steps by"], row["shape"], f"{row['cells']:g}", f"{row['steps']:g}",
                              study.shown(row, "elastica", ".2f", 100), study.shown(row, "tip", ".2f", 100), f"{row['seconds']:.2g}"])
        text.append("The finest, two particles along a cell\n\n"
                    + study.table(["length", "steps by", "shape", "cells", "steps", "elastica, %", "tip, %", "seconds"], lines))
        failed = study.failures(rows)
        return "\n\n".join(text) + (f"\n\nNot done:\n\n{failed}" if failed else "")


STUDY = Cantilever()
