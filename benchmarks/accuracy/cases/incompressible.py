"""Nearly incompressible solids at rest: Cook's membrane and a compressed block."""

import functools

import numpy as np

import derive
import methods
import plane_strain
from case import Case, Error, Study
from cases import support

DENSITY, YOUNG = 1.0, 1.0
LOADED, LOAD = 1 / 8, 1e-5  # width of the loaded strip, force on a unit of thickness
DAMPING, END, RAMP = 1.2, 18.0, 6.0

SHAPES = {"cook": lambda s, t: (s, (44 * s + (44 - 28 * s) * t) / 48), "block": lambda s, t: (s, t)}
STRIPS = {"cook": lambda x, y: x > 1 - LOADED, "block": lambda x, y: (y > 1 - LOADED) & (x < 0.5)}


@functools.cache
def deflection(body, poisson, rows=16):
    """Of the strip under a unit force, by `rows` x `rows` finite elements, in eighths; eight rows change it by 0.2 % (Cook) and 0.02 %."""
    mesh = plane_strain.Mesh(SHAPES[body], rows, rows)
    solid = derive.Solid(YOUNG, poisson, DENSITY)
    weights = mesh.mean_over(STRIPS[body])
    force, held = np.zeros_like(mesh.nodes), np.zeros(mesh.nodes.shape, bool)
    if body == "cook":
        force[:, 1], held[mesh.s == 0] = weights, True
    else:
        force[:, 1] = -weights
        held[mesh.s == 0, 0] = held[mesh.t == 0] = True
    return abs(weights @ mesh.solve(solid.shear, solid.lame + 2 / 3 * solid.shear, force, held)[:, 1])


def particles(body, h, split):
    """Lines of a point file: columns of particles along y, with as many in each as its height has lengths h/split."""
    dp, lines = h / split, []
    for x in (np.arange(round(1 / dp)) + 0.5) * dp:
        lower, upper = SHAPES[body](x, 0.0)[1], SHAPES[body](x, 1.0)[1]
        count = max(round((upper - lower) / dp), 1)
        size = (upper - lower) / count
        for y in lower + (np.arange(count) + 0.5) * size:
            lines += [f"{DENSITY * dp * dp * size!r} {x!r} {y!r} {(k + 0.5) * dp!r}" for k in range(split)]
    return "\n".join(lines) + "\n"


def every_transfer():
    return list(dict.fromkeys([*methods.flip(), *methods.every_transfer(("QuadraticBSpline",))]))


class Incompressible(Case):
    name = "incompressible"
    title = "Cook's membrane and a compressed block"
    about = """Elastic bodies in plane strain (one cell between symmetry planes; E = 1) that a small load bends or compresses,
damped until they rest, for Poisson's ratios from 0.3 to 0.4999, with `Volumetric averaging` none and cell. *cook*: the
membrane of R. D. Cook (J. Struct. Div. ASCE 100 (1974) 1851), here of length 1, heights 44/48 and 16/48, clamped at x = 0 and loaded
upwards over the last eighth of its length. *block*: half of a block on a rough base, twice as wide as high, pressed down over
the middle half of its upper eighth. Particles follow the edges (`Point` files). Error: of the loaded part's mean displacement, against
finite elements that do not lock (nine nodes, linear pressures; their own error is 0.1 %), without its sign: at 0.49 and above, without averaging, all are too
stiff. *Pressure noise*: standard deviation inside the cells, over the mean of the absolute value."""
    errors = {"deflection": Error("error of the displacement, %", ".1f", 100),
              "noise": Error("pressure noise, %", ".0f", 100, order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {f"{body} {poisson:g} {averaging}":
               Study(f"{body}, Poisson's ratio {poisson:g}, averaging {averaging}; cells along the length, factor 0.5.", (4, 8, 12, 16), 0.5,
                     quick=(8, 16) if body == "cook" and poisson == 0.49 else (), methods=every_transfer if poisson == 0.4999 else None)
               for body in SHAPES for poisson in (0.3, 0.49, 0.4999) for averaging in ("none", "cell")}
    plotted = ("cook 0.4999 none", "cook 0.4999 cell")

    def methods(self):
        return methods.flip()

    def excluded(self, method):
        if method.shape in ("cpGIMP", "CPDI", "CPDI2"):
            return "particles of a point file have no domains that fit the body"
        return None

    @staticmethod
    def of(point):
        body, poisson, averaging = point.study.split()
        return body, float(poisson), averaging

    def files(self, point):
        return {"points.txt": particles(self.of(point)[0], 1 / point.cells, point.split)}

    def scene(self, point):
        body, poisson, averaging = self.of(point)
        h = 1 / point.cells
        solid = derive.Solid(YOUNG, poisson, DENSITY)
        if body == "cook":
            share, area = f"if(X&gt;{1 - LOADED},1,0)", LOADED * (16 + 28 * LOADED / 2) / 48
            grid = support.grid((0, -2 * h, 0), (1 + 2 * h, round((60 / 48 + 4 * h) / h) * h, h), "100022", h)
        else:
            share, area = f"if(Y&gt;{1 - LOADED},if(X&lt;0.5,-1,0),0)", LOADED / 2
            grid = support.grid((0, 0, 0), (1.5, 1 + 4 * h, h), "201022", h)
        force = f'<BodyForce by="{LOAD / (DENSITY * area)!r}*{share}*if(t&lt;{RAMP},(t/{RAMP})^2*(3-2*t/{RAMP}),1)"/>'
        bodies = [f'<Body name="solid" material="solid" type="Point"><Geometry file="points.txt"/>{force}</Body>']
        more = f'<DynamicRelax damping="{DAMPING}"/><Volumetric averaging="{averaging}"/>'
        return support.scene(bodies, grid, support.solution(END, point.factor, more),
                             [support.material("solid", DENSITY, solid.law)], support.pictures(END, ["pres"]))

    def measure(self, point, folder):
        body, poisson, _ = self.of(point)
        states = support.States(folder)
        x, y = states.column("x", 0), states.column("y", 0)
        loaded = STRIPS[body](x, y)
        moved = abs((states.column("y") - y)[loaded].mean())
        pressure = states.column("pres")
        cells = np.unique(np.floor(np.column_stack([x, y]) * point.cells), axis=0, return_inverse=True)[1].ravel()
        count = np.bincount(cells)
        mean = np.bincount(cells, pressure) / count
        scatter = np.sqrt(((pressure - mean[cells]) ** 2).mean())
        return {"deflection": moved / (LOAD * deflection(body, poisson)) - 1, "noise": scatter / np.abs(pressure).mean(),
                "drift": support.drift(folder)}


CASE = Incompressible()
