"""Elastic bodies at rest: Lame's cylinder under pressure, and a plate with a hole."""

import numpy as np

import derive
import methods
from case import Case, Error, Study
from cases import support

SOLID = derive.Solid(1.0, 0.3, 1.0)
LOAD, DAMPING, END = 1e-4, 1.0, 20.0
INNER, OUTER = 1.0, 2.0  # of the cylinder
HOLE, WIDTH = 1.0, 3.0  # of the quarter of the plate


def lame(x, y):
    """Stresses xx, yy, xy of a cylinder under an inner pressure of 1."""
    r2 = x * x + y * y
    a, b = INNER**2 / (OUTER**2 - INNER**2), INNER**2 * OUTER**2 / (OUTER**2 - INNER**2)
    radial, around = a - b / r2, a + b / r2
    return (radial * x * x + around * y * y) / r2, (radial * y * y + around * x * x) / r2, (radial - around) * x * y / r2


def kirsch(x, y):
    """Stresses xx, yy, xy of an infinite plate with a hole under a tension of 1 along x (G. Kirsch, 1898)."""
    r, t = np.hypot(x, y), np.arctan2(y, x)
    q = (HOLE / r) ** 2
    xx = 1 - q * (1.5 * np.cos(2 * t) + np.cos(4 * t)) + 1.5 * q * q * np.cos(4 * t)
    yy = -q * (0.5 * np.cos(2 * t) - np.cos(4 * t)) - 1.5 * q * q * np.cos(4 * t)
    xy = -q * (0.5 * np.sin(2 * t) + np.sin(4 * t)) + 1.5 * q * q * np.sin(4 * t)
    return xx, yy, xy


def kirsch_written():
    """The same as expressions of the input language."""
    q, t = f"({HOLE**2}/(x*x+y*y))", "atan2(y,x)"
    return (f"{LOAD}*(1-{q}*(1.5*cos(2*{t})+cos(4*{t}))+1.5*{q}^2*cos(4*{t}))",
            f"{LOAD}*(-{q}*(0.5*cos(2*{t})-cos(4*{t}))-1.5*{q}^2*cos(4*{t}))",
            f"{LOAD}*(-{q}*(0.5*sin(2*{t})+sin(4*{t}))+1.5*{q}^2*sin(4*{t}))")


class ElasticStatics(Case):
    name = "elastic_statics"
    title = "Lamé's cylinder and a plate with a hole"
    about = """Quarters of bodies in plane strain (one cell between symmetry planes; E = 1, Poisson's ratio 0.3), damped
until they rest. *cylinder*: radii 1 and 2 under an inner pressure of 1e-4. *plate*: a hole of radius 1 in a square of half
width 3, under the tractions that Kirsch's solution of the infinite plate has there for a tension of 1e-4. The lattice of
particles cuts the round edges into stairs, and the load on the surface is spread over about a cell: first order is to be
expected. Error: root mean square of the stress over its largest value; *inside*: of the particles more than 0.25 from an
edge."""
    errors = {"stress": Error("error of stress"), "inside": Error("inside", ".2e", order=False)}
    studies = {"cylinder": Study("cells per unit of length, factor 0.4.", (4, 8, 12, 16), 0.4),
               "plate": Study("cells per unit of length, factor 0.4.", (3, 4, 6, 8), 0.4)}

    def methods(self):
        return methods.short()

    def scene(self, point):
        h = 1 / point.cells
        body = self.cylinder(h, point.split) if point.study == "cylinder" else self.plate(h, point.split)
        room = (OUTER if point.study == "cylinder" else WIDTH) + 4 * h
        return support.scene(body, support.grid((0, 0, 0), (room, room, h), "202022", h),
                             support.solution(END, point.factor, f'<DynamicRelax damping="{DAMPING}"/>'),
                             [support.material("solid", SOLID.density, SOLID.law)], support.pictures(END, support.STRESSES))

    @staticmethod
    def round_body(name, inner, outer, h, split, more):
        dp = h / split
        return (f'<Body name="{name}" material="solid" type="Cylinder" {more[0]}><Geometry x0="0" y0="0" z0="0" dp_bottom="{dp!r}" '
                f'dp_top="{dp!r}" Bottom_Inner_Radius="{inner}" Top_Inner_Radius="{inner}" Bottom_Outer_Radius="{outer}" '
                f'Top_Outer_Radius="{outer}" height="{h!r}" angle="90"/>{more[1]}</Body>')

    def cylinder(self, h, split):
        # A smooth function of the radius that is LOAD at the inner and 0 at the outer surface.
        load = f"{LOAD / (OUTER - INNER)!r}*({OUTER}-sqrt(x*x+y*y))"
        return [self.round_body("cylinder", INNER, OUTER, h, split, ("", f'<Traction pressure="{load}"/>'))]

    def plate(self, h, split):
        whole = support.block("whole", (0, 0, 0), (WIDTH, WIDTH, h), h / split, "solid", attributes='ForBoolBody="1"')
        hole = self.round_body("hole", 0, HOLE, h, split, ('ForBoolBody="1"', ""))
        xx, yy, xy = kirsch_written()
        loads = (f'<Traction tx="{xx}" ty="{xy}" normal="0" xmin="{WIDTH - 0.5}" ramp="0.9"/>'
                 f'<Traction tx="{xy}" ty="{yy}" normal="1" ymin="{WIDTH - 0.5}" ramp="0.9"/>')
        return [whole, hole, '<Body name="plate" material="solid" type="Bool" BoolType="subtract" BoolBodyA="whole" '
                             f'BoolBodyB="hole">{loads}</Body>']

    def measure(self, point, folder):
        states = support.States(folder)
        x, y = states.column("x"), states.column("y")
        exact = lame(x, y) if point.study == "cylinder" else kirsch(x, y)
        found = [states.column(name) for name in ("SigmaX", "SigmaY", "SigmaXY")]
        off = np.column_stack([f / LOAD - e for f, e in zip(found, exact)])
        radius = np.hypot(x, y)
        if point.study == "cylinder":
            inside = (radius > INNER + 0.25) & (radius < OUTER - 0.25)
        else:
            inside = (radius > HOLE + 0.25) & (x < WIDTH - 0.25) & (y < WIDTH - 0.25)
        scale = max(np.abs(e).max() for e in exact)
        return {"stress": support.rms(off) / scale, "inside": support.rms(off[inside]) / scale}


CASE = ElasticStatics()
