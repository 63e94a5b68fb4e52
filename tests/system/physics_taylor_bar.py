"""The Taylor bar of benchmarks/taylor_bar and its report: the shape that the thesis found with the same cells.

Finer models, against the experiment: tests/validation/taylor_bar.py."""

import re
import subprocess
import sys

import _mpm

FOLDER = _mpm.SOURCE / "benchmarks/taylor_bar"
# Standard MPM with particles 0.38 mm apart, P. Huang's thesis (Tsinghua, 2010), table 5.1.
THESIS = {"L": 16.3, "D": 13.2, "W": 9.9}


class TaylorBar(_mpm.Case):
    def test_shape(self):
        self.run_in("out", [FOLDER / "taylor_bar.xmp"])
        summary = _mpm.summary(self.folder / "out", "taylor_bar")
        self.assertLess(abs(summary["energy"]["relative_drift"]), 0.003)  # asked for

        report = subprocess.run([sys.executable, FOLDER / "report.py", self.folder / "out"], capture_output=True, text=True)
        self.assertEqual(report.returncode, 0, report.stderr)
        computed = re.search(r"computed +(\S+) +(\S+) +(\S+)", report.stdout)
        self.assertTrue(computed, report.stdout)
        # Half of the table's last digit, and as much again because the thesis cut its disc from other particles (368 in
        # a layer, here 316).
        for (name, expected), value in zip(THESIS.items(), computed.groups()):
            self.assertAlmostEqual(float(value), expected, delta=0.1, msg=name)

        picture = self.folder / "out/taylor_bar.png"
        self.assertIn(str(picture), report.stdout)
        self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))
        self.assertGreater(picture.stat().st_size, 20000)  # a picture with something on it


_mpm.main()
