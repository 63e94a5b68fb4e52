"""Functions of place and time in the input: initial velocities, body forces, tractions and prescribed velocities
against their closed forms, the same bits on any ranks and threads and through a restart, and wrong expressions."""

import math
import re

import _cases
import _mpm
import numpy as np

SCHEMES = ("MUSL", "USF", "USL", "USAVG")
SHAPES = ("linear", "SGMP", "DDMP", "uGIMP", "cpGIMP", "CPDI", "CPDI2", "QuadraticBSpline", "CubicBSpline")


def pictures(interval, variables="pres"):
    return f'<PostProcessing time_interval="{interval!r}" h5part="1" var="{variables}"/>'


def body(name, lower, size, loads, dp=0.5, of="soft"):
    """A block with its loads, initial velocity included."""
    still = '<InitialVelocity vx="0" vy="0" vz="0"/>'
    text = _mpm.block(name, lower, size, dp=dp, of=of, more=loads)
    return text.replace(still, "") if "InitialVelocity" in loads or "PrescribedVelocity" in loads else text


class Expressions(_mpm.Case):
    def scene(self, loads, end, algorithm="MUSL", step=None, faces="000000", output="", more=""):
        text = _mpm.scene([body("block", (6, 2, 2), (4, 4, 4), loads)], _mpm.grid((0, 0, 0), (16, 8, 8), faces),
                          _mpm.solution(end, algorithm, more=more),
                          output=f'<Console print_time="{end / 5}"/>' + output)
        return text if step is None else text.replace('<TimeStep factor="0.5"/>', f'<TimeStep specified="{step!r}"/>')

    def found(self, text, folder="run", **how):
        outcome = self.run_in(folder, [self.write(text)], **how)
        return _mpm.summary(self.folder / folder), outcome

    def test_initial_velocity(self):
        # The columns keep all digits: what C's sine gives at each particle.
        text = _mpm.scene([body("bar", (0, 0, 0), (25, 1, 1), '<InitialVelocity vx="0.1*sin(pi*x/25)" vy="-Z*x" vz="0.5"/>')],
                          _mpm.grid((0, 0, 0), (26, 1, 1), "202222"), _mpm.solution(1e-3),
                          output=pictures(1e-3, "pres"))
        self.run_in("run", [self.write(text)])
        states = _cases.States(self.folder / "run")
        x, z = states.column("x", 0), states.column("z", 0)
        self.assertEqual(len(x), 200)
        kind = states.steps[0]["velocity_0"].dtype
        exact = np.array([0.1 * math.sin(math.pi * at / 25) for at in x])
        np.testing.assert_array_equal(states.column("velocity_0", 0), exact.astype(kind))
        np.testing.assert_array_equal(states.column("velocity_1", 0), (-z * x).astype(kind))
        np.testing.assert_array_equal(states.column("velocity_2", 0), 0.5)

    def test_body_force_of_first_place_and_time(self):
        # Linear in time, so that the middles of the steps give the integral: p = sum m (1 + X^2) T^2/2.
        end = 0.45  # whose last step is long enough to make up for the lag of the velocities
        places = np.arange(6.25, 10, 0.5)
        exact = 0.125 * 64 * (1 + places**2).sum() * end**2 / 2
        for algorithm in SCHEMES:
            with self.subTest(algorithm=algorithm):
                text = self.scene('<BodyForce bx="(1 + X*X)*t"/>', end, algorithm)
                summary, outcome = self.found(text, algorithm)
                self.assertLess(abs(summary["momentum"][0] / exact - 1), 1e-13)
                self.assertLess(abs(summary["energy"]["relative_drift"]), 2e-4)  # of the waves inside
                self.assertIn("beyond the mechanics", outcome.out)
                self.assertRegex(outcome.out, r"beyond the mechanics.* first_x\b(?! first_y)")

    def test_body_force_of_place_and_time(self):
        # A force linear in x acts on the centre of mass alone: that moves as an oscillator in a leapfrog, whatever the
        # particles do.
        omega, centre, push, dt, steps = 3.0, 7.5, 2.0, 0.01, 100
        mass, x, v = 64.0, 8.0, 0.0
        for n in range(steps):
            v += dt * (-omega**2 * (x - centre) + push * (n + 0.5) * dt)
            x += dt * v
        for algorithm in SCHEMES:
            with self.subTest(algorithm=algorithm):
                text = self.scene(f'<BodyForce bx="-{omega}^2*(x - {centre}) + {push}*t"/>', dt * steps, algorithm, dt)
                summary, outcome = self.found(text, algorithm)
                self.assertEqual(summary["steps"], steps)
                self.assertLess(abs(summary["momentum"][0] - mass * v), 1e-11 * mass)
                self.assertLess(abs(summary["bodies"][0]["centre"][0] - x), 1e-12 * x)
                self.assertNotIn("first_x", outcome.out)
        # To the exact motion, in second order of the step at its middle and in first at its end.
        exact = push / omega**2 * (1 - math.cos(omega)) - (8 - centre) * omega * math.sin(omega)
        self.assertLess(abs(v - exact), 2 * dt)

    def test_energy_of_a_body_force(self):
        # It squeezes the block; the balance closes as the step falls. Measured: 0.22, 0.15, 0.11 % (MUSL), 1.2, 0.16, 0.01 % (USF).
        for algorithm in ("MUSL", "USF", "USAVG"):  # USL dissipates by itself
            drift = []
            for dt in (0.01, 0.005, 0.0025):
                text = self.scene('<BodyForce bx="-9*(x - 7.5) + 2*t"/>', 1.0, algorithm, dt)
                drift.append(abs(self.found(text, f"{algorithm}-{dt}")[0]["energy"]["relative_drift"]))
            self.assertLess(drift[0], 0.013)
            self.assertLess(max(drift[1:]), 0.002)

    def test_energy_as_with_gravity(self):
        # The same acceleration by Gravity, by a constant BodyForce and by expressions; walls make the block bounce.
        drift, state, centre = {}, {}, {}
        for name, loads, more in (("gravity", "", '<Gravity ax="0" ay="0" az="-20"/>'),
                                  ("number", '<BodyForce bz="-20"/>', ""),
                                  ("time", '<BodyForce bz="if(t &lt; 9, -20, 0)"/>', ""),
                                  ("place", '<BodyForce bz="if(x &lt; 99, -20, 0)"/>', "")):
            summary, outcome = self.found(self.scene(loads, 1.0, faces="222222", more=more), name)
            drift[name], state[name] = abs(summary["energy"]["relative_drift"]), outcome.state
            centre[name] = summary["bodies"][0]["centre"]
            self.assertGreater(summary["energy"]["external_work"], 0)
        self.assertEqual(state["number"], state["time"])
        for name in ("number", "place"):
            np.testing.assert_allclose(centre[name], centre["gravity"], atol=1e-10)
        # The blow on the wall loses 6 % of the energy with each. The work of what is the same for all particles is that of gravity,
        # over their displacements; that of other loads, at the nodes, is booked at the middle of the step: a difference of first order.
        self.assertAlmostEqual(drift["number"], drift["gravity"], delta=1e-10)
        self.assertAlmostEqual(drift["place"], drift["gravity"], delta=0.01)
        # Without walls nothing deforms, and the work is exact.
        summary, _ = self.found(self.scene('<BodyForce bx="2*t" by="if(x &lt; 99, 1, 0)"/>', 0.5), "free")
        self.assertLess(abs(summary["energy"]["relative_drift"]), 1e-12)

    def test_weight_at_walls(self):
        # A constant BodyForce is gravity, for every shape and scheme, in a corner of walls of each kind: by the masses of the nodes
        # where all bodies of a brick have the same, by particles where they differ.
        for n, shape in enumerate(SHAPES):
            algorithm = ("MUSL", "USF", "USL")[n % 3]
            found = {}
            for name, forces in (("gravity", ("", "")), ("nodes", ("-20", "-20")), ("particles", ("-20", "-20.0000000001"))):
                bodies = [_mpm.block(f"block {k}", (0.2 + 3 * k, 5.2, 0.4), (3, 3, 3), (-2, 3, -4),
                                     more=force and f'<BodyForce bx="3" by="1" bz="{force}"/>') for k, force in enumerate(forces)]
                gravity = '<Gravity ax="3" ay="1" az="-20"/>' if name == "gravity" else ""
                grid = _mpm.grid((0, 0, 0), (12, 9, 8), "200140").replace("<Grid>", f'<Grid shape="{shape}">')
                found[name] = self.found(_mpm.scene(bodies, grid, _mpm.solution(0.35, algorithm, 0.4, more=gravity)), f"{shape} {name}")[0]
            # With USL uniform forces strain light nodes no more than gravity does; those that particles map do.
            for name, other in (("nodes", "gravity"), ("nodes", "particles"))[:1 if algorithm == "USL" else 2]:
                with self.subTest(shape=shape, algorithm=algorithm, other=other):
                    for body, wanted in zip(found[name]["bodies"], found[other]["bodies"]):
                        for value in ("centre", "velocity"):
                            np.testing.assert_allclose(body[value], wanted[value], atol=1e-8)
                    for value in ("kinetic", "external_work"):
                        self.assertAlmostEqual(found[name]["energy"][value] / found[other]["energy"][value], 1, delta=1e-8)

    def test_energy_of_prescribed_motion(self):
        """The force of the constraint works with the mean of the velocities before and after a step, as weight and damping do. (With the
        later one the books are off by 40 % here.)"""
        for algorithm in SCHEMES:
            with self.subTest(algorithm=algorithm):
                text = self.scene('<PrescribedVelocity vx="2*sin(6*t)" vy="0" vz="-1"/>', 1.0, algorithm, 0.0075,
                                  more='<Gravity ax="3" ay="1" az="-20"/><DynamicRelax damping="3"/>')
                summary, _ = self.found(text, algorithm)
                self.assertLess(abs(summary["energy"]["relative_drift"]), 1e-12)
                self.assertGreater(summary["energy"]["kinetic"], 1)

    def test_prescribed_velocity(self):
        # v(t) at the ends of the steps moves the body by their sum; v(X) and v(x) shear and stretch it.
        dt, steps = 0.01, 40
        load = '<PrescribedVelocity vx="2*cos(3*t)" vy="0.1*(X - 6)*t" vz="0.2*(z - 2)"/>'
        text = self.scene(load, dt * steps, step=dt, output=pictures(dt * steps))
        self.run_in("run", [self.write(text)])
        states = _cases.States(self.folder / "run")
        times = dt * np.arange(1, steps + 1)
        first = {axis: states.column(axis, 0) for axis in "xyz"}
        np.testing.assert_allclose(states.column("velocity_0"), 2 * math.cos(3 * times[-1]), rtol=1e-6)
        np.testing.assert_allclose(states.column("x") - first["x"], dt * 2 * np.cos(3 * times).sum(), rtol=1e-5)
        np.testing.assert_allclose(states.column("velocity_1"), 0.1 * (first["x"] - 6) * times[-1], rtol=1e-6)
        np.testing.assert_allclose(states.column("y") - first["y"], 0.1 * (first["x"] - 6) * dt * times.sum(), rtol=1e-4)
        np.testing.assert_allclose(states.column("z") - 2, (first["z"] - 2) * (1 + 0.2 * dt) ** steps, rtol=1e-5)
        np.testing.assert_array_equal(states.column("velocity_2", 0), (0.2 * (first["z"] - 2)).astype(np.float32))

    def test_pressure_over_the_surface(self):
        # A pressure that is linear in z lifts by its gradient times the volume, the same on every shape; its factor
        # over time multiplies it. Stiff, so that the volume stays.
        table = '<Coefficient time="0" c="0"/><Coefficient time="1" c="1"/>'
        stiff = _mpm.material("stiff", 1.0, 'type="IsoElastic" Young="1e6" Poisson="0.3"')
        end = 0.02
        for name, load, factor in (("constant", '<Traction pressure="7 - 3*z"/>', end),
                                   ("growing", f'<Traction pressure="7 - 3*z">{table}</Traction>', end**2 / 2),
                                   ("time", '<Traction pressure="(7 - 3*z)*(1 + t)"/>', end + end**2 / 2)):
            with self.subTest(name=name):
                text = _mpm.scene([body("cube", (2, 2, 2), (4, 4, 4), load, of="stiff")], _mpm.grid((0, 0, 0), (8, 8, 8)),
                                  _mpm.solution(end), [stiff])
                summary, _ = self.found(text, name)
                self.assertLess(abs(summary["momentum"][2] / (3 * 64 * factor) - 1), 1e-4)
                self.assertLess(max(map(abs, summary["momentum"][:2])), 1e-9)

    def test_traction(self):
        # A pull of 2 y at the end of a bar: its mean over the end face times the area is the force.
        end = 0.02
        stiff = _mpm.material("stiff", 1.0, 'type="IsoElastic" Young="1e6" Poisson="0"')
        totals = {}
        for name, tx in (("number", "8"), ("place", "2*y"), ("time", "if(t &gt;= 0, 8, 0)"), ("along", "2*y*x/12")):
            text = _mpm.scene([body("bar", (2, 2, 2), (10, 4, 4), f'<Traction tx="{tx}" normal="0" xmin="9"/>', of="stiff")],
                              _mpm.grid((0, 0, 0), (16, 8, 8)), _mpm.solution(end), [stiff])
            totals[name] = self.found(text, name)[0]["momentum"][0]
        self.assertLess(abs(totals["number"] / (8 * 16 * end) - 1), 1e-4)
        self.assertEqual(totals["time"], totals["number"])
        self.assertLess(abs(totals["place"] / totals["number"] - 1), 1e-3)
        self.assertLess(abs(totals["along"] / totals["number"] - 1), 1e-3)

    EVERYTHING = [
        body("left", (1, 2, 2), (5, 4, 4), '<InitialVelocity vx="2 + 0.3*sin(pi*x/5)" vy="cos(Y)" vz="z/9"/>'
             '<BodyForce bx="3*sin(x + t)" by="-9" bz="(X - Z)*if(t &lt; 0.2, t, y)"/>'),
        body("right", (9, 2, 2), (5, 4, 4), '<InitialVelocity vx="-3" vy="0" vz="Z - 4"/>'
             '<Traction pressure="2 + sin(3*y)*t"/><Traction tx="exp(-t)*y" ty="t" tz="0" normal="0" xmin="12"/>'),
        body("piston", (6.5, 2, 2), (2, 4, 1), '<PrescribedVelocity vx="0.5*sin(9*t)" vy="0" vz="0.1*(X - x)"/>')]

    def everything(self, algorithm="MUSL", end=0.6):
        return _mpm.scene(self.EVERYTHING, _mpm.grid((0, 0, 0), (16, 8, 8), "222222"), _mpm.solution(end, algorithm),
                          output=f'<Console print_time="{end / 10}"/>')

    def test_the_same_bits(self):
        for algorithm in SCHEMES:
            with self.subTest(algorithm=algorithm):
                case = self.write(self.everything(algorithm))
                alone = self.run_in(f"{algorithm}-1", [case])
                self.assertRegex(alone.out, r'"left" .* first_x first_z\b')
                self.assertRegex(alone.out, r'"piston" .* first_x\b')
                self.assertNotRegex(alone.out, r'"right" .* first_')
                for ranks, threads in ((1, 2), (2, 1), (2, 2), (3, 1)):
                    how = f"{algorithm}-{ranks}-{threads}"
                    self.assertEqual(self.run_in(how, [case], ranks=ranks, threads=threads).state, alone.state, how)
                # From the restart file on the way, by other ranks and threads.
                text = self.everything(algorithm).replace("<Output>", '<Output><Restart time_interval="0.25"/>')
                self.run_in(f"{algorithm}-saved", [self.write(text)], ranks=2)
                restart = _mpm.restarts(self.folder / f"{algorithm}-saved")[0]
                again = self.run_in(f"{algorithm}-again", [restart], ranks=3, threads=2)
                self.assertEqual(again.state, alone.state)

    def test_restart_with_another_input(self):
        text = self.everything().replace("<Output>", '<Output><Restart time_interval="0.25"/>')
        self.run_in("run", [self.write(text)])
        restart = _mpm.restarts(self.folder / "run")[0]
        # Loads may change, the velocities at the start and what the particles do not carry may not.
        changed = self.write(text.replace("3*sin(x + t)", "4*sin(x + t)"), "changed.xmp")
        self.assertEqual(self.run_in("changed", [restart, "-rt", changed]).code, 0)
        other = self.write(text.replace("cos(Y)", "sin(Y)"), "other.xmp")
        outcome = self.run_in("other", [restart, "-rt", other], code=_mpm.INPUT_ERROR)
        self.assertIn('<Body name="left">: differs from the input of the restart file', outcome.complaint)
        first = self.write(text.replace('by="-9"', 'by="-9*Y"'), "first.xmp")
        outcome = self.run_in("first", [restart, "-rt", first], code=_mpm.INPUT_ERROR)
        self.assertRegex(outcome.complaint, r'<Body name="left">: the scene needs state that the restart file does not '
                                            r"have: first_y; keep .* the expressions in X, Y, Z")

    def test_not_finite_at_the_start(self):
        loads = '<InitialVelocity vx="sqrt(8 - x)" vy="0" vz="0"/>'
        case = self.write(self.scene(loads, 0.1))
        message = (r'case\.xmp:\d+: <InitialVelocity vx="sqrt\(8 - x\)">: not a number for particle 4 of body "block" at '
                   r"\(8\.25, 2\.25, 2\.25\), t = 0: give an expression that is finite there")
        for ranks in (1, 2, 3):
            outcome = self.run_in("run", [case], code=_mpm.INPUT_ERROR, ranks=ranks)
            self.assertRegex(outcome.complaint, message)
        self.assertRegex(_mpm.run([case], program="mpm_check").complaint, message)

    def test_not_finite_in_the_run(self):
        step = r"step \d+, time [\d.e-]+: .*case\.xmp:\d+: "
        for name, loads, who in (
                ("force", '<BodyForce bx="sqrt(0.05 - t)*y/y" by="1"/>',
                 r'<BodyForce bx="sqrt\(0\.05 - t\)\*y/y"> is not a number for particle 0 of body "block" at \([-\d., e]+\), t = 0\.05'),
                ("time", '<BodyForce bx="sqrt(0.05 - t)"/>',
                 r'<BodyForce bx="sqrt\(0\.05 - t\)"> is not a number for every particle of body "block", t = 0\.05'),
                ("held", '<PrescribedVelocity vx="1" vy="ln(0.05 - t + X - X)" vz="0"/>',
                 r'<PrescribedVelocity vy="ln\(0\.05 - t \+ X - X\)"> is (not a number|infinite) for particle 0 of body "block" at'),
                ("pressure", '<Traction pressure="1/(x - 6.25)"/>',
                 r'<Traction pressure="1/\(x - 6\.25\)"> is infinite for particle 0 of body "block" at \(6\.25, 2\.25, 2\.25\), t = ')):
            with self.subTest(name=name):
                case = self.write(self.scene(loads, 0.2))
                found = set()
                for ranks, threads in ((1, 1), (1, 2), (3, 1)):
                    outcome = self.run_in(name, [case], code=_mpm.NUMERICAL_FAILURE, ranks=ranks, threads=threads)
                    self.assertRegex(outcome.complaint, step + who)
                    found.add(outcome.complaint)
                self.assertEqual(len(found), 1, "the same message on any ranks and threads")

    def test_wrong_input(self):
        loads = ('<InitialVelocity vx="t" vy="foo + 1" vz="sin(x"/>'
                 '<BodyForce bx="1/0" by="x, y" bz="5 GPa"/><Traction pressure="X"/>')
        case = self.write(self.scene(loads, 0.1))
        outcomes = [_mpm.run([case], program="mpm_check"), self.run_in("run", [case], code=_mpm.INPUT_ERROR),
                    self.run_in("run", [case], code=_mpm.INPUT_ERROR, ranks=2)]
        for outcome in outcomes:
            self.assertEqual(outcome.code, _mpm.INPUT_ERROR)
            for piece in ('vx="t">: expected a number, written like 1.5e-3, or an expression in x, y, z, X, Y, Z; t is not available here',
                          "unknown name 'foo' at character 1", "a closing parenthesis is missing", "this is infinite",
                          "a comma is outside of a function call", "unknown name 'GPa' at character 3",
                          'pressure="X">: expected a number, written like 1.5e-3, or an expression in x, y, z, t; X is not available here'):
                self.assertEqual(outcome.err.count(piece), 1, f"{piece}\n{outcome}")

    def test_rigid_bodies_move_alike(self):
        rigid = _mpm.material("rigid", 1.0, 'type="Rigid"')
        grid, solution = _mpm.grid((0, 0, 0), (16, 8, 8)), _mpm.solution(0.5, more="").replace(
            '<TimeStep factor="0.5"/>', '<TimeStep specified="0.01"/>')
        free = body("stone", (2, 2, 2), (2, 2, 2), '<BodyForce bx="4*t"/>', of="rigid")
        summary, _ = self.found(_mpm.scene([free], grid, solution, [rigid]), "free")
        self.assertLess(abs(summary["momentum"][0] - 8 * 4 * 0.5**2 / 2), 1e-12)
        bent = body("stone", (2, 2, 2), (2, 2, 2), '<InitialVelocity vx="x" vy="0" vz="0"/><BodyForce bx="y*t"/>', of="rigid")
        outcome = _mpm.run([self.write(_mpm.scene([bent], grid, solution, [rigid]))], program="mpm_check")
        self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
        self.assertEqual(len(re.findall("a rigid body moves as a whole: expected a number", outcome.err)), 2, outcome)


_mpm.main()
