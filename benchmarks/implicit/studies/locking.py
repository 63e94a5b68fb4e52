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
TOLERANCE = 'rtol="1e-7"'
COOK = (36.0, 1.34)  # time and damping of its explicit runs


def averages(averaging):
    return f'<Volumetric averaging="{averaging}"/>'


class Locking(study.Study):
    name = "locking"
    title = "Averages against volumetric locking"
    about = f"""Plane strain, neo-Hookean, Poisson's ratio {POISSON}, with `Volumetric averaging` none and cell. *cook*: the membrane of
[accuracy.md](accuracy.md#cooks-membrane-and-a-compressed-block), clamped at one end and bent upwards by a small load in one
load step; error of the displacement of the loaded part; without `CPDI2`, as its particles follow the sloping edges. *block*:
the block of the study above. Errors against finite elements that do not lock. *residuals*: of Newton's method; the tolerance, 1e-7,
is what the round-off of a strain times the bulk modulus, over the small load, leaves room for. Explicit runs of the block as above; Cook's load
grows in the first half of {COOK[0]:g} units of time, and {COOK[1]:g} is the critical damping of the first mode (an angular frequency of 0.67, by finite
elements); twice the time changes its error with 8 cells from 3.69 to 3.71 % (`linear`) and from -0.86 to -0.55 % (splines, which creep). Cook's membrane with 32 cells is not run in explicit steps, which would be {COOK[0] * stiff.wave(POISSON) * 32 / scenes.FACTOR:,.0f} (`linear`), eight times as long as with 16."""
    labels = ("body", "steps by", "shape", "averaging", "cells")
    measured = ("error", "residuals")

    def runs(self):
        found = []
        for shape in SHAPES:
            for averaging in ("none", "cell"):
                quick = averaging == "cell" and shape in ("linear", "QuadraticBSpline")
                for n in (8, 16, 32):
                    if shape != "CPDI2":
                        found.append(self.cook("implicit", shape, averaging, n, quick and n == 8))
                    found.append(self.block_of("implicit", shape, averaging, n, quick and n == 8))
        for shape in stiff.COMPARED:
            found += [self.cook("explicit", shape, "cell", n) for n in (8, 16)]
            found += [self.block_of("explicit", shape, "cell", n) for n in (8, 16, 32)]
        return found

    def cook(self, by, shape, averaging, cells, quick=False):
        h, width = 1 / cells, incompressible.LOADED
        share = incompressible.LOAD / (width * (16 + 28 * width / 2) / 48)
        end, growth, solution = 1.0, "1", scenes.implicit(1.0, 1.0, more=TOLERANCE, children=averages(averaging))
        if by == "explicit":
            end, damping = COOK
            growth = study.smooth_growth(end / 2)
            solution = scenes.explicit(end, damping=damping, more=averages(averaging))
        grid = scenes.grid(shape, (0, -2 * h, 0), (1 + 2 * h, round((60 / 48 + 4 * h) / h) * h, h), "100022", h)
        body = ('<Body name="solid" material="solid" type="Point"><Geometry file="points.txt"/>'
                f'<BodyForce by="{share!r}*{growth}*if(X&gt;{1 - width},1,0)"/></Body>')
        text = scenes.scene([body], grid, solution, [scenes.neo_hookean(1.0, POISSON, 1.0)], scenes.pictures(end, ("pres",)))

        def measure(result):
            loaded = incompressible.STRIPS["cook"](result.column("x", 0), result.column("y", 0))
            moved = (result.column("y") - result.column("y", 0))[loaded].mean()
            return self.measures(result, moved / (incompressible.LOAD * incompressible.deflection("cook", POISSON)))

        labels = {"body": "cook", "steps by": by, "shape": shape, "averaging": averaging, "cells": cells}
        return Run(labels, text, measure, quick, files={"points.txt": incompressible.particles("cook", h, 2)})

    def block_of(self, by, shape, averaging, cells, quick=False):
        h = 1 / cells
        body = scenes.block("block", (0, 0, 0), (0.5, h, 1), h / 2)
        text, force = stiff.compressed(shape, [body], "202210", (0.5, h, 1), h, [scenes.neo_hookean(stiff.YOUNG, POISSON, 1.0)],
                                       stiff.EXPLICIT if by == "explicit" else None, TOLERANCE, averages(averaging))
        return Run({"body": "block", "steps by": by, "shape": shape, "averaging": averaging, "cells": cells}, text,
                   lambda result: self.measures(result, force(result) / stiff.block_force(POISSON)), quick)

    @staticmethod
    def measures(result, ratio):
        return {"error": ratio - 1, "residuals": " ".join(f"{n:.0e}" for s in result.steps[-1:] for n in s.norms)}

    def block(self, rows):
        text = []
        for body, what in (("cook", "error of the displacement, per cent, over the cells along the length"),
                           ("block", "error of the force, per cent, over the cells along the height")):
            mine = study.where(rows, body=body)
            if mine:
                text.append(f"**{body}**: {what}\n\n"
                            + study.convergence(mine, "error", "cells", ("steps by", "shape", "averaging"), ".3g", 100))
                text.append(study.beside(mine, "error", ("shape", "averaging", "cells"), ".3g", 100))
        lines = [[row["body"], row["shape"], row["averaging"], f"{row['newton']:g}", row["residuals"]]
                 for row in study.where(rows, cells=16, **{"steps by": "implicit"}) if study.done(row)]
        if lines:
            text.append("16 cells\n\n" + study.table(["body", "shape", "averaging", "Newton", "residuals"], lines))
        failed = study.failures(rows)
        return "\n\n".join(filter(None, text)) + (f"\n\nNot done:\n\n{failed}" if failed else "")


STUDY = Locking()
