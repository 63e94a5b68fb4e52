"""The lead sphere and plate of apps/scenes/lead_on_lead with other cells, spacings, shapes and laws, and the size of the debris."""

import math

import _cases
import _gallery
import _mpm
import numpy as np

JOB = "lead_on_lead"
END = 30.6e-3  # ms


def text(cell, spacing=0.53, shape="linear", full=False, end=END, factor=0.9, width=140, changes=None):
    """`full`: without symmetry planes; `width`: of the plate."""
    layers, half = round(6.36 / spacing), round(width / 2 / spacing)
    thick, side = layers * spacing, half * spacing
    far, low, high = (math.ceil(x / cell) * cell for x in (212, 318, 212))
    every = {".//Geometry": {"dp": spacing}, ".//DCell": dict.fromkeys(("dx", "dy", "dz"), cell), ".//Grid": {"shape": shape},
             ".//Body[@name='plate']/Geometry": {"z0": -thick, "lz": thick, "lx": side, "ly": side},
             ".//XMax": {"value": far}, ".//YMax": {"value": far}, ".//ZMin": {"value": -low}, ".//ZMax": {"value": high},
             ".//EndTime": {"value": end}, ".//Console": {"print_time": end / 100},
             ".//PostProcessing": {"time_interval": end, "vtk_data": 0}, ".//TimeStep": {"factor": factor}}
    if full:
        every[".//Body[@name='sphere']/Geometry"] = {"angle": 360}
        every[".//Body[@name='plate']/Geometry"] |= {"x0": -side, "y0": -side, "lx": 2 * side, "ly": 2 * side}
        every |= {".//XMin": {"value": -far, "boundary": 0}, ".//YMin": {"value": -far, "boundary": 0}}
    root = _gallery.scene(JOB)
    return _gallery.text(root, every | (changes or {}))


def measure(folder, spacing=0.53):
    """Of the cloud that has left the plate's rear by 20 mm: `front`, distance from the rear, and `width`, of its shadow on a film
    along a wall of the grid: of all particles, and without the farthest thousandth and hundredth of its mass."""
    states, status, summary = _cases.States(folder, JOB), _cases.status(folder, JOB), _mpm.summary(folder, JOB)
    first, now = (np.column_stack([states.column(axis, which) for axis in "xyz"]) for which in (0, -1))
    first = first[np.isin(states.column("id", 0), states.column("id"))]  # some may have left the grid
    rear = first[:, 2].min() - spacing / 2
    cloud = now[:, 2] < rear - 20
    ahead, aside = rear - now[cloud, 2], np.abs(now[cloud, :2]).ravel()
    found = {"particles": summary["particles"], "steps": summary["steps"]}
    for name, part in (("", 1), ("_999", 0.999), ("_99", 0.99)):
        found |= {f"front{name}": float(np.quantile(ahead, part)), f"width{name}": 2 * float(np.quantile(aside, part))}
    sphere = first[:, 2] > 0
    return found | {"cloud": float(cloud.mean() * len(now) / len(sphere)), "sphere_in": 100 * float(cloud[sphere].mean()),
                    "failed": 100 * float((states.column("fail")[cloud] > 0).mean()),
                    "fastest": float(np.sqrt(sum(states.column(f"velocity_{axis}") ** 2 for axis in range(3))).max()),
                    "drift": 100 * summary["energy"]["relative_drift"]}
