"""What the cases share: pieces of input files and readers of results."""

import numpy as np

from case import Unmeasurable  # first: it says where the next ones are

import _cases
import _mpm


class States(_cases.States):
    """As there; all particles must be there at the end."""

    def __init__(self, folder):
        super().__init__(folder)
        lost = len(self.steps[0]["id"]) - len(self.steps[-1]["id"])
        if lost:
            raise Unmeasurable(f"{lost} particles have left the grid")


def material(name, density, strength, equation=""):
    return _mpm.material(name, density, strength, equation)


def block(name, lower, size, dp, of, loads="", attributes=""):
    """A block at rest, or with the InitialVelocity that `loads` hold."""
    geometry = 'x0="{!r}" y0="{!r}" z0="{!r}" lx="{!r}" ly="{!r}" lz="{!r}"'.format(*map(float, (*lower, *size)))
    return (f'<Body name="{name}" material="{of}" type="Block" {attributes}><Geometry dp="{dp!r}" {geometry}/>'
            f"{loads}</Body>")


def grid(lower, upper, faces, cell):
    return _mpm.grid([float(v) for v in lower], [float(v) for v in upper], faces, float(cell))


def solution(end, factor, more=""):
    return _mpm.solution(repr(float(end)), factor=repr(float(factor)), more=more)


def averages(point, relaxation=None):
    """The element of studies with averages, averaged or relaxed by their names; `relaxation` of those that relax."""
    relaxed = "relaxed" in point.study
    if not relaxed and "averaged" not in point.study:
        return ""
    return f'<Volumetric averaging="cell" relaxation="{relaxation}"/>' if relaxed else '<Volumetric averaging="cell"/>'


def pictures(interval, variables):
    return f'<PostProcessing time_interval="{interval!r}" h5part="1" var="{"|".join(variables)}"/>'


def scene(bodies, grid_, solution_, materials, output):
    return _mpm.scene(bodies, grid_, solution_, materials, output)


def columns(states, names, which=-1):
    return np.column_stack([states.column(name, which) for name in names])


def places(states, which=-1):
    return columns(states, "xyz", which)


def velocities(states, which=-1):
    return columns(states, [f"velocity_{a}" for a in range(3)], which)


def stresses(states, which=-1):
    """Symmetric matrices (particles, 3, 3)."""
    xx, yy, zz, xy, yz, xz = (states.column(f"Sigma{a}", which) for a in ("X", "Y", "Z", "XY", "YZ", "XZ"))
    return np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), -1, 0)


STRESSES = ["SigmaX", "SigmaY", "SigmaZ", "SigmaXY", "SigmaYZ", "SigmaXZ"]


def rms(values):
    """Root of the mean over the particles of the squared length of a vector or matrix."""
    return float(np.sqrt((np.asarray(values) ** 2).reshape(len(values), -1).sum(axis=1).mean()))


def off_mean_of_cell(values, cells):
    """Deviation of each particle's value from the mean in its cell (`cells`: a number each), and the cell's particles."""
    _, at = np.unique(cells, return_inverse=True)
    count = np.bincount(at)
    return values - (np.bincount(at, values) / count)[at], count[at]


def summary(folder):
    return _mpm.summary(folder)


def status(folder):
    return _cases.status(folder)


def drift(folder):
    return summary(folder)["energy"]["relative_drift"]


def neo_hookean(gradient, solid):
    """Cauchy stresses of deformation gradients (particles, 3, 3)."""
    j = np.linalg.det(gradient)[:, None, None]
    left = gradient @ np.swapaxes(gradient, 1, 2)
    one = np.eye(3)
    return (solid.lame * np.log(j) * one + solid.shear * (left - one)) / j
