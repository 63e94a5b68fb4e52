"""The scenes of apps/scenes with friction and rebound whose answers are exact, with other cells, shapes and contact, and how they are
measured: ball_on_a_slope, sliding_block, also between two plates, pressed_cube and two_discs."""

import math
import xml.etree.ElementTree as ElementTree

import _cases
import _gallery
import _mpm
import numpy as np

# Ball on a slope (P. Huang, thesis, Tsinghua 2010, 4.4.3 and 5.3.2): angle in degrees and friction. Units: m, kg, s.
SLOPES = {"rolling": (45, 0.4), "sliding": (60, 0.2)}
GRAVITY = 10.0


def contact(shape, normal, kind):
    return {".//Grid": {"shape": shape}, ".//Contact": {"contact_normal": normal, "contact_type": kind}}


def cells(cell):
    """Cells with eight particles each."""
    return {".//Geometry": {"dp": cell / 2}, ".//DCell": dict.fromkeys(("dx", "dy", "dz"), cell)}


def slope_path(motion, time):
    """Of the centre of a rigid ball from rest (thesis 4-62)."""
    angle, friction = SLOPES[motion]
    along, across = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    sticks = math.tan(math.radians(angle)) <= 3.5 * friction
    return GRAVITY * (5 / 14 * along if sticks else (along - friction * across) / 2) * time**2


def slope(cell, motion, plane="rigid", shape="linear", normal="mass_gradient", kind=1, end=1.0, shells=False, stiffness=1):
    """`plane`: rigid; "elastic", ten times as stiff and dense as the ball and held from below; or "rubber", 0.8 thick, of the ball's material,
    while the ball is rigid and moves freely. `shells`: of particles of the ball, in the place of a lattice; `stiffness`: of the rubber, over
    that of the scene."""
    angle, friction = SLOPES[motion]
    root = _gallery.scene("ball_on_a_slope")
    if plane == "rubber":
        root.find(".//Body[@name='ball']").set("material", "rigid")
        body = root.find(".//Body[@name='plane']")
        body.set("material", "rubber")
        body.remove(body.find("PrescribedVelocity"))
        body.find("Geometry").attrib.update(z0="-0.8", lz="0.8")
        root.find(".//ZMin").attrib.update(value="-0.8", boundary="1")
    if plane == "elastic":
        material = root.find("Material[@name='rigid']")
        material.find("ReferenceDensity").set("value", "10000")
        material.find("StrengthModel").attrib.update(type="IsoElastic", Young="4.2e7", Poisson="0.4")
        body = root.find(".//Body[@name='plane']")
        body.remove(body.find("PrescribedVelocity"))
        root.find(".//ZMin").set("boundary", "1")
        root.find("Component[@name='plane']").set("normal_vector_weight", "1")
    gravity = {"ax": GRAVITY * math.sin(math.radians(angle)), "ay": 0, "az": -GRAVITY * math.cos(math.radians(angle))}
    young = float(root.find("Material[@name='rubber']/StrengthModel").get("Young"))
    return _gallery.text(root, cells(cell) | contact(shape, normal, kind)
                         | {"Material[@name='rubber']/StrengthModel": {"Young": stiffness * young}}
                         | ({".//Geometry[@Outer_Radius]": {"discretization": 1}} if shells else {})
                         | {".//Friction/Coefficient": {"value": friction}, ".//Gravity": gravity, ".//EndTime": {"value": end},
                            ".//PostProcessing": {"vtk_data": 0, "h5part": 0}})


def measure_slope(folder, motion):
    """`centre`: error of the ball's way in percent."""
    summary = _mpm.summary(folder, "ball_on_a_slope")
    found = {"particles": summary["particles"], "steps": summary["steps"],
             "centre": 100 * (summary["bodies"][0]["centre"][0] / slope_path(motion, summary["time"]) - 1)}
    return found | {"drift": 100 * summary["energy"]["relative_drift"]}


# A block dragged off all axes: along ALONG, with DRAG a unit of mass; weight 1 a unit of mass.
ALONG = np.array([math.cos(math.radians(30)), 0.5])
DRAG, END = {1: 0.6, 2: 1.7}, {1: 4.0, 2: 3.0}  # by plates; the block stays below the second one
PLATE_MASS, BLOCK_MASS = 72.0, 20.0


def block(cell=1.0, friction=0.3, shape="linear", normal="regression", kind=1, weight=0, plates=1):
    """`weight`: of the normals of the base, and of a second plate that lies on the block with `plates` 2."""
    root = _gallery.scene("sliding_block")
    root.find("Component[@name='base']").set("normal_vector_weight", str(weight))
    if plates == 2:
        top = root.find("Component[@name='top']")
        second = ElementTree.fromstring(f'<Component name="plate" normal_vector_weight="{weight}"><Body name="plate" material="soft" '
                                        'type="Block"><Geometry x0="0.2" y0="0.3" z0="3" lx="9" ly="8" lz="1" dp="0.5"/>'
                                        '<BodyForce bx="0" by="0" bz="-0.25*min(t/0.5,1)"/></Body></Component>')
        root.insert(list(root).index(top) + 1, second)
    rise = "*min(max((t-0.5)/0.25,0),1)"
    return _gallery.text(root, cells(cell) | contact(shape, normal, kind)
                         | {".//Friction/Coefficient": {"value": friction}, ".//EndTime": {"value": END[plates]},
                            ".//Body[@name='top']/BodyForce": {"bx": f"{float(DRAG[plates] * ALONG[0])!r}{rise}", "by": f"{DRAG[plates] * float(ALONG[1])!r}{rise}"},
                            ".//PostProcessing": {"vtk_data": 0, "h5part": 0}})


def measure_block(folder, friction=0.3, plates=1, cell=1.0):
    """In percent: `acceleration` of the block over Coulomb's - 1, between plates with the measured normal forces, `across` its velocity across
    the drag over that along it, `heat` of friction over that of Coulomb's forces - 1. `entered`: how deep its particles' faces are in the
    base, in cells. `plate`: the second plate's acceleration over Coulomb's - 1."""
    status, summary = _cases.status(folder, "sliding_block"), _mpm.summary(folder, "sliding_block")
    late = status["time"] >= 1
    time = status["time"][late]
    speed, across = (np.column_stack([status[f"v{a}[body:top]"] for a in "xy"])[late] @ direction
                     for direction in (ALONG, np.array([-ALONG[1], ALONG[0]])))
    forces = _mpm.table(folder / "sliding_block_curv.dat")
    when = np.array(forces["time"])
    inside = (when[:-1] >= time[0] - 1e-9) & (when[1:] <= time[-1] + 1e-9)

    def pressing(pair):
        """Mean of the normal force; the second plate tips and bounces a little."""
        return np.average(np.array(forces[f"contact_z[{pair}]"])[1:][inside], weights=np.diff(when)[inside])

    below, above = (pressing("1,2"), pressing("2,3")) if plates == 2 else (BLOCK_MASS, 0.0)
    exact = DRAG[plates] - friction * (below + above) / BLOCK_MASS
    mean = (speed[-1] - speed[0]) / (time[-1] - time[0])
    heat = friction * below * np.trapz(speed, time)
    found = {"particles": summary["particles"], "steps": summary["steps"],
             "acceleration": 100 * (mean / exact - 1), "across": 100 * abs(across[-1] / speed[-1]), "plate": math.nan}
    if plates == 2:
        of_plate = np.column_stack([status[f"v{a}[body:plate]"] for a in "xy"])[late] @ ALONG
        heat += friction * above * np.trapz(speed - of_plate, time)
        found["plate"] = 100 * ((of_plate[-1] - of_plate[0]) / (time[-1] - time[0]) / (friction * above / PLATE_MASS) - 1)
    base, top = summary["bodies"][:2]
    first = status["friction_heat"][late][0]
    return found | {"heat": 100 * ((status["friction_heat"][-1] - first) / heat - 1) if friction else math.nan,
                    "entered": (base["upper"][2] - top["lower"][2] + cell / 2) / cell, "drift": 100 * summary["energy"]["relative_drift"]}


# An elastic cube with an edge of 8, an eighth of it, that a platen presses.
YOUNG, POISSON, EDGE = 1000.0, 0.3, 4.0


def cube(cell=1.0, shape="QuadraticBSpline", normal="regression", kind=1):
    return _gallery.text(_gallery.scene("pressed_cube"), cells(cell) | contact(shape, normal, kind)
                         | {".//PostProcessing": {"vtk_data": 0, "h5part": 0}})


def uniaxial(stretch):
    """Stretch across and stress of NeoHookean along, where there is no stress across."""
    mu, lame = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    low, high = 1.0, 2.0
    for _ in range(60):
        middle = (low + high) / 2
        across = mu * (middle**2 - 1) + lame * math.log(middle**2 * stretch)
        low, high = (low, middle) if across > 0 else (middle, high)
    return low, (mu * (stretch**2 - 1) + lame * math.log(low**2 * stretch)) / (low**2 * stretch)


def measure_cube(folder, cell=1.0):
    """`force` on the platen and `width` of the cube over the exact ones - 1, in percent, means over the last eighth of the way's time, in which
    the platen hardly moves; `entered`: how deep the faces of the cube's particles are in the platen, in cells."""
    summary, status = _mpm.summary(folder, "pressed_cube"), _cases.status(folder, "pressed_cube")
    cube, platen = summary["bodies"]
    stretch = (platen["lower"][2] - cell / 4) / EDGE
    across, stress = uniaxial(stretch)
    half = cell / 4  # of a particle's edge, at the start
    width = np.mean([cube["upper"][a] + half * across for a in (0, 1)])
    return {"particles": summary["particles"], "steps": summary["steps"], "stretch": stretch,
            "force": 100 * (np.mean(status["fz[contact:platen]"][-5:]) / (-stress * (across * EDGE)**2) - 1),
            "width": 100 * (width / (across * EDGE) - 1),
            "entered": (cube["upper"][2] + half * stretch - (platen["lower"][2] - half)) / cell,
            "drift": 100 * summary["energy"]["relative_drift"]}


# Two discs of radius 5 that approach each other with 1.
RADIUS, DISTANCE = 5.0, 10.6


def discs(cell=1.0, offset=0.0, shape="linear", normal="regression", kind=0, rings=1, end=None):
    """`offset`: of the second one's centre across the velocities."""
    root = _gallery.scene("two_discs")
    lattice = {"dp_bottom": cell / 2, "dp_top": cell / 2, "height": cell, "discretization": rings}
    found = _gallery.text(root, {".//Geometry": lattice, ".//DCell": dict.fromkeys(("dx", "dy", "dz"), cell), ".//ZMax": {"value": cell},
                                 ".//Body[@name='right']/Geometry": {"y0": 7.35 + offset}, ".//Point": {"z": cell / 2},
                                 ".//EndTime": {"value": end or 3.6 + first_touch(offset) - 0.6}, ".//PostProcessing": {"vtk_data": 0, "h5part": 0}}
                          | contact(shape, normal, kind))
    return found


def first_touch(offset):
    return DISTANCE - math.sqrt(4 * RADIUS**2 - offset**2)


def measure_discs(folder, cell=1.0, offset=0.0):
    """`gap` at the first force, in cells; `lost`: energy, kinetic and elastic, in percent; `kinetic`: share of that which is left."""
    time, force = _gallery.forces(folder, "two_discs")
    first, last = _gallery.first_and_last(time, force)
    summary, status = _mpm.summary(folder, "two_discs"), _cases.status(folder, "two_discs")
    momentum = summary["bodies"][0]["mass"] * 0.5
    start = momentum * offset  # angular momentum of two that pass at this distance
    return {"particles": summary["particles"], "steps": summary["steps"],
            "gap": (math.hypot(DISTANCE - first, offset) - 2 * RADIUS) / cell, "parted": last,
            "lost": 100 * (1 - status["total"][-1] / status["total"][0]), "kinetic": status["kinetic"][-1] / status["kinetic"][0],
            "momentum": max(np.abs(status[name]).max() for name in ("px", "py", "pz")) / momentum,
            "angular": 100 * abs(abs(summary["angular_momentum"][2]) - start) / (momentum * RADIUS),
            "turned": status["vy[body:right]"][-1], "drift": 100 * summary["energy"]["relative_drift"]}
