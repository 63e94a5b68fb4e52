"""Scenes of apps/scenes with other cells, shapes and contact, and how their results are measured: for the physics tests
here and for the validations."""

import math
import xml.etree.ElementTree as ElementTree

import _cases
import _mpm
import numpy as np
from scipy.spatial import cKDTree

# Units of the balls: m, kg, s.
RADIUS, DENSITY, YOUNG, POISSON = 1.6, 1000.0, 4.2e6, 0.4


def scene(name):
    """The elements of apps/scenes/NAME/NAME.xmp."""
    return ElementTree.parse(_mpm.SOURCE / "apps/scenes" / name / f"{name}.xmp").getroot()


def text(root, changes):
    """The scene's text with other attributes: {"path of elements": {attribute: value}}; a path must lead to something."""
    for path, attributes in changes.items():
        found = root.findall(path)
        if not found:
            raise KeyError(path)
        for element in found:
            element.attrib.update({name: str(value) for name, value in attributes.items()})
    return ElementTree.tostring(root, encoding="unicode")


def resolution(cell, shape, normal, kind=0):
    """Changes of every scene: cells with eight particles each, shape, and contact."""
    return {".//Geometry": {"dp": cell / 2}, ".//DCell": dict.fromkeys(("dx", "dy", "dz"), cell), ".//Grid": {"shape": shape},
            ".//Contact": {"contact_normal": normal, "contact_type": kind}, ".//PostProcessing": {"vtk_data": 0}}


def forces(folder, job):
    """Times, and the forces that component 1 exerts on 2: means since the row before."""
    found = _mpm.table(folder / f"{job}_curv.dat")
    return np.array(found["time"]), np.column_stack([found[f"contact_{a}[1,2]"] for a in "xyz"])


def acting(force):
    """The rows with a force above round-off, which can be 1e-15 of the largest one."""
    size = np.abs(force).reshape(len(force), -1).max(axis=1)
    return np.flatnonzero(size > 1e-9 * size.max())


def first_and_last(time, force):
    """The start of the step with the first force, and the end of that with the last one."""
    on = acting(force)
    return time[on[0] - 1], time[on[-1]]


def face_gap(near, far, along, spacing):
    """The smallest gap along `along` between the faces of particles of two bodies, `far` beyond `near`, that are within two spacings of
    each other across it. Particles keep their first size."""
    across = np.linalg.svd(along[None])[2][1:].T
    front = [places[way * (places @ along) > (way * (places @ along)).max() - 8 * spacing] for places, way in ((near, 1), (far, -1))]
    pairs = cKDTree(front[0] @ across).query_ball_tree(cKDTree(front[1] @ across), 2 * spacing)
    return min((front[1][others] @ along).min() - place @ along for place, others in zip(front[0], pairs) if others) - spacing


def two_balls(cell, shape, normal, kind=0):
    changes = resolution(cell, shape, normal, kind)
    changes[".//PostProcessing"] |= {"time_interval": 0.0025, "var": "body"}
    return text(scene("two_balls"), changes)


def measure_two_balls(folder, cell):
    """Gap at the first force in cells, that when the last step with a force began (`last_gap`, between the states before and after it), the
    time of the last force, the largest momentum over m v, the angular momentum at the end over m v R, the energy drift, and the
    restitution: the balls' velocity over what it was."""
    time, force = forces(folder, "two_balls")
    first, last = first_and_last(time, force)
    summary, status = _mpm.summary(folder, "two_balls"), _cases.status(folder, "two_balls")
    along = np.array([math.cos(math.radians(30)), 0, 0.5])
    momentum = summary["bodies"][0]["mass"] * 15
    states, last_step = _cases.States(folder, "two_balls"), time[acting(force)[-1] - 1]
    left = states.column("body", 0) == states.column("body", 0).min()
    after_it = np.searchsorted(states.times, last_step)
    gaps = []
    for which in (after_it - 1, after_it):
        places = np.column_stack([states.column(axis, which) for axis in "xyz"])
        gaps.append(face_gap(places[left], places[~left], along, cell / 2) / cell)
    after = np.array([status[f"v{a}[body:right]"][-1] for a in "xyz"]) @ along
    return {"particles": summary["particles"], "steps": summary["steps"], "gap": (0.8 - 30 * first) / cell, "parted": last,
            "last_gap": float(np.interp(last_step, states.times[after_it - 1:after_it + 1], gaps)),
            "force": np.abs(force @ along).max() / 1e6,
            "momentum": max(np.abs(status[name]).max() for name in ("px", "py", "pz")) / momentum,
            "angular": 100 * np.linalg.norm(summary["angular_momentum"]) / (momentum * RADIUS),
            "drift": 100 * summary["energy"]["relative_drift"], "restitution": after / 15}


def ball_on_a_plate(cell, shape, normal, kind=0, factor=0.5):
    return text(scene("ball_on_a_plate"), {**resolution(cell, shape, normal, kind), ".//TimeStep": {"factor": factor}})


def measure_ball_on_a_plate(folder, cell):
    """As the two balls; `along`: change of the velocity along the plate, over what it was, in percent."""
    time, force = forces(folder, "ball_on_a_plate")
    first, last = first_and_last(time, force)
    summary, status = _mpm.summary(folder, "ball_on_a_plate"), _cases.status(folder, "ball_on_a_plate")
    return {"particles": summary["particles"], "steps": summary["steps"], "gap": (0.4 - 15 * first) / cell, "parted": last,
            "force": np.abs(force[:, 2]).max() / 1e6, "along": 100 * (status["vx[body:ball]"][-1] / 15 - 1),
            "drift": 100 * summary["energy"]["relative_drift"], "restitution": status["vz[body:ball]"][-1] / 15}


def slow_quarter_ball(cell, speed, shape="linear", normal="regression"):
    """A quarter of the ball between two symmetry planes strikes the plate slowly, from a tenth of a cell above."""
    above = 0.1 * cell
    end = above / speed + 1.15 * hertz(speed)[0][-1]
    changes = {".//Body[@name='ball']/Geometry": {"z0": RADIUS + above, "angle": 90},
               ".//Body[@name='ball']/InitialVelocity": {"vx": 0, "vz": -speed},
               ".//Body[@name='plate']/Geometry": {"x0": 0, "y0": 0, "z0": -2 * cell, "lx": RADIUS, "ly": RADIUS, "lz": 2 * cell},
               ".//XMin": {"value": 0, "boundary": 2}, ".//YMin": {"value": 0, "boundary": 2}, ".//XMax": {"value": 2.4},
               ".//YMax": {"value": 2.4}, ".//ZMin": {"value": -2 * cell}, ".//ZMax": {"value": 4}, ".//EndTime": {"value": end},
               ".//Console": {"print_time": end}, ".//PostProcessing": {"time_interval": end},
               ".//Point": {"x": 0.5, "y": 0.5, "z": 1.5}}
    return text(scene("ball_on_a_plate"), {**resolution(cell, shape, normal), **changes})


def stiffness():
    """Hertz: the force is this times the approach to the power of 3/2, on a rigid plane."""
    return 4 / 3 * YOUNG / (1 - POISSON**2) * math.sqrt(RADIUS)


def finite_ball(approach):
    """Force over Hertz's when a ball's own inertia presses it on a plane by `approach` of its centre of mass: the fit of
    tests/validation/_ball_elements.py."""
    s = math.sqrt(approach / RADIUS)
    return 1 + 0.93 * s + s * s


def impact(speed, law, dt=1e-5):
    """Times and forces of the ball's impact on a rigid plane: m x'' = -k x^(3/2) law(x)."""
    mass, k = 4 / 3 * math.pi * RADIUS**3 * DENSITY, stiffness()
    x, v, force, forces = 0.0, speed, 0.0, []
    while x >= 0:
        forces.append(force)
        v -= 0.5 * dt * force / mass
        x += dt * v
        force = k * x**1.5 * law(x) if x > 0 else 0.0
        v -= 0.5 * dt * force / mass
    return dt * np.arange(len(forces)), np.array(forces)


def hertz(speed):
    return impact(speed, lambda x: 1)


def measure_slow_quarter_ball(folder, cell, speed):
    """Forces over Hertz's and over those of a finite ball at the same approach of the ball's centre, where that is at least
    0.9 of its largest; the largest force and the duration over a finite ball's, and the root mean square of the difference
    of the forces over time, from the first force on, over the largest. Forces are means over a sixtieth of the run."""
    time, force = forces(folder, "ball_on_a_plate")
    summary = _mpm.summary(folder, "ball_on_a_plate")
    force, steps, middle = 4 * np.abs(force[1:, 2]), np.diff(time), (time[1:] + time[:-1]) / 2
    velocity = speed - np.concatenate([[0], np.cumsum(force * steps)]) / (4 * summary["bodies"][0]["mass"])
    approach = np.cumsum((velocity[1:] + velocity[:-1]) / 2 * steps) - 0.1 * cell
    near = approach >= 0.9 * approach.max()
    over_hertz = force[near].mean() / (stiffness() * approach[near] ** 1.5).mean()
    on = acting(force)
    first, last = time[on[0]], time[on[-1] + 1]
    times, exact = impact(speed, finite_ball)
    wide = max(1, len(force) // 60)
    smooth, expected = (np.convolve(f, np.ones(wide) / wide, "same")
                        for f in (force, np.interp(middle - first, times, exact, left=0, right=0)))
    return {"particles": summary["particles"], "steps": summary["steps"], "approach": approach.max() / RADIUS,
            "radius": math.sqrt(RADIUS * approach.max()) / cell, "over_hertz": over_hertz,
            "over_finite": over_hertz / finite_ball(0.96 * approach.max()), "largest": smooth.max() / exact.max(),
            "duration": (last - first) / times[-1],
            "history": 100 * math.sqrt(np.mean((smooth - expected)[expected > 0] ** 2)) / exact.max()}
