"""The hemispherical shell and the soil of apps/scenes/hemisphere_into_soil with other cells, speeds, contact and shells, and what
is measured of them."""

import math

import _cases
import _gallery
import _mpm
import numpy as np

JOB = "hemisphere_into_soil"
OUTER, INNER = 204.0, 185.35  # mm, radii of the shell
MASS, DENSITY = 12e3, 2.2e-3  # g, g/mm3: of the whole shell, of the soil


def text(cell, speed=200, end=0.62, width=600, depth=960, shell="elastic", shape="linear", normal="regression", kind=1, contact=True,
         sides=2, bottom=1, factor=0.9, changes=None):
    """`width`, `depth`: of the quarter of soil; `sides`, `bottom`: boundary types at its far faces; `shell`: elastic or rigid."""
    every = _gallery.resolution(cell, shape, normal, kind)
    above = math.ceil(480 / cell) * cell
    every |= {".//Body[@name='shell']/InitialVelocity": {"vz": -speed}, ".//Body[@name='soil']/Geometry": {"lx": width, "ly": width, "lz": depth, "z0": -depth},
              ".//XMax": {"value": width, "boundary": sides}, ".//YMax": {"value": width, "boundary": sides},
              ".//ZMin": {"value": -depth, "boundary": bottom}, ".//ZMax": {"value": above}, ".//EndTime": {"value": end},
              ".//Console": {"print_time": end / 200}, ".//TimeStep": {"factor": factor}}
    every[".//PostProcessing"] |= {"time_interval": end}
    root = _gallery.scene(JOB)
    if shell == "rigid":
        law = root.find("Material[@name='aluminium']/StrengthModel")
        law.attrib.clear()
        law.set("type", "Rigid")
    if not contact:
        root.remove(root.find("Contact"))
        del every[".//Contact"]
    return _gallery.text(root, every | (changes or {}))


def ploughed(depth):
    """The volume of a spherical cap."""
    return math.pi * depth**2 * (OUTER - depth / 3)


def inelastic_depth(speed, time, steps=20000):
    """The shell's depth if it takes along all soil in whose place it is, and nothing else slows it: M v0 = (M + rho V(h)) dh/dt."""
    depth, dt = 0.0, time / steps
    for _ in range(steps):
        half = depth + 0.5 * dt * speed / (1 + DENSITY * ploughed(depth) / MASS)
        depth += dt * speed / (1 + DENSITY * ploughed(half) / MASS)
    return depth


def measure(folder):
    """At the end: depth of the crater on the axis, where the soil's first surface is by its two upper layers, and of the shell's pole, mm;
    velocity. When the shell comes to rest and its depth then, or nan; its least kinetic energy over the first; the soil's greatest
    density over the first."""
    states, status, summary = _cases.States(folder, JOB), _cases.status(folder, JOB), _mpm.summary(folder, JOB)
    first, now = (np.column_stack([states.column(axis, which) for axis in "xyz"]) for which in (0, -1))
    left = np.isin(states.column("id", 0), states.column("id"))  # some soil may have passed a non-reflecting face
    first = first[left]
    soil = states.column("density", 0)[left] < 1.1 * DENSITY
    spacing = np.diff(np.unique(np.round(first[soil, 2], 3)))[-1]
    pole = ~soil & (first[:, 2] < first[~soil, 2].min() + 0.1 * spacing)
    axis = soil & (np.hypot(first[:, 0], first[:, 1]) < spacing)
    upper, lower = (now[axis & (first[:, 2] > -top * spacing) & (first[:, 2] < (1 - top) * spacing), 2].mean() for top in (1, 2))
    time, down = status["time"], -status["vz[body:shell]"]
    rest = depth = math.nan
    back = np.flatnonzero(down <= 0)
    if len(back):
        after, part = back[0], down[back[0] - 1] / (down[back[0] - 1] - down[back[0]])
        rest = time[after - 1] + part * (time[after] - time[after - 1])
        depth = np.trapz(np.append(down[:after], 0), np.append(time[:after], rest))
    kinetic = status["kinetic[body:shell]"]
    return {"particles": summary["particles"], "steps": summary["steps"], "crater": float(-1.5 * upper + 0.5 * lower),
            "pole": float((first[pole, 2] - now[pole, 2]).mean()), "speed": float(down[-1]), "rest": float(rest), "rest_depth": float(depth), "kinetic": float(100 * kinetic.min() / kinetic[0]),
            "densest": float((states.column("density")[soil] / DENSITY).max()), "drift": 100 * summary["energy"]["relative_drift"]}
