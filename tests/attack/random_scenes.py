"""Small random scenes by the thousand: every law, shape, transfer, scheme and boundary type, random sizes and speeds, with contact and
without.

Each runs 200 steps and has to end well, or with exit code 3 and a message that says what failed; pairs that do not go
together have to be refused. A failure is any other exit code, a hang, a NaN or an infinity in a file, or energy that
grows more than tenfold without a word in the log. Scenes are numbered, and number and seed make a scene:
`--only N --keep FOLDER` makes one again."""

import random
import re
import sys

import _attack  # first: it adds the folder of the next ones to the path
import mutants
import _mpm
import bits_laws

STEPS = 200
CELL = bits_laws.CELL
SHAPES = ["linear", "SGMP", "DDMP", "uGIMP", "cpGIMP", "CPDI", "CPDI2", "QuadraticBSpline", "CubicBSpline"]
AFFINE_SHAPES = ["uGIMP", "cpGIMP", "QuadraticBSpline", "CubicBSpline"]
TRANSFERS = ['transfer="FLIP"', 'transfer="FLIP" flip_fraction="0.95"', 'transfer="PIC"', 'transfer="XPIC" xpic_order="3"',
             'transfer="FMPM" xpic_order="2" xpic_interval="3"', 'transfer="FLIP" mass="consistent"']
AFFINE = ['transfer="APIC"', 'transfer="TPIC"', 'transfer="AFLIP"']
CONTACT = '<Contact enable="1" contact_type="{}" {} contact_normal="{}" record_contact_force="1"/>'
OUTPUT = '<Console print_time="1e-12"/><PostProcessing time_interval="1e-6" h5part="1" var="seqv|epef|pres|density|fail"/>'


def body(rng, name, law, lower):
    """A block or a sphere of a random number of cells and particles along a cell, thrown anywhere."""
    speed = rng.choice((1, 10, 100, 1000, 5000)) * rng.random()
    velocity = [rng.uniform(-speed, speed) for _ in range(3)]
    spacing = CELL / rng.choice((1, 1.3, 2, 2, 2.7, 4))
    size = [rng.choice((1, 2, 3)) * CELL * rng.uniform(0.8, 1.2) for _ in range(3)]
    if rng.random() < 0.75:
        return _mpm.block(name, lower, size, velocity, spacing, law)
    radius, centre = size[0] / 2, [c + size[0] / 2 for c in lower]
    return (f'<Body name="{name}" material="{law}" type="Sphere"><Geometry x0="{centre[0]}" y0="{centre[1]}" z0="{centre[2]}" '
            f'Outer_Radius="{radius}" dp="{min(spacing, radius / 2)}"/>'
            '<InitialVelocity vx="{}" vy="{}" vz="{}"/></Body>'.format(*velocity))


def scene(number, seed):
    rng = random.Random(f"{seed}/{number}")
    laws = rng.sample(sorted(bits_laws.MATERIALS), rng.choice((1, 1, 2)))
    bodies = [body(rng, f"b{i}", law, [(1.3 + 4.4 * i) * CELL, 1.2 * CELL, rng.choice((0, 0.7)) * CELL])
              for i, law in enumerate(laws)]
    shape = rng.choice(SHAPES)
    transfer = rng.choice(TRANSFERS + (AFFINE if shape in AFFINE_SHAPES else []))
    scheme = rng.choice(("MUSL", "USF", "USL"))
    if "consistent" in transfer:
        scheme = "USF" if scheme == "USL" else scheme
        shape = "CubicBSpline" if "CPDI" in shape else shape
    if number % 4 == 3:
        scheme = "USAVG"
    if number % 4 == 2 and scheme == "MUSL":
        scheme = "auto"
    faces = "".join(rng.choice("01234") if rng.random() < 0.5 else rng.choice("02") for _ in range(6))
    more = "".join(text for text in ('<Gravity ax="0" ay="0" az="-9.81"/>', f'<Volume update_type="{rng.randrange(5)}"/>',
                                     '<LimitVelocity max="8000"/>') if rng.random() < 0.3)
    factor = rng.choice((0.3, 0.6, 0.9, 0.9, 1.0))
    grid = _mpm.grid((0, 0, 0), [rng.choice((10, 11, 13)) * CELL for _ in range(3)], faces, CELL)
    if 'update_type="1"' not in more and number % 3 == 0:
        more += f'<Volumetric averaging="cell" relaxation="{number % 2}"/>'
    lit = '<Detonation><Item type="point" x="0" y="0" z="0" time="-1"/></Detonation>' if "TNT" in laws else ""
    solution = _mpm.solution(1.0, scheme, factor, transfer, more)
    materials = [bits_laws.material(name) for name in laws]
    if number % 4 == 1:
        materials = [text.replace("<StrengthModel ", '<StrengthModel limiter="shock" ') for text in materials]
    contact = ""
    if len(bodies) == 2 and rng.random() < 0.5:
        bodies.insert(1, '</Component><Component name="other">')
        contact = CONTACT.format(rng.randrange(3), rng.choice(("", 'distance_type="1" min_distance="1"', 'distance_type="2" min_distance="0.1"')),
                                 rng.choice(("automatic", "mass_gradient", "regression")))
    return _mpm.scene(bodies, grid.replace("<Grid>", f'<Grid shape="{shape}">'), solution, materials, OUTPUT, lit + contact)


def judge(number, seed, folder):
    """Kind of end for the count, and what is wrong with it, if anything."""
    folder.mkdir(parents=True)
    (folder / "case.xmp").write_text(scene(number, seed))
    code, said = mutants.call("mpm_run", ["case.xmp", "-nsteps", STEPS + 1, "--output-dir", "out"], folder)
    if code not in (0, 3):
        return "wrong", f"exit code {code}: {said[-600:]}"
    if code == 3 and not re.search(r"(?m)^FAILED +step \d+", said):
        return "wrong", f"exit code 3 without a step: {said[-600:]}"
    nonsense = mutants.not_finite(folder / "out")
    if nonsense:
        return "wrong", nonsense
    rows = _mpm.table(folder / "out/case.sta")
    energy = rows["total"]
    if code == 0 and abs(energy[-1]) > 10 * max(abs(energy[0]), 1e-300) and abs(rows["relative_drift"][-1]) > 0.5:
        if "energy balance" not in said:
            return "wrong", f"energy {energy[0]} became {energy[-1]} without a word"
        return "completed, energy grew and the log says so", ""
    return "completed" if code == 0 else "exit code 3", ""


if __name__ == "__main__":
    sys.exit(_attack.numbered("scene", judge, 10000, __doc__))
