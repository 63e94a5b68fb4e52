"""Nodes with hardly any mass: the condition of the matrix and the iterations of its solution."""

import math
import re

import numpy as np

import scenes
import study
from run_one import Run

CELLS = 12  # along an edge; above 5,000 unknowns, so that multigrid is the default
LOAD = 1e-3  # weight per area over Young's modulus
REACHES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
REMEDIES = (1e-3, 0.0)  # Implicit@stabilisation
# Particles along an edge, and how far the support of a node reaches beyond the one before the last, in cells.
SHAPES = {"linear": (2 * CELLS + 1, 0.0), "QuadraticBSpline": (2 * CELLS + 2, 0.5)}
ESTIMATE = "singular_values"
CAPS = {"none": 2000, "Jacobi": 1000, "multigrid": 1000}  # iterations per linear system
CG = ("-ksp_type", "cg", "-ksp_rtol", "1e-8", "-snes_linesearch_type", "basic")
PRECONDITIONERS = {"none": ("-pc_type", "none", "-ksp_view_singularvalues", f":{{folder}}/{ESTIMATE}"),
                   "Jacobi": ("-pc_type", "jacobi"), "multigrid": ()}
QUICK = ("linear", 1e-3)


def condition(folder):
    """The largest of the estimates of all linear systems."""
    path = folder / ESTIMATE
    return max(map(float, re.findall(r"max/min (\S+)", path.read_text()))) if path.exists() else math.nan


class Conditioning(study.Study):
    name = "conditioning"
    title = "Nodes with hardly any mass"
    about = f"""A neo-Hookean cube of about {CELLS} cells' edge under its weight ({LOAD:g} of Young's modulus per area), with Poisson's
ratio 0, between three symmetry planes, from rest to equilibrium in one load step. Its outermost particles reach by the stated part of a
cell into the support of one more layer of nodes, on its three free faces, at its edges and at its corner. Exact: the stress in a layer is the
weight above it; *error*: the mean over the particles of |sigma - exact|, over the weight's stress at the bottom. Conjugate gradients reduce
the residual to 1e-8. *condition*: of the matrix, as estimated by their Lanczos process without a preconditioner. Estimates are
lower bounds: of a system that is not solved the smallest eigenvalue has not been found. *Jacobi*, *multigrid*: iterations per linear
system, preconditioned with the diagonal and with coarser grids. A system is given up after {CAPS["none"]} iterations without a
preconditioner, or {CAPS["Jacobi"]} with one ("> {CAPS["Jacobi"]}"); DTOL: the residual has grown 1e5 times. *with*: the default
`stabilisation="{REMEDIES[0]:g}"`, *without*: `stabilisation="0"`; what then bounds the condition is the stiffness of 1e-10 of nodes with less
than a twentieth of a cell's volume, and that nodes with less than 1e-6 of support are no unknowns."""
    labels = ("shape", "reach", "stabilisation", "solver")
    measured = ("condition", "error")

    def runs(self):
        return [self.run(*labels) for labels in self.cases()]

    @staticmethod
    def cases():
        return [(shape, reach, remedy, solver) for shape in SHAPES for reach in REACHES for remedy in REMEDIES
                for solver in CAPS]

    @staticmethod
    def run(shape, reach, remedy, solver):
        particles, before = SHAPES[shape]
        dp = (CELLS + before + reach) / (particles - 0.5)  # the last one is half a spacing inside the face
        edge, room = particles * dp, CELLS + 5
        text = scenes.scene([scenes.block("cube", (0, 0, 0), (edge,) * 3, dp)],
                            scenes.grid(shape, (0, 0, 0), (room,) * 3, "202020", 1.0),
                            scenes.implicit(1.0, 1.0, more=f'min_step="1" stabilisation="{remedy:g}"',
                                            children=f'<Gravity ax="0" ay="0" az="{-LOAD / edge!r}"/>'),
                            [scenes.neo_hookean(1.0, 0.0, 1.0)], scenes.pictures(1.0))

        def measure(result):
            exact = -LOAD * (1 - result.column("z", 0) / edge)
            error = np.abs(result.column("SigmaZ") - exact).mean() / LOAD
            return {"error": error, **({"condition": condition(result.folder)} if solver == "none" else {})}

        return Run({"shape": shape, "reach": reach, "stabilisation": remedy, "solver": solver}, text, measure,
                   (shape, reach) == QUICK, options=(*CG, "-ksp_max_it", str(CAPS[solver]), *PRECONDITIONERS[solver]))

    def block(self, rows):
        text = []
        for shape in study.values(rows, "shape"):
            lines = []
            for reach in study.values(study.where(rows, shape=shape), "reach"):
                mine = study.where(rows, shape=shape, reach=reach)
                of = {(r["solver"], r["stabilisation"]): r for r in mine}
                line = [f"{reach:.0e}"]
                for solver, show in (("none", shown_condition), ("Jacobi", shown_iterations), ("multigrid", shown_iterations),
                                     ("multigrid", lambda r: study.shown(r, "error", ".2e"))):
                    line += [show(of[solver, remedy]) if (solver, remedy) in of else "–" for remedy in REMEDIES]
                lines.append(line)
            heads = [f"{what}, {how}" for what in ("condition", "Jacobi", "multigrid", "error") for how in ("with", "without")]
            text.append(f"**{shape}**: {summary(study.where(rows, shape=shape))}\n\n{study.table(['reach', *heads], lines)}")
        return "\n\n".join(text)


def summary(rows):
    """What the table of a shape function says, in a sentence for each remedy."""
    said = []
    for remedy in REMEDIES:
        parts = []
        for solver, what in (("none", "the condition is"), ("Jacobi", "the diagonal takes"), ("multigrid", "multigrid takes")):
            mine = study.where(rows, solver=solver, stabilisation=remedy)
            if not mine:
                continue
            found = [r["condition"] if solver == "none" else r["linear"] / r["newton"] for r in mine if study.done(r)]
            span = "{:.2g} to {:.2g}".format(min(found), max(found)) if found else ""
            left = f"{len(mine) - len(found)} of {len(mine)} systems are not solved" if len(found) < len(mine) else ""
            words = f"{what} {span}{'' if solver == 'none' else ' iterations'}" if span else f"with {solver}"
            parts.append(f"{words} ({left})" if span and left else f"{words} {left}" if left else words)
        if not parts:
            continue
        errors = [r["error"] for r in rows if r["stabilisation"] == remedy and study.done(r)]
        said.append(f"{'with' if remedy else 'without'} the stiffness {', '.join(parts)}"
                    + (f", and the error is at most {max(errors):.2e}" if errors else ""))
    return "; ".join(said) + "."


def shown_condition(row):
    return study.shown(row, "condition", ".1e") if study.done(row) else reason_of(row)


def shown_iterations(row):
    return f"{row['linear'] / row['newton']:.3g}" if study.done(row) else reason_of(row)


def reason_of(row):
    """PETSc's, without DIVERGED; that of the iterations as their number."""
    found = re.findall(r"DIVERGED_(\w+)", row["note"])
    return row["status"] if not found else f"> {CAPS[row['solver']]} it." if found[-1] == "ITS" else found[-1]


STUDY = Conditioning()
