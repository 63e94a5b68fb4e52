"""benchmarks/stability: each of its commands measures a point, finds what is unstable, and refuses what does not exist."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import _mpm

FOLDER = _mpm.SOURCE / "benchmarks/stability"
sys.path[:0] = [str(FOLDER), str(_mpm.SOURCE / "benchmarks")]

import limits  # noqa: E402: found by the line above
import long_runs  # noqa: E402
import verdicts  # noqa: E402
from accuracy import methods  # noqa: E402


class Stability(unittest.TestCase):
    def test_limits(self):
        # On either side of the limit of 0.64 in the table.
        method = "linear", "FLIP", "USL", "lumped"
        self.assertLess(limits.growth("fluid", method, 0.5), limits.GROWTH)
        self.assertGreater(limits.growth("fluid", method, 1.0), limits.GROWTH)

    def test_long_runs(self):
        row = long_runs.measure("viscous", methods.Method("linear", "FLIP", "MUSL"), steps=5000)
        self.assertEqual(row["code"], 0)
        self.assertLess(abs(row["drift"]), 0.02)
        twice = long_runs.measure("viscous", methods.Method("linear", "FLIP", "MUSL"), steps=5000, factor=0.45)
        self.assertAlmostEqual(twice["steps"] / row["steps"], 2, delta=0.05)
        self.assertIsNone(long_runs.measure("viscous", methods.Method("linear", "APIC", "MUSL"), steps=10))

    def test_verdicts(self):
        with tempfile.TemporaryDirectory() as folder:
            row = verdicts.judge("density", "SGMP", "MUSL", "none", pathlib.Path(folder))
        self.assertEqual(row["verdict"], "stable", row)

    def test_what_does_not_exist(self):
        for script, words in (("limits.py", ("--shape", "cubic")), ("verdicts.py", ("--scene", "none")),
                              ("long_runs.py", ("--scheme", "RK4"))):
            done = subprocess.run([sys.executable, FOLDER / script, *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, done)
            self.assertIn("choose from", done.stderr)


if __name__ == "__main__":
    _mpm.main()
