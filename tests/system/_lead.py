"""The lead sphere and plate of apps/scenes/lead_on_lead with other cells, spacings, shapes and laws, and the size of the debris."""

import math

import _cases
import _gallery
import _mpm
import numpy as np

JOB = "lead_on_lead"
END = 30.6e-3  # ms


def text(cell, spacing=0.53, shape="SGMP", full=False, end=END, factor=0.5, plate=140, changes=None):
    """`full`: without symmetry planes; `plate`: its width."""
    layers, half = round(6.36 / spacing), round(plate / 2 / spacing)
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
    """Of the cloud that has left the plate's rear by 20 mm: `front`, distance from the rear face, `struck`, from the struck one, and `width`, of
    its shadow along an axis of the grid, without the farthest thousandth of its mass; `farthest` and `widest`: of all particles. The
    cloud's mass, and how much of it is the sphere's and failed, in percent."""
    states, summary = _cases.States(folder, JOB), _mpm.summary(folder, JOB)
    stayed = np.isin(states.column("id", 0), states.column("id"))  # some may have left the grid
    first, now = (np.column_stack([states.column(axis, which) for axis in "xyz"]) for which in (0, -1))
    rear, sphere = first[:, 2].min() - spacing / 2, first[stayed, 2] > 0
    cloud = now[:, 2] < rear - 20
    ahead, aside = rear - now[cloud, 2], np.abs(now[cloud, :2]).ravel()
    front = float(np.quantile(ahead, 0.999))
    # of all four quarters
    mass = 4 * 11.35e-3 * spacing**3 * cloud.sum() if first[:, 0].min() > 0 else 11.35e-3 * spacing**3 * cloud.sum()
    return {"particles": summary["particles"], "steps": summary["steps"], "front": front, "struck": front - rear,
            "width": 2 * float(np.quantile(aside, 0.999)), "farthest": float(ahead.max()), "widest": 2 * float(aside.max()), "cloud": float(mass),
            "of_sphere": 100 * float(sphere[cloud].mean()), "failed": 100 * float((states.column("fail")[cloud] > 0).mean()),
            "drift": 100 * summary["energy"]["relative_drift"]}
