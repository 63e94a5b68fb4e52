"""Thick cylinder under internal pressure, elastic and elastic-plastic; a plate with a hole."""

import functools

import numpy as np

import radial
import scenes
import study
from run_one import Run

INNER, OUTER, WIDTH = 1.0, 2.0, 3.0
YOUNG, POISSON, YIELD = 1.0, 0.3, 1e-3
LOADS = {"elastic": 1e-4, "plastic": 6.4e-4, "plate": 1e-4}
CELLS = {"elastic": (4, 8, 16), "plastic": (4, 8, 16), "plate": (4, 8, 12)}
EXPLICIT = {"elastic": (60.0, 0.7), "plastic": (60.0, 0.7), "plate": (60.0, 0.59)}  # time and damping
EDGE = 0.25  # what `inside` leaves out next to the edges


@functools.cache
def reference(body):
    yielded = YIELD if body == "plastic" else 1e6
    return radial.solve(INNER, OUTER, YOUNG, POISSON, yielded, LOADS[body] * np.arange(1, 21) / 20)


def of_cylinder(body, x, y):
    """Stresses xx, yy, xy."""
    radii, stress, *_ = reference(body)
    r2 = x * x + y * y
    rr, tt = (np.interp(np.sqrt(r2), radii, stress[:, i]) for i in range(2))
    return (rr * x * x + tt * y * y) / r2, (rr * y * y + tt * x * x) / r2, (rr - tt) * x * y / r2


def kirsch(x, y):
    """Stresses xx, yy, xy of an infinite plate with a hole of radius 1 under a tension of 1 along x (G. Kirsch, 1898)."""
    r, t = np.hypot(x, y), np.arctan2(y, x)
    q = r**-2.0
    return (1 - q * (1.5 * np.cos(2 * t) + np.cos(4 * t)) + 1.5 * q * q * np.cos(4 * t),
            -q * (0.5 * np.cos(2 * t) - np.cos(4 * t)) - 1.5 * q * q * np.cos(4 * t),
            -q * (0.5 * np.sin(2 * t) + np.sin(4 * t)) + 1.5 * q * q * np.sin(4 * t))


def kirsch_written(load):
    """The same as expressions of the input language."""
    q, t = "(1/(x*x+y*y))", "atan2(y,x)"
    return (f"{load}*(1-{q}*(1.5*cos(2*{t})+cos(4*{t}))+1.5*{q}^2*cos(4*{t}))",
            f"{load}*(-{q}*(0.5*cos(2*{t})-cos(4*{t}))-1.5*{q}^2*cos(4*{t}))",
            f"{load}*(-{q}*(0.5*sin(2*{t})+sin(4*{t}))+1.5*{q}^2*sin(4*{t}))")


class Cylinder(study.Study):
    name = "cylinder"
    title = "Thick cylinder and a plate with a hole"
    about = f"""Quarters in plane strain (one cell between symmetry planes; E = {YOUNG:g}, Poisson's ratio {POISSON:g}).
*elastic*: radii 1 and 2, an inner pressure of {LOADS['elastic']:g} (Lamé); *plastic*: perfectly plastic at {YIELD:g} (von
Mises), a pressure of {LOADS['plastic']:g} in ten load steps, which is 0.8 of the limit load 2/sqrt(3) ln 2 of the yield
stress; reference: finite elements over the radius (benchmarks/implicit/radial.py). *plate*: a hole of radius 1 in a square
of half width 3, under the tractions of Kirsch's solution for a tension of {LOADS['plate']:g}. The cylinder's
particles lie in rings; the plate's lattice cuts the hole's edge into stairs. `Traction` spreads a load over about a cell:
first order is to be expected. *stress*:
root mean square of the error of the stress over its largest value; *inside*: of the particles more than {EDGE:g} from an
edge; *peak*: the largest hoop stress of a particle over the exact one where the edge is (3 of the plate); *moved*: error of
the mean displacement of the particles within {EDGE:g} of the inner surface. The explicit runs are damped (`DynamicRelax`), and
their load grows in the first half of {EXPLICIT["plate"][0]:g} units of time. The plate's lowest mode has an angular frequency of 0.295 (finite
elements), for which a damping of {EXPLICIT["plate"][1]:g} is critical; the cylinder breathes with 0.735, for which {EXPLICIT["elastic"][1]:g} is
half the critical damping. Twice the time changes *inside* of the plate with 4 cells from 7.8e-3 to 7.9e-3."""
    labels = ("body", "steps by", "shape", "cells")
    measured = ("stress", "inside", "peak", "moved")

    def runs(self):
        found = []
        for body in LOADS:
            for shape in scenes.SHAPES:
                for cells in CELLS[body]:
                    quick = body != "plate" and cells == 4 and shape in ("linear", "QuadraticBSpline")
                    found.append(self.one(body, "implicit", shape, cells, quick))
        found += [self.one(body, "explicit", "QuadraticBSpline", cells, False) for body in LOADS for cells in CELLS[body]]
        return found

    @staticmethod
    def one(body, by, shape, cells, quick):
        h, load, plastic = 1 / cells, LOADS[body], body == "plastic"
        if by == "implicit":
            end, growth = 1.0, "t"
            solution = scenes.implicit(end, 0.1 if plastic else 1.0)
        else:
            end, damping = EXPLICIT[body]
            growth, solution = study.smooth_growth(end / 2), scenes.explicit(end, damping=damping)
        if body == "plate":
            xx, yy, xy = kirsch_written(f"{load}*{growth}")
            loads = (f'<Traction tx="{xx}" ty="{xy}" normal="0" xmin="{WIDTH - 0.5}" ramp="0.9"/>'
                     f'<Traction tx="{xy}" ty="{yy}" normal="1" ymin="{WIDTH - 0.5}" ramp="0.9"/>')
            bodies = [scenes.block("whole", (0, 0, 0), (WIDTH, WIDTH, h), h / 2, attributes='ForBoolBody="1"'),
                      scenes.ring("hole", 0, 1, h, h / 2, attributes='ForBoolBody="1"'),
                      '<Body name="plate" material="solid" type="Bool" BoolType="subtract" BoolBodyA="whole" '
                      f'BoolBodyB="hole">{loads}</Body>']
        else:
            pressure = f"{load / (OUTER - INNER)!r}*({OUTER}-sqrt(x*x+y*y))*{growth}"
            bodies = [scenes.ring("cylinder", INNER, OUTER, h, h / 2, more=f'<Traction pressure="{pressure}"/>', rings=True)]
        room = (WIDTH if body == "plate" else OUTER) + 4 * h
        law = f'type="ElaPlastic" Young="{YOUNG}" Poisson="{POISSON}" Yield0="{YIELD}" bq1="0" bq2="0"'
        text = scenes.scene(bodies, scenes.grid(shape, (0, 0, 0), (room, room, h), "202022", h), solution,
                            [scenes.material("solid", 1.0, law) if plastic else scenes.neo_hookean(YOUNG, POISSON, 1.0)],
                            scenes.pictures(end, scenes.STRESSES))

        def measure(result):
            x, y = result.column("x", 0), result.column("y", 0)
            exact = np.stack(kirsch(x, y) if body == "plate" else of_cylinder(body, x, y), 1) * (load if body == "plate" else 1)
            off = np.stack([result.column(n) for n in ("SigmaX", "SigmaY", "SigmaXY")], 1) - exact
            r, scale = np.hypot(x, y), np.abs(exact).max()
            if body == "plate":
                inside = (r > 1 + EDGE) & (x < WIDTH - EDGE) & (y < WIDTH - EDGE)
                return {"stress": rms(off) / scale, "inside": rms(off[inside]) / scale,
                        "peak": result.column("SigmaX").max() / (3 * load)}
            inside = (r > INNER + EDGE) & (r < OUTER - EDGE)
            moved, near = np.hypot(result.column("x"), result.column("y")) - r, r < INNER + EDGE
            wanted = np.interp(r, *reference(body)[3])
            hoop = off + exact
            around = (hoop[:, 0] * y * y + hoop[:, 1] * x * x - 2 * hoop[:, 2] * x * y) / r**2
            stress = reference(body)[1]
            return {"stress": rms(off) / scale, "inside": rms(off[inside]) / scale, "peak": around.max() / stress[:, 1].max(),
                    "moved": moved[near].mean() / wanted[near].mean() - 1}

        return Run({"body": body, "steps by": by, "shape": shape, "cells": cells}, text, measure, quick)

    def block(self, rows):
        text = []
        for body in study.values(rows, "body"):
            mine = study.where(rows, body=body)
            text.append(f"**{body}**: *inside*, over the cells per unit of length\n\n"
                        + study.convergence(mine, "inside", "cells", ("steps by", "shape")))
            text.append(study.beside(mine, "inside", ("shape", "cells")))
            finest = max(study.values(mine, "cells"))
            errors = {"stress": ".3f", "inside": ".2e", "peak": ".3f", "moved": ".4f"}
            lines = [[r["steps by"], r["shape"], *(study.shown(r, name, how) for name, how in errors.items()),
                      f"{r['steps']:g}", f"{r['newton']:g}" if r["newton"] != "" else "–", f"{r['seconds']:.2g}"]
                     for r in study.where(mine, cells=finest) if study.done(r)]
            text.append(f"The finest, {finest:g} cells\n\n" + study.table(
                ["steps by", "shape", *errors, "steps", "Newton iterations", "seconds"], lines))
        failed = study.failures(rows)
        return "\n\n".join(filter(None, text)) + (f"\n\nNot done:\n\n{failed}" if failed else "")


def rms(off):
    """Of plane stress errors xx, yy, xy."""
    return float(np.sqrt((off[:, 0]**2 + off[:, 1]**2 + 2 * off[:, 2]**2).mean()))


STUDY = Cylinder()
