"""Pieces of input files that the studies share."""

import run_one  # noqa: F401: says where the next one is

import _mpm

FACTOR = 0.8  # of explicit runs, of the critical step
SHAPES = ("linear", "uGIMP", "QuadraticBSpline", "SGMP", "CPDI2")


def neo_hookean(young, poisson, density, name="solid", viscous=False):
    """`viscous`: with the default artificial viscosity, else without."""
    viscosity = "" if viscous else ' bq1="0" bq2="0"'
    return material(name, density, f'type="NeoHookean" Young="{young!r}" Poisson="{poisson!r}"{viscosity}')


def material(name, density, strength, more=""):
    return _mpm.material(name, repr(float(density)), strength, more)


def rigid(density=1.0, name="rigid"):
    return material(name, density, 'type="Rigid"')


def block(name, lower, size, dp, of="solid", more="", attributes=""):
    geometry = 'x0="{!r}" y0="{!r}" z0="{!r}" lx="{!r}" ly="{!r}" lz="{!r}"'.format(*map(float, (*lower, *size)))
    return (f'<Body name="{name}" material="{of}" type="Block" {attributes}><Geometry dp="{float(dp)!r}" {geometry}/>'
            f"{more}</Body>")


def ring(name, inner, outer, height, dp, of="solid", more="", attributes="", rings=False):
    """A quarter about the z axis, its particles in a lattice along the axes or in rings."""
    return (f'<Body name="{name}" material="{of}" type="Cylinder" {attributes}>'
            f'<Geometry x0="0" y0="0" z0="0" dp_bottom="{dp!r}" dp_top="{dp!r}" Bottom_Inner_Radius="{inner}" '
            f'Top_Inner_Radius="{inner}" Bottom_Outer_Radius="{outer}" Top_Outer_Radius="{outer}" height="{height!r}" angle="90" discretization="{int(rings)}"/>{more}</Body>')


def moved(vx=0.0, vy=0.0, vz=0.0):
    return f'<PrescribedVelocity vx="{vx}" vy="{vy}" vz="{vz}"/>'


def grid(shape, lower, upper, faces, cell):
    text = _mpm.grid([float(v) for v in lower], [float(v) for v in upper], faces, float(cell))
    return text.replace("<Grid>", f'<Grid shape="{shape}">')


def implicit(end, step, kind="quasistatic", more="", children=""):
    return _mpm.solution(repr(float(end)), attributes='Integration="impl"',
                         more=f'<Implicit type="{kind}" time_step="{float(step)!r}" {more}/>{children}')


def explicit(end, factor=FACTOR, damping=None, more="", transfer="FLIP"):
    relax = f'<DynamicRelax damping="{damping!r}"/>' if damping else ""
    return _mpm.solution(repr(float(end)), factor=repr(factor), attributes=f'transfer="{transfer}"', more=relax + more)


def pressed_block(shape, h, height, velocity, in_contact, solution, materials, output):
    """A block of 2 x 2 cells between smooth walls and a rigid platen on it with this velocity, a number or an expression: it is
    in contact, or the block sticks to it."""
    body = block("block", (0, 0, 0), (2 * h, 2 * h, height), h / 2)
    platen = block("platen", (0, 0, height), (2 * h, 2 * h, 2 * h), h / 2, "rigid", moved(vz=velocity))
    parts = (grid(shape, (0, 0, 0), (2 * h, 2 * h, height + 4 * h), "222220", h), solution, materials, output)
    if not in_contact:
        return scene([body, platen], *parts)
    return two_components([body], [platen], *parts, more='<Contact enable="1"/>')


STRESSES = ("SigmaX", "SigmaY", "SigmaZ", "SigmaXY", "SigmaYZ", "SigmaXZ")


def pictures(interval, variables=("SigmaZ",)):
    return f'<PostProcessing time_interval="{float(interval)!r}" h5part="1" var="{"|".join(variables)}"/>'


def scene(bodies, grid_, solution, materials, output="", more=""):
    return _mpm.scene(bodies, grid_, solution, materials, output, more)


def two_components(first, second, grid_, solution, materials, output="", more=""):
    """Bodies that touch: each list is a component."""
    text = _mpm.scene(first, grid_, solution, materials, output, more)
    return text.replace("</Component>", '</Component>\n<Component name="other">\n' + "\n".join(second) + "\n</Component>", 1)
