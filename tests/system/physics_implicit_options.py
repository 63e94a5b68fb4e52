"""PETSc's options, after -- and from elsewhere: what implicit steps follow, and what they refuse by name, once, on any ranks, and
where they can before files of an earlier run are touched. A step is taken only with a residual within the tolerance, whatever ends
Newton's method."""

from unittest import mock

import numpy as np

import _cases
import _mpm
from _implicit import SOFT, column

# Files of options that PETSc itself would end the program for.
UNREADABLE = [
    ("-ksp_type cg\nksp_rtol 1e-8\n", '"ksp_rtol" at the start of line 2'),
    ("-ksp_type gmres 3\n", '"3" in line 1'),
    ("-snes_monitor -ksp_monitor\n", '"-ksp_monitor" in line 1'),
    ("! no comment\n", '"!" at the start of line 1'),
]

# Each with words of its message.
REFUSED = [
    (("-ksp_typo", "gmres"), ("-ksp_typo", "spelling")),
    (("-ksp_type", "gmrez"), ("-ksp_type", "gmrez")),
    (("-ksp_rtol", "abc"), ("-ksp_rtol",)),
    (("-snes_rtol", "1e-3"), ("-snes_rtol", "rtol and atol of Implicit")),
    (("-snes_convergence_test", "skip"), ("-snes_convergence_test", "rtol and atol of Implicit")),
    (("-snes_max_it", "50"), ("-snes_max_it", "max_newton of Implicit")),
    (("-snes_divergence_tolerance", "10"), ("-snes_divergence_tolerance", "max_newton of Implicit")),
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


@_mpm.needs_implicit_steps
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

    def test_a_preconditioner_alone(self):
        """What does not solve small systems by itself is iterated with, unless the user says how."""
        path = self.write(column(steps=2))
        for options, words in ((("-pc_type", "jacobi"), "gmres with jacobi"), (("-pc_type", "none"), "gmres with none"),
                               (("-pc_type", "ilu"), "gmres with ilu"), (("-pc_type", "icc"), "gmres with icc"),
                               (("-pc_type", "gamg"), "gmres with gamg"), (("-pc_type", "hypre"), "gmres with hypre"),
                               (("-pc_type", "jacobi", "-ksp_type", "cg"), "cg with jacobi"),
                               (("-pc_type", "cholesky"), "preonly with cholesky"), (("-pc_type", "lu"), "preonly with lu")):
            with self.subTest(options=options):
                outcome = self.run_with(path, options)
                self.assertEqual(outcome.code, _mpm.DONE, outcome)
                self.assertIn(f": {words};", outcome.out)
                self.assertIn("0 of them rejected", outcome.out)

    def test_options_from_elsewhere(self):
        """Of the environment and of files that PETSc reads by itself: followed, or refused with where they come from."""
        path = self.write(column(steps=2))
        (self.folder / "home").mkdir()
        own = self.folder / "home/.petscrc"
        place = {"environment": "in the environment variable PETSC_OPTIONS", "file": "in a file .petscrc"}

        def run(environment="", file="", after=(), **more):
            own.write_text(file)
            with mock.patch.dict(_mpm.ENVIRONMENT, PETSC_OPTIONS=environment, HOME=str(own.parent)):
                return self.run_with(path, after, **more)

        for source in place:
            with self.subTest(source):
                outcome = run(**{source: "-ksp_type gmres"})
                self.assertEqual(outcome.code, _mpm.DONE, outcome)
                self.assertIn(": gmres with lu;", outcome.out)
                for options, words in (("-nosuch 1", f"unknown or unused options of PETSc {place[source]}: -nosuch;"),
                                       ("-ksp_type gmrez", f"options of PETSc {place[source]} (-ksp_type gmrez): "),
                                       ("-snes_max_it 50", f"option -snes_max_it of PETSc {place[source]} has no effect"),
                                       ("-mat_type dense", f"option -mat_type dense of PETSc {place[source]}: expected aij")):
                    outcome = run(**{source: options})
                    self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
                    self.assertEqual(len(outcome.err.splitlines()), 1, outcome)
                    self.assertIn(words, outcome.err)
        for parts, words in (({"environment": "-ksp_type cg nonsense"}, f'"nonsense" {place["environment"]} belongs to no option'),
                             ({"environment": "-options_file /nonexist"}, f'{place["environment"]}: the file cannot be read'),
                             ({"file": "nonsense\n"}, f'{own}, whose options PETSc takes, has "nonsense" at the start of line 1'),
                             ({"environment": "-one 1", "file": "-two 2", "after": ("-three", "3", "-one", "1")},
                              f'after --: -one, -three, {place["file"]}: -two;'),
                             ({"environment": "-nosuch 1", "ranks": 2}, f'{place["environment"]}: -nosuch;')):
            with self.subTest(words):
                outcome = run(**parts)
                self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
                self.assertEqual(len(outcome.complaint.splitlines()), 1, outcome)
                self.assertIn(words, outcome.err)
        outcome = run(file="-nosuch 1", after=("-skip_petscrc",))
        self.assertEqual(outcome.code, _mpm.DONE, outcome)

    def test_files_of_an_earlier_run_stay(self):
        path = self.write(column(steps=2, output='<PostProcessing time_interval="0.5" h5part="1" var="pres"/>'))
        self.run_in("out", [path])
        before = _mpm.contents(self.folder / "out")
        for options in (("nonsense",), ("-options_file", "/nonexist"), ("-snes_rtol", "1e-3"), ("-mat_type", "dense")):
            for dry in ((), ("--dry-run",)):
                with self.subTest(options=options, dry=dry):
                    outcome = _mpm.run([path, *dry, "--output-dir", self.folder / "out", "--", *options])
                    self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
                    self.assertIn(options[0], outcome.err)
                    self.assertEqual(_mpm.contents(self.folder / "out"), before)

    def test_what_is_refused(self):
        path = self.write(column(steps=2))
        for options, words in REFUSED:
            with self.subTest(options=options):
                outcome = self.run_with(path, options)
                self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
                self.assertEqual(len(outcome.err.splitlines()), 1, outcome)
                for word in words:
                    self.assertIn(word, outcome.err)
        for text, words in UNREADABLE:
            with self.subTest(text):
                (self.folder / "options").write_text(text)
                outcome = self.run_with(path, ("-options_file", self.folder / "options"))
                self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
                self.assertIn(words, outcome.err)
        outcome = self.run_with(self.write(_mpm.bounce(0.1), "explicit.xmp"), ("-ksp_type", "cg"))
        self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
        self.assertIn("-ksp_type", outcome.err)
        semi = self.write(column(steps=2).replace("quasistatic", "semi"), "semi.xmp")
        outcome = self.run_with(semi, ("-snes_type", "newtonls"))
        self.assertEqual(outcome.code, _mpm.INPUT_ERROR, outcome)
        self.assertIn("ksponly", outcome.err)

    def test_ranks_leave_together(self):
        path = self.write(column(steps=2))
        for options in (("-mat_type", "dense"), ("-mat_type", "nosuch"), ("-options_file", "/nonexist"), ("-pc_type", "nosuch"),
                        ("nonsense",)):
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
