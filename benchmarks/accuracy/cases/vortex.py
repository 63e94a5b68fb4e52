"""The generalised vortex: a ring whose circles turn, each by its own angle."""

import numpy as np
import sympy as sp

import derive
import methods
from case import Case, Error, Study
from cases import support
from derive import BEND, GAIN, RADIUS, SLOPE, SPIN, T, X, Y

RINGS = "rings, fine steps"
INNER, OUTER, TURN, END, PICTURES, HALF = 0.75, 1.25, sp.Rational(3, 20), 1.0, 4, 2
ROOM = 1.5  # half of the grid
SOLID = derive.Solid(1.0, 0.3, 1.0)
MIDDLE = sp.Rational(17, 16)  # of the radii's squares, which are 1/2 below and above it
GROWTH = sp.Rational(13, 5) * T * (1 - T**2)


SQUARE, SHARE = sp.symbols("square share", positive=True)  # of the radius; 1 - 4 (square - MIDDLE)^2, whose square is the profile


def loads():
    """InitialVelocity and BodyForce: the radial and the circumferential part over the radius, at the present
    place. Both are polynomials in the radius's square, written by means of SHARE to keep them short."""
    off, radius = SQUARE - MIDDLE, sp.sqrt(SQUARE)
    profile = (1 - 4 * off**2) ** 2
    first, second = -16 * off * SHARE, sp.factor(sp.diff(profile, SQUARE, 2))
    grown = TURN * GROWTH
    local = []
    for part in derive.turning_rings(SOLID):
        part = sp.expand(part / RADIUS).subs({SLOPE: 2 * radius * first * grown, BEND: (2 * first + 4 * SQUARE * second) * grown,
                                              SPIN: SHARE**2 * sp.diff(grown, T), GAIN: SHARE**2 * sp.diff(grown, T, 2)})
        local.append(part.subs(RADIUS, radius))
    names = {"share": "4*(square-0.5625)*(1.5625-square)", "square": "X*X+Y*Y"}
    radial, around = (derive.written(part, **names) for part in local)
    spin = derive.written(SHARE**2 * sp.diff(grown, T).subs(T, 0), **names)
    return (f'<InitialVelocity vx="-Y*({spin})" vy="X*({spin})" vz="0"/>'
            f'<BodyForce bx="({radial})*x-({around})*y" by="({radial})*y+({around})*x"/>')


def angles(first, time):
    return float(TURN) * growth(time) * (1 - 4 * (first[:, 0]**2 + first[:, 1]**2 - float(MIDDLE)) ** 2) ** 2


def growth(time):
    return 2.6 * time * (1 - time**2)


def exact_places(first, time):
    a = angles(first, time)
    return np.stack([first[:, 0] * np.cos(a) - first[:, 1] * np.sin(a), first[:, 0] * np.sin(a) + first[:, 1] * np.cos(a)],
                    axis=1)


def exact_gradients(first, time):
    """Rotation by alpha of 1 + R dalpha/dR e_theta e_R."""
    radius = np.hypot(first[:, 0], first[:, 1])
    a, off = angles(first, time), radius**2 - float(MIDDLE)
    slope = float(TURN) * growth(time) * 2 * (1 - 4 * off**2) * (-8 * off) * 2 * radius
    out, around = first[:, :2] / radius[:, None], np.stack([-first[:, 1], first[:, 0]], axis=1) / radius[:, None]
    f = np.tile(np.eye(3), (len(first), 1, 1))
    f[:, :2, :2] += (radius * slope)[:, None, None] * around[:, :, None] * out[:, None, :]
    turn = np.tile(np.eye(3), (len(first), 1, 1))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(a)
    turn[:, 1, 0], turn[:, 0, 1] = np.sin(a), -np.sin(a)
    return turn @ f


class Vortex(Case):
    name = "vortex"
    title = "Generalised vortex"
    about = """A neo-Hookean ring, radii 0.75 to 1.25, in plane strain (one cell between symmetry planes), whose circles turn
by 0.15 (1 - 4 (R^2 - 17/16)^2)^2 2.6 t (1 - t^2), to t = 1: shears of up to 1.2 and superposed rotation, edges at rest and
free of stress. After R. M. Brannon, K. Kamojjala and A. Sadeghirad, *Establishing credibility of particle methods through
verification testing* (2011), with another profile, which needs no square root. The body force is derived with SymPy. Error:
the largest over four times of the root mean square over the particles of the displacement's error, over the largest
displacement. A lattice of particles cuts the ring's edges into stairs; particles in rings (`discretization="1"`) follow them."""
    errors = {"displacement": Error("error of displacement"), "stress": Error("error of stress"),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {
        "steps as cells": Study("time step proportional to the cells (factor 0.4); cells across the ring's width.",
                                (4, 8, 12, 16), 0.4),
        "fine steps": Study("time step proportional to the cells squared (factor 3.2/cells).", (4, 8, 12, 16), lambda n: 3.2 / n,
                            methods=lambda: [*methods.flip(), *methods.product(("QuadraticBSpline", "CubicBSpline"), ("APIC",))]),
        RINGS: Study("the same with the particles in rings, which follow the edges.", (4, 8, 12, 16), lambda n: 3.2 / n,
                     methods=lambda: methods.product(("QuadraticBSpline", "CubicBSpline", "CPDI2", "SGMP"))),
    }

    def methods(self):
        return methods.short()

    def scene(self, point):
        h = (OUTER - INNER) / point.cells
        dp = h / point.split
        ring = (f'<Body name="ring" material="solid" type="Cylinder"><Geometry x0="0" y0="0" z0="0" dp_bottom="{dp!r}" '
                f'dp_top="{dp!r}" Bottom_Inner_Radius="{INNER}" Top_Inner_Radius="{INNER}" Bottom_Outer_Radius="{OUTER}" '
                f'Top_Outer_Radius="{OUTER}" height="{h!r}" discretization="{int(point.study == RINGS)}"/>{loads()}</Body>')
        return support.scene([ring], support.grid((-ROOM, -ROOM, 0), (ROOM, ROOM, h), "000022", h),
                             support.solution(END, point.factor), [support.material("solid", SOLID.density, SOLID.law)],
                             support.pictures(END / PICTURES, support.STRESSES))

    def measure(self, point, folder):
        states = support.States(folder)
        first = support.places(states, 0)
        worst = largest = 0.0
        for which in range(1, len(states.times)):
            exact = exact_places(first, states.times[which])
            worst = max(worst, support.rms(support.places(states, which)[:, :2] - exact))
            largest = max(largest, np.abs(exact - first[:, :2]).max())
        # At the end the ring is back; the stress is measured near its largest.
        exact = support.neo_hookean(exact_gradients(first, states.times[HALF]), SOLID)
        stress = support.rms(support.stresses(states, HALF) - exact) / np.abs(exact).max()
        return {"displacement": worst / largest, "stress": stress, "drift": support.drift(folder)}


CASE = Vortex()
