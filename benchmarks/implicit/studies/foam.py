"""A block of foam that a platen compresses until it locks."""

import numpy as np

import scenes
import study
from run_one import Run

HEIGHT, SHARE = 10.0, 0.25  # of the block, mm; of it that is left
YOUNG, POISSON, DENSITY = 1000.0, 0.2, 3e-4  # MPa, g/mm3; the unit of time is ms
YIELD, LINEAR, LOGARITHMIC, EXPONENT, LOCKING = 5.0, 1.0, 4.0, 2.5, 1.42
SHEAR, BULK = YOUNG / (2 * (1 + POISSON)), YOUNG / (3 * (1 - 2 * POISSON))
MODULUS = BULK + 4 / 3 * SHEAR
ALPHA = (3 * SHEAR / BULK) ** 0.5  # 1.5: elastic and plastic strain have the same direction
FACTOR = ((1 + 4 * ALPHA**2 / 9) * (9 + ALPHA**2)) ** 0.5 / (3 * ALPHA)  # of the axial stress over the yield stress
WAVE = (MODULUS / DENSITY) ** 0.5
LAW = (f'type="DFFoam" Young="{YOUNG}" Poisson="{POISSON}" Yield0="{YIELD}" alfa="{ALPHA!r}" epsud="{LOCKING}" '
       f'alal="{LOGARITHMIC}" gama="{LINEAR}" bebe="{EXPONENT}" vole="0" bq1="0" bq2="0"')
CELLS = (8, 16, 32)
EXPLICIT_SPEEDS = (0.01, 0.001)  # of the platen, over that of elastic waves
PICTURES = 48
NEWTON = 100
TANGENTS = ("differences", "matrixfree")  # beside assembled
PLATEAU = 0.8
PARTS = {"a cell": 1, "half a cell": 2}  # steps for each cell of the way


def strength(plastic):
    """Axial stress over the axial plastic strain."""
    r = FACTOR * plastic / LOCKING
    return FACTOR * (YIELD + LINEAR * r - LOGARITHMIC * np.log1p(-r**EXPONENT))


def solved(rising, wanted, high):
    """Where a rising function of the plastic strain, below `high`, has this value, by bisection."""
    low, high = np.zeros_like(wanted), np.broadcast_to(high, np.shape(wanted))
    for _ in range(100):
        middle = 0.5 * (low + high)
        above = rising(middle) > wanted
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return low


LOCK = (1 - 1e-12) * LOCKING / FACTOR  # no plastic strain is larger


def exact(strain):
    """Axial stress in uniaxial strain, both positive in compression."""
    plastic = solved(lambda p: p + strength(p) / MODULUS, np.asarray(strain, float), LOCK)
    return np.where(strain > FACTOR * YIELD / MODULUS, MODULUS * (strain - plastic), MODULUS * np.asarray(strain))


def strain_at(stress):
    """The inverse."""
    return solved(strength, np.asarray(stress, float), LOCK) + stress / MODULUS


def slope(plastic):
    """d stress / d strain beyond yield."""
    r = FACTOR * plastic / LOCKING
    hardening = FACTOR**2 / LOCKING * (LINEAR + LOGARITHMIC * EXPONENT * r ** (EXPONENT - 1) / (1 - r**EXPONENT))
    return MODULUS * hardening / (MODULUS + hardening)


class Foam(study.Study):
    name = "foam"
    title = "Foam that locks"
    about = f"""A block of metal foam (`DFFoam`: E = {YOUNG:g} MPa, Poisson's ratio {POISSON:g}, alfa {ALPHA:g}, yield at
{YIELD:g} MPa; gama {LINEAR:g}, alal {LOGARITHMIC:g}, bebe {EXPONENT:g}, epsud {LOCKING:g}), {HEIGHT:g} mm high and two by two
cells wide between symmetry planes, that a rigid platen compresses to {SHARE:g} of its height. With these constants elastic
and plastic strain have the same direction, so that the law in uniaxial strain has a closed form, which `mpm_point`
reproduces. The slope of stress over logarithmic strain is {slope(0.0):.2f} MPa where the plateau begins,
1/{MODULUS / slope(0.0):.0f} of the elastic one, and
{slope(solved(lambda p: p + strength(p) / MODULUS, -np.log(SHARE), LOCK)):.0f} MPa at the end, where the stress is
{exact(-np.log(SHARE)):.1f} MPa. *steps by*: a load step moves the platen by so much; Newton's method may take {NEWTON}
iterations. *plateau*: the largest error of the stress up to r = {PLATEAU:g} of the locking strain, relative; *gap*: the exact
height at the last stress less the block's, in cells, since the stress of a locked foam tells no more; *iterations*: of
Newton's method per step, on the plateau and from there on; *cuts*: steps taken again. In the explicit runs (without
artificial viscosity) the platen is in contact, and moves at the stated part of the speed of elastic waves, {WAVE:.0f} m/s."""
    labels = ("steps by", "shape", "jacobian", "cells")
    measured = ("plateau", "gap", "stress", "early", "late")

    def runs(self):
        found = []
        for shape in ("QuadraticBSpline", "CPDI2"):
            for by in (*PARTS, *(f"explicit {speed:g}" for speed in EXPLICIT_SPEEDS)):
                found += [self.one(by, shape, cells, cells == 8 and by in ("a cell", "explicit 0.01") and shape == "CPDI2")
                          for cells in CELLS]
        found += [self.one("a cell", "CPDI2", cells, tangent=tangent) for tangent in TANGENTS for cells in CELLS[:2]]
        return found

    @staticmethod
    def one(by, shape, cells, quick=False, tangent="assembled"):
        h, is_implicit = HEIGHT / cells, "explicit" not in by
        knee = PLATEAU * LOCKING / FACTOR
        speed = 1.0 if is_implicit else float(by.split()[1]) * WAVE
        end = (1 - SHARE) * HEIGHT / speed
        steps = round((1 - SHARE) * cells) * PARTS[by] if is_implicit else PICTURES
        solution = (scenes.implicit(end, end / steps, more=f'jacobian="{tangent}" max_newton="{NEWTON}"') if is_implicit
                    else scenes.explicit(end))
        text = scenes.pressed_block(shape, h, HEIGHT, -speed, not is_implicit, solution,
                                    [scenes.material("solid", DENSITY, LAW), scenes.rigid(DENSITY)],
                                    scenes.pictures(end / min(steps, PICTURES), ("SigmaZ", "density")))

        def measure(result):
            mine = result.column("z", 0) < HEIGHT
            first, times = result.column("density", 0)[mine], np.array(result.states.times)
            heights = HEIGHT - speed * times
            # The mean over the height of a force that is the same at every height; volumes shrink as the height does.
            volumes = [first / result.column("density", i)[mine] for i in range(len(times))]
            stress = np.array([-(v * result.column("SigmaZ", i)[mine]).sum() / v.sum() for i, v in enumerate(volumes)])
            strain = np.log(HEIGHT / heights)
            flat = (strain > 0) & (strain < knee)
            iterations, ends = [s.newton for s in result.steps], np.cumsum([s.length for s in result.steps])
            turn = int((HEIGHT - speed * ends > HEIGHT * np.exp(-knee)).sum())
            gap = HEIGHT * np.exp(-strain_at(stress[-1])) - heights[-1]
            found = {"plateau": np.abs(stress[flat] / exact(strain[flat]) - 1).max(), "gap": gap / h,
                     "stress": stress[-1] / exact(strain[-1])}
            if is_implicit:
                found.update(early=np.mean(iterations[:turn]), late=np.mean(iterations[turn:]))
            return found

        labels = {"steps by": by, "shape": shape, "jacobian": tangent if is_implicit else "none", "cells": cells}
        return Run(labels, text, measure, quick)

    def block(self, rows):
        heads = ["steps by", "shape", "Jacobian", "cells", "plateau", "gap, cells", "last stress over exact", "steps", "cuts",
                 "iterations, plateau", "iterations, locking", "seconds"]
        lines = [[r["steps by"], r["shape"], "–" if r["jacobian"] == "none" else r["jacobian"], f"{r['cells']:g}",
                  *(study.shown(r, *how) for how in (("plateau", ".1e"), ("gap", "+.2f"), ("stress", ".2f"))),
                  *("–" if r[name] == "" else f"{r[name]:g}" for name in ("steps", "cuts")),
                  *(study.shown(r, *how) for how in (("early", ".1f"), ("late", ".1f"), ("seconds", ".2g")))] for r in rows]
        failed = study.failures(rows)
        return study.table(heads, lines) + (f"\n\nNot done:\n\n{failed}" if failed else "")


STUDY = Foam()
