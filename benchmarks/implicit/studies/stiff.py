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


def moduli(poisson):
    return YOUNG / (2 * (1 + poisson)), YOUNG * poisson / ((1 + poisson) * (1 - 2 * poisson))


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
method is too stiff."""
    labels = ("body", "shape", "value", "cells")
    measured = ("force", "error")

    def runs(self):
        found = []
        for shape in ("linear", "QuadraticBSpline", "SGMP", "uGIMP", "CPDI2"):
            for ratio in RATIOS:
                for cells in (8, 16, 32):
                    found.append(self.inclusion("laminate", shape, ratio, cells, cells == 8 and shape == "QuadraticBSpline"))
                for cells in (4, 8, 12):
                    if shape in ("linear", "QuadraticBSpline"):
                        found.append(self.inclusion("inclusion", shape, ratio, cells, False))
            for poisson in POISSONS:
                for cells in (8, 16, 32):
                    found.append(self.block_of(shape, poisson, cells, cells == 8 and shape in ("linear", "QuadraticBSpline")))
        return found

    @staticmethod
    def run(labels, bodies, faces, size, h, materials, exact, quick):
        platen = scenes.block("platen", (0, 0, 1), (size[0] + (h if faces[1] == "0" else 0), size[1], 2 * h), h / 2, "rigid",
                              scenes.moved(vz=-STRAIN))
        upper = (size[0] + (2 * h if faces[1] == "0" else 0), size[1], 1 + 4 * h)
        text = scenes.scene([*bodies, platen], scenes.grid(labels["shape"], (0, 0, 0), upper, faces, h),
                            scenes.implicit(1.0, 1.0), [*materials, scenes.rigid()],
                            scenes.pictures(1.0, ("SigmaZ", "density")))

        def measure(result):
            mine = result.column("z", 0) < 1
            volume = (result.column("density", 0) / result.column("density"))[mine] * (h / 2) ** 3
            force = (volume * result.column("SigmaZ")[mine]).sum() / (size[0] * size[1]) / STRAIN
            return {"force": force, **({"error": force / exact - 1} if exact else {})}

        return Run(labels, text, measure, quick)

    def inclusion(self, body, shape, ratio, cells, quick):
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
        return self.run({"body": body, "shape": shape, "value": ratio, "cells": cells}, [whole, hole, matrix, core], "222220",
                        size, h, materials, laminate_stress(ratio) if body == "laminate" else None, quick)

    def block_of(self, shape, poisson, cells, quick):
        h = 1 / cells
        body = scenes.block("block", (0, 0, 0), (0.5, h, 1), h / 2)
        return self.run({"body": "block", "shape": shape, "value": poisson, "cells": cells}, [body], "202210", (0.5, h, 1), h,
                        [scenes.neo_hookean(YOUNG, poisson, 1.0)], block_force(poisson), quick)

    def block(self, rows):
        text = []
        for body, what in (("laminate", "error of the stress, per cent"), ("block", "error of the force, per cent")):
            mine = study.where(rows, body=body)
            if mine:
                text.append(f"**{body}**: {what}, over the cells along the height\n\n"
                            + study.convergence(mine, "error", "cells", ("shape", "value"), ".3g", 100))
        mine = study.where(rows, body="inclusion")
        lines = []
        for row in mine:
            one = study.where(mine, shape=row["shape"], cells=row["cells"], value=1.0)
            ok = study.done(row) and one and study.done(one[0])
            lines.append([row["shape"], f"{row['cells']:g}", f"{row['value']:g}",
                          f"{row['force'] / one[0]['force']:.4f}" if ok else row["status"],
                          f"{row['newton']:g}" if ok else "–", f"{row['seconds']:.2g}" if ok else "–"])
        if lines:
            heads = ["shape", "cells", "ratio", "force", "Newton iterations", "seconds"]
            text.append("**inclusion**\n\n" + study.table(heads, lines))
        failed = study.failures(rows)
        return "\n\n".join(text) + (f"\n\nNot done:\n\n{failed}" if failed else "")


STUDY = Stiff()
