"""The programs of the preset minimal: they run what they have and refuse by name what they were built without."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "system"))
import _mpm
from _mpm import INPUT_ERROR, Case

_mpm.BIN = _mpm.SOURCE / "build/minimal/bin"


class Minimal(Case):
    def refused(self, words, grid="", solution=""):
        """With these attributes."""
        case = self.write(_mpm.bounce(0.02).replace("<Grid>", f"<Grid {grid}>").replace("<Solution ", f"<Solution {solution} "))
        for program in "mpm_check", "mpm_run":
            outcome = _mpm.run([case, *(["--output-dir", self.folder / "out"] if program == "mpm_run" else [])],
                               program=program)
            self.assertEqual(outcome.code, INPUT_ERROR, outcome)
            for word in words:
                self.assertIn(word, outcome.err)

    def test_runs_linear_shape_functions(self):
        self.run_in("out", [self.write(_mpm.bounce(0.02).replace("<Grid>", '<Grid shape="linear">'))])

    def test_refuses_other_shape_functions(self):
        for shape in ("SGMP", "DDMP", "uGIMP", "cpGIMP", "CPDI", "CPDI2", "QuadraticBSpline", "CubicBSpline"):
            with self.subTest(shape):
                self.refused(["case.xmp:", f"built without {shape}", "expected linear", "MPM_SHAPES"], f'shape="{shape}"')
        self.refused(["case.xmp:", "built without uGIMP", "MPM_SHAPES"], 'gimp="1"')

    def test_refuses_other_shape_functions_with_other_transfers(self):
        for shape, solution in (("QuadraticBSpline", 'transfer="APIC"'), ("DDMP", 'transfer="TPIC"'), ("CPDI", 'mass="consistent"')):
            with self.subTest(shape=shape, solution=solution):
                self.refused(["case.xmp:", f"built without {shape}"], f'shape="{shape}"', solution)

    def test_refuses_corrections(self):
        for transfer in ("XPIC", "FMPM"):
            self.refused(["case.xmp:", f"built without {transfer}", "MPM_CORRECTIONS"], solution=f'transfer="{transfer}"')
        self.refused(["case.xmp:", "built without the consistent mass", "MPM_CORRECTIONS"], solution='mass="consistent"')

    def test_refuses_implicit_steps(self):
        self.refused(["case.xmp:", "MPM_WITH_PETSC"], solution='Integration="impl"')


if __name__ == "__main__":
    _mpm.main()
