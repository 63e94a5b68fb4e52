"""A strip footing on weightless cohesive soil: Prandtl's load."""

import numpy as np

import scenes
import study
from run_one import Run

HALF, WIDTH, DEPTH = 1.0, 4.0, 2.0  # of the footing, of the half of the soil, of the soil
COHESION, YOUNG, POISSON = 1.0, 500.0, 0.3
PRANDTL = (2 + np.pi) * COHESION
PRESSED, STEPS = 0.08, 40
WAVE = (YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))) ** 0.5  # the density is 1
FRICTION = 1.0  # of a rough footing
AVERAGED = 5  # rows of explicit runs
EXPLICIT_SPEEDS = (1e-3, 1e-4)  # of the footing, over that of waves
WIDER = "27, 17 and 12"  # measured once
AVERAGES = '<Volumetric averaging="cell"/>'
AVERAGING = ("linear", "uGIMP", "QuadraticBSpline", "CPDI2")  # shapes
# Von Mises with the cohesion as shear strength, which is Tresca's criterion in plane strain.
LAWS = {"DruckerPrager": f'type="DruckerPrager" qfai="0" kfai="{COHESION}" qpsi="0" ten_f="1e6"',
        "ElaPlastic": f'type="ElaPlastic" Yield0="{3**0.5 * COHESION!r}" bq1="0" bq2="0"'}


def driven(by, way, wave):
    """Of steps `by`: the speed of the footing on its way, the solution, and the rows of which a load is the mean."""
    if by.startswith("implicit"):
        return way, scenes.implicit(1.0, 1 / STEPS), 1
    speed = float(by.split()[1]) * wave
    return speed, scenes.explicit(way / speed), AVERAGED


def pressed(shape, h, soil, speed, strength, solution, tied=False, rough=False, end=HALF):
    """The input of soil of this width and depth under the footing, which ends at `end`."""
    width, depth = soil
    body = scenes.block("soil", (0, 0, 0), (width, h, depth), h / 2)
    footing = scenes.block("footing", (0, 0, depth), (end, h, 2 * h), h / 2, "rigid", scenes.moved(vz=-speed))
    parts = (scenes.grid(shape, (0, 0, 0), (width, h, depth + 4 * h), "222210", h), solution,
             [scenes.material("solid", 1.0, strength), scenes.rigid()])
    if tied:
        return scenes.scene([body, footing], *parts)
    friction = f'<Friction><Coefficient mat1="solid" mat2="rigid" value="{FRICTION}"/></Friction>' if rough else ""
    return scenes.two_components([body], [footing], *parts, more='<Contact enable="1"/>' + friction)


def against(limit, h, rows, averaged=1):
    """The measured loads, of a status file, over the limit load per width; `averaged`: over so many rows."""
    force = np.abs(next(rows[name] for name in ("fz[contact:footing]", "fz[drive:footing]") if name in rows))
    loads = np.convolve(force, np.ones(averaged) / averaged, "valid") / (h * HALF * limit)
    return {"load": loads.max() - 1, "last": loads[-1] - 1, "growth": loads[-1] / loads[3 * len(loads) // 4 - 1] - 1}


def loads_table(rows, labels, measured):
    """A line for each run."""
    lines = [[*(f"{r[n]:g}" if isinstance(r[n], float) else r[n] for n in labels), *(study.shown(r, n, ".2f", 100) for n in measured),
              *("–" if r[name] == "" else f"{r[name]:g}" for name in ("steps", "newton", "cuts")), f"{r['seconds']:.2g}"]
             for r in rows if study.done(r)]
    text = study.table([*labels, *(f"{n}, %" for n in measured), "steps", "Newton iterations", "cuts", "seconds"], lines)
    failed = study.failures(rows)
    return text + (f"\n\nNot done:\n\n{failed}" if failed else "")


class Footing(study.Study):
    name = "footing"
    title = "Strip footing"
    about = f"""Half of a strip of half width {HALF:g} on weightless soil, {WIDTH:g} wide and {DEPTH:g} deep, in plane
strain (cohesion {COHESION:g}, friction 0, E = {YOUNG:g}, Poisson's ratio {POISSON:g}); a rigid body with
`PrescribedVelocity` presses it by {PRESSED:g} in {STEPS} load steps. L. Prandtl's load is (2 + pi) c = {PRANDTL:.3f} over
the width. The load is the force on the body (`.sta`; of explicit runs the mean of five of 100 rows): the stress of layers near it is
less, as explicit contact also acts at nodes inside the soil. *load*: the largest over Prandtl's, less 1; *last*: at the end; *growth*: of the load over the
last quarter, relative; a method that locks finds no limit load. The body sinks by {PRESSED / HALF:.0%} of its half width, which adds some per cent to
the load. *averaging*: of `Volumetric`. *implicit, tied*: without contact the soil sticks to the body;
*implicit, contact*: with a coefficient of friction of {FRICTION:g} (*rough*) or without friction; all have Prandtl's load. The
displacement of the soil's surface falls from the body's to that of free soil over the cell behind the last node below the body, whose
end is at a node: it ends half a cell inside the strip (*cells*: 2.5, 4.5 and 8.5 along the half width). A body that ends at the strip's edge
presses a strip half a cell wider on each side: {WIDER} % too much with the quadratic spline, rough, and 2, 4 and 8 cells. In the explicit runs
(density 1, the default artificial viscosity) the footing ends at the strip's edge. It is in contact without friction, which leaves Prandtl's load as it is,
and moves at the stated part of the speed of waves, {WAVE:.1f}."""
    labels = ("steps by", "law", "averaging", "shape", "cells")
    measured = ("load", "last", "growth")

    def runs(self):
        found = []

        def add(by, shapes, cells=(2.5, 4.5, 8.5), law="DruckerPrager", averaging="none", quick=None):
            for shape in shapes:
                for n in cells:
                    found.append(self.one(by, law, averaging, shape, n, (shape, n) == quick))

        spline = ("QuadraticBSpline", 2.5)
        add("implicit, tied", scenes.SHAPES, quick=spline)
        add("implicit, tied", AVERAGING, averaging="cell", quick=spline)
        for averaging in ("none", "cell"):  # the same criterion
            add("implicit, tied", ("linear", "QuadraticBSpline"), (2.5, 4.5), "ElaPlastic", averaging)
        add("implicit, contact, rough", scenes.SHAPES, quick=spline)
        add("implicit, contact, rough", ("linear", "QuadraticBSpline"), averaging="cell", quick=spline)
        for averaging in ("none", "cell"):
            add("implicit, contact, smooth", ("QuadraticBSpline",), averaging=averaging, quick=spline if averaging == "none" else None)
        for speed in EXPLICIT_SPEEDS:
            quick = ("QuadraticBSpline", 2) if speed == EXPLICIT_SPEEDS[0] else None
            add(f"explicit {speed:g}", ("linear", "QuadraticBSpline"), (2, 4, 8), quick=quick)
        return found

    @staticmethod
    def one(by, law, averaging, shape, cells, quick):
        h, is_implicit, is_tied = HALF / cells, by.startswith("implicit"), by == "implicit, tied"
        speed, solution, averaged = driven(by, PRESSED, WAVE)
        if averaging == "cell":
            solution = solution.replace("</Solution>", f"{AVERAGES}</Solution>")
        strength = f'{LAWS[law]} Young="{YOUNG}" Poisson="{POISSON}"'
        text = pressed(shape, h, (WIDTH, DEPTH), speed, strength, solution, is_tied, by.endswith("rough"),
                       HALF - h / 2 if is_implicit else HALF)

        return Run({"steps by": by, "law": law, "averaging": averaging, "shape": shape, "cells": cells}, text,
                   lambda result: against(PRANDTL, h, result.energies, averaged), quick)

    def block(self, rows):
        kinds = [[r for r in rows if r["steps by"].startswith("implicit") == is_implicit] for is_implicit in (True, False)]
        text = ["*last*, per cent, over the cells along the half width"]
        text += [study.convergence(mine, "last", "cells", ("steps by", "law", "averaging", "shape"), ".2f", 100) for mine in kinds if mine]
        text.append(loads_table(rows, self.labels, self.measured))
        return "\n\n".join(text)


STUDY = Footing()
