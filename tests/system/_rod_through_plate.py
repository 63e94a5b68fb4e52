"""The rod and the plate of apps/scenes/rod_through_a_plate with other velocities, cells, plates and contact, and what is left of them."""

import math
import xml.etree.ElementTree as ElementTree

import _cases
import _gallery
import _mpm
import numpy as np

JOB = "rod_through_a_plate"
THICKNESS, TILT = 26.3, math.radians(30)
# Striking velocity: residual velocity of the experiment and of the thesis (table 4.5), m/s.
KNOWN = {340: (91, 83.8), 400: (217, 207.8), 446: (288, 280.0), 575: (455, 442.8), 730: (655, 623.9)}


def text(cells=13, speed=400, half_width=61, shape="linear", normal="regression", kind=1, distance=2, gap=0.05, contact=True,
         nose=0.3, failure=1.6, heat=890, friction=0, path=140, factor=0.5, rings=0):
    """`cells`: through the plate; `half_width`: of the plate, mm; `nose`: spacing of the particles in the rod's nose, in cells, half a
    cell at its rear; `rings`: particles of the rod in rings, with its exact volume; `failure`: plastic strain; `heat`: specific
    heat of the plate, mJ/(g K); `path`: of the rod until the end, mm, at the mean of the experiment's velocities; slow rods need
    more, since they are slower than that while they leave the plate."""
    cell = THICKNESS / cells
    wide = round(half_width / cell) * cell
    direction = np.array([math.sin(TILT), 0, -math.cos(TILT)])
    length = 67.5 + math.sqrt(6.45 * (2 * 38.7 - 6.45))
    # The tip is a cell before the plate, and the middle of the rod's path through it is that of the plate.
    rear = np.array([-THICKNESS * math.tan(TILT) / 2, 0, 0]) - (length + cell) * direction
    end = path / ((speed + KNOWN[speed][0]) / 2)
    velocity = {"vx": speed * direction[0], "vz": speed * direction[2]}
    changes = _gallery.resolution(cell, shape, normal, kind)
    del changes[".//Geometry"]
    changes |= {".//WorkPlane": {"r0x": rear[0], "r0z": rear[2]}, ".//Body[@name='shank']/InitialVelocity": velocity,
                ".//Body[@name='nose']/InitialVelocity": velocity,
                ".//Body[@name='shank']/Geometry": {"dp_bottom": cell / 2, "dp_top": nose * cell, "discretization": rings},
                ".//Body[@name='nose']/Geometry": {"dp_bottom": nose * cell, "dp_top": nose * cell, "discretization": rings},
                ".//Body[@name='plate']/Geometry": {"x0": -wide, "lx": 2 * wide, "ly": wide, "dp": cell / 2},
                ".//XMin": {"value": -math.ceil(80 / cell) * cell}, ".//XMax": {"value": math.ceil(110 / cell) * cell},
                ".//YMax": {"value": math.ceil(75 / cell) * cell}, ".//ZMin": {"value": -math.ceil(200 / cell) * cell},
                ".//ZMax": {"value": math.ceil(100 / cell) * cell}, ".//FailureModel": {"epmax": failure},
                ".//Material[@name='aluminium']/StrengthModel": {"SpecHeat": heat},
                ".//EndTime": {"value": end}, ".//TimeStep": {"factor": factor}, ".//Console": {"print_time": end / 100},
                ".//PostProcessing": {"time_interval": end / 4, "vtk_data": 0}}
    root = _gallery.scene(JOB)
    if contact:
        changes[".//Contact"] |= {"distance_type": distance, "min_distance": gap}
        if friction:
            pair = {"value": str(friction), "mat1": "steel", "mat2": "aluminium"}
            ElementTree.SubElement(ElementTree.SubElement(root, "Friction"), "Coefficient", pair)
    else:
        root.remove(root.find("Contact"))
        del changes[".//Contact"]
    return _gallery.text(root, changes)


def velocity(status, masses):
    """Of the whole rod: rows of vx, vz."""
    parts = [np.column_stack([status[f"v{axis}[body:{name}]"] for axis in "xz"]) for name in ("shank", "nose")]
    return (masses["shank"] * parts[0] + masses["nose"] * parts[1]) / (masses["shank"] + masses["nose"])


def measure(folder, speed=400):
    """The rod's mass (both halves) in g and its velocity at the end in m/s, that over the experiment's in percent, and what it has lost
    since nine tenths of the time; the angle by which its path has turned, in degrees; the failed fraction of the plate."""
    states, status, summary = _cases.States(folder, JOB), _cases.status(folder, JOB), _mpm.summary(folder, JOB)
    masses = {body["name"]: body["mass"] for body in summary["bodies"]}
    moving = velocity(status, masses)
    speeds, late = np.hypot(*moving.T), np.searchsorted(status["time"], 0.9 * status["time"][-1])
    turned = math.degrees(math.atan2(moving[-1, 0], -moving[-1, 1])) - math.degrees(TILT)
    body, failed = states.column("body"), states.column("fail") > 0
    plate = body == body.max()
    return {"particles": summary["particles"], "steps": summary["steps"], "mass": 2 * (masses["shank"] + masses["nose"]),
            "residual": float(speeds[-1]), "error": 100 * float(speeds[-1] / KNOWN[speed][0] - 1),
            "lost": float(speeds[late] - speeds[-1]), "turned": turned, "failed": 100 * float(failed[plate].mean()),
            "drift": 100 * summary["energy"]["relative_drift"]}
