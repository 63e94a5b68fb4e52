"""Friction and rebound against exact answers, over cells, shape and normals (apps/scenes/ball_on_a_slope, sliding_block, pressed_cube and
two_discs).

Ball on a slope: its centre within 2 % of a rigid ball's path (P. Huang, thesis, Tsinghua 2010, 4-62), the error falling with the cell.
Block: its acceleration within 1 % of Coulomb's, on one plate and between two. Cube under a platen: none of it leaks. Discs: at most 1 %
of the energy is lost, the first force comes at a gap below 0.05 cells. What normals by gradients of mass miss is printed and is no
failure: they tilt at edges (docs/contact.md)."""

import itertools

import _common  # first: it says where the next one is
import _friction

COMMON = {"cell": ("cell", "g"), "shape": ("shape", ""), "normal": ("normals", ""), "kind": ("contact_type", "d"),
          "particles": ("particles", "d"), "steps": ("steps", "d")}
END = {"drift": ("energy drift %", "+.2f"), "cpu_seconds": ("processor s", ".1f")}
SLOPE = {"motion": ("motion", ""), "plane": ("slope", ""), **COMMON, "centre": ("way of the centre, error %", "+.2f"), **END}
ROLLING = {"particles in": ("ball's particles in", ""), "stiffness": ("stiffness", "g"), "cell": ("cell", "g"), "particles": ("particles", "d"),
           "steps": ("steps", "d"), "centre": ("way of the centre, error %", "+.2f"), **END}
BLOCK = {"plates": ("plates", "d"), "weight": ("weight of the plates", "d"), **COMMON, "acceleration": ("acceleration, error %", "+.2f"),
         "plate": ("of the upper plate %", "+.2f"), "across": ("across/along %", ".2f"), "heat": ("heat of friction, error %", "+.2f"),
         "entered": ("enters the base, cells", "+.3f"), **END}
CUBE = {**COMMON, "force": ("force, error %", "+.2f"), "width": ("width, error %", "+.2f"), "entered": ("enters the platen, cells", "+.3f"), **END}
DISCS = {"offset": ("offset/R", "g"), **COMMON, "gap": ("gap, cells", ".3f"), "lost": ("energy lost %", "+.2f"), "kinetic": ("kinetic energy left", ".3f"),
         "momentum": ("momentum/(m v)", ".0e"), "angular": ("angular momentum/(m v R) %", ".3f"), **END}


def row(options, job, text, measure, *words, **names):
    folder = options.out / "-".join(str(word) for word in (job, *names.values()))
    seconds = _common.run(folder, text, job)
    found = {**names, **measure(folder, *words), "cpu_seconds": seconds}
    print(job, " ".join(f"{key} {value}" for key, value in found.items()), flush=True)
    return found


def slope(options, verdict):
    cases = [*itertools.product(("rolling", "sliding"), ("rigid", "elastic"), ("mass_gradient",), (1,), (0.4, 0.2)),
             *itertools.product(("rolling", "sliding"), ("rigid",), ("mass_gradient", "regression"), (1,), options.finest),
             *itertools.product(("rolling", "sliding"), ("rigid",), ("regression",), (1, 0), (0.4, 0.2))]
    rows = []
    for motion, plane, normal, kind, cell in cases:
        case = {"cell": cell, "motion": motion, "plane": plane, "shape": "linear", "normal": normal, "kind": kind}
        rows.append(row(options, "ball_on_a_slope", _friction.slope(**case), _friction.measure_slope, motion, **case))
    for r in rows:
        name = f"ball on a slope, {r['motion']}, {r['plane']}, {r['normal']}, type {r['kind']}, cells of {r['cell']}"
        if r["cell"] <= 0.2:
            verdict.expect(abs(r["centre"]) < 2, f"{name}: {r['centre']:+.2f} %, asked for 2 %")
        coarse = [c for c in rows if c["cell"] == 2 * r["cell"] and all(c[key] == r[key] for key in ("motion", "plane", "normal", "kind"))]
        for c in coarse:  # below 0.2 % it may grow
            if abs(c["centre"]) < abs(r["centre"]) < 0.2:
                print(f"BELOW 0.2 % {name}: the error grows, {c['centre']:+.2f} to {r['centre']:+.2f} %", flush=True)
            verdict.expect(abs(r["centre"]) < max(abs(c["centre"]), 0.2), f"{name}: the error grows, {c['centre']:+.2f} to {r['centre']:+.2f} %")
    return rows


def rolled(options, plane, shells, stiffness, cell):
    case = {"cell": cell, "motion": "rolling", "plane": plane, "normal": "automatic", "shells": shells, "stiffness": stiffness}
    found = row(options, "ball_on_a_slope", _friction.slope(**case), _friction.measure_slope, "rolling", **case)
    return found | {"particles in": "shells" if shells else "a lattice"}


def expect_falling(verdict, rows, shells, what):
    """The errors of what is ten times as stiff; the softer ones roll farther as they give way."""
    errors = [abs(r["centre"]) for r in rows if r["shells"] == shells and r["stiffness"] == 10]
    verdict.expect(errors == sorted(errors, reverse=True), f"{what}: errors of {errors} % do not fall with the cell")


def rolling(options, verdict):
    """What is soft, and what has steps: particles on a lattice or in shells, and stiffer balls."""
    cases = (*itertools.product((False,), (0.3, 1, 3, 10), (0.2,)), *itertools.product((True,), (1, 10), (0.4, 0.2, *options.finest)))
    rows = [rolled(options, "rigid", *case) for case in cases]
    expect_falling(verdict, rows, True, "a stiff ball in shells")
    return rows


def free(options, verdict):
    """A rigid ball that moves freely, on rubber that is held from below."""
    cases = [(shells, stiffness, cell) for stiffness in (1, 10) for shells in (False, True) for cell in (0.4, 0.2, *options.finest)]
    rows = [rolled(options, "rubber", *case) for case in cases]
    expect_falling(verdict, rows, False, "a rigid ball on a lattice, on stiff rubber")
    expect_falling(verdict, rows, True, "a rigid ball in shells, on stiff rubber")
    return rows


def block(options, verdict):
    cases = [*itertools.product((1,), ("linear",), (("regression", 0), ("mass_gradient", 0), ("mass_gradient", 1)), (1,), (1.0, 0.5)),
             *itertools.product((1,), ("uGIMP", "QuadraticBSpline", "SGMP"), (("regression", 0),), (1,), (1.0,)),
             *itertools.product((1,), ("linear",), (("regression", 0),), (0, 2), (1.0,)),
             *itertools.product((2,), ("linear",), (("regression", 0), ("mass_gradient", 1)), (1,), (1.0, 0.5))]
    rows = []
    for plates, shape, (normal, weight), kind, cell in cases:
        case = {"plates": plates, "weight": weight, "cell": cell, "shape": shape, "normal": normal, "kind": kind}
        rows.append(row(options, "sliding_block", _friction.block(**case), _friction.measure_block, 0.3, plates, cell, **case))
    for r in rows:
        what = (f"block, {r['plates']} plates, {r['shape']}, {r['normal']}, weight {r['weight']}, type {r['kind']}, cells of {r['cell']}: "
                f"acceleration {r['acceleration']:+.2f} %, asked for 1 %; {r['entered']:+.3f} cells within the base, asked for 0.05")
        if abs(r["acceleration"]) >= 1 or r["entered"] >= 0.05:
            if r["normal"] == "mass_gradient" and r["weight"] == 0:
                print(f"NOT REACHED {what}", flush=True)
            else:
                verdict.expect(False, what)
    return rows


def cube(options, verdict):
    rows = []
    for shape, normal, kind, cell in [*itertools.product(("QuadraticBSpline",), ("regression",), (1,), (1.0, 0.5, 0.25)),
                                      *itertools.product(("QuadraticBSpline",), ("mass_gradient",), (1,), (1.0, 0.5)),
                                      *itertools.product(("linear", "uGIMP", "SGMP"), ("regression",), (1,), (1.0,)),
                                      ("QuadraticBSpline", "regression", 0, 1.0)]:
        case = {"cell": cell, "shape": shape, "normal": normal, "kind": kind}
        rows.append(row(options, "pressed_cube", _friction.cube(**case), _friction.measure_cube, cell, **case))
        verdict.expect(normal == "mass_gradient" or rows[-1]["entered"] < 0.05,
                       f"cube, {shape}, {normal}, type {kind}, cells of {cell}: {rows[-1]['entered']:+.3f} cells within the platen, asked for 0.05")
    return rows


def discs(options, verdict):
    rows = []
    for offset, shape, normal, kind, cell in [
            *itertools.product((0.0, 5.0, 8.0), ("linear",), ("regression",), (0,), (1.0, 0.5, 0.25)),
            *itertools.product((0.0, 8.0), ("uGIMP", "QuadraticBSpline", "SGMP"), ("regression",), (0,), (1.0,)),
            *itertools.product((0.0,), ("QuadraticBSpline",), ("regression",), (0,), (0.5, 0.25)),
            *itertools.product((0.0, 8.0), ("linear",), ("regression",), (1,), (1.0, 0.5)),
            *itertools.product((0.0, 8.0), ("linear",), ("mass_gradient",), (0,), (1.0, 0.5))]:
        case = {"cell": cell, "offset": offset / _friction.RADIUS, "shape": shape, "normal": normal, "kind": kind}
        rows.append(row(options, "two_discs", _friction.discs(**case | {"offset": offset}), _friction.measure_discs, cell, offset, **case))
    for r in rows:
        what = (f"discs, offset {r['offset']:g} R, {r['shape']}, {r['normal']}, type {r['kind']}, cells of {r['cell']}: {r['lost']:+.2f} % lost, "
                f"asked for 1 %; gap {r['gap']:.3f}, asked for 0.05")
        verdict.expect(r["momentum"] < 1e-12, f"{what}; momentum {r['momentum']:.0e}")
        if abs(r["lost"]) <= 1 and r["gap"] < 0.0505:  # the first step within 0.05
            continue
        if (r["shape"], r["normal"], r["kind"]) == ("linear", "regression", 0):
            verdict.expect(False, what)
        else:
            print(f"NOT REACHED {what}", flush=True)
    return rows


def main():
    parser = _common.arguments(__doc__, "friction_and_rebound")
    parts = {"slope": (slope, SLOPE), "rolling": (rolling, ROLLING), "free": (free, ROLLING), "block": (block, BLOCK), "cube": (cube, CUBE),
             "discs": (discs, DISCS)}
    parser.add_argument("--parts", nargs="+", default=list(parts), choices=parts)
    parser.add_argument("--finest", nargs="*", type=float, default=[], help="cells of further balls on the rigid slope, for example 0.1")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    for part in options.parts:
        make, columns = parts[part]
        _common.write(options.out, part, make(options, verdict), columns)
    verdict.finish()


main()
