"""Shape of a Taylor bar, measured as the image of its initial surface.

The outermost particles are half a particle size inside the surface, and the impact changes that size. The measure is
therefore the image of the nominal surface (a cylinder of LENGTH and DIAMETER): near each of its points the motion x(X)
is fitted by an affine map to the particles with initial positions X within REACH spacings, and that map moves the
point. In the middle of the bar this adds half of the local particle spacing to the outermost centres; it also smooths
the steps of a lattice cut to a circle. The same for every model and scheme.

  L  height of the end face, mean over the face
  D  widest diameter near the foot, mean over the directions
  W  diameter at the height 0.2 LENGTH above the wall, mean over the directions

Experiment: G. R. Johnson and T. J. Holmquist (1988), as quoted in P. Huang's thesis (Tsinghua, 2010), table 5.1.
"""

import functools
import json
import pathlib

import h5py
import numpy as np

LENGTH, DIAMETER = 25.4, 7.6  # mm
EXPERIMENT = {"L": 16.2, "D": 13.5, "W": 10.1}  # mm
W_HEIGHT = 0.2 * LENGTH
REACH = 2.0  # spacings: a dozen particles even at the rim of the foot


class Lattice:
    """The particles by their initial positions, which are nodes of a cubic lattice."""

    def __init__(self, first):
        self.first = first
        levels = np.unique(np.round(first[:, 2], 4))
        self.spacing = (levels[-1] - levels[0]) / (len(levels) - 1)
        self.low = first.min(axis=0)
        index = np.rint((first - self.low) / self.spacing).astype(int)
        self.shape = index.max(axis=0) + 1
        self.number = np.full(self.shape + 2, -1)  # one layer of nothing around
        self.number[tuple((index + 1).T)] = np.arange(len(first))
        self.index = index

    def at(self, index):
        """Indices of the particles at these lattice sites, -1 where there is none."""
        return self.number[tuple(np.moveaxis(np.clip(index + 1, 0, self.shape + 1), -1, 0))]

    def carry(self, points, now, values=None):
        """Current positions of points of the initial configuration; with values, also these (affine fit)."""
        fields = now if values is None else np.column_stack([now, values])
        centre = np.rint((points - self.low) / self.spacing).astype(int)
        span = np.arange(-3, 4)
        offsets = np.stack(np.meshgrid(span, span, span, indexing="ij"), axis=-1).reshape(-1, 3)
        carried = np.empty((len(points), fields.shape[1]))
        for some in np.array_split(np.arange(len(points)), max(1, len(points) // 4096)):
            near = self.at(centre[some, None, :] + offsets)
            away = (self.first[near] - points[some, None, :]) / self.spacing
            weight = np.where(near < 0, 0, np.maximum(0, 1 - (away**2).sum(axis=-1) / REACH**2))
            basis = np.concatenate([np.ones_like(away[..., :1]), away], axis=-1)
            normal = np.einsum("pn,pni,pnj->pij", weight, basis, basis)
            right = np.einsum("pn,pni,pnf->pif", weight, basis, fields[near])
            carried[some] = np.linalg.solve(normal, right)[:, 0]
        return carried


def steps_of(h5part):
    return sorted((name for name in h5part if name.startswith("Step#")), key=lambda name: int(name[5:]))


def read_step(step, names):
    """Columns of one time in the order of the particles' identities."""
    order = np.argsort(step["id"][:])
    return [step[name][:][order].astype(float) for name in names]


class Bar:
    """The last state in an output folder of mpm_run."""

    def __init__(self, folder):
        folder = pathlib.Path(folder)
        self.summary_file = one_file(folder, "*.summary.json")
        self.summary = json.loads(self.summary_file.read_text())
        self.h5part = one_file(folder, self.summary["job"] + ".h5part")
        with h5py.File(self.h5part) as file:
            steps = steps_of(file)
            self.lattice = Lattice(np.column_stack(read_step(file[steps[0]], "xyz")))
            self.now = np.column_stack(read_step(file[steps[-1]], "xyz"))
            (self.plastic_strain,) = read_step(file[steps[-1]], ["epef"])
            self.time = float(file[steps[-1]].attrs["TimeValue"])
        if len(self.now) != len(self.lattice.first):
            raise SystemExit(f"{self.h5part}: the bar has lost particles; it cannot be measured")

    def side(self, directions=72):
        """Image of the side: arrays (directions, levels) of radius, height and plastic strain."""
        angle = 2 * np.pi * np.arange(directions) / directions
        level = np.linspace(0, LENGTH, int(round(2 * LENGTH / self.lattice.spacing)) + 1)
        a, z = (grid.ravel() for grid in np.meshgrid(angle, level, indexing="ij"))
        points = np.column_stack([DIAMETER / 2 * np.cos(a), DIAMETER / 2 * np.sin(a), z])
        image = self.lattice.carry(points, self.now, self.plastic_strain)
        grid = (directions, len(level))
        return np.hypot(image[:, 0], image[:, 1]).reshape(grid), image[:, 2].reshape(grid), image[:, 3].reshape(grid)

    def end_face(self, directions=24, rings=8):
        """Image of the end face: heights at the middles of parts of equal area."""
        a, r = np.meshgrid(2 * np.pi * np.arange(directions) / directions,
                           DIAMETER / 2 * np.sqrt((np.arange(rings) + 0.5) / rings))
        points = np.column_stack([(r * np.cos(a)).ravel(), (r * np.sin(a)).ravel(), np.full(a.size, LENGTH)])
        return self.lattice.carry(points, self.now)[:, 2]

    @functools.cached_property
    def sizes(self):
        """L, D and W in mm."""
        radius, height, _ = self.side()
        waist = [np.interp(W_HEIGHT, z, r) for r, z in zip(radius, height)]
        return {"L": self.end_face().mean(), "D": 2 * radius.max(axis=1).mean(), "W": 2 * np.mean(waist)}


def errors(sizes):
    """Relative errors of L, D and W, and the mean of their absolute values (thesis, table 5.1)."""
    relative = {name: sizes[name] / EXPERIMENT[name] - 1 for name in EXPERIMENT}
    return relative, sum(abs(e) for e in relative.values()) / len(relative)


def one_file(folder, pattern):
    found = sorted(folder.glob(pattern))
    if len(found) != 1:
        raise SystemExit(f"{folder}: expected one {pattern}, found {len(found)}; run mpm_run --output-dir {folder} first")
    return found[0]
