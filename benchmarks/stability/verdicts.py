#!/usr/bin/env python3
"""Scenes that strain a material point method, and a verdict on each: which end, how much energy, how fast.

  verdicts.py                      every scene with every shape and scheme; an hour and a half on one core
  verdicts.py --scene NAME ...     these scenes; --shape, --scheme, --averaging choose methods alike
  verdicts.py --fracture           the stretch at which each shape tears a bar
  verdicts.py --course             the error of the energy of a vibrating block in eighths of 16 units of time
  verdicts.py --docs               with any of these: also its table of docs/stability.md. Verdicts and the block's are kept in
                                   docs/stability/verdicts.csv and course.csv, where those that were not asked for stay
  verdicts.py --tables             the tables of these two from the files, without a run

stable: the run completes, its energy balance is within 1 % in the mean of the last quarter of the rows of the status file,
and no particle is faster at the end than the scene's bound. drift: it completes, but the balance is not, or a particle is too fast. stopped: exit code 3 with a message that says what failed, at
which step. wrong: any other end, or a number that is not finite in a file. The program's defaults, with FLIP and a factor of 0.9
where the scene says nothing else."""

import argparse
import dataclasses
import functools
import itertools
import pathlib
import sys
import tempfile

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / part) for part in ("benchmarks", "tests/system")]

from accuracy import methods  # noqa: E402: found by the line above
from common import results  # noqa: E402
import _mpm  # noqa: E402
import bits_laws  # noqa: E402
import numpy as np  # noqa: E402

PAGE, TABLE = results.ROOT / "docs/stability.md", results.ROOT / "docs/stability/verdicts.csv"
COURSE_TABLE = results.ROOT / "docs/stability/course.csv"
AVERAGING = ("none", "cell")
SCHEMES = methods.choices("Solution", "algorithm")
WITHIN = 0.01  # of the energy
JWL = '<EquationOfState type="JWL" A="371.2e3" B="3.23e3" R1="4.15" R2="0.95" w="0.3" E0="7e3"/>'
COPPER = _mpm.material("copper", 8.93e-3, 'type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="157" TangMod="423"',
                       '<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>')


@dataclasses.dataclass(frozen=True)
class Scene:
    about: str
    text: str
    fastest: float  # bound of a particle's speed


def elastic(name, density, young, poisson=0.3, law="IsoElastic"):
    return _mpm.material(name, density, f'type="{law}" Young="{young!r}" Poisson="{poisson!r}"')


def box(upper, cell=1, faces="000000"):
    return _mpm.grid((0, 0, 0), upper, faces, cell)


def solution(end, more="", factor=0.9):
    return _mpm.solution(repr(end), "MUSL", factor, "", more)


def collision(about, first, second, end, fastest):
    """Two blocks that meet in the middle of a cell at a relative speed of 2; of 4 x 4 x 4 cells."""
    bodies = [_mpm.block("left", (1.3, 2.2, 2.1), (4, 4, 4), (2, 0.3, 0.1), of="first"),
              _mpm.block("right", (5.8, 2.2, 2.1), (4, 4, 4), (0, 0, 0), of="second")]
    return Scene(about, _mpm.scene(bodies, box((14, 9, 9)), solution(end), [first, second]), fastest)


def wave(about, material, end, dp=0.5, cell=1, factor=0.9, fastest=3.0, room=12):
    """A block that vibrates in its longest mode while it drifts across cells."""
    speed = [f"{drift}+0.5*cos(pi*({axis}-{low})/6)" for drift, axis, low in zip((0.4, 0.3, 0.2), "xyz", (2.1, 2.2, 2.3))]
    body = _mpm.block("block", (2.1, 2.2, 2.3), (6, 6, 6), speed, dp, "soft")
    return Scene(about, _mpm.scene([body], box((room,) * 3, cell), solution(end, factor=factor), [material]), fastest)


def narrow_cells():
    grid = box((12, 12, 12)).replace('dx="1" dy="1" dz="1"', 'dx="1" dy="1" dz="0.1"')
    body = _mpm.block("block", (2.1, 2.2, 2.25), (6, 6, 2), ("0.4+0.5*cos(pi*(x-2.1)/6)", 0.3, 0.05), 0.25, "soft")
    return Scene("cells of 1 x 1 x 0.1", _mpm.scene([body], grid, solution(4.0), [elastic("soft", 1.0, 1000.0)]), 3.0)


def lone_particle():
    body = ('<Body name="lone" material="soft" type="Point"><Geometry><Point mass="0.125" x="2.5" y="2.5" z="2.5"/></Geometry>'
            '<InitialVelocity vx="0.5" vy="0.05" vz="0.01"/></Body>')
    return Scene("a lone particle that creeps across the faces of cells",
                 _mpm.scene([body], box((8, 6, 6)), solution(8.0), [elastic("soft", 1.0, 1000.0)]), 0.6)


def impact():
    ball = ('<Body name="ball" material="copper" type="Sphere"><Geometry x0="10" y0="10" z0="11.6" Outer_Radius="2" dp="0.5"/>'
            '<InitialVelocity vx="0" vy="0" vz="-20000"/></Body>')
    plate = _mpm.block("plate", (4, 4, 7), (12, 12, 2), dp=0.5, of="copper")
    return Scene("a copper ball into a plate at 20 km/s",
                 _mpm.scene([ball, plate], box((20, 20, 20)), solution(8e-4), [COPPER]), 30000.0)


EXPLOSIVE = _mpm.material("gas", 1.63e-3, 'type="HighExpBurn" D="6930" beta="2" PCJ="21e3"', JWL)


def plates():
    """Of 10 mm of steel, which 20 mm of explosive drive apart."""
    steel = _mpm.material("steel", 7.85e-3, 'type="IsoHarden" Young="2e5" Poisson="0.3" Yield0="700" TangMod="0"',
                          '<EquationOfState type="Gruneisen" C0="4569" S1="1.49" gamma0="2.17"/>')
    lit = '<Detonation><Item type="point" x="250" y="1" z="1" time="0"/></Detonation>'
    bodies = [_mpm.block("gas", (240, 0, 0), (20, 2, 2), dp=0.5, of="gas"), _mpm.block("lower", (230, 0, 0), (10, 2, 2), dp=0.5, of="steel"),
              _mpm.block("upper", (260, 0, 0), (10, 2, 2), dp=0.5, of="steel")]
    return Scene("an explosive that drives two plates of steel apart",
                 _mpm.scene(bodies, box((500, 2, 2), faces="002222"), solution(0.1), [EXPLOSIVE, steel], more=lit), 4000.0)


def products(about, ratio, speed, end, fastest):
    """Detonation products in a column that a linear velocity compresses or expands to the given ratio of volumes."""
    lit = '<Detonation><Item type="point" x="0" y="0" z="0" time="-1"/></Detonation>'
    body = _mpm.block("gas", (0, 0, 0), (20, 2, 2), (f"{speed}*x/20", 0, 0), 0.5, "gas")
    length = max(20 * ratio + 40, 60)
    return Scene(about, _mpm.scene([body], box((length, 2, 2), faces="202222"), solution(end), [EXPLOSIVE], more=lit), fastest)


def torn():
    bar = _mpm.block("bar", (20.2, 1.2, 1.1), (10, 3, 3), ("8*(x-25.2)", 0, 0), of="soft")
    law = _mpm.material("soft", 1.0, 'type="IsoHarden" Young="1000" Poisson="0.3" Yield0="1" TangMod="0"')
    return Scene("a plastic bar pulled to five times its length", _mpm.scene([bar], box((50, 6, 6)), solution(0.5), [law]), 60.0)


def water(steps):
    law = _mpm.material("water", 1000.0, 'type="Null" mu="1e-3"',
                        '<EquationOfState type="Polynomial" c0="0" c1="2e6" c2="0" c3="0" c4="0" c5="0" c6="0"/>')
    body = _mpm.block("water", (0, 0, 0), (0.2, 0.05, 0.2), dp=0.025, of="water")
    step = 0.9 * 0.05 / 45  # about the program's own
    return Scene(f"water at rest in a tank, {steps} steps",
                 _mpm.scene([body], _mpm.grid((0, 0, 0), (0.2, 0.05, 0.3), "222220", 0.05),
                            solution(steps * step, '<Gravity ax="0" ay="0" az="-9.81"/>'), [law]), 1.0)


def failed(viscosity):
    law = _mpm.material("brittle", 8.93e-3, 'type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="157" TangMod="423" '
                        f'FailViscosity="{viscosity}"', '<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>'
                        '<FailureModel type="PlaStrain" epmax="0.05"/>')
    body = _mpm.block("block", (4, 4, 0), (4, 4, 8), (0, 0, -500), 0.5, "brittle")
    words = "with" if viscosity else "without"
    return Scene(f"a brittle block at 500 m/s onto a wall, {words} FailViscosity",
                 _mpm.scene([body], box((12, 12, 12), faces="000020"), solution(0.01), [law]), 1500.0)


def foam():
    steel = elastic("steel", 7830.0, 200e9)
    ball = ('<Body name="ball" material="steel" type="Sphere"><Geometry x0="5e-3" y0="5e-3" z0="5e-3" Outer_Radius="1e-3" dp="0.5e-3"/>'
            '<InitialVelocity vx="100" vy="0" vz="0"/></Body>')
    whole = _mpm.block("whole", (1e-3, 1e-3, 1e-3), (8e-3, 8e-3, 8e-3), dp=0.5e-3, of="foam", attributes='ForBoolBody="1"')
    whole = whole.replace('<InitialVelocity vx="0" vy="0" vz="0"/>', "")
    hole = ball.replace('"ball"', '"hole" ForBoolBody="1"').split("<InitialVelocity")[0] + "</Body>"
    rest = '<Body name="foam" material="foam" type="Bool" BoolType="subtract" BoolBodyA="whole" BoolBodyB="hole"/>'
    return Scene("a steel ball that moves inside a block of foam at 100 m/s",
                 _mpm.scene([ball, whole, hole, rest], _mpm.grid((0, 0, 0), (12e-3, 10e-3, 10e-3), "000000", 1e-3), solution(5e-5),
                            [steel, bits_laws.material("foam")]), 400.0)


def rebound():
    body = _mpm.block("block", (3, 3, 1.5), (4, 4, 4), (0, 0, -1.5), 0.5, "soft")
    return Scene("an elastic block that rebounds from a rigid wall (type 4)",
                 _mpm.scene([body], box((10, 10, 10), faces="000040"), solution(4.0), [SOFT]), 4.0)


SOFT = elastic("soft", 1.0, 1000.0)
SCENES = {
    "stiffness": collision("stiffness 1e6 : 1, met in a cell", elastic("first", 1.0, 1e7), elastic("second", 1.0, 10.0), 0.3, 10.0),
    "density": collision("density 1e4 : 1, met in a cell", elastic("first", 1e4, 1e6), elastic("second", 1.0, 1e3), 1.0, 10.0),
    "both": collision("density 100 : 1 and stiffness 1000 : 1, met in a cell", elastic("first", 100.0, 1e6), elastic("second", 1.0, 1e3),
                      0.6, 12.0),
    "poisson": wave("Poisson's ratio 0.4999", elastic("soft", 1.0, 1000.0, 0.4999, "NeoHookean"), 4.0),
    "lone": lone_particle(),
    "impact": impact(),
    "compressed": products("products compressed more than tenfold", 0.1, -25000, 8e-4, 40000.0),
    "expanded": products("products expanded more than a hundredfold", 100, 12000, 0.17, 20000.0),
    "plates": plates(),
    "torn": torn(),
    "sparse": wave("1 particle in a cell", SOFT, 8.0, dp=1.0),
    "dense": wave("64 particles in a cell", SOFT, 8.0, dp=0.25),
    "narrow": narrow_cells(),
    "factor": wave("factor 0.99", SOFT, 8.0, factor=0.99),
    "water": water(100000),
    "failed": failed(0),
    "failed viscous": failed(1),
    "foam": foam(),
    "rebound": rebound(),
}


def finite(folder):
    return all(np.isfinite(values).all() for values in _mpm.table(folder / "case.sta").values())


def speed(folder):
    """The largest of a particle at the end; 0 where all have left the grid."""
    import h5py
    with h5py.File(folder / "case.h5part") as file:
        last = _mpm.pictures(file)[-1]
        return float(np.sqrt(sum(last[f"velocity_{a}"][:].astype(float) ** 2 for a in range(3))).max(initial=0.0))


def judge(name, shape, scheme, averaging, folder):
    """A row of the table."""
    scene = SCENES[name]
    text = scene.text.replace("<Grid>", f'<Grid shape="{shape}">').replace('algorithm="MUSL"', f'algorithm="{scheme}"')
    text = text.replace("</Solution>", f'<Volumetric averaging="{averaging}"/></Solution>')
    end = text.split('<EndTime value="')[1].split('"')[0]
    text = text.replace("<Output>", f'<Output><PostProcessing time_interval="{end}" h5part="1" var="pres"/>')
    (folder / "case.xmp").write_text(text)
    done = _mpm.run([folder / "case.xmp", "--output-dir", folder])
    row = {"scene": name, "shape": shape, "scheme": scheme, "averaging": averaging, "verdict": "wrong", "code": done.code,
           "steps": "", "drift": "", "speed": "", "note": ""}
    if done.code == 2:
        results.refuse(f"{name}: {done.err}")
    if done.code not in (0, 3):
        row["note"] = done.err.strip()[-100:]
        return row
    summary = _mpm.summary(folder)
    rows = _mpm.table(folder / "case.sta")
    drifts = rows["relative_drift"]
    row.update(steps=summary["steps"], drift=float(np.mean(drifts[-(len(drifts) + 3) // 4:])))
    if done.code == 3:
        row.update(verdict="stopped" if summary["reason"].startswith("step ") and finite(folder) else "wrong", note=summary["reason"])
        return row
    row["speed"] = speed(folder)
    if finite(folder):
        row["verdict"] = "stable" if abs(row["drift"]) <= WITHIN and row["speed"] <= scene.fastest else "drift"
    return row


LONGEST, RATE = 20, 1.0  # of the bar below, over its length; its rate of stretching at the start


def fracture(shape, folder):
    """How far a bar with two particles along a cell can be stretched before it tears by itself (numerical fracture). Its stresses
    are negligible and its velocities linear along it, so that the specific volume is the stretch; it tears where the particles of
    its middle half lack a tenth of that, since neighbours no longer share nodes."""
    import h5py
    length = 10
    bar = _mpm.block("bar", (2.2, 1.2, 1.1), (length, 2, 2), (f"{RATE}*(x-2.2)", 0, 0), of="soft")
    text = _mpm.scene([bar], box((length * LONGEST + 6, 5, 5)), solution((LONGEST - 1) / RATE), [elastic("soft", 1.0, 1e-9, 0.0)])
    text = text.replace("<Grid>", f'<Grid shape="{shape}">')
    text = text.replace("<Output>", '<Output><PostProcessing time_interval="0.05" h5part="1" var="density"/>')
    (folder / "case.xmp").write_text(text)
    done = _mpm.run([folder / "case.xmp", "--output-dir", folder])
    if done.code != 0:
        raise SystemExit(f"fracture, {shape}: {done.err}")
    with h5py.File(folder / "case.h5part") as file:
        for picture in _mpm.pictures(file):
            stretch = 1 + RATE * float(picture.attrs["TimeValue"])
            order = np.argsort(picture["x"][:])
            middle = picture["density"][:][order[len(order) // 4:-len(order) // 4]]
            if np.mean(1 / middle) < 0.9 * stretch:
                return stretch
    return float("inf")


FRACTURE_COLUMNS = {"shape": (lambda r: f"`{r['shape']}`", ""),
                    "torn at": (lambda r: f"{r['stretch']:.2f}" if np.isfinite(r["stretch"]) else f"not up to {LONGEST}", "")}


def course(shape, scheme, dp, folder, factor=0.9):
    """The error of the energy balance of a block that vibrates while it drifts, in the mean of each eighth of 16 units of time, some
    45 periods, and the kinetic energy of its vibration in the second eighth over that at the start; a row of the table."""
    text = wave("", SOFT, 16.0, dp=dp, factor=factor, room=18).text.replace("<Grid>", f'<Grid shape="{shape}">')
    (folder / "case.xmp").write_text(text.replace('algorithm="MUSL"', f'algorithm="{scheme}"'))
    done = _mpm.run([folder / "case.xmp", "--output-dir", folder])
    if done.code != 0:
        raise SystemExit(f"course, {shape}: {done}")
    rows = {name: np.array(values) for name, values in _mpm.table(folder / "case.sta").items()}
    eighths = np.minimum(rows["time"] // 2, 7)
    carried = sum(rows[f"p{axis}"] ** 2 for axis in "xyz") / (2 * 6**3)  # by the mass centre
    vibration = (rows["kinetic"] - carried) / (rows["kinetic"] - carried)[0]
    return {"shape": shape, "scheme": scheme, "particles": round(1 / dp**3), "steps": _mpm.summary(folder)["steps"],
            "vibration": float(np.mean(vibration[eighths == 1])),
            **{f"{i + 1}/8": float(np.mean(rows["relative_drift"][eighths == i])) for i in range(8)}}


COURSE_SHAPES = ("linear", "SGMP", "QuadraticBSpline", "CubicBSpline")
COURSES = [*((shape, scheme, 0.5) for scheme in ("MUSL", "USAVG", "USF", "USL") for shape in COURSE_SHAPES),
           *(("linear", scheme, 1.0) for scheme in ("MUSL", "USAVG", "USF", "USL"))]
EIGHTHS = [f"{i}/8" for i in range(1, 9)]
COURSE_COLUMNS = {"shape": (lambda r: f"`{r['shape']}`", ""), "scheme": (lambda r: r["scheme"], ""),
                  "particles in a cell": (lambda r: r["particles"], "g"), "steps": (lambda r: r["steps"], ".0f"),
                  "vibration, %": (lambda r: 100 * r["vibration"], ".2g"),
                  **{name: (lambda r, name=name: 100 * r[name], "+.2g") for name in EIGHTHS}}

KEYS, COURSE_KEYS = ("scene", "shape", "scheme", "averaging"), ("particles", "scheme", "shape")


def on_file(path):
    return results.read(path)[1] if path.exists() else []


def merged(old, new):
    """The rows on file with these in the place of the same ones, in the order of the scenes and the program's lists."""
    rows = {tuple(row[key] for key in KEYS): row for row in [*old, *new]}
    lists = list(SCENES), methods.shapes(), SCHEMES, AVERAGING
    return [rows[key] for key in sorted(rows, key=lambda key: [names.index(word) for names, word in zip(lists, key)])]


def merged_courses(old, new):
    """Alike, in the order of COURSES."""
    rows = {tuple(row[key] for key in COURSE_KEYS): row for row in [*old, *new]}
    order = [(round(1 / dp**3), scheme, shape) for shape, scheme, dp in COURSES]
    return [rows[key] for key in order if key in rows]


def words(row):
    """The drift in per cent of a stable run; of another one in bold type, or that it is stopped, too fast or wrong."""
    if row is None:
        return None
    said = row["verdict"] if row["verdict"] in ("stopped", "wrong") else f"{100 * row['drift']:+.2g}"
    if row["speed"] != "" and row["speed"] > SCENES[row["scene"]].fastest:
        said += ", too fast"
    return said if row["verdict"] == "stable" else f"**{said}**"


def table(rows):
    """Scenes and schemes in rows, shapes in columns."""
    measured = {(row["scene"], row["scheme"], row["shape"]): row for row in rows if row["averaging"] == "none"}
    known = {key[:2] for key in measured}
    columns = {"scene": (lambda m: SCENES[m[0]].about, ""), "scheme": (lambda m: m[1], ""),
               **{f"`{shape}`": (lambda m, shape=shape: words(measured.get((*m, shape))), "s") for shape in methods.shapes()}}
    return results.markdown([m for m in itertools.product(SCENES, SCHEMES) if m in known], columns)


def tables():
    """The blocks of the page that files keep."""
    return {"verdicts": table(on_file(TABLE)), "course": results.markdown(on_file(COURSE_TABLE), COURSE_COLUMNS)}


def measured(points, function):
    """Rows of the points, each in a folder of its own; printed as they come."""
    for point in points:
        with tempfile.TemporaryDirectory() as folder:
            row = function(*point, pathlib.Path(folder))
        print(", ".join(f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()), flush=True)
        yield row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--shape", nargs="+", choices=methods.shapes())
    parser.add_argument("--scheme", nargs="+", choices=SCHEMES, default=SCHEMES)
    parser.add_argument("--averaging", nargs="+", choices=AVERAGING, default=("none",))
    parser.add_argument("--fracture", action="store_true", help="the stretch at which each of the shapes tears a bar instead")
    parser.add_argument("--course", action="store_true", help="the energy of a vibrating block over 16 units of time instead")
    parser.add_argument("--factor", type=float, default=0.9, help="of the critical step, with --course and without --docs")
    parser.add_argument("--docs", action="store_true", help="write the table of docs/stability.md, and docs/stability/verdicts.csv")
    parser.add_argument("--tables", action="store_true", help="write the tables of verdicts and of the block from the files")
    options = parser.parse_args()
    if options.docs and options.factor != 0.9:
        parser.error("--docs: the table is that of a factor of 0.9")
    if options.tables:
        return results.refresh(PAGE, tables())
    if options.fracture:
        shapes = [(shape,) for shape in options.shape or methods.shapes()]
        rows = list(measured(shapes, lambda shape, folder: {"shape": shape, "stretch": fracture(shape, folder)}))
        if options.docs:
            results.refresh(PAGE, {"fracture": results.markdown(rows, FRACTURE_COLUMNS)})
        return
    if options.course:
        points = [c for c in COURSES if c[0] in (options.shape or COURSE_SHAPES) and c[1] in options.scheme]
        if not points:
            parser.error(f"--course has none of these shapes; choose from {', '.join(COURSE_SHAPES)}")
        function, path, join = functools.partial(course, factor=options.factor), COURSE_TABLE, merged_courses
    else:
        points = [(name, shape, scheme, averaging) for name in options.scene for shape in options.shape or methods.shapes()
                  for scheme in options.scheme for averaging in options.averaging]
        function, path, join = judge, TABLE, merged
    rows = []
    for row in measured(points, function):
        rows.append(row)
        if options.docs:
            results.write(path, join(on_file(path), rows))
    if options.docs:
        results.refresh(PAGE, tables())


if __name__ == "__main__":
    main()
