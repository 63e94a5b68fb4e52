"""Length of implicit steps: what is tried before a step is cut, how short it may get, and what the end of a run then says."""

import re

import _mpm
from _implicit import RAM, column, implicit
from physics_implicit import METAL, alpha


@_mpm.needs_implicit_steps
class Steps(_mpm.Case):
    def words(self, folder):
        return (self.folder / folder / "case.out").read_text()

    def overloaded(self, more):
        """Dead weight far beyond what a column bears."""
        weak = _mpm.material("soft", 1.0, 'type="ElaPlastic" Young="1000" Poisson="0.3" Yield0="1"')
        return _mpm.scene([_mpm.block("column", (1, 1, 0), (2, 2, 6))], _mpm.grid((0, 0, 0), (4, 4, 8), "000010"),
                          implicit(1.0, more='max_newton="8" gravity_ramp="1" ' + more,
                                   extra='<Gravity ax="0" ay="0" az="-20"/>'), [weak])

    def test_without_equilibrium_the_state_is_kept(self):
        """No equilibrium, and a restart of the last one."""
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                folder = f"failed{ranks}"
                outcome = self.run_in(folder, [self.write(self.overloaded('time_step="0.1" min_step="0.05"'))], ranks=ranks,
                                      code=_mpm.NUMERICAL_FAILURE)
                self.assertIn("no equilibrium", outcome.err)
                self.assertRegex(outcome.err, r'residual force, [\d.e+-]+, is at node \([\d, ]+\) of body "column"')
                self.assertEqual(outcome.err.count("no equilibrium"), 1)  # not from every rank
                self.assertTrue(_mpm.restarts(self.folder / folder))
                self.assertEqual(_mpm.summary(self.folder / folder)["status"], "failed")

    def test_the_smallest_step_is_tried(self):
        outcome = self.run_in("run", [self.write(self.overloaded('time_step="0.08" min_step="0.05"'))], code=_mpm.NUMERICAL_FAILURE)
        self.assertIn("with the smallest step, 0.05:", outcome.err)

    def test_the_node_of_the_largest_residual(self):
        """The first linear system fails: the residual is the answer to the way of the ram, next to which its largest part is."""
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                outcome = _mpm.run([self.write(column(more='min_step="0.05"')), "--output-dir", self.folder / "out", "--",
                                    "-pc_type", "none", "-ksp_type", "gmres", "-ksp_max_it", "1"], ranks=ranks)
                self.assertEqual(outcome.code, _mpm.NUMERICAL_FAILURE, outcome)
                self.assertIn("DIVERGED_LINEAR_SOLVE", outcome.err)
                force, z = re.search(r"residual force, ([\d.e+-]+), is at node \([\d.]+, [\d.]+, ([\d.]+)\)", outcome.err).groups()
                self.assertGreater(float(force), 1)  # measured 67
                self.assertGreaterEqual(float(z), 7)

    def test_a_thousand_explicit_steps(self):
        """A metal cube under a ram that moves at once: with rules whose velocity depends on the forces at the start nodes keep
        velocities whose free flight would invert particles. Newton's method then begins at rest, and no step is cut."""
        strain, end = 0.2, 1e-3
        for rule in (alpha(0.9), alpha(0.5), alpha(0), 'newmark_beta="0.3025" newmark_gamma="0.6"'):
            with self.subTest(rule=rule):
                ram = _mpm.block("ram", (1, 1, 4), (6, 6, 2), of="ram",
                                 more=f'<PrescribedVelocity vx="{2 * strain / end}" vy="0" vz="{-4 * strain / end}"/>')
                text = _mpm.scene([_mpm.block("cube", (2, 2, 0), (4, 4, 4)), ram],
                                  _mpm.grid((0, 0, 0), (8, 8, 8), "000010").replace("<Grid>", '<Grid shape="QuadraticBSpline">'),
                                  implicit(end, "dynamic", end / 4, rule),
                                  [_mpm.material("soft", 8.93e-9, f'type="IsoElastic" {METAL}'), RAM])
                self.run_in("run", [self.write(text)])
                words = self.words("run")
                self.assertIn("begun again at rest", words)
                self.assertNotIn("shortened", words)
                self.assertEqual(_mpm.summary(self.folder / "run")["steps"], 4)
                iterations = int(re.search(r"(\d+) Newton iterations", words).group(1))
                self.assertLessEqual(iterations, 16)  # measured 11 and 12, as with the trapezoidal rule


if __name__ == "__main__":
    _mpm.main()
