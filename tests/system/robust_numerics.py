"""Guards, walls and what is prescribed: runs that go wrong end with exit code 3 and a message that names the particle;
particles that leave are booked; walls, limits, damping and prescribed motion do what the input says."""

import json
import math
import re

import h5py

import _mpm
from _mpm import NUMERICAL_FAILURE, STOPPED, Case

ROOM = (16, 8, 8)
YOUNG, POISSON, DENSITY = 1000.0, 0.3, 1.0  # of _mpm.material()
FLIGHT = [_mpm.block("bird", (9, 2, 2), (4, 4, 4), (10, 0, 0))]  # leaves through the face at x = 16 until t = 0.7


def refuse(constant):
    raise ValueError(f"{constant} is no JSON")


def strict_summary(folder):
    return json.loads((folder / "case.summary.json").read_text(), parse_constant=refuse)


def scene(bodies, more="", end=1.0, faces="222222", room=ROOM, output="", attributes=""):
    return _mpm.scene(bodies, _mpm.grid((0, 0, 0), room, faces), _mpm.solution(end, attributes=attributes, more=more),
                      output=f'<Console print_time="{end / 10}"/>' + output)


def fluid_of(bulk_modulus, energy=""):
    """To be put in the place of _mpm.material()."""
    equation = (f'<EquationOfState type="Polynomial" c0="0" c1="{bulk_modulus}" c2="0" c3="0" c4="0" c5="0" c6="0" '
                f"{energy}/>")
    return _mpm.material(strength='type="Null"', more=equation)


class Failures(Case):
    def check_failure(self, text, pattern, ranks=(1, 2, 3)):
        """The same message on any ranks, on standard error, in the log and in the summary."""
        self.write(text)
        complaints = set()
        for n in ranks:
            outcome = self.run_in(f"out{n}", [self.folder / "case.xmp"], code=NUMERICAL_FAILURE, ranks=n)
            complaints.add(outcome.complaint)
            self.assertRegex(outcome.complaint, rf"^{pattern}$")
            found = strict_summary(self.folder / f"out{n}")
            self.assertEqual((found["status"], found["reason"]), ("failed", outcome.complaint))
            log = (self.folder / f"out{n}/case.out").read_text()
            self.assertIn(f"FAILED     {outcome.complaint}", log)
            self.assertIn(f"FAILED     {outcome.complaint}", outcome.out)
        self.assertEqual(len(complaints), 1, complaints)

    PARTICLE = r'step \d+, time [\d.e+-]+: .*particle \d+ of body "(left|right|bird)" at \([^)]*\).*'

    def test_step_that_is_far_too_long(self):
        for steps in (4, 10):
            with self.subTest(f"{steps} times the critical step"):
                step = f'<TimeStep specified="{steps * 0.025}"/>'
                text = scene(_mpm.BOUNCING, end=50)
                self.check_failure(text.replace('<TimeStep factor="0.5"/>', step), self.PARTICLE)

    def test_short_run_with_a_step_that_is_too_long(self):
        """A block that swings: two steps in which its energy grows tenfold would else end as if they were good."""
        swinging = _mpm.block("bird", (4, 2, 2), (4, 4, 4), ("0.1*(x-6)", 0, 0))
        for step, too_long in ((0.02, False), (0.1, True)):
            with self.subTest(step=step):
                self.write(scene([swinging], end=8 * step).replace('<TimeStep factor="0.5"/>', f'<TimeStep specified="{step}"/>'))
                outcome = self.run_in("out", [self.folder / "case.xmp"])
                said = [line for line in outcome.out.splitlines() if line.startswith("warning: ")]
                if not too_long:
                    self.assertEqual(said, [])
                    continue
                self.assertEqual(len(said), 2, outcome)
                self.assertIn("the specified time step 0.1 is 3.69 times the critical step 0.0271", said[0])
                self.assertRegex(said[1], r"the error of the energy balance was \d+.* % at step 8, the last")

    def test_the_last_row_is_judged_too(self):
        """A block with one particle in a cell that drifts across cells gains energy; no row of the status file is due before the end."""
        speed = [f"{drift}+3*cos(pi*({axis}-4.1)/6)" for drift, axis in zip((1, 0.7, 0.4), "xyz")]
        soft = _mpm.material("soft", 1.0, 'type="IsoElastic" Young="1000" Poisson="0.3"')
        text = _mpm.scene([_mpm.block("block", (4.1, 4.1, 4.1), (6, 6, 6), speed, 1, "soft")], _mpm.grid((0, 0, 0), (30, 30, 30)),
                          _mpm.solution(4, factor=0.9), [soft], '<Console print_time="40"/>')
        self.write(text)
        outcome = self.run_in("out", [self.folder / "case.xmp"])
        self.assertEqual(len(_mpm.table(self.folder / "out/case.sta")["step"]), 2)
        self.assertRegex(outcome.out, r"warning: the error of the energy balance was up to \d+.* %")
        self.assertIn("the error of the energy balance", _mpm.summary(self.folder / "out")["reason"])

    def test_energy_fraction(self):
        self.check_failure(scene(_mpm.BOUNCING, '<EnergyFraction value="1e-4"/>', end=9),
                           r"step \d+, time [\d.]+: the relative error of the total energy is .*, more than EnergyFraction 0\.0001")

    def test_energy_fraction_is_checked_at_every_step(self):
        """The run ends in the first step whose energy is off, whenever .sta is written."""
        self.write(scene(_mpm.BOUNCING, end=9).replace('print_time="0.9"', 'print_time="1e-9"'))
        self.run_in("all", [self.folder / "case.xmp"])
        table = _mpm.table(self.folder / "all/case.sta")
        first = next(int(s) for s, drift in zip(table["step"], table["relative_drift"]) if abs(drift) > 1e-4)
        self.assertGreater(first, 10)
        self.check_failure(scene(_mpm.BOUNCING, '<EnergyFraction value="1e-4"/>', end=9)
                           .replace('print_time="0.9"', 'print_time="9"'),
                           rf"step {first}, time [\d.]+: the relative error of the total energy is .*, more than EnergyFraction 0\.0001")

    def test_particle_outside_at_level_2(self):
        self.check_failure(scene(FLIGHT, '<Warn type="grid" level="2"/>', faces="000000"), self.PARTICLE)

    def test_negative_internal_energy_at_level_2(self):
        fluid = fluid_of(1000, 'E0="-1"')
        text = scene(_mpm.BOUNCING, '<Warn type="ie|vol" level="2"/>').replace(_mpm.material(), fluid)
        self.check_failure(text, r"step 1, time [\d.e+-]+: 1536 particle\(s\) with internal energy below zero; "
                                 r'the first: particle 0 of body "left" at \([^)]*\)')

    def test_volume_that_vanishes_at_level_2(self):
        """Two fluids that flow through each other in steps which are too long for them."""
        bodies = [_mpm.block("left", (1, 2, 2), (6, 4, 4), (20, 0, 0)),
                  _mpm.block("right", (8, 2, 2), (6, 4, 4), (-20, 0, 0))]
        text = scene(bodies, '<Warn type="vol" level="2"/>').replace(_mpm.material(), fluid_of(1))
        self.check_failure(text.replace('<TimeStep factor="0.5"/>', '<TimeStep specified="0.1"/>'),
                           r"step \d+, time [\d.e+-]+: \d+ particle\(s\) whose volume would have vanished.*")

    def test_last_good_restart_file_is_named(self):
        self.write(scene(FLIGHT, '<Warn type="grid" level="2"/>', faces="000000",
                         output='<Restart time_interval="0.1"/>'))
        outcome = self.run_in("out", [self.folder / "case.xmp"], code=NUMERICAL_FAILURE)
        newest = _mpm.restarts(self.folder / "out")[-1]
        self.assertIn(f"the last good state is in {newest}", outcome.out)
        self.assertEqual(_mpm.run([newest, "--output-dir", self.folder / "out"]).code, NUMERICAL_FAILURE)


class Leaving(Case):
    def fly(self, more="", ranks=1, **changes):
        self.write(scene(FLIGHT, more, faces="000000", **changes))
        return self.run_in("out", [self.folder / "case.xmp"], ranks=ranks)

    def test_booked(self):
        """The whole body leaves stressless, so that the ledger have to balance to round-off."""
        for end, gone in [(0.55, lambda n: 0 < n < 512), (1.0, lambda n: n == 512)]:
            outcome = self.fly(end=end)
            found = strict_summary(self.folder / "out")
            left = 512 - found["particles"]
            self.assertTrue(gone(left), outcome)
            self.assertIn(f"{left} particle(s) left the grid", outcome.out)
            self.assertLess(abs(found["energy"]["relative_drift"]), 1e-12)
            self.assertAlmostEqual(found["bodies"][0]["mass"], 64 - left / 8, delta=1e-9)
            self.assertAlmostEqual(found["momentum"][0], 10 * (64 - left / 8), delta=1e-9)
            self.assertEqual(found["bodies"][0]["centre"][0] is None, left == 512)

    def test_outputs_and_restarts_without_particles(self):
        output = ('<PostProcessing time_interval="0.2" h5part="1" vtk_data="1" var="pres"/>'
                  '<Restart time_interval="0.2"/>'
                  '<TimeHistory var="pres"><Particle x="9" y="4" z="4"/><Point x="9" y="4" z="4"/></TimeHistory>')
        state = self.fly(output=output).state
        for ranks in (2, 3):
            self.assertEqual(self.fly(output=output, ranks=ranks).state, state)
            again = self.run_in("again", [self.folder / "out/case.pe"], ranks=ranks - 1)
            self.assertEqual(again.state, state)
        with h5py.File(self.folder / "out/case.h5part") as file:
            steps = _mpm.pictures(file)
            self.assertEqual((steps[0]["x"].shape, steps[-1]["x"].shape), ((512,), (0,)))
        self.assertEqual(_mpm.table(self.folder / "out/case_curv.dat")["present[particle1]"][-1], 0)

    def test_warnings(self):
        def warnings(more):
            return [line for line in self.fly(more).out.splitlines() if line.startswith("warning: ")]

        steps = warnings('<Warn type="grid"/>')
        self.assertGreaterEqual(len(steps), 8, "one for each step in which a layer of particles leaves")
        for line in steps:
            self.assertRegex(line, r"step \d+, time .*: \d+ particle\(s\) left the grid; "
                                   r'the first: particle \d+ of body "bird"')
        self.assertEqual(sum(int(line.split(": ")[2].split()[0]) for line in steps), 512)
        self.assertEqual(warnings(""), [])

    def test_warnings_by_particle(self):
        """Twenty are named, in the order of steps and identities; the rest is counted. The same on any ranks."""
        logs = set()
        for ranks in (1, 2, 3):
            out = self.fly('<Warn type="grid" level="1"/>', ranks=ranks).out
            named = [line for line in out.splitlines() if line.startswith("warning: ")]
            logs.add("\n".join(named))
            self.assertEqual(len(named), 21)
            found = [re.fullmatch(r"warning: step (\d+), time \S+: particle (\d+) of body \"bird\" at \([^)]*\) "
                                  "left the grid", line) for line in named[:20]]
            order = [(int(m.group(1)), int(m.group(2))) for m in found]
            self.assertEqual(order, sorted(set(order)))
            self.assertRegex(named[20], "20 particles left the grid have been named: further ones are only counted")
            self.assertIn("counted    512 particle(s) left the grid, summed over the steps; 20 named above", out)
        self.assertEqual(len(logs), 1)

    def test_each_particle_is_named_once(self):
        """Five with negative energy in every step, and volumes that would vanish."""
        fluid = fluid_of(1000, 'E0="-1"')
        bodies = [_mpm.block("few", (1, 1, 1), (2.5, 0.5, 0.5))]
        logs = set()
        for ranks in (1, 2):
            self.write(scene(bodies, '<Warn type="ie|vol" level="1"/>', end=0.1).replace(_mpm.material(), fluid))
            out = self.run_in("out", [self.folder / "case.xmp"], ranks=ranks).out
            named = [line for line in out.splitlines() if line.startswith("warning: ")]
            self.assertEqual([re.search(r"particle (\d+) of", line).group(1) for line in named], list("01234"))
            self.assertIn("with internal energy below zero", named[0])
            steps = _mpm.summary(self.folder / "out")["steps"]
            self.assertIn(f"counted    {5 * steps} particle(s) with internal energy below zero, summed over the steps; "
                          "5 named above", out)
            logs.add("\n".join(named))
        self.assertEqual(len(logs), 1)

    def test_vanishing_volumes_are_named(self):
        bodies = [_mpm.block("left", (1, 2, 2), (6, 4, 4), (20, 0, 0)),
                  _mpm.block("right", (8, 2, 2), (6, 4, 4), (-20, 0, 0))]
        text = scene(bodies, '<Warn type="vol" level="1"/>').replace(_mpm.material(), fluid_of(1))
        self.write(text.replace('<TimeStep factor="0.5"/>', '<TimeStep specified="0.1"/>'))
        logs = set()
        for ranks in (1, 3):
            outcome = _mpm.run([self.folder / "case.xmp", "--output-dir", self.folder / "out"], ranks=ranks)
            named = [line for line in outcome.out.splitlines() if line.startswith("warning: ") and "specified" not in line]
            self.assertRegex(named[0], r'warning: step \d+, time \S+: particle \d+ of body "(left|right)" at \([^)]*\) '
                                       "whose volume would have vanished")
            logs.add("\n".join(named))
        self.assertEqual(len(logs), 1)

    def test_stop_near_the_boundary(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                self.write(scene(FLIGHT, faces="000000", attributes='near_boundary_stop="1"'))
                outcome = self.run_in("out", [self.folder / "case.xmp"], code=STOPPED, ranks=ranks)
                self.assertRegex(outcome.out, "stopped +a particle is next to an open boundary")
                found = strict_summary(self.folder / "out")
                self.assertEqual(found["particles"], 512)
                self.assertEqual(math.floor(found["bodies"][0]["upper"][0]), 15)
                self.assertEqual(len(_mpm.restarts(self.folder / "out")), 1)

    def test_walls_are_no_open_boundary(self):
        self.write(scene(_mpm.BOUNCING, end=0.2, attributes='near_boundary_stop="1"'))
        self.run_in("out", [self.folder / "case.xmp"])


class Walls(Case):
    """Six blocks in one room, each before its own face, moving along the face at a fifth of the speed across it."""

    SPEED = 5.0

    def run_blocks(self, boundary, gap, outward, end):
        """What has become of each block: `gap` cells from its face and thrown at it (outward 1) or away (-1)."""
        bodies = []
        for face in range(6):
            axis, upper = face // 2, face % 2
            lower, velocity = [8.0, 8.0, 8.0], [0.0, 0.0, 0.0]
            lower[axis] = 16 - gap if upper else gap
            velocity[axis] = outward * self.SPEED * (1 if upper else -1)
            velocity[(axis + 1) % 3] = self.SPEED / 5
            bodies.append(_mpm.block(f"face{face}", lower, (4, 4, 4), velocity))
        self.write(scene(bodies, end=end, faces=6 * str(boundary), room=(20, 20, 20)))
        self.run_in("out", [self.folder / "case.xmp"], ranks=2)
        blocks = []
        for face, body in enumerate(strict_summary(self.folder / "out")["bodies"]):
            axis, upper = face // 2, face % 2
            blocks.append({"particles": body["particles"],
                           "gap": 20 - body["upper"][axis] if upper else body["lower"][axis],
                           "outward": body["velocity"][axis] * (1 if upper else -1),
                           "along": body["velocity"][(axis + 1) % 3],
                           "internal": body["internal"]})
        for block in blocks[1:]:  # all six do the same
            for key, value in block.items():
                self.assertAlmostEqual(value, blocks[0][key], delta=1e-6, msg=key)
        return blocks[0]

    def throw(self, boundary, end=0.9):
        return self.run_blocks(boundary, 1.5, 1, end)

    def pull(self, boundary):
        return self.run_blocks(boundary, 0, -1, 0.3)

    def check_stopped(self, block):
        """Nothing got through; the block is on its way back."""
        self.assertEqual(block["particles"], 512)
        self.assertGreater(block["gap"], 1)
        self.assertLess(block["outward"], -0.5 * self.SPEED)

    def test_free(self):
        """The front layers have left, the rest goes on as before."""
        block = self.throw(0, end=0.7)
        self.assertTrue(0 < block["particles"] < 512)
        self.assertAlmostEqual(block["outward"], self.SPEED, delta=1e-9)
        self.assertAlmostEqual(block["along"], self.SPEED / 5, delta=1e-9)

    def test_fixed(self):
        """Holds everything, along the wall too, and does not let go."""
        block = self.throw(1)
        self.check_stopped(block)
        self.assertLess(block["along"], 0.5 * self.SPEED / 5)
        block = self.pull(1)
        self.assertGreater(block["outward"], -0.95 * self.SPEED)
        self.assertLess(block["along"], 0.95 * self.SPEED / 5)

    def test_symmetry(self):
        """Holds the velocity across the wall, both ways, and none along it."""
        block = self.throw(2)
        self.check_stopped(block)
        self.assertAlmostEqual(block["along"], self.SPEED / 5, delta=1e-9)
        block = self.pull(2)
        self.assertGreater(block["outward"], -0.95 * self.SPEED)
        self.assertAlmostEqual(block["along"], self.SPEED / 5, delta=1e-9)

    def test_rigid_wall(self):
        """Lets nothing through; what moves away from it does so freely."""
        block = self.throw(4)
        self.check_stopped(block)
        self.assertAlmostEqual(block["along"], self.SPEED / 5, delta=1e-9)
        block = self.pull(4)
        self.assertAlmostEqual(block["outward"], -self.SPEED, delta=1e-9)
        self.assertAlmostEqual(block["along"], self.SPEED / 5, delta=1e-9)
        self.assertLess(block["internal"], 1e-12)

    def test_walls_give_no_energy(self):
        for boundary in (1, 2, 4):
            with self.subTest(boundary=boundary):
                block = self.throw(boundary)
                self.assertGreater(block["outward"], -1.01 * self.SPEED, "faster than it came")
                self.assertLess(strict_summary(self.folder / "out")["energy"]["relative_drift"], 0.03)


class Prescribed(Case):
    def test_limit_of_the_velocity(self):
        more = '<LimitVelocity max="2"/><Gravity ax="30" ay="40" az="0"/>'
        body = _mpm.block("cube", (1, 1, 1), (2, 2, 2))
        self.write(scene([body], more, faces="000000"))
        self.run_in("out", [self.folder / "case.xmp"])
        velocity = strict_summary(self.folder / "out")["bodies"][0]["velocity"]
        self.assertLessEqual(math.hypot(*velocity), 2 * (1 + 1e-12))
        for found, expected in zip(velocity, (1.2, 1.6, 0)):
            self.assertAlmostEqual(found, expected, delta=1e-9, msg="slower, in the same direction")

    def test_prescribed_velocity(self):
        """A body in prescribed motion pushes another one before it and is not slowed."""
        piston = _mpm.block("piston", (1, 2, 2), (3, 4, 4), more='<PrescribedVelocity vx="3" vy="0.5" vz="-0.25"/>')
        freight = _mpm.block("freight", (5, 2, 2), (3, 4, 4))
        self.write(scene([piston, freight], faces="000000"))
        for ranks in (1, 2):
            self.run_in("out", [self.folder / "case.xmp"], ranks=ranks)
            found, pushed = strict_summary(self.folder / "out")["bodies"]
            for axis, (start, speed) in enumerate([(2.5, 3), (4, 0.5), (4, -0.25)]):
                self.assertAlmostEqual(found["velocity"][axis], speed, delta=1e-12)
                self.assertAlmostEqual(found["centre"][axis], start + speed, delta=1e-10)
            self.assertGreater(pushed["velocity"][0], 1)

    def test_energy_of_a_prescribed_motion(self):
        """The ledger hold the work that the motion takes."""
        piston = _mpm.block("piston", (1, 2, 2), (3, 4, 4), more='<PrescribedVelocity vx="1" vy="0" vz="0"/>')
        self.write(scene([piston, _mpm.block("freight", (4, 2, 2), (4, 4, 4))], faces="000000"))
        self.run_in("out", [self.folder / "case.xmp"])
        energy = strict_summary(self.folder / "out")["energy"]
        self.assertGreater(energy["external_work"], 10)
        self.assertLess(abs(energy["relative_drift"]), 0.02)

    def test_rigid_body(self):
        """It flies on through the other rigid body in its way, under gravity, undeformed, and no stiffness limits the
        step."""
        gravity = (0.5, -0.2, 0)
        bodies = [_mpm.block("ram", (1, 2, 2), (2, 4, 4), (3, 0.5, -0.25), of="iron"),
                  _mpm.block("freight", (3, 2, 2), (3, 4, 4), of="wood")]
        materials = [_mpm.material("wood", 1.0, 'type="Rigid"'), _mpm.material("iron", 50.0, 'type="Rigid"')]
        more = '<Gravity ax="{}" ay="{}" az="{}"/>'.format(*gravity)
        for algorithm, ranks in (("MUSL", 1), ("MUSL", 2), ("USF", 1), ("USL", 2)):
            with self.subTest(algorithm=algorithm, ranks=ranks):
                self.write(_mpm.scene(bodies, _mpm.grid((0, 0, 0), ROOM), _mpm.solution(1.0, algorithm, 0.05, more=more),
                                      materials))
                self.run_in("out", [self.folder / "case.xmp"], ranks=ranks)
                found = strict_summary(self.folder / "out")
                ram, freight = found["bodies"]
                for axis, (start, speed) in enumerate([(2, 3), (4, 0.5), (4, -0.25)]):
                    self.assertAlmostEqual(ram["velocity"][axis], speed + gravity[axis], delta=1e-9)
                    # Steps of v += g dt, x += v dt are ahead by g t dt/2, dt at most 0.05/3.
                    way = speed + gravity[axis] / 2
                    self.assertAlmostEqual(ram["centre"][axis], start + way, delta=0.01 * abs(gravity[axis]) + 1e-9)
                    self.assertAlmostEqual(ram["upper"][axis] - ram["lower"][axis], (1.5, 3.5, 3.5)[axis], delta=1e-9)
                self.assertEqual(ram["internal"], 0)
                for axis in range(3):  # neither pushed nor slowed
                    self.assertAlmostEqual(freight["velocity"][axis], gravity[axis], delta=1e-9)
                self.assertLess(abs(found["energy"]["relative_drift"]), 0.02)
                self.assertLess(found["steps"], 90)  # a speed of 3.6 crosses a cell in 0.28: 72 steps at this factor

    def test_rigid_body_beside_others(self):
        """Without contact it would push nothing, so it is refused; prescribed motion of a body that deforms pushes."""
        materials = [_mpm.material(), _mpm.material("iron", 50.0, 'type="Rigid"')]
        moved = '<PrescribedVelocity vx="0" vy="0" vz="-0.5"/>'

        def press(of):
            bodies = [_mpm.block("column", (0, 0, 0), (2, 2, 8)), _mpm.block("ram", (0, 0, 8), (2, 2, 2), of=of, more=moved)]
            return self.write(_mpm.scene(bodies, _mpm.grid((0, 0, 0), (2, 2, 12), "222220"), _mpm.solution(1.0), materials))

        outcome = self.run_in("out", [press("iron")], code=_mpm.INPUT_ERROR)
        self.assertRegex(outcome.complaint, r'case.xmp:\d+: <Body material="iron">: a rigid body acts on others only through '
                         r"contact, .* pass through 'column' without exerting a force\. Set Contact enable to 1, give the body a deformable material")
        self.run_in("out", [press("soft")])
        column, ram = strict_summary(self.folder / "out")["bodies"]
        self.assertAlmostEqual(ram["lower"][2], 8.25 - 0.5, delta=1e-9)
        self.assertAlmostEqual(column["upper"][2], 7.75 - 0.5, delta=0.1)  # shorter by what the ram has come down

    def test_bar_laws_are_for_bars(self):
        self.write(_mpm.scene([_mpm.block("cube", (1, 1, 1), (2, 2, 2))], _mpm.grid((0, 0, 0), ROOM), _mpm.solution(1),
                              [_mpm.material(strength='type="Elastic_1D" Young="1000" Poisson="0.3"')]))
        outcome = self.run_in("out", [self.folder / "case.xmp"], code=_mpm.INPUT_ERROR)
        self.assertRegex(outcome.complaint, "material `soft` is for bars only, but body `cube`")

    def test_dynamic_relaxation(self):
        """A column under its own weight, between walls without friction. At rest (linear elasticity, uniaxial strain,
        M the modulus): sigma_zz = -rho g (H - z), mean settlement rho g H^2 / (3 M). The damping is critical for the
        first mode, 2 pi c / (2 H)."""
        height, gravity = 8.0, 1.0
        modulus = YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))
        damping = math.pi * math.sqrt(modulus / DENSITY) / height
        more = f'<DynamicRelax damping="{damping}"/><Gravity ax="0" ay="0" az="{-gravity}"/>'
        output = '<PostProcessing time_interval="9" h5part="1" var="SigmaZ"/>'
        self.write(scene([_mpm.block("column", (0, 0, 0), (2, 2, height))], more, 2.0, "222220", (2, 2, 9), output))
        self.run_in("out", [self.folder / "case.xmp"])
        found = strict_summary(self.folder / "out")
        body = found["bodies"][0]
        settlement = DENSITY * gravity * height**2 / (3 * modulus)
        self.assertAlmostEqual(height / 2 - body["centre"][2], settlement, delta=0.02 * settlement)
        self.assertLess(found["energy"]["kinetic"], 1e-6 * found["energy"]["internal"])
        with h5py.File(self.folder / "out/case.h5part") as file:
            last = _mpm.pictures(file)[-1]
            errors = last["SigmaZ"][()] + DENSITY * gravity * (height - last["z"][()])
        # Stress is constant over a cell, whose two layers of particles lie a quarter of it from its middle.
        self.assertLess(math.sqrt((errors**2).mean()), 1.05 * DENSITY * gravity / 4)
        self.assertLess(abs(found["energy"]["relative_drift"]), 0.02)


if __name__ == "__main__":
    _mpm.main()
