"""Nearly incompressible solids, with and without averaged volume changes."""

import sys

from common import results

import scenes
import study
from run_one import Run
from studies import stiff

sys.path.append(str(results.ROOT / "benchmarks/accuracy"))

from cases import incompressible  # noqa: E402: from benchmarks/accuracy

POISSON = 0.4999
SHAPES = ("linear", "uGIMP", "QuadraticBSpline", "CPDI2")


class Locking(study.Study):
    name = "locking"
    title = "Averages against volumetric locking"
    about = f"""Plane strain, neo-Hookean, Poisson's ratio {POISSON}, with `Volumetric averaging` none and cell. *cook*: the membrane of
[accuracy.md](accuracy.md#cooks-membrane-and-a-compressed-block), clamped at one end and bent upwards by a small load in one
load step; error of the displacement of the loaded part; without `CPDI2`, as its particles follow the sloping edges. *block*:
the block of the study above. Errors against finite elements that do not lock. *residuals*: of Newton's method; the tolerance, 1e-7,
is what the round-off of a strain times the bulk modulus, over the small load, leaves room for."""
    labels = ("body", "shape", "averaging", "cells")
    measured = ("error", "residuals")

    def runs(self):
        found = []
        for shape in SHAPES:
            for averaging in ("none", "cell"):
                quick = averaging == "cell" and shape in ("linear", "QuadraticBSpline")
                for n in (8, 16, 32):
                    if shape != "CPDI2":
                        found.append(self.cook(shape, averaging, n, quick and n == 8))
                    found.append(self.block_of(shape, averaging, n, quick and n == 8))
        return found

    @staticmethod
    def solution(averaging):
        return scenes.implicit(1.0, 1.0, more='rtol="1e-7"', children=f'<Volumetric averaging="{averaging}"/>')

    def cook(self, shape, averaging, cells, quick):
        h, width = 1 / cells, incompressible.LOADED
        share = incompressible.LOAD / (width * (16 + 28 * width / 2) / 48)
        grid = scenes.grid(shape, (0, -2 * h, 0), (1 + 2 * h, round((60 / 48 + 4 * h) / h) * h, h), "100022", h)
        body = ('<Body name="solid" material="solid" type="Point"><Geometry file="points.txt"/>'
                f'<BodyForce by="{share!r}*if(X&gt;{1 - width},1,0)"/></Body>')
        text = scenes.scene([body], grid, self.solution(averaging), [scenes.neo_hookean(1.0, POISSON, 1.0)],
                            scenes.pictures(1.0, ("pres",)))

        def measure(result):
            loaded = incompressible.STRIPS["cook"](result.column("x", 0), result.column("y", 0))
            moved = (result.column("y") - result.column("y", 0))[loaded].mean()
            return self.measures(result, moved / (incompressible.LOAD * incompressible.deflection("cook", POISSON)))

        labels = {"body": "cook", "shape": shape, "averaging": averaging, "cells": cells}
        return Run(labels, text, measure, quick, files={"points.txt": incompressible.particles("cook", h, 2)})

    def block_of(self, shape, averaging, cells, quick):
        h = 1 / cells
        body = scenes.block("block", (0, 0, 0), (0.5, h, 1), h / 2)
        platen = scenes.block("platen", (0, 0, 1), (0.5 + h, h, 2 * h), h / 2, "rigid", scenes.moved(vz=-stiff.STRAIN))
        text = scenes.scene([body, platen], scenes.grid(shape, (0, 0, 0), (0.5 + 2 * h, h, 1 + 4 * h), "202210", h),
                            self.solution(averaging), [scenes.neo_hookean(stiff.YOUNG, POISSON, 1.0), scenes.rigid()],
                            scenes.pictures(1.0, ("SigmaZ", "density")))

        def measure(result):
            mine = result.column("z", 0) < 1
            volume = (result.column("density", 0) / result.column("density"))[mine] * (h / 2) ** 3
            force = (volume * result.column("SigmaZ")[mine]).sum() / (0.5 * h) / stiff.STRAIN
            return self.measures(result, force / stiff.block_force(POISSON))

        return Run({"body": "block", "shape": shape, "averaging": averaging, "cells": cells}, text, measure, quick)

    @staticmethod
    def measures(result, ratio):
        return {"error": ratio - 1, "residuals": " ".join(f"{n:.0e}" for n in result.steps[-1].norms)}

    def block(self, rows):
        text = []
        for body, what in (("cook", "error of the displacement, per cent, over the cells along the length"),
                           ("block", "error of the force, per cent, over the cells along the height")):
            mine = study.where(rows, body=body)
            if mine:
                text.append(f"**{body}**: {what}\n\n"
                            + study.convergence(mine, "error", "cells", ("shape", "averaging"), ".3g", 100))
        lines = [[row["body"], row["shape"], row["averaging"], f"{row['newton']:g}", row["residuals"]]
                 for row in study.where(rows, cells=16) if study.done(row)]
        if lines:
            text.append("16 cells\n\n" + study.table(["body", "shape", "averaging", "Newton", "residuals"], lines))
        failed = study.failures(rows)
        return "\n\n".join(text) + (f"\n\nNot done:\n\n{failed}" if failed else "")


STUDY = Locking()
