"""report.py OUTDIR: the Taylor bar in OUTDIR compared with the experiment, as a table and a picture.

How L, D and W are measured: bar.py beside this file."""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import bar as taylor

SURFACE = "#333333"
FIRST = "#8a8a8a"
COLOURS = "Spectral_r"


def many(count, thing):
    return f"{count} {thing}" + ("s" if count != 1 else "")


def table(bar):
    sizes = bar.sizes
    relative, mean = taylor.errors(sizes)
    s = bar.summary
    lines = [
        f"Taylor bar: {s['particles']} particles, {s['steps']} steps to {1e3 * bar.time:.4g} us "
        f"in {s['wall_seconds']['loop']:.1f} s on {many(s['ranks'], 'rank')} of {many(s['threads'], 'thread')}",
        "",
        "               " + "".join(f"{name:>9}" for name in sizes),
        "  experiment   " + "".join(f"{taylor.EXPERIMENT[name]:9.2f}" for name in sizes) + "  mm",
        "  computed     " + "".join(f"{value:9.2f}" for value in sizes.values()) + "  mm",
        "  error        " + "".join(f"{100 * relative[name]:+9.2f}" for name in sizes) + "  %",
        "",
        f"  mean error   {100 * mean:9.2f}  %",
        f"  energy drift {100 * s['energy']['relative_drift']:+9.3f}  %",
        f"  largest effective plastic strain {s['bodies'][0]['max_epef']:.2f}",
        "",
        "  L: length; D: widest diameter at the foot; W: diameter 5.08 mm above the wall. Measured on the image of the",
        "  bar's surface, by the motion of the particles beside it; D and W are means over all directions.",
    ]
    if s["status"] != "completed":
        lines.append(f"\n  The run did not reach its end: {s['status']}, {s['reason']}")
    return "\n".join(lines)


def section(bar):
    """The particles beside the plane y = 0 as quadrilaterals (x, z) that fill it, and their plastic strain."""
    lattice = bar.lattice
    h = lattice.spacing
    front = np.flatnonzero(np.abs(lattice.first[:, 1] - 0.5 * h) < 0.25 * h)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 0.5 * h
    first = lattice.first[front]
    ends = first[:, None, :] + np.stack([corners[:, 0], np.zeros(4), corners[:, 1]], axis=-1)
    ends[..., 1] = 0
    # A corner outside the nominal bar is projected onto its surface.
    ends[..., 0] = np.clip(ends[..., 0], -taylor.DIAMETER / 2, taylor.DIAMETER / 2)
    ends[..., 2] = np.clip(ends[..., 2], 0, taylor.LENGTH)
    unique, place = np.unique(np.round(ends.reshape(-1, 3), 6), axis=0, return_inverse=True)
    image = lattice.carry(unique, bar.now)[place.ravel()]
    return image[:, [0, 2]].reshape(-1, 4, 2), bar.plastic_strain[front]


def dimension(axes, start, end, text, where, **more):
    axes.annotate("", start, end, arrowprops={"arrowstyle": "|-|,widthA=0.25,widthB=0.25", "lw": 0.9, "color": SURFACE,
                                              "shrinkA": 0, "shrinkB": 0})
    axes.text(*where, text, color=SURFACE, fontsize=8.5, **more)


def draw_section(axes, bar, top_strain):
    quads, strain = section(bar)
    filled = PolyCollection(quads, array=strain, cmap=COLOURS, edgecolors="face", linewidths=0.3)
    filled.set_clim(0, top_strain)
    axes.add_collection(filled)
    r, l = taylor.DIAMETER / 2, taylor.LENGTH
    axes.plot([-r, -r, r, r], [0, l, l, 0], ls=(0, (5, 4)), lw=0.9, color=FIRST)
    axes.text(0, l + 0.4, "first shape", ha="center", va="bottom", fontsize=8.5, color=FIRST)
    axes.axhline(0, color=SURFACE, lw=1.4)

    sizes = bar.sizes
    e = taylor.EXPERIMENT
    height, waist, foot = sizes["L"], sizes["W"] / 2, sizes["D"] / 2
    dimension(axes, (-8.6, 0), (-8.6, height), f"L {height:.2f}\n({e['L']})", (-8.9, height / 2), ha="right", va="center")
    dimension(axes, (-waist, taylor.W_HEIGHT), (waist, taylor.W_HEIGHT), f"W {2 * waist:.2f} ({e['W']})",
              (waist + 0.4, taylor.W_HEIGHT), ha="left", va="center")
    dimension(axes, (-foot, -1.0), (foot, -1.0), f"D {2 * foot:.2f} ({e['D']})", (0, -1.5), ha="center", va="top")
    axes.set_xlim(-12.2, 12.2)
    axes.set_ylim(-3.0, 27.5)
    axes.set_aspect("equal")
    axes.set_xlabel("x, mm")
    axes.set_ylabel("z, mm")
    axes.set_title("section through the axis; in brackets the experiment", fontsize=9.5)
    return filled


class Eye:
    """Parallel projection, seen from `azimuth` and `height` degrees."""

    def __init__(self, azimuth=-60, height=20):
        a, h = np.radians([azimuth, height])
        self.right = np.array([-np.sin(a), np.cos(a), 0])
        self.up = np.array([-np.sin(h) * np.cos(a), -np.sin(h) * np.sin(a), np.cos(h)])
        self.towards = np.array([np.cos(h) * np.cos(a), np.cos(h) * np.sin(a), np.sin(h)])
        self.light = 0.55 * self.towards - 0.55 * self.right + 0.63 * self.up

    def see(self, points):
        return np.stack([points @ self.right, points @ self.up], axis=-1)


def surface_of(bar, directions=144):
    """Facets (n, 4, 3) of side and end face, counter-clockwise from outside, and their plastic strain."""
    around = [np.vstack([a, a[:1]]) for a in bar.side(directions)]
    inward = np.linspace(1, 0, 9)[1:]
    radius = np.hstack([around[0], around[0][:, -1:] * inward])
    height, strain = (np.hstack([a, np.repeat(a[:, -1:], len(inward), axis=1)]) for a in around[1:])
    turn = 2 * np.pi * np.arange(directions + 1)[:, None] / directions
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1)
    facets = np.stack([points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]], axis=2)
    return facets.reshape(-1, 4, 3), (0.5 * (strain[:-1, :-1] + strain[:-1, 1:])).ravel()


def draw_solid(axes, bar, top_strain):
    """The surface from outside, in the colours of its plastic strain; the wall, and the initial shape as lines."""
    eye = Eye()
    facets, strain = surface_of(bar)
    normal = np.cross(facets[:, 2] - facets[:, 0], facets[:, 3] - facets[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-12)
    seen = np.flatnonzero(normal @ eye.towards > 0)
    seen = seen[np.argsort(facets[seen].mean(axis=1) @ eye.towards)]
    colour = matplotlib.colormaps[COLOURS](np.clip(strain[seen] / top_strain, 0, 1))
    colour[:, :3] *= (0.70 + 0.30 * np.clip(normal[seen] @ eye.light, 0, 1))[:, None]

    wall = 8.2 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    axes.add_patch(plt.Polygon(eye.see(wall), facecolor="#f2f2f2", edgecolor=SURFACE, lw=1.0))
    r, l = taylor.DIAMETER / 2, taylor.LENGTH
    turn = np.linspace(0, 2 * np.pi, 181)
    dashed = {"color": FIRST, "lw": 0.9, "ls": (0, (5, 4))}
    axes.plot(*eye.see(np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full_like(turn, l)])).T, **dashed)
    for sign in (-1, 1):
        axes.plot(*eye.see(np.array([[0, 0, 0], [0, 0, l]]) + sign * r * eye.right).T, **dashed)
    axes.add_collection(PolyCollection(eye.see(facets[seen]), facecolors=colour, edgecolors=colour, linewidths=0.4, zorder=3))
    axes.set_aspect("equal")
    axes.set_axis_off()


def picture(bar, path):
    top_strain = np.ceil(bar.plastic_strain.max() * 10) / 10
    figure = plt.figure(figsize=(10.5, 6.4), dpi=160)
    left = figure.add_axes([0.06, 0.085, 0.46, 0.83])
    right = figure.add_axes([0.53, 0.085, 0.36, 0.83])
    filled = draw_section(left, bar, top_strain)
    draw_solid(right, bar, top_strain)
    # The same scale as the section's, and room for all of the wall.
    right.set_ylim(np.array(left.get_ylim()) - 2.2)
    right.set_xlim(-11.5, 11.5)
    scale = figure.colorbar(filled, cax=figure.add_axes([0.915, 0.20, 0.017, 0.56]))
    scale.set_label("effective plastic strain")
    figure.suptitle(f"Copper Taylor bar, 190 m/s, after {1e3 * bar.time:.3g} us; {bar.summary['particles']} particles",
                    fontsize=11, y=0.985)
    figure.savefig(path)
    plt.close(figure)


def main(folder):
    bar = taylor.Bar(folder)
    print(table(bar))
    path = pathlib.Path(folder) / f"{bar.summary['job']}.png"
    picture(bar, path)
    files = [f"  picture  {path}", f"  ParaView {bar.h5part}"]
    movie = pathlib.Path(folder) / f"{bar.summary['job']}.pvd"
    if movie.exists():
        files.append(f"           {movie}")
    print("\n" + "\n".join(files))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    main(sys.argv[1])
