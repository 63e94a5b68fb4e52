"""The rods of apps/scenes/symmetric_taylor_impact with other cells and contact, and their shape after they have parted."""

import sys

import _cases
import _gallery
import _mpm
import numpy as np

sys.path.insert(0, str(_mpm.SOURCE / "benchmarks/taylor_bar"))

import bar as taylor  # noqa: E402: found by the line above

JOB = "symmetric_taylor_impact"
LENGTH, RADIUS = 38.1, 6.35  # mm
EXPERIMENT = {"L": 31.2, "D": 20.1}  # mm


def text(layers, shape="linear", normal="regression", kind=1, contact=True, radius=RADIUS, yields=311, end=0.14):
    """`layers`: particles along a rod, an even number; eight in a cell. `yields`: at this stress, in MPa."""
    cell = 2 * LENGTH / layers
    changes = _gallery.resolution(cell, shape, normal, kind)
    del changes[".//Geometry"]
    across, along = -(-12.7 // cell) * cell, (layers // 2 + 2) * cell
    changes |= {".//Geometry": {"dp_bottom": cell / 2, "dp_top": cell / 2, "Bottom_Outer_Radius": radius, "Top_Outer_Radius": radius},
                ".//StrengthModel": {"Yield0": yields}, ".//XMax": {"value": across}, ".//YMax": {"value": across},
                ".//ZMin": {"value": -along}, ".//ZMax": {"value": along}, ".//EndTime": {"value": end},
                ".//PostProcessing": {"time_interval": end, "vtk_data": 0}}
    root = _gallery.scene(JOB)
    if not contact:
        root.remove(root.find("Contact"))
        del changes[".//Contact"]
    return _gallery.text(root, changes)


def sizes(first, now, radius):
    """L: from the middle of the foot's face to that of the far end, both means over the face; D: widest diameter near the
    foot, mean over the directions. Images of the rod's first surface, as on the wall (benchmarks/taylor_bar/bar.py)."""
    first, now = ([np.concatenate([p * (sx, sy, 1) for sx in (1, -1) for sy in (1, -1)]) for p in (first, now)])
    lattice = taylor.Lattice(first)
    angle, ring = np.meshgrid(2 * np.pi * np.arange(24) / 24, radius * np.sqrt((np.arange(8) + 0.5) / 8))
    face = np.column_stack([(ring * np.cos(angle)).ravel(), (ring * np.sin(angle)).ravel(), np.zeros(angle.size)])
    foot, end = (lattice.carry(face + (0, 0, z), now)[:, 2].mean() for z in (0, LENGTH))
    level = np.arange(0, 0.3 * LENGTH, lattice.spacing / 2)
    angle, z = np.meshgrid(2 * np.pi * np.arange(72) / 72, level, indexing="ij")
    side = np.column_stack([(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel(), z.ravel()])
    image = lattice.carry(side, now)
    wide = np.hypot(image[:, 0], image[:, 1]).reshape(angle.shape)
    return {"L": end - foot, "D": 2 * wide.max(axis=1).mean(), "foot": foot}


def measure(folder, radius=RADIUS):
    """Sizes of both rods (mean) in mm and their mean error in percent (thesis, 4-61); the same for the centres of the outermost
    particles along the axes; when the force fell below a hundredth of its largest, and when the last one acted, in us; the
    upper rod's velocity, and the gap between the rods at the end."""
    states, status, summary = _cases.States(folder, JOB), _cases.status(folder, JOB), _mpm.summary(folder, JOB)
    first, now = (np.column_stack([states.column(axis, which) for axis in "xyz"]) for which in (0, -1))
    upper = first[:, 2] > 0
    rods = [sizes(first[mine] * (1, 1, way), now[mine] * (1, 1, way), radius) for way, mine in ((1, upper), (-1, ~upper))]
    found = {"particles": summary["particles"], "steps": summary["steps"], "drift": 100 * summary["energy"]["relative_drift"]}
    found |= {name: (rods[0][name] + rods[1][name]) / 2 for name in rods[0]}
    found |= {"L_centres": np.ptp(now[upper, 2]), "D_centres": 2 * now[upper, 0].max()}
    found |= {name: 50 * sum(abs(found[size + where] / EXPERIMENT[size] - 1) for size in EXPERIMENT)
              for name, where in (("error", ""), ("error_centres", "_centres"))}
    found |= {"gap": 2 * found.pop("foot"), "speed": status["vz[body:upper]"][-1], "released": np.nan, "parted": np.nan}
    if "contact_x[1,2]" in _mpm.table(folder / f"{JOB}_curv.dat"):
        time, force = _gallery.forces(folder, JOB)
        large = np.where(np.abs(force) > 0.01 * np.abs(force).max(), force, 0)
        found |= {"released": 1e3 * _gallery.first_and_last(time, large)[1], "parted": 1e3 * _gallery.first_and_last(time, force)[1]}
    return {name: float(value) for name, value in found.items()}
