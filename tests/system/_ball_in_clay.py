"""The ball and the clay of apps/scenes/ball_in_clay with other cells, contact, speeds and walls, and what resists the ball."""

import math

import _gallery
import _mpm

JOB = "ball_in_clay"
RADIUS, DENSITY = 60.0, 1.6e-3  # mm, g/mm3
STRENGTH, SHEAR = 0.01, 1.0  # MPa: k, the strength in simple shear, Yield0/sqrt(3); the shear modulus
WAVES = math.sqrt(SHEAR / DENSITY)  # m/s, of shear
# Limit load over pi R^2 k, von Mises, without walls: the elements of tests/validation/_ball_flow.py.
FACTORS = {"smooth": 10.26, "rough": 14.12}
RAMP = 0.02  # of the radius: the way in which the ball gets its speed


def travel_of(cells):
    """Over the radius: its second half is a whole cell at least, and the load is steady after a tenth of the radius."""
    return max(0.3, 2 / cells)


def ramp_end(speed):
    return 2 * RAMP * RADIUS / (speed * WAVES)


def text(cells, ball="rough", shape="QuadraticBSpline", inset=0, friction=None, speed=0.01, width=4, travel=None, poisson=0.49, averaging="cell", pressure=20,
         normal="regression", kind=1, transfer="FLIP", flip=1):
    """`cells`: over the ball's radius; `inset`: cells by which the body is smaller than the ball; `friction`: Coulomb's instead of a
    rough or smooth surface; `speed`: over that of shear waves; `width`: of the quarter of clay and half of its height, and
    `travel`, of the ball: over the radius; `pressure`: in the clay at the start, over k."""
    cell = RADIUS / cells
    surface = {"rough": 1} if ball == "rough" and friction is None else {"rough": 0, "value": friction or 0}
    wide, v, ramp = round(width * cells) * cell, speed * WAVES, ramp_end(speed)
    end = ramp / 2 + (travel or travel_of(cells)) * RADIUS / v
    bulk = 2 * SHEAR * (1 + poisson) / (3 * (1 - 2 * poisson))
    changes = _gallery.resolution(cell, shape, normal, kind)
    changes[".//PostProcessing"] |= {"time_interval": end}
    changes |= {".//StrengthModel[@Poisson]": {"Young": 2 * SHEAR * (1 + poisson), "Poisson": poisson},
                ".//Coefficient": surface,
                ".//Geometry[@Outer_Radius]": {"Outer_Radius": RADIUS - inset * cell},
                ".//PrescribedVelocity": {"vz": f"-{v}*min(1, t/{ramp})"},
                ".//Body[@name='block']/Geometry": {"lx": wide, "ly": wide, "lz": 2 * wide, "z0": -wide},
                ".//Body[@name='clay']": {"density": DENSITY * (1 + pressure * STRENGTH / bulk)},
                ".//XMax": {"value": wide}, ".//YMax": {"value": wide}, ".//ZMin": {"value": -wide}, ".//ZMax": {"value": wide},
                ".//EndTime": {"value": end}, ".//Console": {"print_time": end / 100}, ".//Volumetric": {"averaging": averaging},
                ".//Solution": {"transfer": transfer} | ({"flip_fraction": flip} if flip < 1 else {})}
    return _gallery.text(_gallery.scene(JOB), changes)


def resistance(folder):
    """Times, and the force that the clay exerts on the whole ball against its motion, over pi R^2 k: means since the row before."""
    time, force = _gallery.forces(folder, JOB)
    return time, -4 * force[:, 2] / (math.pi * RADIUS**2 * STRENGTH)


def measure(folder, ball="rough", speed=0.01):
    """`factor`: the mean over the second half of the ball's way; `growth`: from the half before it (its last two thirds) to this one;
    `scatter`: standard deviation of the rows in it, both in percent."""
    time, found = resistance(folder)
    summary = _mpm.summary(folder, JOB)
    way = time - ramp_end(speed) / 2
    late, early = way > way[-1] / 2, (way > way[-1] / 6) & (way <= way[-1] / 2)
    factor = found[late].mean()
    return {"particles": summary["particles"], "steps": summary["steps"], "factor": factor, "error": 100 * (factor / FACTORS[ball] - 1),
            "growth": 100 * (factor / found[early].mean() - 1), "scatter": 100 * found[late].std() / factor,
            "drift": 100 * summary["energy"]["relative_drift"]}
