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
STEPS = (10, 20, 40, 80)
CELLS = (4, 8, 16)
EXPLICIT_SPEEDS = (0.01, 0.001)  # of the platen, over that of elastic waves
PICTURES = 40
TANGENTS = ("differences", "matrixfree")
LOCKED = 0.9  # r above which the foam counts as locking


def strength(plastic):
    """Axial stress over the axial plastic strain."""
    r = FACTOR * plastic / LOCKING
    return FACTOR * (YIELD + LINEAR * r - LOGARITHMIC * np.log1p(-r**EXPONENT))


def exact(strain):
    """Axial stress and plastic strain in uniaxial strain, both positive in compression: bisection of sigma = M (e - ep)."""
    low, high = np.zeros_like(strain), np.minimum(strain, (1 - 1e-15) * LOCKING / FACTOR)
    for _ in range(200):
        middle = 0.5 * (low + high)
        above = MODULUS * (strain - middle) > strength(middle)
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return MODULUS * (strain - low), low


def slope(plastic):
    """d stress / d strain beyond yield."""
    r = FACTOR * plastic / LOCKING
    hardening = FACTOR**2 / LOCKING * (LINEAR + LOGARITHMIC * EXPONENT * r ** (EXPONENT - 1) / (1 - r**EXPONENT))
    return MODULUS * hardening / (MODULUS + hardening)


class Foam(study.Study):
    name = "foam"
    title = "Foam that locks"
    about = f"""to come"""
    labels = ("steps by", "shape", "cells")
    measured = ("plateau", "locked", "end", "strain", "plateau iterations", "locking iterations")

    def runs(self):
        found = []
        for shape in ("uGIMP", "QuadraticBSpline", "CPDI2"):
            for steps in STEPS:
                for cells in CELLS:
                    found.append(self.one(f"implicit {steps}", shape, cells))
        for speed in EXPLICIT_SPEEDS:
            for cells in CELLS:
                found.append(self.one(f"explicit {speed:g}", "QuadraticBSpline", cells))
        return found

    @staticmethod
    def one(by, shape, cells, quick=False, tangent="differences"):
        h, is_implicit = HEIGHT / cells, "implicit" in by
        speed = 1.0 if is_implicit else float(by.split()[1]) * WAVE
        end = (1 - SHARE) * HEIGHT / speed
        steps = int(by.split()[1]) if is_implicit else PICTURES
        solution = scenes.implicit(end, end / steps, more=f'jacobian="{tangent}"') if is_implicit else scenes.explicit(end)
        body = scenes.block("block", (0, 0, 0), (2 * h, 2 * h, HEIGHT), h / 2)
        platen = scenes.block("platen", (0, 0, HEIGHT), (2 * h, 2 * h, 2 * h), h / 2, "rigid", scenes.moved(vz=-speed))
        parts = (scenes.grid(shape, (0, 0, 0), (2 * h, 2 * h, HEIGHT + 4 * h), "222220", h), solution,
                 [scenes.material("solid", DENSITY, LAW), scenes.rigid(DENSITY)],
                 scenes.pictures(end / min(steps, PICTURES), ("SigmaZ", "density")))
        if is_implicit:
            text = scenes.scene([body, platen], *parts)
        else:
            text = scenes.two_components([body], [platen], *parts, more='<Contact enable="1"/>')

        def measure(result):
            mine = result.column("z", 0) < HEIGHT
            count, first = len(result.states.steps), result.column("density", 0)[mine]
            # The mean over the height, of the same force at every height: over the present one, as volumes shrink.
            volumes = [first / result.column("density", i)[mine] for i in range(count)]
            stress = np.array([-(v * result.column("SigmaZ", i)[mine]).sum() / v.sum() for i, v in enumerate(volumes)])
            strain = -np.log(1 - (1 - SHARE) * np.arange(count) / (count - 1))
            wanted, plastic = exact(strain)
            off = stress - wanted
            print(np.c_[strain,stress,wanted])
            return {"end": off[-1]/wanted[-1]}

        return Run({"steps by": by, "shape": shape, "cells": cells}, text, measure, quick)


STUDY = Foam()
