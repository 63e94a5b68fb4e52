"""Newton's method with the consistent tangent of each law."""

import math

import scenes
import study
from run_one import Run

SIZE, CELLS = 4, 4
METAL = 'Young="200e3" Poisson="0.3"'
# Strain of the whole load, and its steps. Elastic laws reach round-off in few iterations: they show an order in large steps.
ELASTIC, PLASTIC = (0.2, 2), (0.02, 5)
# Law: (attributes of StrengthModel, elements beside it, load).
DENSITY = 8.93e-9  # matters to the heat of adiabatic laws alone
LAWS = {
    "IsoElastic": (METAL, "", ELASTIC),
    "CauchyElastic": (METAL, "", ELASTIC),
    "NeoHookean": ('Young="1000" Poisson="0.3"', "", ELASTIC),
    "Corotated": ('Young="1000" Poisson="0.3"', "", ELASTIC),
    "MooneyRivlin": ('Mr_A2="200" Mr_B2="50" Poisson="0.45"', "", ELASTIC),
    "ElaPlastic": (METAL + ' Yield0="200"', "", PLASTIC),
    "IsoHarden": (METAL + ' Yield0="200" TangMod="3000"', "", PLASTIC),
    "Voce": (METAL + ' Yield0="200" Q="120" b="100" H="1000"', "", PLASTIC),
    "SimJohnsonCook": (METAL + ' Yield0="90" B="292" n="0.31" C="0.025" epso="1"', "", PLASTIC),
    "JohnsonCook": (METAL + ' Yield0="90" B="292" n="0.31" C="0.025" epso="1"'
                    ' m="1.09" melt="1356" roomt="293" SpecHeat="383e6"', "", PLASTIC),
    "DruckerPrager": ('Young="70" Poisson="0.3" qfai="0.4" kfai="0.2" qpsi="0.1" ten_f="0.1"', "", PLASTIC),
    "DFFoam": ('Young="1000" Poisson="0.2" Yield0="5" alfa="1.5" epsud="1.4" alal="4" gama="10" bebe="2.5" vole="0"', "", PLASTIC),
}


def seen_order(norms):
    """Of the last three residuals above round-off, some 1e-13 of the forces that balance at the platen's face, log(r2/r1)/log(r1/r0). Without the
    first, which holds the linear answer to the platen's whole way."""
    above = [n for n in norms[1:] if n > 5e-13]
    if len(above) < 3 or not above[-3] > above[-2] > above[-1]:
        return math.nan
    return math.log(above[-1] / above[-2]) / math.log(above[-2] / above[-3])


class Laws(study.Study):
    name = "laws"
    title = "Quadratic convergence of each law"
    about = f"""A cube of {CELLS} cells per edge, fixed at the bottom, free at the sides, that a platen presses and shears
by the stated strain (of the height, and half as much sideways) in {ELASTIC[1]} load steps (elastic laws) or {PLASTIC[1]}, with a tolerance of 1e-12 and
QuadraticBSpline. *iterations*: the most in a step; *order*: of the last three residuals above round-off, the largest of the
steps (2: quadratic); *differences*: iterations with `jacobian="differences"`; *residuals*: of the last step, over the
forces that balance."""
    labels = ("law", "tangent")
    measured = ("strain", "iterations", "order", "residuals")

    def runs(self):
        return [self.one(law, tangent, law in ("NeoHookean", "IsoHarden") and tangent == "assembled")
                for law in LAWS for tangent in ("assembled", "differences")]

    @staticmethod
    def one(law, tangent, quick):
        values, more, (strain, steps) = LAWS[law]
        h = SIZE / CELLS
        cube = scenes.block("cube", (2, 2, 0), (SIZE, SIZE, SIZE), h / 2)
        platen = scenes.block("platen", (1, 1, SIZE), (SIZE + 2, SIZE + 2, 2 * h), h / 2, "rigid",
                              scenes.moved(vx=strain * SIZE / 2, vz=-strain * SIZE))
        grid = scenes.grid("QuadraticBSpline", (0, 0, 0), (SIZE + 4, SIZE + 4, SIZE + 4), "000010", h)
        text = scenes.scene([cube, platen], grid,
                            scenes.implicit(1.0, 1 / steps, more=f'rtol="1e-12" jacobian="{tangent}"'),
                            [scenes.material("solid", DENSITY, f'type="{law}" {values}', more), scenes.rigid()])

        def measure(result):
            found = [o for o in (seen_order(s.norms) for s in result.steps) if not math.isnan(o)]
            return {"strain": strain, "iterations": max(len(s.norms) - 1 for s in result.steps),
                    "order": max(found, default=math.nan), "residuals": " ".join(f"{n:.1e}" for n in result.steps[-1].norms)}

        return Run({"law": law, "tangent": tangent}, text, measure, quick)

    def block(self, rows):
        lines = []
        for row in study.where(rows, tangent="assembled"):
            other = study.where(rows, law=row["law"], tangent="differences")
            lines.append([row["law"], study.shown(row, "strain", "g"), study.shown(row, "iterations", ".0f"),
                          study.shown(row, "order", ".2f"),
                          study.shown(other[0], "iterations", ".0f") if other else "–", row["residuals"] or "–"])
        failed = study.failures(rows)
        return (study.table(["law", "strain", "iterations", "order", "differences", "residuals"], lines)
                + (f"\n\nNot done:\n\n{failed}" if failed else ""))


STUDY = Laws()
