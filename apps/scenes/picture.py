"""A picture of a scene's particles in the plane of its middle, x and z, at a few times, in colours of one variable:

    picture.py FOLDER [--times 0 0.05 0.1 0.2] [--variable seqv] [--window X0 X1 Z0 Z1] [--half | --quarter | --plan]
               [--out PICTURE.png]

FOLDER: of a run of mpm_run with h5part="1" and the variable among its outputs. The default is four times of those that
the run wrote, from the first to the last."""

import argparse
import pathlib

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--times", nargs="+", type=float)
    parser.add_argument("--variable", default="seqv")
    parser.add_argument("--window", nargs=4, type=float, metavar=("X0", "X1", "Z0", "Z1"), help="what is shown (with --plan Y for Z); default: all")
    parser.add_argument("--half", action="store_true", help="the scene has a symmetry plane at y = 0: the layer next to it")
    parser.add_argument("--quarter", action="store_true", help="the scene is a quarter between symmetry planes at x = 0 and y = 0: the layer next to y = 0, and its image")
    parser.add_argument("--plan", action="store_true", help="from above: x and y, the layer in the middle along z")
    parser.add_argument("--out", type=pathlib.Path, help="default: JOB.png in the folder")
    options = parser.parse_args()
    files = sorted(options.folder.glob("*.h5part"))
    if len(files) != 1:
        raise SystemExit(f"{options.folder}: expected one .h5part file, found {len(files)}; run mpm_run --output-dir {options.folder} first")
    with h5py.File(files[0]) as file:
        steps = sorted((step for name, step in file.items() if name.startswith("Step#")), key=lambda step: int(step.name[6:]))
        written = np.array([float(step.attrs["TimeValue"]) for step in steps])
        times = options.times or np.linspace(written[0], written[-1], 4)
        shown = [steps[np.abs(written - time).argmin()] for time in times]
        if options.variable not in shown[0]:
            raise SystemExit(f"{files[0]}: no variable {options.variable}; it has {', '.join(shown[0])}")
        slices = [middle(step, options.variable, "xzy" if options.plan else "xyz", options.half, options.quarter) for step in shown]
        titles = [f"t = {float(step.attrs['TimeValue']):g}" for step in shown]
    draw(slices, titles, options.variable, options.window, options.out or files[0].with_suffix(".png"), "y" if options.plan else "z")


def middle(step, variable, axes, half, quarter):
    """The first axis, the last one and the variable of the layer of particles next to the middle along the second one, drawn from the rear to
    the front."""
    x, y, z, value = (step[name][:].astype(float) for name in (*axes, variable))
    centre = 0 if half or quarter else (y.min() + y.max()) / 2
    thick = 1.5 * np.cbrt(np.ptp(x) * np.ptp(y) * np.ptp(z) / len(x))
    near = np.flatnonzero(np.abs(y - centre) <= thick)
    near = near[np.argsort(-y[near])]
    x, z, value = x[near], z[near], value[near]
    return (np.append(-x, x), np.append(z, z), np.append(value, value)) if quarter else (x, z, value)


def spacing(x, z):
    """The distance of neighbours: the median over a few hundred particles."""
    some = np.random.default_rng(1).integers(len(x), size=300)
    apart = np.hypot(x[some, None] - x, z[some, None] - z)
    apart[apart == 0] = np.inf
    return np.median(apart.min(axis=1))


def draw(slices, titles, variable, window, path, upwards):
    (x0, x1), (z0, z1), (low, high) = ((min(part.min() for part in parts), max(part.max() for part in parts)) for parts in zip(*slices))
    apart = spacing(*slices[0][:2])
    x0, x1, z0, z1 = window or (x0 - apart, x1 + apart, z0 - apart, z1 + apart)
    width = 3.2 * len(slices)
    figure, axes = plt.subplots(1, len(slices), figsize=(width, 1.1 + 3.0 * (z1 - z0) / (x1 - x0)), dpi=150, squeeze=False,
                                layout="constrained", sharey=True)
    dot = max(1.2, 0.7 * apart / (x1 - x0) * 0.8 * 72 * width / len(slices))  # points; neighbours do not quite touch
    for ax, (x, z, value), title in zip(axes[0], slices, titles):
        points = ax.scatter(x, z, c=value, s=dot**2, vmin=low, vmax=high, cmap="viridis", linewidths=0)
        ax.set(xlim=(x0, x1), ylim=(z0, z1), aspect="equal", title=title, xlabel="x")
    axes[0][0].set_ylabel(upwards)
    figure.colorbar(points, ax=axes, label=variable)
    figure.savefig(path)
    print(path)


main()
