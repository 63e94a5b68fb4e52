"""How far an implicit step may go: over bricks and ranks, up to walls and other bodies."""

import math
import re

import numpy as np

import _cases
import _mpm
from _implicit import POISSON, RAM, SOFT, YOUNG, column, implicit


@_mpm.needs_implicit_steps
class Far(_mpm.Case):
    """Steps in which particles travel over several bricks of four cells."""

    def final(self, folder):
        states = _cases.States(self.folder / folder)
        return np.array([[states.column(axis, which) for axis in "xyz"] for which in (0, -1)])

    def words(self, folder):
        return (self.folder / folder / "case.out").read_text()

    def test_a_step_of_several_bricks_on_any_ranks(self):
        """A column of 24 cells' height that one step compresses to half: uniform strain, while the ram's face is at a node. Its
        top travels over three bricks, into bricks of any rank; a second step goes on from there."""
        bodies = [_mpm.block("column", (0, 0, 0), (2, 2, 24)),
                  _mpm.block("ram", (0, 0, 24), (2, 2, 1), of="ram", more='<PrescribedVelocity vx="0" vy="0" vz="-12"/>')]
        text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), (2, 2, 26), "222210"), implicit(1.25, step=1, more='rtol="1e-10" stabilisation="0"'),
                          [SOFT, RAM], '<PostProcessing time_interval="1" h5part="1" var="pres"/>')
        for ranks in (1, 2, 3):
            with self.subTest(ranks=ranks):
                folder = f"on{ranks}"
                self.run_in(folder, [self.write(text)], ranks=ranks)
                self.assertNotIn("shortened", self.words(folder))
                states = _cases.States(self.folder / folder)
                first, halfway, last = (np.array([states.column(axis, which) for axis in "xyz"]) for which in (0, 1, 2))
                mine = first[2] < 24
                np.testing.assert_allclose(halfway[2][mine], 0.5 * first[2][mine], atol=1e-6)
                np.testing.assert_allclose(halfway[2][~mine], first[2][~mine] - 12, atol=1e-9)
                # The column is no longer in step with the cells: the same to the tolerance on any ranks.
                if ranks == 1:
                    alone = last
                self.assertLess(np.abs(last - alone).max(), 1e-6)
                self.assertEqual(_mpm.summary(self.folder / folder)["particles"], mine.size)

    def test_flight_over_bricks(self):
        """Free flight of 10, 5 and 2.5 cells in a step, into bricks that no rank knows yet."""
        body = _mpm.block("body", (2, 2, 2), (3, 3, 3), (10.0, 5.0, 2.5))
        text = _mpm.scene([body], _mpm.grid((0, 0, 0), (30, 20, 12)), implicit(2.0, "dynamic", 1.0), [SOFT])
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                self.run_in(f"on{ranks}", [self.write(text)], ranks=ranks)
                found = _mpm.summary(self.folder / f"on{ranks}")
                self.assertEqual(found["steps"], 2)
                np.testing.assert_allclose(found["bodies"][0]["velocity"], (10.0, 5.0, 2.5), atol=1e-8)
                np.testing.assert_allclose(found["bodies"][0]["centre"], (23.5, 13.5, 8.5), atol=1e-7)

    def test_stop_of_a_body_that_leaves_in_one_step(self):
        body = _mpm.block("body", (2, 2, 2), (3, 3, 3), (10.0, 0, 0))
        solution = implicit(4.0, "dynamic", 1.0).replace("<Solution ", '<Solution near_boundary_stop="1" ')
        self.run_in("run", [self.write(_mpm.scene([body], _mpm.grid((0, 0, 0), (8, 8, 8)), solution, [SOFT]))], code=_mpm.STOPPED)

    def test_first_step_of_a_quasistatic_run(self):
        """EndTime/20 where the input gives none, within its bounds; easy steps grow up to the largest."""
        for bounds, fewest, most in (("", 20, 20), ('max_step="0.02"', 50, 50), ('min_step="0.25"', 4, 4), ('max_step="0.5"', 5, 12)):
            with self.subTest(bounds=bounds):
                self.run_in("run", [self.write(column().replace('time_step="0.1"', bounds))])
                steps = _mpm.summary(self.folder / "run")["steps"]
                self.assertTrue(fewest <= steps <= most, steps)

    def test_walls_and_bodies_are_not_passed(self):
        """A body that flies at a wall two cells away, or at another body, in steps of six cells."""
        flying = _mpm.block("ball", (1, 1, 4), (2, 2, 2), (0, 0, -6.0))
        self.run_in("wall", [self.write(_mpm.scene([flying], _mpm.grid((0, 0, 0), (4, 4, 8), "222220"),
                                                   implicit(1.0, "dynamic", 1.0), [SOFT]))])
        found = _mpm.summary(self.folder / "wall")
        self.assertEqual(found["particles"], 64)
        self.assertGreater(found["bodies"][0]["centre"][2], 0.3)
        self.assertIn("passes a wall", self.words("wall"))
        target = _mpm.block("target", (1, 1, 0), (2, 2, 1))
        self.run_in("body", [self.write(_mpm.scene([flying, target], _mpm.grid((0, 0, 0), (4, 4, 8), "222220"),
                                                   implicit(0.5, "dynamic", 0.5), [SOFT]))])
        bodies = _mpm.summary(self.folder / "body")["bodies"]
        self.assertIn('bodies "ball" and "target" meet', self.words("body"))
        self.assertGreater(bodies[0]["centre"][2], bodies[1]["centre"][2] + 0.5)

    def test_strain_of_increments(self):
        """Of a law that adds up increments a step of stretch s has the strain h = 2 (s - 1)/(s + 1), which is ln s less
        h^3/12; a step with more than a half is refused."""
        modulus = YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))
        material = _mpm.material("soft", 1.0, f'type="IsoElastic" Young="{YOUNG}" Poisson="{POISSON}" bq1="0" bq2="0"')
        for travel in (5, 8):
            with self.subTest(travel=travel):
                bodies = [_mpm.block("column", (0, 0, 0), (2, 2, 16)),
                          _mpm.block("ram", (0, 0, 16), (2, 2, 1), of="ram",
                                     more=f'<PrescribedVelocity vx="0" vy="0" vz="{-travel}"/>')]
                text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), (2, 2, 18), "222210"), implicit(1.0, step=1, more='stabilisation="0"'),
                                  [material, RAM], '<PostProcessing time_interval="1" h5part="1" var="SigmaZ"/>')
                self.run_in(str(travel), [self.write(text)])
                stretch = 1 - travel / 16
                strain = 2 * (stretch - 1) / (stretch + 1)
                refused = re.findall(r"a particle is strained by ([\d.]+)", self.words(str(travel)))
                if abs(strain) > 0.5:
                    self.assertAlmostEqual(float(refused[0]), abs(strain), delta=1e-3)
                    continue
                self.assertEqual(refused, [])
                states = _cases.States(self.folder / str(travel))
                stress = states.column("SigmaZ")[states.column("z", 0) < 16]
                self.assertLess(np.abs(stress / (modulus * strain) - 1).max(), 1e-4)
                self.assertLess(abs(strain / math.log(stretch) - 1), 0.25 / 12)


if __name__ == "__main__":
    _mpm.main()
