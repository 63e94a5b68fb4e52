"""Stiff inclusions, and solids that change their volume hardly."""

import functools
import sys

import numpy as np
from common import results

import scenes
import study
from run_one import Run

sys.path.append(str(results.ROOT / "benchmarks/accuracy"))

import plane_strain  # noqa: E402: from benchmarks/accuracy

STRAIN, YOUNG = 1e-3, 1.0
RATIOS = (1.0, 1e3, 1e6)
POISSONS = (0.3, 0.45, 0.499)
QUICK = ("laminate", "implicit", "QuadraticBSpline", 8)
COMPARED = ("linear", "QuadraticBSpline")  # shapes of explicit runs
EXPLICIT = (6.9, 7.0)  # their time and damping
MOST = {("laminate", 1e6): 16, ("inclusion", 1e6): 4}  # their cells, where more take too long


def moduli(poisson):
    return YOUNG / (2 * (1 + poisson)), YOUNG * poisson / ((1 + poisson) * (1 - 2 * poisson))


def wave(poisson):
    shear, lame = moduli(poisson)
    return (lame + 2 * shear) ** 0.5


def explicit_steps(ratio, cells):
    return EXPLICIT[0] * ratio**0.5 * wave(0.3) * cells / scenes.FACTOR


@functools.cache
def block_force(poisson, elements=12):
    """Force over the whole top of a unit square in plane strain between rough faces, over STRAIN; half of it is meshed."""
    mesh = plane_strain.Mesh(lambda s, t: (0.5 * s, t), elements, elements)
    shear, lame = moduli(poisson)
    held = np.column_stack([(mesh.s == 0) | (mesh.t == 0) | (mesh.t == 1), (mesh.t == 0) | (mesh.t == 1)])
    given = np.column_stack([0 * mesh.t, -1.0 * (mesh.t == 1)])
    moved = mesh.solve(shear, lame + 2 / 3 * shear, np.zeros_like(given), held, given)
    forces = (mesh.stiffness(shear, lame + 2 / 3 * shear) @ moved.ravel()).reshape(-1, 2)
    return 2 * forces[mesh.t == 1, 1].sum()


def laminate_stress(ratio):
    """Vertical stress over STRAIN of a unit height, of which the middle half is stiffer, in uniaxial strain; Poisson's
    ratio 0.3."""
    shear, lame = moduli(0.3)
    return -(lame + 2 * shear) / (0.5 + 0.5 / ratio)


def compressed(shape, bodies, faces, size, h, materials, explicit=None, more="", children=""):
    """The input of a unit body below a rough platen, and what measures, of a Result, the force over STRAIN and the area.
    `explicit`: time and damping of an explicit run."""
    side = h if faces[1] == "0" else 0.0
    grid = scenes.grid(shape, (0, 0, 0), (size[0] + 2 * side, size[1], 1 + 4 * h), faces, h)
    end, damping = explicit or (1.0, None)
    velocity = f"-{STRAIN!r}*{study.smooth_speed(end / 2)}" if explicit else -STRAIN
    platen = scenes.block("platen", (0, 0, 1), (size[0] + side, size[1], 2 * h), h / 2, "rigid", scenes.moved(vz=velocity))
    parts = [*materials, scenes.rigid()], scenes.pictures(end, ("SigmaZ", "density"))
    if explicit:
        rough = "".join(f'<Coefficient rough="1" mat1="{name}" mat2="rigid"/>' for name in ("solid", "stiff")[:len(materials)])
        text = scenes.two_components(bodies, [platen], grid, scenes.explicit(end, damping=damping, more=children), *parts,
                                     f'<Contact enable="1" distance_type="2" min_distance="0.1"/><Friction>{rough}</Friction>')
    else:
        text = scenes.scene([*bodies, platen], grid, scenes.implicit(end, end, more=more, children=children), *parts)

    def force(result):
        mine = result.column("z", 0) < 1
        volume = (result.column("density", 0) / result.column("density"))[mine] * (h / 2) ** 3
        return (volume * result.column("SigmaZ")[mine]).sum() / (size[0] * size[1]) / STRAIN

    return text, force


class Stiff(study.Study):
    name = "stiff"
    title = "Stiff inclusions and nearly incompressible solids"
    about = f"""Unit bodies that a rough platen compresses by {STRAIN:g} in one load step, from a fixed face; neo-Hookean.
The force is the mean over the height of the vertical stress, which equilibrium makes the same at every height. *laminate*:
a column between symmetry planes, whose middle half is stiffer by the ratio; exact, but for the strain squared: stresses in series. *inclusion*: a cube
between symmetry planes, with a stiffer cube of half its edge inside; force over that at ratio 1; at 1e6 the inclusion must
be rigid, so that 1e3 and 1e6 are nearly the same. Functions that reach beyond the interface (splines, SGMP) stiffen about
half a cell of the matrix on each side. The round-off of a strain, 1e-16, times the modulus bounds the residual: at 1e6 a
tolerance much below the default cannot be met. *block*: plane strain, free sides, Poisson's ratio to 0.499; error of the
force against finite elements that do not lock (benchmarks/accuracy/plane_strain.py, 12 x 12 of nine nodes); a locking
method is too stiff. In the explicit runs the platen is in rough contact, with gaps measured between faces (without that splines, whose
functions reach beyond the gap, bear more: 32 % instead of 18 % too much, the block at 0.499 with 8 cells). It comes to rest in the first half of {EXPLICIT[0]:g} units
of time, four periods of the slowest wave between fixed ends, and `DynamicRelax` damps with {EXPLICIT[1]:g}, which is nearly
critical for that wave (an angular frequency of 3.65) and for the block's first mode (3.3 to 3.5, by finite elements). Twice the time changes
forces with 16 cells by at most 0.15 % (splines) and 0.03 % (`linear`): what is left are errors of contact and of the grid, not of inertia.
A ratio of 1e6 makes explicit steps a thousand times shorter. Not run, as they take two minutes or more by the times of 1e3: the laminate with 32
cells ({explicit_steps(1e6, 32):,.0f} steps of `linear`, 2 min; splines as long) and the inclusion with 8 ({explicit_steps(1e6, 8):,.0f} steps; 2 min, splines 7)
and 12 ({explicit_steps(1e6, 12):,.0f}; 11 and 16 min)."""
    labels = ("body", "steps by", "shape", "value", "cells")
    measured = ("force", "error")

    def runs(self):
        found = []
        for by, shapes in (("implicit", scenes.SHAPES), ("explicit", COMPARED)):
            for shape in shapes:
                for ratio in RATIOS:
                    for body, grids in (("laminate", (8, 16, 32)), ("inclusion", (4, 8, 12) if shape in COMPARED else ())):
                        found += [self.inclusion(body, by, shape, ratio, cells, (body, by, shape, cells) == QUICK)
                                  for cells in grids if by == "implicit" or cells <= MOST.get((body, ratio), cells)]
                for poisson in POISSONS:
                    for cells in (8, 16, 32):
                        found.append(self.block_of(by, shape, poisson, cells, by == "implicit" and shape in COMPARED and cells == 8))
        return found

    @staticmethod
    def run(labels, bodies, faces, size, h, materials, exact, quick):
        explicit = EXPLICIT if labels["steps by"] == "explicit" else None
        text, force = compressed(labels["shape"], bodies, faces, size, h, materials, explicit)

        def measure(result):
            found = force(result)
            return {"force": found, **({"error": found / exact - 1} if exact else {})}

        return Run(labels, text, measure, quick)

    def inclusion(self, body, by, shape, ratio, cells, quick=False):
        h = 1 / cells
        if body == "laminate":
            size, inside = (h, h, 1), ((0, 0, 0.25), (h, h, 0.5))
        else:
            size, inside = (1, 1, 1), ((0.25,) * 3, (0.5,) * 3)
        whole = scenes.block("whole", (0, 0, 0), size, h / 2, "solid", attributes='ForBoolBody="1"')
        hole = scenes.block("hole", *inside, h / 2, "solid", attributes='ForBoolBody="1"')
        matrix = ('<Body name="matrix" material="solid" type="Bool" BoolType="subtract" BoolBodyA="whole" BoolBodyB="hole"/>')
        core = scenes.block("core", *inside, h / 2, "stiff")
        materials = [scenes.neo_hookean(YOUNG, 0.3, 1.0), scenes.neo_hookean(ratio * YOUNG, 0.3, 1.0, "stiff")]
        return self.run({"body": body, "steps by": by, "shape": shape, "value": ratio, "cells": cells}, [whole, hole, matrix, core], "222220",
                        size, h, materials, laminate_stress(ratio) if body == "laminate" else None, quick)

    def block_of(self, by, shape, poisson, cells, quick=False):
        h = 1 / cells
        body = scenes.block("block", (0, 0, 0), (0.5, h, 1), h / 2)
        return self.run({"body": "block", "steps by": by, "shape": shape, "value": poisson, "cells": cells}, [body], "202210", (0.5, h, 1), h,
                        [scenes.neo_hookean(YOUNG, poisson, 1.0)], block_force(poisson), quick)

    def block(self, rows):
        text = []
        for body, what in (("laminate", "error of the stress, per cent"), ("block", "error of the force, per cent")):
            mine = study.where(rows, body=body)
            if mine:
                text.append(f"**{body}**: {what}, over the cells along the height\n\n"
                            + study.convergence(mine, "error", "cells", ("steps by", "shape", "value"), ".3g", 100))
                text.append(study.beside(mine, "error", ("shape", "value", "cells"), ".3g", 100))
        mine = study.where(rows, body="inclusion")
        even = {tuple(r[k] for k in ("steps by", "shape", "cells")): r["force"] for r in study.where(mine, value=1.0)}
        for row in filter(study.done, mine):
            row["over"] = row["force"] / even.get((row["steps by"], row["shape"], row["cells"]), float("nan"))
        if mine:
            text.append("**inclusion**: force over that at ratio 1\n\n"
                        + study.beside(mine, "over", ("shape", "value", "cells"), ".4f", alone=True))
        failed = study.failures(rows)
        return "\n\n".join(filter(None, text)) + (f"\n\nNot done:\n\n{failed}" if failed else "")


STUDY = Stiff()
