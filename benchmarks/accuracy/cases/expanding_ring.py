"""An elastic ring that is set in motion outwards and breathes."""

import functools

import numpy as np

import derive
import methods
from case import Case, Error, Study
from cases import support

SOLID = derive.Solid(1.0, 0.3, 1.0)
INNER, OUTER = 1.0, 1.25
END, PICTURES, LAYERS = 14.0, 28, 160
SPEEDS = {"small": 1e-3, "large": 0.1}  # at radius 1
FALL = SOLID.poisson / (1 - SOLID.poisson)


def start(radius, speed):
    """Velocities for which the rate of radial stress is zero everywhere: (lambda + 2 mu) v' + lambda v/r = 0."""
    return speed * radius**-FALL


@functools.cache
def motion(speed, layers=LAYERS):
    """Radii of the nodes at rest, and at every picture radii, velocities and accelerations: linear elements in R, lumped masses, central differences.

    rho R d2r/dt2 = d(R P_r)/dR - P_t with the stretches f = dr/dR, g = r/R, P_r = mu (f - 1/f) + lambda ln(f g)/f and
    P_t with f and g exchanged; free at both edges."""
    at_rest = np.linspace(INNER, OUTER, layers + 1)
    width, middle = np.diff(at_rest), 0.5 * (at_rest[1:] + at_rest[:-1])
    mass = np.zeros(layers + 1)
    mass[1:] += 0.5 * SOLID.density * middle * width
    mass[:-1] += 0.5 * SOLID.density * middle * width

    def acceleration(r):
        f, g = np.diff(r) / width, 0.5 * (r[1:] + r[:-1]) / middle
        log_j = SOLID.lame * np.log(f * g)
        radial = middle * (SOLID.shear * (f - 1 / f) + log_j / f)
        around = 0.5 * width * (SOLID.shear * (g - 1 / g) + log_j / g)
        force = np.zeros_like(r)
        force[1:] -= radial + around
        force[:-1] += radial - around
        return force / mass

    interval = END / PICTURES
    steps = int(np.ceil(interval / (0.3 * width.min() / SOLID.wave_speed)))
    dt, r, v = interval / steps, at_rest.copy(), start(at_rest, speed)
    states = [(r, v, acceleration(r))]
    v = v + 0.5 * dt * acceleration(r)
    for _ in range(PICTURES):
        for _ in range(steps):
            r = r + dt * v
            v = v + dt * acceleration(r)
        states.append((r, v - 0.5 * dt * acceleration(r), acceleration(r)))
    return at_rest, np.array(states)


def thin_ring_period():
    """Of a ring much thinner than its radius r, in plane strain: r'' = -(E/(1 - nu^2)) u/(rho r^2); see K. F. Graff, Wave
    Motion in Elastic Solids (1975), 4.1, for the plane stress of a rod bent to a ring (E in the place of E/(1 - nu^2))."""
    radius = 0.5 * (INNER + OUTER)
    return 2 * np.pi * radius * (SOLID.density * (1 - SOLID.poisson**2) / SOLID.young) ** 0.5


class ExpandingRing(Case):
    name = "expanding_ring"
    title = "Expanding ring"
    about = """A quarter of a neo-Hookean ring (E = 1, Poisson's ratio 0.3, density 1, radii 1 and 1.25; plane strain) is set in motion
outwards with 0.001 (*small*) or 0.1 (*large*: it widens by a tenth, over up to four cells) times r^(-nu/(1 - nu)), which keeps the radial stress at zero
at first, and breathes for two periods. Reference: the radial equation of motion in 160 elements, which converges to second order; for
*small* its period is that of the thin ring, 2 pi r sqrt(rho (1 - nu^2)/E), to within 0.6 %. The particles stand on rings. Error: root mean
square over the particles and the pictures of the second half of the difference of radii, over the largest displacement."""
    errors = {"radius": Error("error of the radius"), "last": Error("at the end"),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {name: Study(f"{name}: cells per unit of length, factor 0.4.", (8, 16, 24, 32), 0.4,
                           quick=(8, 16, 32) if name == "large" else ())
               for name in SPEEDS}

    def methods(self):
        return methods.short()

    def scene(self, point):
        h = 1 / point.cells
        dp, room = h / point.split, OUTER * 1.5
        speed = SPEEDS[point.study]
        radial = f"{speed!r}*(x*x+y*y)^({-0.5 * (FALL + 1)!r})"
        ring = (f'<Body name="ring" material="solid" type="Cylinder"><Geometry x0="0" y0="0" z0="0" dp_bottom="{dp!r}" '
                f'dp_top="{dp!r}" Bottom_Inner_Radius="{INNER}" Top_Inner_Radius="{INNER}" Bottom_Outer_Radius="{OUTER}" '
                f'Top_Outer_Radius="{OUTER}" height="{h!r}" angle="90" discretization="1"/>'
                f'<InitialVelocity vx="{radial}*x" vy="{radial}*y" vz="0"/></Body>')
        room = np.ceil(room / h) * h
        return support.scene([ring], support.grid((0, 0, 0), (room, room, h), "202022", h), support.solution(END, point.factor),
                             [support.material("solid", SOLID.density, SOLID.law)], support.pictures(END / PICTURES, ["pres"]))

    def measure(self, point, folder):
        at_rest, exact = motion(SPEEDS[point.study])
        states = support.States(folder)
        first = np.hypot(states.column("x", 0), states.column("y", 0))
        largest, off = np.abs(exact[:, 0] - at_rest).max(), []
        for which, time in enumerate(states.times):
            if time < 0.5 * END:
                continue
            nearest = round(time / (END / PICTURES))
            late = time - nearest * END / PICTURES  # a picture is taken at the end of a step
            r, v, a = exact[nearest]
            off.append(np.hypot(states.column("x", which), states.column("y", which))
                       - np.interp(first, at_rest, r + late * v + 0.5 * late**2 * a))
        return {"radius": support.rms(np.concatenate(off)) / largest, "last": support.rms(off[-1]) / largest,
                "drift": support.drift(folder)}


CASE = ExpandingRing()
