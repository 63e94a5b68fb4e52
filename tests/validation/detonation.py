"""Explosives and gases in uniaxial strain: plane detonation of TNT, a plate driven by it, Sod's shock tube.

Targets, with MUSL: speed of the front within 1 % of D, peak within 5 % of the CJ pressure at the finest of three grids; the
plate within 5 % of Gurney's velocity at three ratios of the masses. Reported: the whole wave against the exact Taylor wave,
burn by compression, the plate against another method with the same laws, and the shock tube's L1 errors and their order.
tests/system/_blast.py has the scenes and their exact solutions."""

import dataclasses

import _common  # first: it says where the next ones are
import _blast
import _cases
import _mpm
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

FRONTS = {"burn": ("burn", ""), "algorithm": ("scheme", ""), "cells": ("cells", "d"), "split": ("particles along a cell", "d"),
          "factor": ("time step factor", "g"), "bq2": ("bq2", "g"), "D": ("front %", "+.2f"), "peak": ("peak pressure %", "+.1f"),
          "speed": ("peak velocity %", "+.1f"), "L1 p": ("L1 p %", ".1f"), "L1 u": ("L1 u %", ".1f"),
          "order p": ("order p", ".2f"), "order u": ("order u", ".2f"), "energy": ("energy drift %", "+.2f"), "steps": ("steps", "d"),
          "cpu": ("processor s", ".1f")}
PLATES = {"ratio": ("C/M", "g"), "lit": ("lit at", ""), "cells": ("cells", "d"), "split": ("particles along a cell", "d"),
          "expansion": ("end, explosive/D", "g"), "v": ("plate m/s", ".0f"), "lagrange": ("zones that move, m/s", ".0f"),
          "difference": ("difference %", "+.1f"), "henry": ("Gurney, 2440: %", "+.1f"), "kury": ("Gurney, 2370: %", "+.1f"),
          "growth": ("last quarter %", ".1f"), "energy": ("energy drift %", "+.1f"), "cpu": ("processor s", ".1f")}
TUBES = {"algorithm": ("scheme", ""), "split": ("particles along a cell", "d"), "factor": ("time step factor", "g"),
         "bq2": ("bq2", "g"), "cells": ("cells", "d"), "rho": ("density %", ".2f"), "p": ("pressure %", ".2f"),
         "v": ("velocity %", ".2f"), "order rho": ("order density", ".2f"), "order p": ("order pressure", ".2f"),
         "order v": ("order velocity", ".2f"), "energy": ("energy drift %", "+.2f"), "steps": ("steps", "d"), "cpu": ("processor s", ".1f")}
BURN = {0: "programmed and beta", 1: "beta", 2: "programmed"}


def run(case, out):
    """The case's row so far: its settings, its measures and its cost."""
    seconds = _common.run(out / "run", case.text())
    found = {name: float(value) for name, value in case.measure(out / "run").items()}
    return {**dataclasses.asdict(case), **found, "energy": 100 * found["energy"], "cpu": seconds,
            "steps": _mpm.summary(out / "run")["steps"]}


def show(row, columns):
    print(" ".join(f"{name}={row[name]:{how}}" for name, (_, how) in columns.items()), flush=True)


def orders(rows, names):
    """Observed orders, from each row's predecessor; not a number for the first."""
    for before, row in zip([None, *rows], rows):
        for name, error in names.items():
            row[f"order {name}"] = (np.nan if before is None else
                                    float(_cases.order([1 / before["cells"], 1 / row["cells"]], [before[error], row[error]])[0]))


# Detonation --------------------------------------------------------------------------------------------------------


def detonation(out, verdict):
    families = [{}, {"factor": 0.1}, {"split": 2}, {"split": 4}, {"split": 12}, {"bq2": 0.3}, {"beta": 0},
                {"beta": 1, "booster": 0.2, "bq2": 0.3}, {"beta": 1, "booster": 0.2}, {"algorithm": "USF"}, {"algorithm": "USL"}]
    rows, shown = [], []
    for family in families:
        of_family = []
        for cells in (100, 200, 400):
            case = _blast.Detonation(cells, **family)
            row = run(case, out)
            for name in ("D", "peak", "speed", "L1 p", "L1 u"):
                row[name] *= 100
            row["burn"] = BURN[case.beta]
            of_family.append(row)
            if not family:
                shown.append((case, case.means(case.profile(_cases.States(out / "run")))))
                verdict.expect(abs(row["D"]) < 1, f"detonation, {cells} cells: front {row['D']:+.2f} %")
        orders(of_family, {"p": "L1 p", "u": "L1 u"})
        for row in of_family:
            show(row, FRONTS)
        if not family:
            verdict.expect(abs(of_family[-1]["peak"]) < 5, f"detonation: peak {of_family[-1]['peak']:+.1f} %")
        rows += of_family
    _common.write(out, "detonation", rows, FRONTS)

    way, p, _ = _blast.Products().taylor_wave()
    figure, axis = plt.subplots(figsize=(7, 3.2), dpi=150, layout="constrained")
    for case, profile in shown:
        axis.plot(profile["x"], profile["p"] / 1e3, lw=0.8, label=f"{case.cells} cells")
    end = shown[0][0].end
    axis.plot([*(way * end), way[-1] * end, 100], [*(p / 1e3), 0, 0], "k--", lw=0.9, label="exact")
    axis.set(xlabel="x, mm", ylabel="pressure, GPa", title="TNT, lit along a wall")
    axis.legend(fontsize=8)
    figure.savefig(out / "detonation.png")


# Driven plate ------------------------------------------------------------------------------------------------------


def sandwich(out, verdict):
    how = [{"ratio": ratio} for ratio in (0.5, 1.0, 2.0)]
    how += [{"ratio": 1.0, "cells": cells} for cells in (25, 50, 200)] + [{"ratio": 1.0, "split": split} for split in (2, 6)]
    how += [{"ratio": ratio, "expansion": 24.0, "cells": 50} for ratio in (0.5, 1.0, 2.0)]
    how += [{"ratio": ratio, "lit": "plate"} for ratio in (0.5, 1.0, 2.0)]
    rows = []
    for settings in how:
        case = _blast.Sandwich(**settings)
        row = run(case, out)
        row["lagrange"] = float(case.lagrange())
        row["difference"] = 100 * (row["v"] / row["lagrange"] - 1)
        row["henry"], row["kury"] = (100 * (row["v"] / case.gurney(speed) - 1) for speed in (2440.0, 2370.0))
        row["growth"] *= 100
        rows.append(row)
        show(row, PLATES)
        if set(settings) == {"ratio"}:
            verdict.expect(abs(row["henry"]) < 5, f"plate, C/M {case.ratio:g}: {row['henry']:+.1f} % off Gurney")
            verdict.expect(abs(row["difference"]) < 1, f"plate, C/M {case.ratio:g}: {row['difference']:+.1f} % off moving zones")
        verdict.expect(row["momentum"] < 1e-12, f"plate, {settings}: momentum {row['momentum']:.1e}")
    _common.write(out, "sandwich", rows, PLATES)


# Shock tube --------------------------------------------------------------------------------------------------------


def shock_tube(out, verdict):
    families = [{}, {"factor": 0.1}, {"split": 4}, {"split": 8}, {"bq2": 0.3}, {"algorithm": "USF"}, {"algorithm": "USL"}]
    rows = []
    figure, axes = plt.subplots(1, 3, figsize=(10, 3), dpi=150, layout="constrained")
    for family in families:
        of_family = []
        for cells in (100, 200, 400):
            case = _blast.ShockTube(cells, **family)
            row = run(case, out)
            for name in ("rho", "p", "v"):
                row[name] *= 100
            of_family.append(row)
            if not family and cells != 200:
                found, exact = case.profile(_cases.States(out / "run"))
                for axis, (name, title) in zip(axes, (("rho", "density"), ("p", "pressure"), ("v", "velocity"))):
                    axis.plot(found["x"], found[name], lw=0.8, label=f"{cells} cells")
                    if cells == 400:
                        axis.plot(found["x"], exact[name], "k--", lw=0.8, label="exact")
                    axis.set(title=title, xlabel="x")
        orders(of_family, {"rho": "rho", "p": "p", "v": "v"})
        for row in of_family:
            show(row, TUBES)
        if not family:
            for name in ("rho", "p", "v"):
                verdict.expect(min(row[f"order {name}"] for row in of_family[1:]) > 0.7, f"shock tube: order of {name}")
        rows += of_family
    axes[0].legend(fontsize=8)
    figure.savefig(out / "shock_tube.png")
    _common.write(out, "shock_tube", rows, TUBES)


def main():
    parser = _common.arguments(__doc__, "detonation")
    parser.add_argument("--parts", nargs="+", choices=("detonation", "sandwich", "shock_tube"),
                        default=["detonation", "sandwich", "shock_tube"])
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    for part in options.parts:
        globals()[part](options.out, verdict)
        print(flush=True)
    verdict.finish()


main()
