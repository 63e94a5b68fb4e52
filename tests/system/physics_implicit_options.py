"""PETSc's options after --: what implicit steps follow, and what they refuse by name, once, on any ranks. A step is taken only
with a residual within the tolerance, whatever ends Newton's method."""

import numpy as np

import _cases
import _mpm
from _implicit import SOFT, column

# Each with words of its message.
REFUSED = [
    (("-ksp_typo", "gmres"), ("-ksp_typo", "spelling")),
    (("-ksp_type", "gmrez"), ("-ksp_type", "gmrez")),
    (("-ksp_rtol", "abc"), ("-ksp_rtol",)),
    (("-snes_rtol", "1e-3"), ("-snes_rtol", "rtol and atol of Implicit")),
    (("-snes_convergence_test", "skip"), ("-snes_convergence_test", "rtol and atol of Implicit")),
    (("-pc_factor_mat_solver_type", "nosuch"), ("-pc_factor_mat_solver_type",)),
    # Others would end where they like, or after one system.
    (("-snes_type", "ngmres"), ("-snes_type ngmres", "newtonls or newtontr")),
    (("-snes_type", "ksponly"), ("-snes_type ksponly", "newtonls or newtontr")),
    (("-mat_type", "dense"), ("-mat_type dense", "aij or baij")),
    (("-mat_type", "sbaij"), ("-mat_type sbaij", "aij or baij")),
    (("-mat_type", "aijcusparse"), ("-mat_type aijcusparse", "aij or baij")),
    (("-mat_type", "nosuch"), ("-mat_type nosuch", "aij or baij")),
    # Words that belong to no option.
    (("nonsense",), ('"nonsense"', "begin with -")),
    (("ksp_type", "cg"), ('"ksp_type", "cg"', "begin with -")),
    (("-ksp_type", "gmres", "extra"), ('"extra"', "begin with -")),
    (("-ksp_max_it", "-1", "extra"), ('"extra"', "begin with -")),
    (("-options_file", "/nonexist"), ("-options_file /nonexist", "cannot be read")),
    (("-options_file", "/"), ("-options_file /", "cannot be read")),
    (("-options_file",), ("-options_file", "missing")),
]


class Options(_mpm.Case):
    def run_with(self, job, options, folder="out", **more):
        return _mpm.run([job, "--output-dir", self.folder / folder, "--", *options], **more)

    def test_what_is_followed(self):
        path = self.write(column(steps=2))
        (self.folder / "options").write_text("# a comment\n-ksp_type gmres\n  -pc_type bjacobi\n")
        for options in (("-ksp_type", "gmres", "-pc_type", "bjacobi"), ("-pc_factor_mat_solver_type", "mumps"),
                        ("-options_file", self.folder / "options"), ("-mat_type", "baij"), ("-log_view",)):
            with self.subTest(options=options):
                outcome = self.run_with(path, options)
                self.assertEqual(outcome.code, _mpm.DONE, outcome)

    def test_what_is_refused(self):
        path = self.write(column(steps=2))
        for options, words in REFUSED:
            with self.subTest(options=options):
                outcome = self.run_with(path, options)
                self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
                self.assertEqual(len(outcome.err.splitlines()), 1, outcome)
                for word in words:
                    self.assertIn(word, outcome.err)
        (self.folder / "options").write_text("-ksp_type cg\nksp_rtol 1e-8\n")
        outcome = self.run_with(path, ("-options_file", self.folder / "options"))
        self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
        self.assertIn('"ksp_rtol" at the start of line 2', outcome.err)
        outcome = self.run_with(self.write(_mpm.bounce(0.1), "explicit.xmp"), ("-ksp_type", "cg"))
        self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
        self.assertIn("-ksp_type", outcome.err)
        semi = self.write(column(steps=2).replace("quasistatic", "semi"), "semi.xmp")
        outcome = self.run_with(semi, ("-snes_type", "newtonls"))
        self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
        self.assertIn("ksponly", outcome.err)

    def test_ranks_leave_together(self):
        path = self.write(column(steps=2))
        for options in (("-mat_type", "dense"), ("-mat_type", "nosuch"), ("-options_file", "/nonexist"), ("-pc_type", "nosuch")):
            with self.subTest(options=options):
                outcome = self.run_with(path, options, ranks=2)
                self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
                self.assertEqual(len(outcome.complaint.splitlines()), 1, outcome)
                self.assertIn(" ".join(options), outcome.complaint)
                self.assertNotIn("MPI_ABORT", outcome.err)

    def test_no_step_ends_above_its_tolerance(self):
        """Newton's method stalls at round-off, above a tolerance that no residual meets: its steps are below a part of 1e-14."""
        outcome = self.run_in("run", [self.write(column(travel=0.2, steps=1, more='rtol="1e-30" atol="1e-30" min_step="0.5"'))],
                              code=_mpm.NUMERICAL_FAILURE)
        self.assertIn("no equilibrium", outcome.err)

    def test_a_trust_region_finds_the_same_equilibrium(self):
        """PETSc's trust region in place of full steps, with a law without and one with plastic flow."""
        metal = _mpm.material("soft", 1.0, 'type="IsoHarden" Young="1000" Poisson="0.3" Yield0="20" TangMod="100"')
        for name, material in (("elastic", SOFT), ("plastic", metal)):
            with self.subTest(name):
                path = self.write(column("QuadraticBSpline", 0.8, 4, material, 'rtol="1e-9"',
                                         '<PostProcessing time_interval="1" h5part="1" var="pres"/>'))
                places = []
                for method in ("newtonls", "newtontr"):
                    outcome = self.run_with(path, ("-snes_type", method), method)
                    self.assertEqual(outcome.code, _mpm.DONE, outcome)
                    self.assertRegex(outcome.out, f"PETSc [^:]*: {method}, " if method != "newtonls" else "PETSc [^:]*: preonly")
                    places.append(np.array([_cases.States(self.folder / method).column(axis) for axis in "xyz"]))
                # Places are in single precision: two units in the last place at 8.
                self.assertLess(np.abs(places[1] - places[0]).max(), 2e-6)


if __name__ == "__main__":
    _mpm.main()
