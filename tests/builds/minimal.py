"""The programs of the preset minimal: they run what they have and refuse by name what they were built without."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "system"))
import _mpm
from _mpm import INPUT_ERROR, Case

_mpm.BIN = _mpm.SOURCE / "build/minimal/bin"


class Minimal(Case):
    def refused(self, old, new, words):
        text = _mpm.bounce(0.02)
        self.assertIn(old, text)
        case = self.write(text.replace(old, new, 1))
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
                self.refused("<Grid>", f'<Grid shape="{shape}">', ["case.xmp:", f"built without {shape}",
                                                                  "expected linear", "MPM_SHAPES"])
        self.refused("<Grid>", '<Grid gimp="1">', ["case.xmp:", "built without uGIMP", "MPM_SHAPES"])

    def test_refuses_corrections(self):
        for transfer in ("XPIC", "FMPM"):
            self.refused("<Solution ", f'<Solution transfer="{transfer}" ', ["case.xmp:", f"built without {transfer}", "MPM_CORRECTIONS"])
        self.refused("<Solution ", '<Solution mass="consistent" ', ["case.xmp:", "built without the consistent mass", "MPM_CORRECTIONS"])

    def test_refuses_implicit_steps(self):
        self.refused("<Solution ", '<Solution Integration="impl" ', ["case.xmp:", "MPM_WITH_PETSC"])


if __name__ == "__main__":
    _mpm.main()
