"""Conduction between two half-slabs of different temperature, against the exact solution."""

import math

import _cases
import _mpm
import numpy as np

HOT, COLD = 400.0, 300.0
CONDUCTIVITY, SPECIFIC_HEAT = 3.0, 2.0  # density 1
DIFFUSIVITY = CONDUCTIVITY / SPECIFIC_HEAT
LENGTH = 24.0


class Heat(_mpm.Case):
    def slabs(self, cells, end, folder, dp=2, ranks=1, algorithm="MUSL"):
        """Two halves of a bar of unit cross section between symmetry planes, at rest, `dp` particles along a cell."""
        cell = LENGTH / cells
        materials = [_mpm.material(name, strength=f'type="IsoElastic" Young="0.5" Poisson="0" SpecHeat="{SPECIFIC_HEAT}" '
                                   f'CoefficientOfThermalConductivity="{CONDUCTIVITY}" roomt="{temperature}"')
                     for name, temperature in (("hot", HOT), ("cold", COLD))]
        half = (LENGTH / 2, cell, cell)
        bodies = [_mpm.block("left", (0, 0, 0), half, dp=cell / dp, of="hot"),
                  _mpm.block("right", (LENGTH / 2, 0, 0), half, dp=cell / dp, of="cold")]
        text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), (LENGTH, cell, cell), "222222", cell),
                          _mpm.solution(end, algorithm, 0.9), materials,
                          output=f'<Console print_time="{end / 5}"/><PostProcessing time_interval="{end}" h5part="1" var="kelv|engi"/>')
        outcome = self.run_in(folder, [self.write(text)], ranks=ranks)
        return outcome, _cases.States(self.folder / folder)

    def exact(self, x, time):
        reach = 2 * math.sqrt(DIFFUSIVITY * time)
        return (HOT + COLD) / 2 - (HOT - COLD) / 2 * np.array([math.erf((s - LENGTH / 2) / reach) for s in x])

    def test_half_slabs(self):
        end = 2.0  # 12 is 3.5 times 2 sqrt(a t): the ends know nothing of it
        for algorithm in ("MUSL", "USF", "USL"):
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

    def test_the_step_obeys_diffusion(self):
        _, states = self.slabs(48, 1.0, "step")
        step = (LENGTH / 48) ** 2 / (6 * DIFFUSIVITY)  # shorter than that of sound, 0.5 / 0.7
        steps = _mpm.summary(self.folder / "step")["steps"]
        self.assertAlmostEqual(steps * 0.9 * step, 1.0, delta=0.05)
        self.assertLess(states.column("kelv").max(), HOT * (1 + 1e-6))  # and oscillates nowhere
        self.assertGreater(states.column("kelv").min(), COLD * (1 - 1e-6))

    def test_the_same_on_any_ranks(self):
        self.assertEqual(len({self.slabs(24, 1.0, f"ranks{n}", ranks=n)[0].state for n in (1, 2, 3)}), 1)

    def test_conduction_needs_a_heat_capacity(self):
        text = _mpm.scene([_mpm.block("b", (1, 1, 1), (2, 2, 2))], _mpm.grid((0, 0, 0), (4, 4, 4)), _mpm.solution(1),
                          [_mpm.material(strength='type="IsoElastic" Young="1" Poisson="0" CoefficientOfThermalConductivity="1"')])
        outcome = self.run_in("bad", [self.write(text)], code=_mpm.INPUT_ERROR)
        self.assertIn("CoefficientOfThermalConductivity needs SpecHeat", outcome.err)


_mpm.main()
