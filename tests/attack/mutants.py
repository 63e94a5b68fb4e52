"""Damaged inputs by the thousand: mpm_check and mpm_run have to agree, and nothing may crash, hang or write nonsense.

Each mutant is one of a few small scenes with one to three random changes: extreme numbers, words for numbers, lost,
doubled and swapped attributes and elements, flipped bytes. It goes through mpm_check; what passes runs for 20 steps,
what does not goes through `mpm_run --dry-run`. A failure is
  - a verdict of mpm_check that differs from mpm_run's (memory and the number of ranks are the machine's matter),
  - a signal, a program that does not end in time, an exit code that the README does not promise,
  - a NaN or an infinity in a file of the run.
Mutants are numbered, and number and seed make a mutant: `--only N --keep FOLDER` makes one again."""

import json
import random
import re
import resource
import subprocess
import sys

import _attack  # first: it adds the folder of the next ones to the path
import _mpm
import bits_laws

STEPS = 20
PATIENCE = 120  # seconds: some hundred times what any of these needs
WALL = 5  # after so long a run is asked to stop, and says so with exit code 4
MOST_PARTICLES = 200_000  # of a mutant that still runs here
MEMORY = 6 << 30  # address space of one program
PROMISED = {int(code) for code in re.findall(r"(?m)(?:^|· )(\d) ", (_mpm.SOURCE / "README.md").read_text().split("## Exit codes")[1])}
MACHINE = re.compile(r"GiB are free|must equal the number of ranks")

# Scenes -----------------------------------------------------------------------------------------------------------

EVERY_STEP = '<Console print_time="1e-12" print_momentum="1"/>'
WRITTEN = (EVERY_STEP + '<PostProcessing time_interval="{0}" h5part="1" var="seqv|epef|pres|density|tria|fail|kelv|SigmaXY"/>'
           '<TimeHistory var="pres|engk|velocity_0"><Particle x="{1}" y="{1}" z="{1}"/><Point x="{1}" y="{1}" z="{1}"/>'
           '</TimeHistory><Restart time_interval="{0}"/><Statistics memory="1" cell_occupy="1"/>')


def components(text):
    """The scene with a component for every body."""
    first, *bodies = re.split(r"(?=<Body )", text[text.index("<Component"):text.index("</Component>")])
    made = "".join(f'<Component name="c{i}">{body}</Component>\n' for i, body in enumerate(bodies))
    return text[: text.index("<Component")] + made + text[text.index("</Component>") + len("</Component>"):]


def of_laws(names, end=2e-6, lit=False, faces="000020"):
    """Small blocks of the laws that the comparison of bits has."""
    cell = bits_laws.CELL
    bodies = [_mpm.block(f"{name} block", ((3 * i + 0.5) * cell, cell, 0.5 * cell), [2 * cell] * 3, (0, 20, -60), cell / 2, name)
              for i, name in enumerate(names)]
    more = '<Detonation><Item type="point" x="0" y="0" z="0" time="-1"/></Detonation>' if lit else ""
    upper = [cell * c for c in (3 * len(names) + 1, 6, 6)]
    return _mpm.scene(bodies, _mpm.grid((0, 0, 0), upper, faces, cell), _mpm.solution(end),
                      [bits_laws.material(name) for name in names], WRITTEN.format(end / 4, cell), more)


def scenes():
    made = {}
    made["collision"] = components(_mpm.bounce(1.0, WRITTEN.format(0.05, 3)).replace('<Console print_time="0.1"/>', ""))
    head = '<Header><Name value="rod"/><Unit time="ms" length="mm" mass="g"/></Header>'
    rod = ('<Body name="rod" material="cu" type="Cylinder" workPlane="tilted"><Geometry x0="0" y0="0" z0="0" dp_bottom="0.4" '
           'dp_top="0.4" Bottom_Outer_Radius="1.5" Top_Outer_Radius="1" height="3" angle="360" discretization="1"/>'
           '<InitialVelocity vx="0" vy="0" vz="-190"/></Body>')
    ball = ('<Body name="ball" material="cu" type="Sphere"><Geometry dp="0.4" x0="7" y0="3" z0="4" Outer_Radius="1.2" '
            'Inner_Radius="0.3"/><BodyContrl Deactive="0" NoOutput="1"/></Body>')
    copper = ('<Material name="cu" library="OFHC-Cu-JC"><FailureModel type="PlaStrain" epmax="2" Erosion="1"/><RandomFailure '
              'enable="1" FailDistribution="2"/></Material>')
    plane = '<WorkPlane name="tilted" r0x="3" r0y="3" r0z="1.3" ex="0" ey="0.6" ez="0.8" a11="1" a21="0" a31="0"/>'
    made["rod"] = _mpm.scene([rod, ball], _mpm.grid((0, -2, 0), (10, 8, 8), "220021"),
                             _mpm.solution(0.02, "USF", more='<LimitVelocity max="1e4"/><OpenMPSetting nthread="1"/>'),
                             [copper], WRITTEN.format(0.005, 3), head + plane)
    watched = ('<Volume update_type="2" min="0.1" max="10" erode="1e-3"/><Warn type="ie|vol|grid" level="0"/><EnergyFraction '
               'value="0.9"/><DynamicRelax damping="0.1"/><Gravity ax="0" ay="0" az="-9.8"/>')
    sand = _mpm.material("sand", 1.8, 'type="DruckerPrager" Young="70" Poisson="0.3" phi="20" c="0.1" psi="5" ten_f="0.1"')
    made["heap"] = _mpm.scene([_mpm.block("heap", (0, 0, 0), (3, 3, 5), of="sand")],
                              _mpm.grid((0, 0, 0), (8, 8, 8), "204044").replace("<Grid>", '<Grid mass_cutoff="1e-10">'),
                              _mpm.solution(2.0, "USL", 0.5, 'near_boundary_stop="1"', watched), [sand],
                              WRITTEN.format(0.5, 1))
    pushed = [_mpm.block("pulled", (1, 1, 1), (2, 2, 2), more='<PrescribedAcceleration ax="3" ay="0" az="0" arx="0" ary="0" '
                         'arz="0"><Coefficient time="0" cx="0" cy="0" cz="0" crx="0" cry="0" crz="0"/><Coefficient time="1" '
                         'cx="1" cy="0" cz="0" crx="0" cry="0" crz="0"/></PrescribedAcceleration>'),
              _mpm.block("shaken", (5, 1, 1), (2, 2, 2), more='<HarmExcit><A x="0" y="3" z="0"/><Omega x="0" y="8" z="0"/>'
                         '<Theta x="0" y="0.4" z="0"/><EndTime x="1" y="1" z="1"/></HarmExcit>'),
              _mpm.block("pressed", (1, 5, 1), (2, 2, 2), more='<Traction pressure="1" tx="1" ty="0" tz="0" normal="0" '
                         'xmin="2.5" ramp="1"><Coefficient time="0" c="0"/><Coefficient time="1" c="1"/></Traction>'),
              _mpm.block("piston", (5, 5, 1), (2, 2, 2), more='<PrescribedVelocity vx="0" vy="0" vz="0.5"/>'
                         '<ConstrainRigidPosition value="1"/>')]
    points = ('<Body name="points" material="soft" type="Point" density="1.1"><Geometry><Point mass="0.1" x="6" y="3.5" z="6"/>'
              '<Point mass="0.1" x="6.4" y="3.5" z="6"/></Geometry></Body>')
    made["loads"] = components(_mpm.scene([*pushed, points], _mpm.grid((0, 0, 0), (8, 8, 8), "303212"), _mpm.solution(1.0),
                                          output=WRITTEN.format(0.05, 2)))
    made["metals"] = of_laws(["hardening", "simple", "hot", "voids"])
    made["explosion"] = of_laws(["TNT", "water", "plastic"], lit=True, faces="222222")
    made["brittle"] = of_laws(["concrete", "porous", "ceramic", "foam"])
    iron = _mpm.material("iron", 50.0, 'type="Rigid"')
    made["rigid"] = _mpm.scene([_mpm.block("ram", (1, 1, 1), (2, 2, 2), (1, 0, 0), of="iron", attributes='Deactive="0"')],
                               _mpm.grid((0, 0, 0), (8, 8, 8)), _mpm.solution(0.5, more='<Gravity ax="0" ay="0" az="-1"/>'),
                               [iron], WRITTEN.format(0.1, 2))
    return made


# Mutations --------------------------------------------------------------------------------------------------------

ATTRIBUTE = re.compile(r'\s([A-Za-z_]\w*)="([^"]*)"')
LEAF = re.compile(r"<([A-Za-z]\w*)(?:\s[^<>]*)?/>")
BRANCH = re.compile(r"<(Body|Material|Component|WorkPlane|Geometry|Cell|Output|Solution|TimeHistory)(?:\s[^<>]*)?>.*?</\1>", re.S)
EXTREME = ["0", "-0", "1", "-1", "2", "3", "0.5", "1e-310", "5e-324", "2.3e-308", "1e-300", "1e-200", "1e-150", "1e-30", "1e-12", "1e-6",
           "1e6", "1e9", "2147483647", "2147483648", "-2147483649", "1e12", "12345678901234567890", "1e20", "1e39", "1e100",
           "1e154", "1e200", "1e307", "1.797e308", "1e309", "nan", "inf", "-inf", "", " ", "x", "0x10", "1,5", "1e", "--1",
           "MUSL", "Rigid", "Block", "IsoElastic", "none", "a|b", "1 2", "äöü", "9" * 400]


def piece(rng, pattern, text):
    """A random match: where it is in the text."""
    found = list(pattern.finditer(text))
    return rng.choice(found) if found else None


def cut(text, match, by=""):
    return text[: match.start()] + by + text[match.end():]


def new_value(rng, text, to):
    match = piece(rng, ATTRIBUTE, text)
    return cut(text, match, f' {match[1]}="{to(match[2])}"')


def scaled(rng, value):
    try:
        return repr(float(value) * 10.0 ** rng.uniform(*rng.choice([(-0.3, 0.3), (-1, 1), (-12, 12), (-200, 200)])))
    except (ValueError, OverflowError):
        return value  # a word: another change's matter


def swapped_values(rng, text):
    a, b = sorted((piece(rng, ATTRIBUTE, text) for _ in range(2)), key=lambda match: match.start())
    if a.start() == b.start():
        return text
    text = cut(text, b, f' {b[1]}="{a[2]}"')
    return cut(text, a, f' {a[1]}="{b[2]}"')


def doubled(rng, text, pattern):
    match = piece(rng, pattern, text)
    return text if match is None else cut(text, match, 2 * match[0])


def lost(rng, text, pattern):
    match = piece(rng, pattern, text)
    return text if match is None else cut(text, match)


def moved(rng, text):
    match = piece(rng, LEAF, text)
    rest = cut(text, match)
    to = rng.choice([place.end() for place in re.finditer(r"/>|<\w[^<>]*[^/]>", rest)])
    return rest[:to] + match[0] + rest[to:]


def flipped(rng, text):
    data = bytearray(text.encode())
    for _ in range(rng.choice((1, 1, 2, 8))):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


# Weight and change.
CHANGES = [
    (8, lambda rng, text: new_value(rng, text, lambda _: rng.choice(EXTREME))),
    (16, lambda rng, text: new_value(rng, text, lambda value: scaled(rng, value))),
    (3, lambda rng, text: new_value(rng, text, lambda value: value[1:] if value.startswith("-") else "-" + value)),
    (2, lambda rng, text: new_value(rng, text, lambda value: value + rng.choice("0123456789eE.- x"))),
    (2, lambda rng, text: lost(rng, text, ATTRIBUTE)),
    (3, lambda rng, text: lost(rng, text, LEAF)),
    (1, lambda rng, text: lost(rng, text, BRANCH)),
    (1, lambda rng, text: doubled(rng, text, ATTRIBUTE)),
    (2, lambda rng, text: doubled(rng, text, LEAF)),
    (1, lambda rng, text: doubled(rng, text, BRANCH)),
    (3, swapped_values),
    (1, moved),
]


def mutant(number, seed):
    """Name of the scene, and the bytes."""
    rng = random.Random(f"{seed}/{number}")
    name, text = rng.choice(sorted(SCENES.items()))
    for _ in range(rng.choice((1, 1, 1, 1, 2, 3))):
        text = rng.choices([change for _, change in CHANGES], [weight for weight, _ in CHANGES])[0](rng, text)
    data = flipped(rng, text) if rng.random() < 0.08 else text.encode()
    return name, data[: rng.randrange(len(data))] if rng.random() < 0.01 else data


# Verdicts ---------------------------------------------------------------------------------------------------------


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def call(program, arguments, folder):
    """Exit code and all that was said; None when it did not end."""
    for _ in range(3):
        try:
            ended = subprocess.run([str(_mpm.BIN / program), *map(str, arguments)], cwd=folder, capture_output=True,
                                   timeout=PATIENCE, env={**_mpm.ENVIRONMENT, "OMP_NUM_THREADS": "1"}, preexec_fn=limits)
        except subprocess.TimeoutExpired:
            return None, f"{program} did not end in {PATIENCE} s"
        said = (ended.stdout + ended.stderr).decode(errors="replace")
        if "before MPI_INIT completed" not in said:  # the library could not start, whatever the input
            break
    return ended.returncode, said


def not_finite(folder):
    """Numbers in files that are none: a sentence, or nothing."""
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".sta", ".dat"):
            for n, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
                if not line.startswith("#") and re.search(r"\b(nan|inf)", line, re.I):
                    return f"{path.name}:{n}: {line[:200]}"
        elif path.name.endswith(".summary.json"):
            try:
                json.loads(path.read_text(), parse_constant=lambda word: (_ for _ in ()).throw(ValueError(word)))
            except ValueError as error:
                return f"{path.name}: {error}"
        elif path.suffix == ".h5part":
            import h5py
            import numpy
            with h5py.File(path) as file:
                for step in _mpm.pictures(file):
                    for name, item in step.items():
                        if not numpy.isfinite(item[()]).all():
                            return f"{path.name}: {step.name}/{name}"
    return ""


def judge(number, seed, folder):
    """Kind of end for the count, and what is wrong with it, if anything."""
    name, data = mutant(number, seed)
    folder.mkdir(parents=True)
    (folder / "case.xmp").write_bytes(data)
    checked, said = call("mpm_check", ["case.xmp"], folder)
    if checked not in (0, 2):
        return "check", f"{name}: mpm_check ended with {checked}: {said[-600:]}"
    if checked == 2:
        code, more = call("mpm_run", ["case.xmp", "--dry-run", "--output-dir", "out"], folder)
        wrong = "" if code == 2 else f"{name}: mpm_check refuses and mpm_run ends with {code}:\n{said[-300:]}\n{more[-300:]}"
        return "refused", wrong
    particles = re.search(r"about (\S+) particles", said)
    if particles is None or float(particles[1]) > MOST_PARTICLES:
        return "passed, too large to run here", ""
    code, more = call("mpm_run", ["case.xmp", "-nsteps", STEPS + 1, "--max-wall-time", WALL, "--output-dir", "out"], folder)
    if code == 2 and MACHINE.search(more):
        return "passed, not for this machine", ""
    if code not in PROMISED or code == 2:
        return "run", f"{name}: mpm_check says ok and mpm_run ended with {code}: {more[-600:]}"
    nonsense = not_finite(folder / "out")
    return f"ran, exit code {code}", f"{name}: exit code {code}, {nonsense}" if nonsense else ""


def prepare(top):
    """Makes the scenes; why they cannot be used, if they do not run themselves."""
    global SCENES
    SCENES = scenes()
    for name, text in SCENES.items():
        folder = top / f"scene {name}"
        folder.mkdir(parents=True)
        (folder / "case.xmp").write_text(text)
        code, said = call("mpm_check", ["case.xmp"], folder)
        if code == 0:
            code, said = call("mpm_run", ["case.xmp", "-nsteps", STEPS + 1, "--output-dir", "out"], folder)
        if code != 0 or not_finite(folder / "out"):
            return f"the scene '{name}' itself ends with {code}: {said} {not_finite(folder / 'out')}"
    return ""


if __name__ == "__main__":
    sys.exit(_attack.numbered("mutant", judge, 2000, __doc__, prepare))
