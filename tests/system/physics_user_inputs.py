"""Inputs of users at their defaults (benchmarks/stability/inputs): energy within 1 %, exit code 0. Those that take seconds."""

import sys

import numpy as np

import _cases
import _mpm

sys.path[:0] = [str(_mpm.SOURCE / "benchmarks/stability"), str(_mpm.SOURCE / "benchmarks")]

import user_inputs  # noqa: E402: found by the line above


class UserInputs(_mpm.Case):
    def measure(self, name, shape="linear", scheme="MUSL", share=1):
        folder = self.folder / f"{name}-{shape}-{scheme}"
        folder.mkdir()
        row = user_inputs.measure(name, shape, scheme, share, folder)
        self.assertEqual(row["code"], 0, row)
        return row, folder

    def test_bodies_that_erode_fail_and_leave(self):
        for name in ("bounce", "histories"):
            with self.subTest(name):
                self.assertLess(abs(self.measure(name)[0]["largest"]), 0.01)

    def test_pressed_column(self):
        """Its particles cross cells: linear functions lose 11 % of the energy then, those whose gradients do not jump keep it."""
        loss = self.measure("rigid_ram")[0]["largest"]
        self.assertGreater(loss, -0.13)
        self.assertLess(loss, -0.05)
        row, _ = self.measure("rigid_ram", "SGMP")
        self.assertLess(abs(row["largest"]), 0.001)

    def test_sand_stays_on_the_ground_with_usl(self):
        """The first 8 % of the time. With a longer step than today's USL threw the column into the air within 1 % of the time, with a
        drift of 113 %."""
        row, folder = self.measure("sand_column", scheme="USL", share=0.08)
        self.assertLess(abs(row["largest"]), 0.01)
        states = _cases.States(folder)
        for picture in range(1, len(states.times)):
            self.assertLess(np.max(states.column("z", picture) - states.column("z", 0)), 1e-4)  # of a cell of 0.025


if __name__ == "__main__":
    _mpm.main()
