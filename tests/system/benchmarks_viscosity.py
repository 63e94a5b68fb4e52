"""benchmarks/accuracy/viscosity.py: its exact solutions, and what the limiter of the viscosity does on coarse grids."""

import csv
import sys
import unittest

import _cases
import _mpm
import numpy as np

SCRIPT = "benchmarks/accuracy/viscosity.py"
sys.path[:0] = [str(_mpm.SOURCE / "benchmarks/accuracy"), str(_mpm.SOURCE / "benchmarks")]

import viscosity  # noqa: E402: found by the line above


class Solutions(unittest.TestCase):
    def test_wave(self):
        # Of the mass and energy of the start, and of second order.
        wave, isentrope = viscosity.Wave(25), viscosity.Isentrope()
        _, rho, nodes, v = wave.exact(300)
        mass = _cases.COPPER["density"] * wave.length / 300
        np.testing.assert_allclose(rho * np.diff(nodes), mass, rtol=1e-12)
        energy = isentrope.energy(rho).sum() + 0.5 * (v[1:-1] ** 2).sum()
        self.assertAlmostEqual(energy / 300 / (wave.speed**2 / 4), 1, delta=2e-3)
        quarter = [wave.exact(zones)[3][zones // 4] for zones in (60, 180, 540)]
        self.assertAlmostEqual((quarter[0] - quarter[1]) / (quarter[1] - quarter[2]), 9, delta=1.5)

    def test_isentrope(self):
        # At small compressions the energy is K mu^2/2 per volume; behind a shock it is below the Hugoniot's.
        isentrope, rho0 = viscosity.Isentrope(), _cases.COPPER["density"]
        stiffness = rho0 * _cases.COPPER["c0"] ** 2
        self.assertAlmostEqual(isentrope.energy(1.001 * rho0) * rho0 / (stiffness * 0.5e-6), 1, delta=0.01)
        exact = _cases.Shock(1000.0).exact()
        self.assertTrue(0.5 * exact["e"] < isentrope.energy(exact["rho"]) < exact["e"])


class Quick(_mpm.RunOnce):
    command = (SCRIPT, "--quick")

    def of(self, case, name):
        with open(self.out / "viscosity.csv") as file:
            return {r["viscosity"]: float(r[name]) for r in csv.DictReader(file) if r["case"] == case}

    def test_smooth_wave_is_hardly_damped(self):
        heat = self.of(viscosity.Wave.name, "heat")
        self.assertLess(heat["shocks"], 0.1 * heat["all compression"], heat)

    def test_shocks_keep_their_viscosity(self):
        # Without any, the kinetic energy of the noise is missing from the heat.
        for case in (viscosity.Copper.name, viscosity.Sod.name):
            overshoot = self.of(case, "overshoot")
            self.assertLess(overshoot["shocks"], overshoot["off"], case)


if __name__ == "__main__":
    _mpm.main()
