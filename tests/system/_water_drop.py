"""The drop and the step of apps/scenes/water_drop with other cells, shapes and contact, and the books of the run."""

import _cases
import _gallery
import _mpm
import numpy as np

JOB = "water_drop"
SPEED, RADIUS, DENSITY = 100.0, 25.0, 1e-3  # m/s, mm, g/mm^3


def text(cell, shape="linear", normal="mass_gradient", kind=1, end=3.0):
    """With a history, so that forces have a row for every step."""
    text = _gallery.text(_gallery.scene(JOB), _gallery.resolution(cell, shape, normal, kind)
                         | {".//EndTime": {"value": end}, ".//PostProcessing": {"time_interval": end / 4, "vtk_data": 0}})
    return text.replace("</Output>", '<TimeHistory var="density"><Point x="0" y="0" z="0"/></TimeHistory></Output>')


def measure(folder, cell):
    """`mass`: relative error of the drop's mass at the end. `momentum`: what the drop's momentum changed by less the impulse of
    the recorded force on it, over m v. `force`: the largest mean between rows of .sta, in kN. `stopped`: kinetic energy lost, `dissipated`: by contact, `drift`: not accounted for, all in percent of the first
    kinetic energy. `fastest`: particle over the first velocity. `spread`: root mean square distance of the particles from their centre, in radii. `inside`: particles
    deeper than half a cell within the step, in percent."""
    states, status, summary = _cases.States(folder, JOB), _cases.status(folder, JOB), _mpm.summary(folder, JOB)
    table = _mpm.table(folder / f"{JOB}_curv.dat")
    time = _cases.impulse_time(table["time"])
    force = sum(np.column_stack([table[f"contact_{a}[1,{step}]"] for a in "xyz"]) for step in (2, 3))  # on the step's parts
    mass = summary["bodies"][0]["mass"]
    change = np.array([status[f"p{a}[body:drop]"][-1] - status[f"p{a}[body:drop]"][0] for a in "xyz"])
    given = np.vstack([np.zeros(3), np.cumsum(force[1:] * np.diff(time)[:, None], axis=0)])
    impulse = -given[-1]
    when = np.array(status["time"])
    means = np.diff(np.column_stack([np.interp(when, time, given[:, a]) for a in range(3)]), axis=0) / np.diff(when)[:, None]
    drop = states.column("body", 0) == states.column("body", 0)[0]
    place, velocity = (np.column_stack([states.column(name)[drop] for name in names])
                       for names in ("xyz", ("velocity_0", "velocity_1", "velocity_2")))
    first = mass * SPEED**2 / 2
    energy = summary["energy"]
    return {"particles": summary["bodies"][0]["particles"], "steps": summary["steps"], "end": summary["time"],
            "mass": mass / (drop.sum() * DENSITY * (cell / 2)**3) - 1, "momentum": np.abs(change - impulse).max() / (mass * SPEED),
            "force": np.linalg.norm(means, axis=1).max() / 1e3, "stopped": 100 * (1 - energy["kinetic"] / first),
            "dissipated": 100 * energy["dissipated_by_contact"] / first, "drift": 100 * energy["relative_drift"],
            "fastest": np.linalg.norm(velocity, axis=1).max() / SPEED,
            "spread": np.sqrt(((place - place.mean(axis=0))**2).sum(axis=1).mean()) / RADIUS,
            "inside": 100 * deep(place, cell / 2).mean()}


def deep(place, depth):
    """Which places are deeper than `depth` below every face of the step."""
    x, y, z = place.T
    upper = (x > depth) & (x < 80 - depth) & (z < -depth) & (z > -70 + depth)
    lower = (x > -110 + depth) & (x < 0) & (z < -40 - depth) & (z > -80 + depth)
    return (upper | lower) & (np.abs(y) < 50 - depth)
