"""Implicit steps: equilibrium and dynamics against exact solutions, on any ranks, and through a restart."""

import math
import re

import h5py
import numpy as np

import _cases
import _mpm
from _implicit import POISSON, RAM, SOFT, YOUNG, column, implicit, residuals

SHAPES = ("linear", "uGIMP", "cpGIMP", "CPDI", "CPDI2", "QuadraticBSpline", "CubicBSpline", "SGMP", "DDMP")
# What the laws with a tangent need, and the strain of the whole load under which each shows the order of Newton's method.
METAL = 'Young="200e3" Poisson="0.3"'
JOHNSON_COOK = METAL + ' Yield0="90" B="292" n="0.31" C="0.025" epso="1"'
LAWS = {
    "IsoElastic": (METAL, 0.2), "CauchyElastic": (METAL, 0.2),
    "NeoHookean": ('Young="1000" Poisson="0.3"', 0.2), "Corotated": ('Young="1000" Poisson="0.3"', 0.2),
    "MooneyRivlin": ('Mr_A2="200" Mr_B2="50" Poisson="0.45"', 0.2),
    "ElaPlastic": (METAL + ' Yield0="200"', 0.01), "IsoHarden": (METAL + ' Yield0="200" TangMod="3000"', 0.01),
    "Voce": (METAL + ' Yield0="200" Q="120" b="100" H="1000"', 0.01),
    "SimJohnsonCook": (JOHNSON_COOK, 0.01),
    "JohnsonCook": (JOHNSON_COOK + ' m="1.09" melt="1356" roomt="293" SpecHeat="383e6"', 0.01),
    "DruckerPrager": ('Young="70" Poisson="0.3" qfai="0.4" kfai="0.2" qpsi="0.1" ten_f="0.1"', 0.01),
}


def energy_of(stretch):
    """Strain energy per initial volume of the neo-Hookean column in uniaxial strain."""
    shear, lame = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    log = math.log(stretch)
    return 0.5 * shear * (stretch**2 - 1) - shear * log + 0.5 * lame * log**2


def alpha(radius):
    return f'rule="generalised_alpha" spectral_radius="{radius}"'


def energy_left(radius, angle, steps):
    """Part of an oscillator's energy that Chung and Hulbert's rule leaves after steps of this angle, begun at its largest
    velocity; in units of the step."""
    am, af = (2 * radius - 1) / (radius + 1), radius / (radius + 1)
    gamma, beta, square = 0.5 - am + af, 0.25 * (1 - am + af) ** 2, angle**2
    u, v, a = 0.0, 1.0, 0.0
    for _ in range(steps):
        ahead = u + v + (0.5 - beta) * a
        now = -(am * a + square * ((1 - af) * ahead + af * u)) / (1 - am + square * (1 - af) * beta)
        u, v, a = ahead + beta * now, v + (1 - gamma) * a + gamma * now, now
    return square * u**2 + v**2


@_mpm.needs_implicit_steps
class Implicit(_mpm.Case):
    def test_uniform_compression_is_exact(self):
        """Wherever the ram's face is in a cell, while no particle changes its own; with linear functions, whose particles feel one
        gradient in a cell, the ram holds the node beyond its face: a strain that is too small by the part of a cell, of 8, between."""
        travel = 0.2
        for shape in SHAPES:
            with self.subTest(shape=shape):
                self.run_in(shape, [self.write(column(shape, travel, 4))])
                energy = _mpm.summary(self.folder / shape)["energy"]
                exact = 32 * energy_of(1 - travel / 8)
                kinetic = 0.5 * 4 * travel**2
                self.assertAlmostEqual(energy["kinetic"], kinetic, delta=1e-9)
                self.assertLess(abs(energy["internal"] / exact - 1), 0.02 if shape == "linear" else 0.01)
                # The ram does the work that the column stores.
                self.assertLess(abs(energy["relative_drift"]), 1e-5 if shape == "linear" else 0.005)

    def test_newton_converges_quadratically_with_every_law(self):
        """A cube that a platen presses, and shears half as much, from a fixed face, in two steps: of three residuals that
        follow each other above round-off, the exponent by which they fall (2: quadratic), the largest. Measured 1.8 to 4.3."""
        for law, (parameters, strain) in LAWS.items():
            with self.subTest(law=law):
                ram = _mpm.block("ram", (1, 1, 4), (6, 6, 2), of="ram",
                                 more=f'<PrescribedVelocity vx="{2 * strain}" vy="0" vz="{-4 * strain}"/>')
                text = _mpm.scene([_mpm.block("cube", (2, 2, 0), (4, 4, 4)), ram],
                                  _mpm.grid((0, 0, 0), (8, 8, 8), "000010").replace("<Grid>", '<Grid shape="QuadraticBSpline">'),
                                  implicit(1.0, step=0.5, more='rtol="1e-12"'),
                                  [_mpm.material("soft", 8.93e-9, f'type="{law}" {parameters}'), RAM])
                self.run_in(law, [self.write(text)])
                steps = residuals(self.folder / law)
                self.assertEqual(len(steps), 2, steps)
                orders = []
                for norms in steps:
                    self.assertLessEqual(len(norms), 10, norms)
                    # The first holds the linear answer to the whole way of the ram.
                    above = [n for n in norms[1:] if n > 5e-14]
                    orders += [math.log(c / b) / math.log(b / a) for a, b, c in zip(above, above[1:], above[2:]) if a > b > c]
                print(f"{law}: order {max(orders):.2f}, {len(steps[0]) - 1} and {len(steps[1]) - 1} iterations")
                self.assertGreater(max(orders), 1.75, steps)

    def test_ranks_threads_and_restart_agree_to_the_tolerance(self):
        whole = column("QuadraticBSpline", 1.0, 8, more='rtol="1e-9"',
                       output='<PostProcessing time_interval="1" h5part="1" var="pres"/><Restart time_interval="0.5"/>')
        results = {}
        for ranks, threads in ((1, 1), (1, 2), (2, 1), (3, 1)):
            folder = f"{ranks}x{threads}"
            self.run_in(folder, [self.write(whole)], ranks=ranks, threads=threads)
            results[folder] = self.state_of(folder)
        self.assertIn("not the same bits", (self.folder / "1x1" / "case.out").read_text())
        restart = _mpm.restarts(self.folder / "1x1")[0]
        self.run_in("again", [restart], ranks=2)
        results["again"] = self.state_of("again")
        for name, (place, pressure) in results.items():
            with self.subTest(run=name):
                self.assertLess(np.abs(place - results["1x1"][0]).max(), 1e-6)  # a bit of the file's single precision is 5e-7
                self.assertLess(np.abs(pressure - results["1x1"][1]).max(), 1e-4 * np.abs(pressure).max())

    def state_of(self, folder):
        states = _cases.States(self.folder / folder)
        return np.array([states.column(axis) for axis in "xyz"]), states.column("pres")

    def test_free_flight_is_exact(self):
        """A body that flies obliquely keeps its velocity and stays without stress, with steps of a tenth of a cell."""
        body = _mpm.block("body", (2, 2, 2), (3, 3, 3), (1.0, 0.5, 0.25))
        for shape in ("linear", "QuadraticBSpline"):
            with self.subTest(shape=shape):
                text = _mpm.scene([body], _mpm.grid((0, 0, 0), (12, 10, 8)).replace("<Grid>", f'<Grid shape="{shape}">'),
                                  implicit(2.0, "dynamic", 0.1), [SOFT])
                self.run_in(shape, [self.write(text)])
                found = _mpm.summary(self.folder / shape)
                np.testing.assert_allclose(found["bodies"][0]["velocity"], (1.0, 0.5, 0.25), atol=1e-9)
                np.testing.assert_allclose(found["bodies"][0]["centre"], (5.5, 4.5, 4.0), atol=1e-8)
                self.assertLess(abs(found["energy"]["internal"]), 1e-12)

    def test_long_steps_keep_the_energy(self):
        """A bar between smooth walls that swings in its first mode, five periods: steps of a third of the explicit limit
        and of three times it. The rule itself keeps the energy; the particles' velocities lose a little in each step,
        in proportion to the square of its increment."""
        swing = _mpm.block("bar", (0, 0, 0), (16, 1, 1),
                           more='<BodyForce bx="t &lt; 0.4 ? 20*sin(_pi*X/16) : 0" by="0" bz="0"/>')
        drifts = {}
        for rule, steps in (("", 40), ("", 400), ('rule="backward_euler"', 40)):
            text = _mpm.scene([swing], _mpm.grid((0, 0, 0), (16, 1, 1), "222222").replace(
                "<Grid>", '<Grid shape="QuadraticBSpline">'), implicit(4.0, "dynamic", 4.0 / steps, rule), [SOFT])
            folder = f"{steps}{bool(rule)}"
            self.run_in(folder, [self.write(text)])
            drifts[steps, rule] = _mpm.summary(self.folder / folder)["energy"]
        for (steps, rule), energy in drifts.items():
            with self.subTest(steps=steps, rule=rule):
                left = (energy["kinetic"] + energy["internal"]) / energy["external_work"]
                if rule:
                    self.assertLess(left, 0.5)
                else:
                    self.assertLess(abs(left - 1), 0.15 if steps == 40 else 0.08)

    def test_dynamic_relaxation_slows_a_flight(self):
        """A free body, dv/dt = -c v: what a step leaves of the velocity is (2 - c dt)/(2 + c dt) by the trapezoidal rule,
        1/(1 + c dt) by backward Euler; generalised alpha follows exp(-c t) with second order. Its energy is the work of the
        damping, which is not lost from the balance."""
        damping, end = 1.5, 1.0

        def left(rule, steps, kind="dynamic", shape="QuadraticBSpline"):
            body = _mpm.block("body", (2, 2, 2), (3, 3, 3), (1.0, 0.5, 0.25))
            text = _mpm.scene([body], _mpm.grid((0, 0, 0), (12, 10, 8)).replace("<Grid>", f'<Grid shape="{shape}">'),
                              implicit(end, kind, end / steps, rule + ' rtol="1e-10"', f'<DynamicRelax damping="{damping}"/>'), [SOFT])
            self.run_in("flight", [self.write(text)])
            found = _mpm.summary(self.folder / "flight")
            self.assertLess(abs(found["energy"]["relative_drift"]), 0.02, (rule, steps))
            self.assertLess(abs(found["energy"]["internal"]), 1e-12)
            velocity = np.array(found["bodies"][0]["velocity"])
            np.testing.assert_allclose(velocity[1:] / velocity[0], (0.5, 0.25), atol=1e-9)
            return velocity[0]

        for steps in (10, 20):
            dt = damping * end / steps
            with self.subTest(steps=steps):
                for shape in ("linear", "QuadraticBSpline"):
                    self.assertAlmostEqual(left("", steps, shape=shape), ((2 - dt) / (2 + dt))**steps, delta=1e-9)
                # Nodes with hardly any mass are led to free motion with 1e-10 of the material's stiffness.
                self.assertAlmostEqual(left('rule="backward_euler"', steps), (1 + dt)**-steps, delta=1e-8)
        for radius in (0.8, 0.5):
            with self.subTest(radius=radius):
                errors = [abs(left(alpha(radius), n) - math.exp(-damping * end)) for n in (10, 20)]
                self.assertGreater(math.log2(errors[0] / errors[1]), 1.75, errors)

    def test_dynamic_relaxation_comes_to_rest(self):
        """A block falls on its support in steps of twenty explicit ones, damped critically in its first mode: the rest is
        that of equilibrium, and without damping there is none. FLIP keeps velocities that no node sees."""
        critical = '<DynamicRelax damping="25"/>'
        rest, _ = self.fall("static", "quasistatic", step=5.0)
        for kind in ("dynamic", "semi"):
            with self.subTest(kind):
                fallen, _ = self.fall("damped", kind, step=0.2, end=8.0, extra=critical)
                energy = _mpm.summary(self.folder / "damped")["energy"]
                self.assertLess(np.abs(fallen - rest).max(), 2e-3)
                self.assertLess(energy["kinetic"], 1e-6 * energy["external_work"])
        self.fall("free", "dynamic", step=0.2, end=8.0)
        energy = _mpm.summary(self.folder / "free")["energy"]
        self.assertGreater(energy["kinetic"] + energy["internal"], 1.05 * _mpm.summary(self.folder / "static")["energy"]["internal"])

    def wave(self, folder, rule, steps, end, ratio=1.0, shape="QuadraticBSpline", kind="dynamic"):
        """A bar of 16 cells between symmetry planes whose first mode, a standing wave, begins with its largest velocity;
        `steps` in a length of `ratio` periods, up to `end` periods. Velocities, and the part of the energy that is left."""
        length, wave = 16.0, math.sqrt(YOUNG)
        period = 2 * length / wave
        bar = _mpm.block("bar", (0, 0, 0), (16, 1, 1), (f"{1e-3 * wave!r}*sin({math.pi / length!r}*X)", 0, 0))
        material = _mpm.material("soft", 1.0, f'type="NeoHookean" Young="{YOUNG}" Poisson="0" bq1="0" bq2="0"')
        text = _mpm.scene([bar], _mpm.grid((0, 0, 0), (16, 1, 1), "222222").replace("<Grid>", f'<Grid shape="{shape}">'),
                          implicit(end * period, kind, ratio * period / steps, rule), [material],
                          f'<PostProcessing time_interval="{end * period!r}" h5part="1" var="velocity_0"/>'
                          f'<Restart time_interval="{0.5 * end * period!r}"/>')
        self.run_in(folder, [self.write(text)])
        energy = _mpm.summary(self.folder / folder)["energy"]
        return self.velocities(folder), energy["total"] / energy["initial_total"]

    def velocities(self, folder):
        """Over the amplitude of wave()."""
        return _cases.States(self.folder / folder).column("velocity_0") / (1e-3 * math.sqrt(YOUNG))

    def test_generalised_alpha_is_of_second_order(self):
        """Velocities after 1.1 periods. FLIP's own error, of first order with a small factor, lowers the order a little:
        it is the trapezoidal rule's."""
        exact, _ = self.wave("fine", "", 2560, 1.1)
        errors = {}
        for rule in ("", alpha(1), alpha(0.8), alpha(0.5)):
            errors[rule] = [np.abs(self.wave("coarse", rule, n, 1.1)[0] - exact).max() for n in (40, 80)]
            with self.subTest(rule=rule):
                self.assertGreater(math.log2(errors[rule][0] / errors[rule][1]), 1.75, errors)
        self.assertEqual(errors[""], errors[alpha(1)])

    def test_generalised_alpha_damps_as_its_radius_says(self):
        """Steps of ten periods, against the rule's own oscillator: what a step leaves of the amplitude, over what a step by the
        trapezoidal rule leaves, which is FLIP's loss between grid and particles. That loss is not quite the same with both."""
        for steps in (5, 10):
            whole = self.wave("whole", "", 1, 10.0 * steps, 10.0)[1]
            for radius in (0.9, 0.8):
                with self.subTest(steps=steps, radius=radius):
                    left = self.wave("damped", alpha(radius), 1, 10.0 * steps, 10.0)[1]
                    ratio = left / whole / energy_left(radius, 20 * math.pi, steps)
                    self.assertAlmostEqual(ratio ** (0.5 / steps), 1, delta=0.02)

    def test_generalised_alpha_continues_from_a_restart(self):
        """Particles keep what the rule carries; a run that took the trapezoidal rule can go on with generalised alpha."""
        whole = self.wave("whole", alpha(0.5), 40, 1.1)[0]
        self.run_in("again", [_mpm.restarts(self.folder / "whole")[0]], ranks=2)
        self.assertLess(np.abs(self.velocities("again") - whole).max(), 1e-5)
        self.wave("trapezoidal", "", 40, 1.1)
        path = self.folder / "case.xmp"
        path.write_text(path.read_text().replace("<Implicit", f"<Implicit {alpha(0.5)}"))
        outcome = self.run_in("changed", [_mpm.restarts(self.folder / "trapezoidal")[0], "-rt", path])
        self.assertIn("acceleration_lag_x", outcome.out)

    def test_semi_implicit_steps_are_backward_euler_of_small_strains(self):
        """One linear system per step, here of steps up to 2.5 explicit ones; strains are 1e-3."""
        exact, _ = self.wave("fine", "", 320, 1.1)
        errors = []
        for steps in (20, 40, 80):
            semi, _ = self.wave("semi", "", steps, 1.1, kind="semi")
            full, _ = self.wave("full", 'rule="backward_euler"', steps, 1.1)
            self.assertLess(np.abs(semi - full).max(), 2e-3)
            errors.append(np.abs(semi - exact).max())
        orders = [math.log2(a / b) for a, b in zip(errors, errors[1:])]
        print(f"semi-implicit wave: errors {errors}, orders {orders}")
        self.assertGreater(orders[-1], 0.75)
        self.assertRegex((self.folder / "semi" / "case.out").read_text(), "PETSc .*: cg with pbjacobi; .* linear ones")

    def fall(self, folder, kind, shape="linear", step=0.5, end=40.0, more="", ranks=1, threads=1, material=SOFT, gravity=12,
             extra=""):
        """A block of four cells' edge between smooth walls comes to rest under its weight, which would shorten it by 2.4 %."""
        block = _mpm.block("block", (0, 0, 0), (4, 4, 4))
        text = _mpm.scene([block], _mpm.grid((0, 0, 0), (5, 5, 6), "202022").replace("<Grid>", f'<Grid shape="{shape}">'),
                          implicit(end, kind, step, more, f'<Gravity ax="0" ay="0" az="{-gravity}"/>{extra}'), [material],
                          f'<PostProcessing time_interval="{end}" h5part="1" var="pres"/><Restart time_interval="{end / 2}"/>')
        outcome = self.run_in(folder, [self.write(text)], ranks=ranks, threads=threads)
        return self.state_of(folder)[0], outcome

    def test_semi_implicit_steps_are_linearised_off_the_yield_surface(self):
        """On it round-off would choose between the elastic and the plastic stiffness: a weight changed by 1e-14 changed results by 3 %."""
        for law in ('type="IsoHarden" Young="1e6" Poisson="0.3" Yield0="2e4" TangMod="1e5"',
                    'type="DruckerPrager" Young="1e6" Poisson="0.3" qfai="0.3" kfai="1e4" qpsi="0" ten_f="1e4"'):
            with self.subTest(law=law):
                energies = []
                for weight in ("-9.81", "-9.8100000000001"):
                    more = f'<Gravity ax="0" ay="0" az="{weight}"/><Implicit type="semi" time_step="0.05" min_step="0.05"/>'
                    solution = _mpm.solution(0.4, attributes='Integration="impl"', more=more).replace('<TimeStep factor="0.5"/>', "")
                    text = _mpm.scene([_mpm.block("column", (1, 1, 0), (2, 2, 6))], _mpm.grid((-2, -2, 0), (8, 8, 12), "000010"), solution,
                                      [_mpm.material("soft", 1000, law)])
                    self.run_in("yields", [self.write(text)])
                    energies.append(_mpm.summary(self.folder / "yields")["energy"]["kinetic"])
                self.assertAlmostEqual(energies[0] / energies[1], 1, delta=1e-9)

    def test_quasistatic_particles_begin_at_rest(self):
        """Whatever InitialVelocity says; and energies of short implicit runs are judged: dynamic steps far longer than the period."""
        for kind, drifts in (("quasistatic", False), ("dynamic", True)):
            with self.subTest(kind=kind):
                more = f'<Gravity ax="0" ay="0" az="-1"/><Implicit type="{kind}" time_step="0.5"/>'
                solution = _mpm.solution(1.0, attributes='Integration="impl"', more=more).replace('<TimeStep factor="0.5"/>', "")
                text = _mpm.scene([_mpm.block("block", (0, 0, 0), (2, 2, 2), (0, 0, -3 if kind == "quasistatic" else 0))],
                                  _mpm.grid((0, 0, 0), (2, 2, 6), "222220"), solution, [_mpm.material("soft", 1000, 'type="IsoElastic" Young="1e6" Poisson="0.3"')])
                outcome = self.run_in(kind, [self.write(text)])
                self.assertEqual("error of the energy balance" in outcome.out + outcome.err, drifts)
                if kind == "quasistatic":
                    self.assertEqual(_cases.status(self.folder / kind)["kinetic"][0], 0)

    def test_semi_implicit_steps_come_to_the_same_rest(self):
        """Steps of twenty explicit ones; backward Euler damps. What is linearised has no part in the state of rest."""
        for shape in ("linear", "QuadraticBSpline"):
            with self.subTest(shape=shape):
                rest, _ = self.fall("static", "quasistatic", shape, 5.0)
                fallen, _ = self.fall("semi", "semi", shape)
                print(f"semi-implicit rest {shape}: {np.abs(fallen - rest).max():.1e}")
                self.assertLess(np.abs(fallen - rest).max(), 2e-3)
                # Over the work of the weight; FLIP keeps velocities that no node sees.
                energy = _mpm.summary(self.folder / "semi")["energy"]
                self.assertLess(energy["kinetic"], 1e-6 * energy["external_work"])

    def test_semi_implicit_steps_on_ranks_and_from_a_restart(self):
        first, _ = self.fall("1x1", "semi", end=4.0, more='rtol="1e-11"')
        for ranks, threads in ((1, 2), (2, 1), (3, 1)):
            with self.subTest(ranks=ranks, threads=threads):
                again, _ = self.fall(f"{ranks}x{threads}", "semi", end=4.0, more='rtol="1e-11"', ranks=ranks, threads=threads)
                self.assertLess(np.abs(again - first).max(), 1e-7)
        self.run_in("again", [_mpm.restarts(self.folder / "1x1")[0]], ranks=2)
        self.assertLess(np.abs(self.state_of("again")[0] - first).max(), 1e-7)

    def test_semi_implicit_steps_with_plastic_flow(self):
        """The elastic stiffness at the start of a step delays the flow, with first order; also where it is not associated. Errors
        over the block's height, from full backward Euler steps."""
        soil = _mpm.material("soft", 1.0, 'type="DruckerPrager" Young="1000" Poisson="0.3" qfai="0.3" kfai="4" qpsi="0" ten_f="1"')
        metal = _mpm.material("soft", 1.0, 'type="IsoHarden" Young="1000" Poisson="0.3" Yield0="10" TangMod="50"')
        for name, material in (("soil", soil), ("metal", metal)):
            with self.subTest(name):
                found = [self.fall(name, kind, "QuadraticBSpline", step=step, end=0.6, more=more, material=material, gravity=4)[0]
                         for kind, step, more in (("dynamic", 0.02, 'rule="backward_euler"'), ("semi", 0.04, ""), ("semi", 0.01, ""))]
                errors = [np.abs(place - found[0]).max() / np.ptp(found[0][2]) for place in found[1:]]
                print(f"semi-implicit {name}: errors {errors}")
                self.assertLess(errors[1], 0.5 * errors[0])
                self.assertLess(errors[1], 0.04)

    def test_only_what_carries_a_lag_pays_for_it(self):
        for rule, columns in (("", 0), (alpha(1), 0), (alpha(0.9), 1)):
            with self.subTest(rule=rule):
                scene = self.write(column(more=rule).replace("quasistatic", "dynamic"))
                outcome = _mpm.run([scene, "--output-dir", self.folder, "--dry-run"])
                self.assertEqual(outcome.out.count("acceleration_lag_x"), columns, outcome)  # the ram's have none

    def test_no_explicit_step_bounds_how_long_a_run_may_last(self):
        """Slow creep to rest, in units in which an explicit run would need more than 2^63 steps."""
        soft, end = _mpm.material("soft", 1.0, 'type="NeoHookean" Young="1000" Poisson="0"'), 1e18
        body = _mpm.block("soft", (0, 0, 0), (2, 2, 4), of="soft")
        scene = _mpm.scene([body], _mpm.grid((0, 0, 0), (2, 2, 6), "222220"),
                           implicit(end, step=end / 2, more='gravity_ramp="1"', extra='<Gravity ax="0" ay="0" az="-1"/>'), [soft])
        self.run_in("out", [self.write(scene)])
        summary = _mpm.summary(self.folder / "out")
        self.assertEqual((summary["time"], summary["steps"]), (end, 2))

    def test_a_platen_travels_as_far_in_one_step_as_in_many(self):
        """Its velocity is an expression of t: steps take the mean, of which Gauss's rule has cubic ones exactly."""
        soft = _mpm.material("soft", 1.0, 'type="NeoHookean" Young="1000" Poisson="0.3"')
        ram = _mpm.material("ram", 1.0, 'type="Rigid"')
        grid = _mpm.grid((0, 0, 0), (2, 2, 6), "222220")
        for speed, kind, travel in (("-0.5*t", "quasistatic", 0.25), ("-t^3", "quasistatic", 0.25), ("-0.5*t", "dynamic", 0.25)):
            for steps in (1, 4):
                with self.subTest(speed=speed, kind=kind, steps=steps):
                    bodies = [_mpm.block("soft", (0, 0, 0), (2, 2, 4), of="soft"),
                              _mpm.block("ram", (0, 0, 4), (2, 2, 1), of="ram",
                                         more=f'<PrescribedVelocity vx="0" vy="0" vz="{speed}"/>')]
                    solution = ('<Solution Integration="impl"><EndTime value="1"/>'
                                f'<Implicit type="{kind}" time_step="{1 / steps}"/></Solution>')
                    output = '<PostProcessing time_interval="1" h5part="1" var="body"/>'
                    self.run_in("out", [self.write(_mpm.scene(bodies, grid, solution, [soft, ram], output))])
                    with h5py.File(self.folder / "out/case.h5part") as file:
                        now = _mpm.pictures(file)[-1]
                        top = np.max(now["z"][:])
                    self.assertAlmostEqual(top, 4.75 - travel, delta=1e-12)


@_mpm.needs_implicit_steps
class Refused(_mpm.Case):
    def refused(self, text, *words):
        outcome = self.run_in("refused", [self.write(text)], code=_mpm.INPUT_ERROR)
        for word in words:
            self.assertIn(word, outcome.err)

    def test_what_implicit_steps_cannot_do(self):
        scene = column()
        self.refused(scene.replace('Integration="impl"', 'Integration="impl" transfer="APIC"').replace(
            "<Grid shape=\"linear\">", '<Grid shape="QuadraticBSpline">'), "transfer", "FLIP")
        for scheme in ("USF", "USL"):
            self.refused(scene.replace('algorithm="MUSL"', f'algorithm="{scheme}"'), "case.xmp:", f'algorithm="{scheme}"',
                         "implicit steps", "remove it")
        self.refused(scene.replace("<Implicit", '<LimitVelocity max="1"/><Implicit'), "LimitVelocity")
        self.refused(scene.replace("<Implicit", '<Volume erode="0.1"/><Implicit'), "erode")
        self.refused(scene.replace('boundary="0"', 'boundary="3"', 1), "non-reflecting")
        self.refused(scene.replace('<PrescribedVelocity vx="0" vy="0" vz="-1.0"/>', ""), "ram", "no prescribed motion")
        failing = _mpm.material("soft", 1.0, 'type="ElaPlastic" Young="1000" Poisson="0.3" Yield0="20"',
                                '<FailureModel type="PlaStrain" epmax="0.3"/>')
        self.refused(column(material=failing), "soft", "not available with implicit steps", "FailureModel")
        eroding = failing.replace("epmax=", 'Erosion="1" epmax=')
        crushed = _mpm.material("soft", 1.0, 'type="HolmquistJohnsonCook" Young="1000" Poisson="0.3" A="1" B="2" N="0.6" C="0.01" '
                                'fc="48" SMax="7" D1="0.04" D2="1" EFMin="0.01" T="4" epso="1" {}="1"')
        for more in ("", 'jacobian="differences"'):
            self.refused(column(material=eroding, more=more), "case.xmp:3:", "Erosion", "not deleted in implicit steps", "set it to 0")
            for attribute in ("ErosionByDamage", "ErosionByPressure"):
                self.refused(column(material=crushed.format(attribute), more=more), attribute, "not deleted in implicit steps")
        fluid = _mpm.material("soft", 1.0, 'type="Null"', '<EquationOfState type="Gruneisen" C0="37" S1="1.5" gamma0="2" E0="0"/>')
        explosive = _mpm.material("soft", 1.0, 'type="HighExpBurn" D="100" beta="0" PCJ="2000"',
                                  '<EquationOfState type="JWL" A="371e3" B="3200" R1="4.2" R2="0.95" w="0.3" E0="7000"/>')
        for more in ("", 'jacobian="differences"'):
            self.refused(column(material=fluid, more=more), "case.xmp:6:", "'soft'", "stiffness in shear", "dynamic")
            self.refused(column(material=explosive, more=more), "case.xmp:6:", "'soft'", "explosives", "remove Solution@Integration")
        warm = _mpm.material("soft", 1.0, 'type="IsoHarden" Young="1000" Poisson="0.3" Yield0="20" TangMod="100" '
                             'SpecHeat="1" CoefficientOfThermalConductivity="0.1"')
        for more in ("", 'jacobian="differences"'):
            self.refused(column(material=warm, more=more), "case.xmp:6:", "'soft'", "heat is conducted in explicit steps alone")
            self.assertNotIn("differences", _mpm.run([self.folder / "case.xmp"], program="mpm_check").err)
        self.refused(column(more='newmark_beta="0.1"').replace("quasistatic", "dynamic"), "newmark_beta")
        self.refused(column(more='min_step="1"'), "time_step")


if __name__ == "__main__":
    _mpm.main()
