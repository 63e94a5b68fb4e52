"""A plane shock in copper against Us = c0 + s up and the jump conditions; its front and the noise behind it.

Targets, with MUSL at 0.2, 0.5 and 1 km/s: shock speed and mean pressure, density and energy of the plateau within 1 %.
The copper is without strength (Null), so nothing needs correcting; tests/system/_cases.py has the scene and says how
the means are taken. Reported: width of the front (10 to 90 % of the normal stress), overshoot at it, and the ripple
behind it (standard deviation of the pressure), over the cell size, the particles per cell, the viscosity and the scheme."""

import _common  # first: it says where the next one is
import _cases
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SPEEDS = (200.0, 500.0, 1000.0)
COLUMNS = {"speed": ("up m/s", "g"), "scheme": ("scheme", ""), "factor": ("time step factor", "g"), "cell": ("cell mm", "g"),
           "split": ("particles along a cell", "d"), "bq1": ("bq1", "g"), "bq2": ("bq2", "g"), "Us": ("Us %", "+.2f"),
           "p": ("p %", "+.2f"), "rho": ("density %", "+.3f"), "e": ("energy %", "+.2f"), "width": ("front, cells", ".1f"),
           "overshoot": ("overshoot %", ".0f"), "ripple": ("ripple %", ".0f")}


def measure(out, **how):
    shock = _cases.Shock(**how)
    folder = out / "run"
    seconds = _common.run(folder, shock.text())
    found = shock.measure(folder)
    profile = shock.profiles(_cases.States(folder))
    row = {"speed": shock.speed, "scheme": shock.algorithm, "factor": shock.factor, "cell": shock.cell, "split": shock.split,
           "bq1": shock.bq1, "bq2": shock.bq2, **{k: 100 * float(e) for k, e in found["error"].items()},
           "width": float(found["width"]), "overshoot": 100 * float(found["overshoot"]), "ripple": 100 * float(found["ripple"]),
           "cpu_seconds": seconds}
    print(" ".join(f"{k}={row[k]:{f}}" for k, (_, f) in COLUMNS.items()), flush=True)
    return row, shock, profile


def plot(shown, path):
    figure, axes = plt.subplots(len(shown), 1, figsize=(7, 2.2 * len(shown)), dpi=150, sharex=True, layout="constrained")
    for axis, (shock, profile) in zip(axes, shown):
        exact = shock.exact()
        axis.plot(profile["X"], profile["stress"] / 1e3, lw=0.7, label="computed, -SigmaX")
        axis.plot([0, 0.8 * shock.length, 0.8 * shock.length, shock.length], [exact["p"] / 1e3] * 2 + [0, 0], "k--", lw=0.9,
                  label="jump conditions")
        axis.set_ylabel("GPa")
        axis.set_title(f"up = {shock.speed:g} m/s", fontsize=9)
    axes[0].legend(fontsize=8)
    axes[-1].set_xlabel("first place of the particles X, mm")
    figure.savefig(path)


def main():
    options = _common.arguments(__doc__, "plane_shock").parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    rows, shown = [], []
    for speed in SPEEDS:
        row, shock, profile = measure(options.out, speed=speed, across=2)
        rows.append(row)
        shown.append((shock, profile))
        for name in ("Us", "p", "rho", "e"):
            verdict.expect(abs(row[name]) < 1, f"{speed:g} m/s: {name} {row[name]:+.2f} %, asked for 1 %")
    plot(shown, options.out / "plane_shock.png")

    vary = [{"cell": 2.0}, {"cell": 0.5},
            {"split": 2}, {"split": 3}, {"split": 4}, {"split": 8},
            {"factor": 0.9}, {"factor": 0.4}, {"factor": 0.1},
            {"bq2": 0.0}, {"bq2": 0.2}, {"bq2": 0.5}, {"bq1": 0.0, "bq2": 0.0}, {"bq1": 4.0},
            *({"algorithm": scheme, "factor": factor} for scheme in ("USF", "USL") for factor in (0.9, 0.2, 0.1))]
    rows += [measure(options.out, speed=500.0, **how)[0] for how in vary]
    rows += [measure(options.out, speed=speed, split=2)[0] for speed in (200.0, 1000.0)]
    print()
    _common.write(options.out, "plane_shock", rows, COLUMNS)
    verdict.finish()


main()
