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
import theory  # noqa: E402
import verdicts  # noqa: E402
from accuracy import methods  # noqa: E402


class Stability(unittest.TestCase):
    def test_limits(self):
        # On either side of the limit of 0.64 in the table.
        method = "linear", "FLIP", "USL", "lumped"
        self.assertLess(limits.growth("fluid", method, 0.5), limits.GROWTH)
        self.assertGreater(limits.growth("fluid", method, 1.0), limits.GROWTH)

    def test_theory(self):
        # A lone particle at xi between two nodes, neither lighter than the floor of USL's masses: its stress changes by the factor
        # 1 - dt^2/(xi (1 - xi)) in a step of USL (thesis 2-49), and not with MUSL.
        for xi in (0.4, 0.5):
            bar = theory.Bar("linear", [2 + xi])
            edge = (2 * xi * (1 - xi)) ** 0.5
            self.assertTrue(bar.stable("USL", "FLIP", 0.99 * edge))
            self.assertFalse(bar.stable("USL", "FLIP", 1.01 * edge))
            self.assertTrue(bar.stable("MUSL", "FLIP", 3 * edge))
        # MUSL and USF are the same two half steps, begun with either.
        for shape in ("linear", "SGMP", "QuadraticBSpline"):
            self.assertAlmostEqual(theory.limit(shape, "MUSL", packings=20), theory.limit(shape, "USF", packings=20), delta=0.03)
        # Wider functions bear longer steps.
        self.assertLess(theory.limit("linear", "MUSL"), theory.limit("QuadraticBSpline", "MUSL"))

    def test_limit_of_the_program(self):
        self.assertAlmostEqual(limits.of_program(("SGMP", "FLIP", "MUSL", "lumped")), 1.25, delta=1e-9)
        with self.assertRaises(limits.Refused):
            limits.growth("block", ("linear", "APIC", "MUSL", "lumped"), 0.5)

    def test_fracture(self):
        with tempfile.TemporaryDirectory() as folder:
            stretch = verdicts.fracture("linear", pathlib.Path(folder))
        self.assertGreater(stretch, 2)  # where a cell may be empty at first
        self.assertLess(stretch, 5)  # no particle shares a cell with another beyond 4

    def test_long_runs(self):
        row = long_runs.measure("viscous", methods.Method("linear", "FLIP", "MUSL"), steps=5000)
        self.assertEqual(row["code"], 0)
        self.assertLess(abs(row["drift"]), 0.02)
        twice = long_runs.measure("viscous", methods.Method("linear", "FLIP", "MUSL"), steps=5000, factor=0.45)
        self.assertAlmostEqual(twice["steps"] / row["steps"], 2, delta=0.05)
        with self.assertRaises(limits.Refused):
            long_runs.measure("viscous", methods.Method("linear", "APIC", "MUSL"), steps=10)

    def test_verdicts(self):
        # At a density ratio of 10^4 no shape lets heavy particles drive nodes that have their mass of light ones alone.
        for shape in methods.shapes():
            for scheme in ("MUSL", "USF"):
                with self.subTest(shape=shape, scheme=scheme), tempfile.TemporaryDirectory() as folder:
                    row = verdicts.judge("density", shape, scheme, "none", pathlib.Path(folder))
                    self.assertEqual(row["verdict"], "stable", row)
                    self.assertLess(row["steps"], 150, row)

    def test_what_does_not_exist(self):
        method = ("--shape", "linear", "--transfer", "APIC", "--scheme", "MUSL")
        for script, words, said in (("limits.py", ("--shape", "cubic"), "choose from"), ("verdicts.py", ("--scene", "none"), "choose from"),
                                    ("long_runs.py", ("--scheme", "RK4"), "choose from"), ("run.py", ("everything",), "choose from"),
                                    # A choice that leaves nothing: of the table's rows, or since the program refuses it.
                                    ("user_inputs.py", ("--input", "bounce", "--scheme", "USL"), "choose from bounce linear MUSL"),
                                    ("verdicts.py", ("--course", "--shape", "uGIMP"), "choose from linear, SGMP,"),
                                    ("limits.py", ("--docs", "--factor", "0.5", *method), "linear APIC MUSL lumped: "),
                                    ("long_runs.py", ("--steps", "100", *method), "expected shape QuadraticBSpline,")):
            with self.subTest(script=script, words=words):
                done = subprocess.run([sys.executable, FOLDER / script, *words], capture_output=True, text=True)
                self.assertEqual(done.returncode, 2, done)
                self.assertIn(said, done.stderr)

    def test_help_names_every_transfer(self):
        done = subprocess.run([sys.executable, FOLDER / "long_runs.py", "--help"], capture_output=True, text=True)
        self.assertIn(" ".join(f"{name}," for name in methods.transfers())[:-1], " ".join(done.stdout.split()))


if __name__ == "__main__":
    _mpm.main()
