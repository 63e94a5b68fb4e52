"""Water and sand that have come to rest: how much the pressure of particles scatters inside a cell."""

import numpy as np

import methods
from case import Case, Error, Study, Unmeasurable  # first: it says where the next ones are

import _cases
from cases import support
from cases.dam_break import DENSITY, GRAVITY, SIDE, WATER

SAND = {"density": 1600.0, "side": 0.1}
# As apps/scenes/sand_column.
SAND_LAW = ('type="DruckerPrager" Young="1e6" Poisson="0.3" qfai="0.6009" kfai="0" qpsi="0" ten_f="0" closes="1" '
            'VarSoundspeed="1"')
RELAXATION = 0.5
PRECISION = 1e-7  # of the numbers in pictures
FULL = 4  # particles of a cell that counts
COVERED = 2  # cells above it
FINE = (*methods.flip(), *methods.product(("QuadraticBSpline", "CubicBSpline"), ("APIC",)))


class Rest(Case):
    name = "rest"
    title = "Pressure at rest"
    about = f"""Water: a square of water (that of the dam break) falls apart in a tank twice as wide, slowed down
(`DynamicRelax`), and comes to rest at half its height, its particles in disorder. Sand: the column of
[sand_column](../apps/scenes/sand_column/README.md), which falls apart on a rough floor and comes to rest by friction. The
scatter is the standard deviation of the particles' pressure inside a cell, over the mean pressure; *hydrostatic*: the root
mean square of the deviation from rho g (depth), over its mean. Cells with {FULL} particles or more, {COVERED} cells or more
below the surface, count. *velocity*: root mean square of what is left, over the square root of g times the height. *averaged*: with
`Volumetric averaging="cell"`; *relaxed*: with `relaxation="{RELAXATION}"` besides."""
    errors = {"scatter": Error("pressure inside a cell, % of its mean", ".1f", 100, order=False),
              "hydrostatic": Error("off the hydrostatic pressure, %", ".1f", 100, order=False),
              "velocity": Error("velocity left", ".1e", order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"water": Study("water, cells along the square, factor 0.9.", (6, 8, 16), 0.9, fine=(12,), fine_methods=FINE),
               "water_averaged": Study("the same, averaged.", (6, 8, 16), 0.9, fine=(12,), fine_methods=FINE),
               "water_relaxed": Study("averaged and relaxed.", (6, 8, 16), 0.9, fine=(12,), fine_methods=FINE),
               "sand": Study("sand, cells along the column's foot, factor 0.9.", (8, 10, 20), 0.9, fine=(15,), fine_methods=FINE),
               "sand_averaged": Study("the same, averaged.", (8, 10, 20), 0.9, fine=(15,), fine_methods=FINE),
               "sand_relaxed": Study("averaged and relaxed.", (8, 10, 20), 0.9, fine=(15,), fine_methods=FINE)}

    def methods(self):
        return list(dict.fromkeys([*methods.short(), *methods.product(("CubicBSpline", "uGIMP"), ("APIC", "AFLIP"))]))

    def scene(self, point):
        return (self.water if point.study.startswith("water") else self.sand)(point, support.averages(point, RELAXATION))

    @staticmethod
    def water(point, averaged):
        h = SIDE / point.cells
        body = support.block("water", (0, 0, 0), (SIDE, h, SIDE), h / point.split, "water")
        more = f'<Gravity ax="0" ay="0" az="-{GRAVITY}"/><DynamicRelax damping="25"/>{averaged}'
        return support.scene([body], support.grid((0, 0, 0), (2 * SIDE, h, 1.5 * SIDE), "222222", h),
                             support.solution(1.0, point.factor, more),
                             [WATER],
                             support.pictures(1.0, ["pres"]))

    @staticmethod
    def sand(point, averaged):
        side = SAND["side"]
        h = side / point.cells
        body = support.block("sand", (0, 0, 0), (side, h, side), h / point.split, "sand")
        more = f'<Gravity ax="0" ay="0" az="-{GRAVITY}"/>{averaged}'
        return support.scene([body], support.grid((0, 0, 0), (5 * side, h, side + 3 * h), "202210", h),
                             support.solution(1.0, point.factor, more), [support.material("sand", SAND["density"], SAND_LAW)],
                             support.pictures(1.0, ["pres"]))

    def measure(self, point, folder):
        states = _cases.States(folder)  # a few grains of sand fly out of the grid
        is_water = point.study.startswith("water")
        side = SIDE if is_water else SAND["side"]
        h = side / point.cells
        x, z, p = (states.column(name) for name in ("x", "z", "pres"))
        column, layer = np.floor(x / h).astype(int), np.floor(z / h).astype(int)
        # The surface of a column of cells: what its particles fill.
        depth = np.bincount(column) * (h / point.split) ** 2 / (h * point.split)
        below = layer + 1 + COVERED <= depth[column] / h
        off_mean, count = support.off_mean_of_cell(p, column + 100000 * layer)
        inner = below & (count >= FULL)
        if not inner.any():
            raise Unmeasurable("no cell is deep enough below the surface")
        scatter = support.rms(off_mean[inner, None]) / abs(p[inner].mean())
        found = {"scatter": max(scatter, PRECISION),
                 "velocity": support.rms(support.velocities(states)) / (GRAVITY * side) ** 0.5,
                 "hydrostatic": float("nan"), "drift": support.drift(folder)}
        if is_water:
            hydrostatic = DENSITY * GRAVITY * (SIDE / 2 - z)
            found["hydrostatic"] = support.rms((p - hydrostatic)[inner, None]) / float(hydrostatic[inner].mean())
        return found


CASE = Rest()
