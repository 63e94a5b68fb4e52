"""A coarse plane shock in copper against the jump conditions; tests/validation/plane_shock.py has the full study."""

import _cases
import _mpm


class PlaneShock(_mpm.Case):
    def test_jump_conditions(self):
        shock = _cases.Shock(speed=500.0)
        self.run_in("out", [self.write(shock.text())])
        found = shock.measure(self.folder / "out")
        # 1 % is asked for. Six particles along a cell: with two, the noise of particles that cross cells alone takes
        # 2 % off the mean pressure.
        for name, error in found["error"].items():
            self.assertLess(abs(error), 0.01, name)
        # The quadratic viscosity spreads the front over some cells, however strong the shock.
        self.assertGreater(found["width"], 1.5)
        self.assertLess(found["width"], 6)


_mpm.main()
