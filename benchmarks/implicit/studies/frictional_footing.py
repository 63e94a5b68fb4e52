"""A strip footing on weightless soil with cohesion and friction: the limit load of Prandtl and Reissner."""

import numpy as np

import scenes
import study
from run_one import Run
from studies.footing import HALF, STEPS, against, driven, loads_table, pressed

WIDTH, DEPTH = 8.0, 4.0  # the mechanism is 6.1 wide and 2.3 deep
COHESION, ANGLE, YOUNG, POISSON = 1.0, 20.0, 2000.0, 0.3
TANGENT = np.tan(np.radians(ANGLE))
SURCHARGE = np.exp(np.pi * TANGENT) * np.tan(np.radians(45 + ANGLE / 2)) ** 2  # Reissner's N_q
LIMIT = COHESION * (SURCHARGE - 1) / TANGENT  # Prandtl's c N_c
PRESSED = 0.1
WAVE = (YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))) ** 0.5  # the density is 1
EXPLICIT_SPEEDS = (1e-3, 1e-4)  # of the footing, over that of waves
APEX = 0.999 * COHESION / TANGENT  # largest mean tension


class FrictionalFooting(study.Study):
    name = "frictional_footing"
    title = "Strip footing on soil with friction"
    about = f"""Half of a rough strip of half width {HALF:g} on weightless soil, {WIDTH:g} wide and {DEPTH:g} deep, in plane strain: DruckerPrager
with cohesion {COHESION:g}, friction and dilation of {ANGLE:g} degrees and the cone inscribed in Mohr and Coulomb's pyramid (`match="3"`), with which
the limit theorems give the load of Prandtl and Reissner exactly, (N_q - 1) c cot phi = {LIMIT:.2f} over the width, N_q = exp(pi tan phi)
tan^2(45 deg + phi/2) (E = {YOUNG:g}, Poisson's ratio {POISSON:g}). The body is in contact and ends half a cell inside the strip, as [above](#strip-footing), and is pressed by {PRESSED:g} in
{STEPS} load steps; while it sinks the soil heaves beside it, and the load goes on growing. *load*: the largest over the limit load, less 1; *last*: at the
end; *growth*: over the last quarter, relative. The explicit runs (density 1, the default artificial viscosity) are in rough contact too; the body moves at the
stated part of the speed of waves, {WAVE:.1f}. Half of the lower speed changes the last load with 2.5 cells by 0.1 % at most. Implicit
steps with 6.5 cells are left out: by the times of the other grids they are to take some 4 (splines) and 6 minutes (`SGMP`)."""
    labels = ("steps by", "shape", "cells")
    measured = ("load", "last", "growth")

    def runs(self):
        kinds = {"implicit": (2.5, 3.5, 4.5), **{f"explicit {speed:g}": (2.5, 3.5, 4.5, 6.5) for speed in EXPLICIT_SPEEDS}}
        return [self.one(by, shape, cells) for by, grids in kinds.items() for cells in grids for shape in ("SGMP", "QuadraticBSpline")]

    @staticmethod
    def one(by, shape, cells):
        h = HALF / cells
        speed, solution, averaged = driven(by, PRESSED, WAVE)
        strength = (f'type="DruckerPrager" phi="{ANGLE:g}" c="{COHESION:g}" psi="{ANGLE:g}" match="3" ten_f="{APEX!r}" '
                    f'Young="{YOUNG}" Poisson="{POISSON}"')
        text = pressed(shape, h, (WIDTH, DEPTH), speed, strength, solution, rough=True, end=HALF - h / 2)
        return Run({"steps by": by, "shape": shape, "cells": cells}, text,
                   lambda result: against(LIMIT, h, result.energies, averaged), (by, shape, cells) == ("implicit", "SGMP", 2.5))

    def block(self, rows):
        return "\n\n".join(filter(None, (
            "*last*, per cent, over the cells along the half width", study.beside(rows, "last", ("shape", "cells"), ".2f", 100),
            study.convergence(rows, "last", "cells", ("steps by", "shape"), ".2f", 100), loads_table(rows, self.labels, self.measured))))


STUDY = FrictionalFooting()
