"""The Taylor bar of apps/scenes/taylor_bar_on_a_plate with other cells and contact, and its shape after the rebound."""

import sys

import _cases
import _gallery
import _mpm
import h5py
import numpy as np

sys.path.insert(0, str(_mpm.SOURCE / "benchmarks/taylor_bar"))

import bar as taylor  # noqa: E402: found by the line above

JOB = "taylor_bar_on_a_plate"


class Bar(taylor.Bar):
    """The last state of the bar, without the plate; heights from the foot, which may be above the plate."""

    def __init__(self, folder):
        self.summary = _mpm.summary(folder, JOB)
        with h5py.File(folder / f"{JOB}.h5part") as file:
            names = taylor.steps_of(file)
            first = np.column_stack(taylor.read_step(file[names[0]], "xyz"))
            now = np.column_stack(taylor.read_step(file[names[-1]], "xyz"))
            (strain,) = taylor.read_step(file[names[-1]], ["epef"])
        mine = first[:, 2] > 0
        self.lattice, self.now, self.plastic_strain = taylor.Lattice(first[mine]), now[mine], strain[mine]
        angle = 2 * np.pi * np.arange(24) / 24
        foot = np.column_stack([taylor.DIAMETER / 4 * np.cos(angle), taylor.DIAMETER / 4 * np.sin(angle), 0 * angle])
        self.height = self.lattice.carry(foot, self.now)[:, 2].mean()
        self.now[:, 2] -= self.height


def text(layers, shape="linear", normal="regression", kind=0, end=0.2):
    """`layers`: particles along the bar; the plate's size is the nearest whole number of cells."""
    spacing = taylor.LENGTH / layers
    cell = 2 * spacing
    half, height = round(11.4 / cell), -(-layers // 2) + 4
    changes = _gallery.resolution(cell, shape, normal, kind)
    del changes[".//Geometry"]
    changes |= {".//Body[@name='bar']/Geometry": {"dp_bottom": spacing, "dp_top": spacing},
                ".//Body[@name='plate']/Geometry": {"x0": -half * cell, "y0": -half * cell, "z0": -2 * cell, "dp": spacing,
                                                    "lx": 2 * half * cell, "ly": 2 * half * cell, "lz": 2 * cell},
                ".//ZMin": {"value": -2 * cell}, ".//ZMax": {"value": height * cell}, ".//EndTime": {"value": end},
                ".//PostProcessing": {"time_interval": end, "vtk_data": 0}}
    for axis in "XY":
        changes |= {f".//{axis}Min": {"value": -half * cell}, f".//{axis}Max": {"value": half * cell}}
    return _gallery.text(_gallery.scene(JOB), changes)


def measure(folder):
    """L, D and W in mm, mean errors of L and D and of all three in percent, the bar's velocity at the end, its height above
    the plate, and the row before the last mean force."""
    bar, status = Bar(folder), _cases.status(folder, JOB)
    relative, mean = taylor.errors(bar.sizes)
    forces = _gallery.acting(status["fz[contact:plate]"])
    return {"particles": len(bar.now), "steps": bar.summary["steps"], **{name: float(size) for name, size in bar.sizes.items()},
            "error_LD": 50 * float(abs(relative["L"]) + abs(relative["D"])), "mean_error": 100 * float(mean),
            "parted": 1e3 * float(status["time"][forces[-1] - 1]), "speed": float(status["vz[body:bar]"][-1]),
            "height": float(bar.height), "drift": 100 * bar.summary["energy"]["relative_drift"]}
