"""Random scenes of bodies that meet: every type of contact, normal and distance, friction, rigid bodies, debris as a component of
its own, conduction, loads, with any laws, shapes and schemes; and whether any ranks, threads and a restart leave the same bits.

Number and seed make a scene. Units: m, kg, s."""

import random
import re

import _mpm
import bits_laws

CELL = bits_laws.CELL
SHAPES = ["linear", "linear", "SGMP", "uGIMP", "cpGIMP", "CPDI", "CPDI2", "QuadraticBSpline", "CubicBSpline"]
SPEEDS = (20, 100, 400, 1500)
OUTPUT = ('<Console print_time="{}"/><Restart time_interval="{}"/><TimeHistory var="pres|velocity_0"><Particle x="0.002" y="0.002" z="0.001"/>'
          "</TimeHistory>")


def material(rng, name, heat):
    """A law of the manual that conducts heat, or fails, in some scenes."""
    text = bits_laws.material(name)
    if heat:
        missing = "" if "SpecHeat" in text else 'SpecHeat="400" '
        text = text.replace("<StrengthModel ", f'<StrengthModel {missing}CoefficientOfThermalConductivity="{rng.choice((400, 1e4))}" ')
    if rng.random() < 0.4:
        failure = f'<FailureModel type="InstGeoStrain" ErosionStrain="{rng.choice((0.002, 0.03))}" Erosion="{rng.choice("001")}"/>'
        text = re.sub("<FailureModel [^>]*/>", "", text).replace("</Material>", failure + "</Material>")
    return text


def loads(rng, speed):
    more = ""
    if rng.random() < 0.2:
        more += f'<BodyForce bx="{speed}e5*sin(1e6*t)+y*1e6" by="x*1e7" bz="t*{speed}e11"/>'
    if rng.random() < 0.2:
        more += '<Traction normal="0" tx="1e6" ty="3e12*t" zmin="0.001" ramp="0.001"/>'
    return more


def rigid_body(rng, place, speed):
    """Driven, held with its loads, or free."""
    motion = rng.choice(("", '<RigidInertia mass="1e-3"/>', '<ConstrainRigidPosition value="1"/>',
                         f'<PrescribedVelocity vx="-{speed}*cos(1e6*t)" vy="0" vz="0"/>'))
    return _mpm.block("rigid", [place * CELL, 0.6 * CELL, 0.6 * CELL], [2 * CELL, 4 * CELL, 3 * CELL], (-speed, 0, 0), CELL / 2, "rigid", motion)


def contact(rng, names):
    words = f'enable="1" record_contact_force="1" contact_type="{rng.randrange(3)}" failure_to_component="{rng.choice("011")}"'
    words += rng.choice(("", ' contact_normal="mass_gradient"', ' contact_normal="regression"'))
    distance = rng.randrange(3)
    if distance > 0:
        words += f' distance_type="{distance}" min_distance="{(0.5, 0.05)[distance - 1]}"'
    if rng.random() < 0.3:
        words += ' contact_time_step="1"'
    friction = "".join(f'<Coefficient mat1="{names[0]}" mat2="{name}" value="0.3"/>' for name in names)
    return f"<Friction>{friction}</Friction><Contact {words}/>"


def scene(number, seed):
    rng = random.Random(f"{seed}/{number}")
    names = rng.sample(sorted(bits_laws.MATERIALS), rng.choice((2, 2, 3)))
    speed, heat, end = rng.choice(SPEEDS), rng.random() < 0.4, rng.choice((2e-6, 4e-6))
    components, place = [], 1.3
    for i, name in enumerate(names):
        bodies = ""
        for j in range(rng.choice((1, 1, 2))):
            velocity = (speed * (0.5 - i) * rng.uniform(0.5, 1), rng.uniform(-speed, speed) / 5, rng.uniform(-speed, speed) / 5)
            lower = [place * CELL, rng.choice((1.2, 1.6)) * CELL, rng.choice((0, 0.7, 1)) * CELL]
            hot = f'<InitialTemperature value="{rng.choice((300, 600))}"/>' if heat else ""
            bodies += _mpm.block(f"{name} {j}", lower, [2 * CELL, rng.choice((2, 3)) * CELL, 2 * CELL], velocity, CELL / 2, name,
                                 hot + loads(rng, speed))
            place += rng.choice((2, 2.45))
        components.append(bodies)
    materials = [material(rng, name, heat) for name in names]
    if rng.random() < 0.5:
        materials.append(bits_laws.material("rigid"))
        components.append(rigid_body(rng, place, speed))
    faces = "".join(rng.choice("000234") for _ in range(4)) + rng.choice("0124") + "0"
    more = "".join(text for text in ('<Gravity ax="1e6" ay="0" az="-1e7"/>', '<DynamicRelax damping="1e5"/>',
                                     '<Volumetric averaging="cell" relaxation="0.5"/>') if rng.random() < 0.3)
    lit = '<Detonation><Item type="point" x="0" y="0" z="0" time="-3e-7"/></Detonation>' if "TNT" in names else ""
    shape = rng.choice(SHAPES)
    grid = _mpm.grid((0, 0, 0), [18 * CELL, 7 * CELL, 6 * CELL], faces, CELL).replace("<Grid>", f'<Grid shape="{shape}">')
    algorithm, factor = rng.choice(("MUSL", "USAVG", "USF", "USL")), rng.choice((0.5, 0.9))
    bodies = components[0] + "".join(f'</Component><Component name="{i + 2}">{of}' for i, of in enumerate(components[1:]))
    meets = contact(rng, names)
    consistent = rng.random() < 0.2 and algorithm != "USL" and "CPDI" not in shape
    solution = _mpm.solution(end, algorithm, factor, 'mass="consistent"' if consistent else "", more)
    return _mpm.scene([bodies], grid, solution, materials, OUTPUT.format(end / 7, 0.43 * end), meets + lit)


def judge(number, seed, folder):
    """Kind of end, and what is wrong with it, if anything."""
    folder.mkdir(parents=True)
    case = folder / "case.xmp"
    case.write_text(scene(number, seed))

    def run(name, what=case, **how):
        outcome = _mpm.run([what, "--output-dir", folder / name], timeout=120, **how)
        return outcome.code, outcome.state if outcome.code == _mpm.DONE else re.findall("FAILED +step.*", outcome.err), outcome

    code, state, outcome = run("alone")
    if code == _mpm.INPUT_ERROR and "case.xmp:" in outcome.err:
        return "refused", ""
    if code not in (_mpm.DONE, _mpm.NUMERICAL_FAILURE) or not state:
        return "wrong", f"exit code {code}: {outcome.err[-600:]}"
    others = {"on two ranks": (case, {"ranks": 2}), "on three ranks, with two threads": (case, {"ranks": 3, "threads": 2})}
    halfway = _mpm.restarts(folder / "alone")
    if code == _mpm.DONE and halfway:
        others["after a restart on two ranks"] = (halfway[0], {"ranks": 2})
    for name, (what, how) in others.items():
        other, its_state, outcome = run(name.replace(" ", "_"), what, **how)
        if (other, its_state) != (code, state):
            return "wrong", f"{name}: exit code {other}, {its_state} instead of {code}, {state}: {outcome.err[-600:]}"
    return "completed" if code == _mpm.DONE else "exit code 3", ""
