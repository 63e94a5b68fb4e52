"""Conduction between two half-slabs of different temperature, of one or two materials, against the exact solution."""

import math
import re

import _cases
import _mpm
import numpy as np

HOT, COLD, ROOM = 400.0, 300.0, 320.0
CONDUCTIVITY, SPECIFIC_HEAT = 3.0, 2.0  # density 1
DIFFUSIVITY = CONDUCTIVITY / SPECIFIC_HEAT
LENGTH = 24.0
# Two materials, (conductivity, specific heat) of the hot and the cold one.
PAIRS = {"conductivities": ((3.0, 2.0), (0.03, 2.0)), "capacities": ((3.0, 2.0), (3.0, 20.0))}
# Share of the jump by which a particle next to it passes the first temperatures for some steps. The term that smooths the
# jump is of fourth order in the wave number, without a maximum principle: one material alone overshoots by 0.7 to 2.9 %.
OVERSHOOT = {"linear": 0.014, "SGMP": 0.046, "DDMP": 0.075, "uGIMP": 0.014, "cpGIMP": 0.014, "CPDI": 0.014, "CPDI2": 0.014,
             "QuadraticBSpline": 0.028, "CubicBSpline": 0.028}


class Heat(_mpm.Case):
    def slabs(self, cells, end, folder, dp=2, ranks=1, algorithm="MUSL", shape="linear", faces="222222", pictures=1,
              pair=((CONDUCTIVITY, SPECIFIC_HEAT), (CONDUCTIVITY, SPECIFIC_HEAT))):
        """Two halves of a bar of unit cross section between symmetry planes, at rest, `dp` particles along a cell."""
        cell = LENGTH / cells
        materials = [_mpm.material(name, strength=f'type="IsoElastic" Young="0.5" Poisson="0" SpecHeat="{c}" '
                                   f'CoefficientOfThermalConductivity="{k}" roomt="{temperature}"')
                     for (name, temperature), (k, c) in zip((("hot", HOT), ("cold", COLD)), pair)]
        half = (LENGTH / 2, cell, cell)
        bodies = [_mpm.block("left", (0, 0, 0), half, dp=cell / dp, of="hot"),
                  _mpm.block("right", (LENGTH / 2, 0, 0), half, dp=cell / dp, of="cold")]
        grid = _mpm.grid((0, 0, 0), (LENGTH, cell, cell), faces, cell).replace("<Grid>", f'<Grid shape="{shape}">')
        text = _mpm.scene(bodies, grid, _mpm.solution(end, algorithm, 0.9), materials,
                          output=f'<Console print_time="{end / 5}"/>'
                          f'<PostProcessing time_interval="{end / pictures}" h5part="1" var="kelv|engi"/>')
        outcome = self.run_in(folder, [self.write(text)], ranks=ranks)
        return outcome, _cases.States(self.folder / folder)

    def exact(self, x, time, pair=((CONDUCTIVITY, SPECIFIC_HEAT), (CONDUCTIVITY, SPECIFIC_HEAT))):
        """Carslaw and Jaeger, 2.15: the temperatures meet in proportion to the effusivities sqrt(k rho c)."""
        hot, cold = (math.sqrt(k * c) for k, c in pair)
        middle = (hot * HOT + cold * COLD) / (hot + cold)
        temperature = []
        for distance in x - LENGTH / 2:
            side, (k, c) = (HOT, pair[0]) if distance < 0 else (COLD, pair[1])
            temperature.append(middle + (side - middle) * math.erf(abs(distance) / (2 * math.sqrt(k / c * time))))
        return np.array(temperature)

    def test_half_slabs(self):
        end = 2.0  # 12 is 3.5 times 2 sqrt(a t): the ends know nothing of it
        for algorithm in ("MUSL", "USF", "USL", "USAVG"):
            with self.subTest(algorithm=algorithm):
                errors = []
                for cells in (24, 48, 96):
                    _, states = self.slabs(cells, end, f"{algorithm}{cells}", algorithm=algorithm)
                    temperature = states.column("kelv")
                    errors.append(np.abs(temperature - self.exact(states.column("x"), end)).mean() / (HOT - COLD))
                    # All particles have the same capacity, and none of the heat is lost.
                    self.assertAlmostEqual(temperature.mean() / ((HOT + COLD) / 2), 1, delta=1e-6)  # written as floats
                    # Heat is internal energy: what the particles gained of one is what they gained of the other.
                    mass = (LENGTH / cells / 2) ** 3
                    rise = temperature - states.column("kelv", 0)
                    gained = states.column("engi") - states.column("engi", 0)
                    self.assertLess(np.abs(gained / (mass * SPECIFIC_HEAT) - rise).max(), 1e-3 * (HOT - COLD))
                self.assertLess(errors[-1], 2e-5)
                for observed in _cases.order([1 / 24, 1 / 48, 1 / 96], errors):
                    self.assertGreater(observed, 1.7)

    def test_two_materials_keep_their_heat(self):
        for name, pair in PAIRS.items():
            for shape, most in OVERSHOOT.items():
                faces = "222222" if name == "conductivities" else "041204"
                with self.subTest(pair=name, shape=shape):
                    _, states = self.slabs(24, 2.0, f"{name}{shape}", shape=shape, faces=faces, pictures=20, pair=pair)  # every step
                    # Internal energy is that of heating from the first temperatures: what one slab loses the other gains.
                    gained = states.column("engi")
                    passed = gained[states.column("x") > LENGTH / 2].sum()
                    self.assertGreater(passed, 1.0)
                    internal = _mpm.summary(self.folder / f"{name}{shape}")["energy"]["internal"]
                    self.assertLess(abs(internal), 1e-12 * passed)
                    every = [states.column("kelv", n) for n in range(len(states.times))]
                    over = max(np.max(every) - HOT, COLD - np.min(every)) / (HOT - COLD)
                    self.assertLess(over, most)

    def test_two_materials(self):
        """Of first order: the gradient jumps at the contact, where the nodes belong to both."""
        for name, pair in PAIRS.items():
            with self.subTest(pair=name):
                errors = []
                for cells in (24, 48, 96):
                    _, states = self.slabs(cells, 2.0, f"{name}{cells}", pair=pair)
                    exact = self.exact(states.column("x"), 2.0, pair)
                    errors.append(np.abs(states.column("kelv") - exact).mean() / (HOT - COLD))
                for observed in _cases.order([1 / 24, 1 / 48, 1 / 96], errors):
                    self.assertGreater(observed, 0.85)

    def test_the_step_obeys_diffusion(self):
        _, states = self.slabs(48, 1.0, "step")
        step = (LENGTH / 48) ** 2 / (6 * DIFFUSIVITY)  # shorter than that of sound, 0.5 / 0.7
        steps = _mpm.summary(self.folder / "step")["steps"]
        self.assertAlmostEqual(steps * 0.9 * step, 1.0, delta=0.05)
        self.assertLess(states.column("kelv").max(), HOT * (1 + 1e-6))  # and oscillates nowhere
        self.assertGreater(states.column("kelv").min(), COLD * (1 - 1e-6))

    def hot_and_cold(self, folder, ranks=1, more=""):
        """The slabs again, of one material whose room temperature is neither's."""
        law = (f'type="IsoElastic" Young="0.5" Poisson="0" SpecHeat="{SPECIFIC_HEAT}" '
               f'CoefficientOfThermalConductivity="{CONDUCTIVITY}" roomt="{ROOM}"')
        bodies = [_mpm.block(name, (x, 0, 0), (LENGTH / 2, 0.5, 0.5), dp=0.25,
                             more=f'<InitialTemperature value="{temperature}"/>')
                  for name, x, temperature in (("left", 0, HOT), ("right", LENGTH / 2, COLD))]
        text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), (LENGTH, 0.5, 0.5), "222222", 0.5), _mpm.solution(2.0, factor=0.9),
                          [_mpm.material(strength=law)],
                          output='<Console print_time="0.4"/><Restart time_interval="1"/>'
                          '<PostProcessing time_interval="2" h5part="1" var="kelv|engi"/>' + more)
        self.write(text)
        return self.run_in(folder, [self.folder / "case.xmp"], ranks=ranks), _cases.States(self.folder / folder)

    def test_steps_that_the_strain_shortens(self):
        """Heat is conducted for as long as the run lasts, also where the strain shortens the steps that conduction has taken."""
        law = _mpm.material("soft", strength='type="IsoElastic" Young="1000" Poisson="0.3" CoefficientOfThermalConductivity="20" SpecHeat="1"')
        bodies = [_mpm.block(name, (4, y, 4), (2, 1, 2), ("300*(x-5)", 0, 0), more=f'<InitialTemperature value="{kelvin}"/>')
                  for name, y, kelvin in (("hot", 4, 600), ("cold", 5, 300))]
        hottest, steps = [], []
        for step in ('factor="0.5"', 'specified="0.00002"'):
            text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), (10, 10, 10)), _mpm.solution(0.006).replace('factor="0.5"', step), [law])
            self.run_in("run", [self.write(text)])
            found = _mpm.summary(self.folder / "run")
            hottest.append(found["bodies"][0]["max_temperature"])
            steps.append(found["steps"])
        print(f"hottest after {steps} steps: {hottest}")
        self.assertLess(steps[0], steps[1])
        self.assertAlmostEqual(hottest[0], hottest[1], delta=0.1 * (600 - hottest[1]))

    def test_temperature_of_a_body(self):
        outcome, states = self.hot_and_cold("one")
        first = states.column("kelv", 0)
        self.assertEqual(set(first), {np.float32(HOT), np.float32(COLD)})
        temperature = states.column("kelv")
        self.assertLess(np.abs(temperature - self.exact(states.column("x"), 2.0)).mean() / (HOT - COLD), 2e-4)
        # The energy is that of heating from the room temperature, at the start and at any time.
        mass = 0.25**3
        for which in (0, -1):
            energy = states.column("engi", which) / (mass * SPECIFIC_HEAT)
            self.assertLess(np.abs(energy - (states.column("kelv", which) - ROOM)).max(), 1e-3 * (HOT - COLD))
        self.assertEqual(self.hot_and_cold("two", ranks=2)[0].state, outcome.state)
        again = self.run_in("two", [_mpm.restarts(self.folder / "two")[0]], ranks=1)
        self.assertEqual(again.state, outcome.state)

    def test_a_restart_keeps_its_temperatures(self):
        self.hot_and_cold("out")
        text = (self.folder / "case.xmp").read_text()
        restart = _mpm.restarts(self.folder / "out")[0]
        self.run_in("same", [restart, "-rt", self.write(text, "other.xmp")])
        self.write(text.replace(f'<InitialTemperature value="{HOT}"/>', '<InitialTemperature value="350"/>'), "other.xmp")
        outcome = self.run_in("bad", [restart, "-rt", self.folder / "other.xmp"], code=_mpm.INPUT_ERROR)
        self.assertRegex(outcome.err, r'other\.xmp:\d+: <Body name="left">: differs from the input of the restart file')

    def test_a_hot_body_is_softer(self):
        """Johnson-Cook: the yield stress at the start is that at the body's temperature, and so is the blow's end."""
        law = ('type="JohnsonCook" Young="1000" Poisson="0.3" Yield0="10" B="0" n="1" C="0" m="1" melt="1293" SpecHeat="1e3" '
               'epso="1" roomt="293"')
        yields = {}
        for temperature in (293, 793):
            body = _mpm.block("bar", (0, 1, 1), (4, 2, 2), (-3, 0, 0), more=f'<InitialTemperature value="{temperature}"/>')
            text = _mpm.scene([body], _mpm.grid((0, 0, 0), (8, 4, 4), "200000"), _mpm.solution(0.5), [_mpm.material(strength=law)],
                              output='<PostProcessing time_interval="0.5" h5part="1" var="sigy|epef|kelv"/>')
            self.run_in("jc", [self.write(text)])
            states = _cases.States(self.folder / "jc")
            yields[temperature] = states.column("sigy", 0), states.column("epef").max()
        np.testing.assert_allclose(yields[293][0], 10, rtol=1e-6)
        np.testing.assert_allclose(yields[793][0], 5, rtol=1e-6)
        self.assertGreater(yields[793][1], 1.2 * yields[293][1])

    def test_density_of_a_hot_body(self):
        """Heat presses where the equation of state knows of it; the log names a density with which it hardly does."""
        law = ('type="JohnsonCook" Young="117e3" Poisson="0.35" Yield0="90" B="292" n="0.31" C="0.025" epso="1" m="1.09" '
               'melt="1356" SpecHeat="383"')  # mm, g, ms
        more = '<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>'

        def start(attributes):
            body = _mpm.block("bar", (1, 1, 1), (2, 2, 2), more='<InitialTemperature value="600"/>', attributes=attributes)
            text = _mpm.scene([body], _mpm.grid((0, 0, 0), (4, 4, 4)), _mpm.solution(1e-5),
                              [_mpm.material(density="8.93e-3", strength=law, more=more)],
                              output='<PostProcessing time_interval="1e-5" h5part="1" var="pres"/>')
            self.run_in("hot", [self.write(text)])
            notes = re.findall(r"body 'bar' starts with the pressure (\S+), including thermal pressure; with density=\"(\S+)\"",
                               (self.folder / "hot/case.out").read_text())
            return _cases.States(self.folder / "hot").column("pres", 0), notes

        pressure, notes = start("")
        np.testing.assert_allclose(pressure, 1.96 * 8.93e-3 * 383 * (600 - 293), rtol=1e-6)
        self.assertEqual(len(notes), 1)
        relieved, _ = start(f'density="{notes[0][1]}"')
        self.assertLess(np.abs(relieved).max(), 0.05 * pressure.max())

    def test_only_what_carries_a_temperature_has_one(self):
        body = _mpm.block("b", (1, 1, 1), (2, 2, 2), more='<InitialTemperature value="400"/>')
        text = _mpm.scene([body], _mpm.grid((0, 0, 0), (4, 4, 4)), _mpm.solution(1))
        self.write(text)
        for program in ("mpm_run", "mpm_check"):
            outcome = _mpm.run([self.folder / "case.xmp"], program=program)
            self.assertEqual(outcome.code, _mpm.INPUT_ERROR)
            self.assertRegex(outcome.err, r"case\.xmp:\d+: <InitialTemperature>: material `soft` of body `b` has no "
                                          "temperature")

    def test_the_same_on_any_ranks(self):
        for pair in PAIRS.values():
            states = {self.slabs(24, 1.0, f"ranks{n}", ranks=n, pair=pair)[0].state for n in (1, 2, 3)}
            self.assertEqual(len(states), 1)

    def test_the_same_on_any_ranks_where_components_meet(self):
        # Nodes of the contact have a velocity field each; a block that flies into new bricks changes the bricks of one rank only.
        soft = _mpm.material(strength='type="IsoElastic" Young="1000" Poisson="0.3" SpecHeat="1" CoefficientOfThermalConductivity="5"')
        components = [[_mpm.block("lower", (1, 1, 1), (22, 2, 1), more='<InitialTemperature value="500"/>'),
                       _mpm.block("thrown", (21, 1, 5), (2, 2, 2), (0, 0, 15))],
                      [_mpm.block("upper", (1, 1, 2), (22, 2, 1)), _mpm.block("rests", (1, 1, 5), (2, 2, 2))]]
        text = _mpm.scene(['</Component><Component name="second">'.join("".join(bodies) for bodies in components)],
                          _mpm.grid((0, 0, 0), (24, 4, 40)), _mpm.solution(1.2, factor=0.9), [soft], more='<Contact enable="1"/>')
        states = {self.state(text, f"contact{n}", ranks=n) for n in (1, 2, 3)}
        self.assertEqual(len(states), 1)

    def test_conduction_needs_a_heat_capacity(self):
        text = _mpm.scene([_mpm.block("b", (1, 1, 1), (2, 2, 2))], _mpm.grid((0, 0, 0), (4, 4, 4)), _mpm.solution(1),
                          [_mpm.material(strength='type="IsoElastic" Young="1" Poisson="0" CoefficientOfThermalConductivity="1"')])
        outcome = self.run_in("bad", [self.write(text)], code=_mpm.INPUT_ERROR)
        self.assertIn("CoefficientOfThermalConductivity needs SpecHeat", outcome.err)


_mpm.main()
