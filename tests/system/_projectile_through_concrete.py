"""The projectile and the slab of apps/scenes/projectile_through_concrete with other velocities, cells and contact, and what is left of
them."""

import math

import _cases
import _gallery
import _mpm
import numpy as np

JOB = "projectile_through_concrete"
THICKNESS, LENGTH, RADIUS, ARC, SHANK = 178.0, 143.7, 12.7, 76.2, 101.58  # mm; ARC: of the nose
MASS = 500  # g
# Striking and residual velocity, m/s: Hanchak et al. (1992), slabs of 48 MPa.
EXPERIMENT = {434: 214, 606: 449, 749: 615, 1058: 947}


def particles(apart):
    """Number of the projectile's particles, all quarters, at this spacing."""
    z = (np.arange(round(LENGTH / apart)) + 0.5) * apart
    outline = np.sqrt(np.maximum(ARC**2 - np.maximum(z - SHANK, 0) ** 2, 0)) - (ARC - RADIUS)
    across = (np.arange(math.ceil(RADIUS / apart)) + 0.5) * apart
    squares = np.add.outer(across**2, across**2)
    return 4 * sum(int((squares <= radius**2).sum()) for radius in outline if radius > 0)


def text(cells=32, speed=749, radius=200, shape="linear", normal="regression", kind=1, distance=2, gap=0.05, contact=True, split=2,
         path=250, factor=0.5, strength=None):
    """`cells`: through the slab; `radius`: of the slab, mm; `split`: particles of the projectile along half a cell; `path`: of
    the projectile until the end, mm, at the mean of the experiment's velocities; `strength`: attributes of the concrete's."""
    cell = THICKNESS / cells
    across = math.ceil((radius + 60) / cell) * cell
    end = path / ((speed + EXPERIMENT[speed]) / 2)
    changes = _gallery.resolution(cell, shape, normal, kind)
    apart = cell / 2 / split
    spacing = {"dp_bottom": apart, "dp_top": apart}
    changes |= {".//WorkPlane": {"r0z": LENGTH + cell}, ".//Geometry": spacing,
                ".//Body[@name='slab']/Geometry": {"dp_bottom": cell / 2, "dp_top": cell / 2, "Bottom_Outer_Radius": radius,
                                                   "Top_Outer_Radius": radius},
                ".//Material[@name='projectile']/ReferenceDensity": {"value": MASS / (particles(apart) * apart**3)},
                ".//InitialVelocity": {"vz": -speed}, ".//XMax": {"value": across}, ".//YMax": {"value": across},
                ".//ZMin": {"value": -math.ceil(450 / cell) * cell}, ".//ZMax": {"value": math.ceil(200 / cell) * cell},
                ".//EndTime": {"value": end}, ".//TimeStep": {"factor": factor}, ".//Console": {"print_time": end / 100},
                ".//PostProcessing": {"time_interval": end / 4, "vtk_data": 0}}
    root = _gallery.scene(JOB)
    if strength:
        concrete = root.find("Material[@name='concrete']")
        concrete.insert(0, concrete.makeelement("StrengthModel", {name: str(value) for name, value in strength.items()}))
    changes[".//Contact"] |= {"distance_type": distance, "min_distance": gap}
    return _gallery.text(root, changes)


def measure(folder, speed=749):
    """The projectile's mass (all quarters) in g, its velocity at the end in m/s, that over the experiment's in percent, and what it
    has lost since nine tenths of the time."""
    status, summary = _cases.status(folder, JOB), _mpm.summary(folder, JOB)
    speeds = -status["vz[body:projectile]"]
    late = np.searchsorted(status["time"], 0.9 * status["time"][-1])
    mass = next(body["mass"] for body in summary["bodies"] if body["name"] == "projectile")
    return {"particles": summary["particles"], "steps": summary["steps"], "mass": 4 * mass, "residual": float(speeds[-1]),
            "error": 100 * float(speeds[-1] / EXPERIMENT[speed] - 1), "lost": float(speeds[late] - speeds[-1]),
            "drift": 100 * summary["energy"]["relative_drift"]}
