"""Bodies that fly freely across cells, bricks and the borders of ranks feel nothing of it.

A uniform velocity has no gradient, and the shape functions add up to one: so no stress, and mass and momentum as
on the first day, but for round-off."""

import numpy as np

import _cases
import _mpm

ROUND_OFF = np.finfo(float).eps
YOUNG = 117e3
COPPER = _cases.copper(f'type="IsoHarden" Young="{YOUNG}" Poisson="0.35" Yield0="157" TangMod="423"')
END = 0.1  # ms: 14 to 20 cells at these speeds, or 4 to 5 bricks
# Borders of ranks at z = 13, which the first body crosses, and z = 29, which the second one crosses.
SLABS = '<DomainDecomposition dimension0="1" dimension1="1" dimension2="3"/>'


def flight(algorithm, more=""):
    """Two blocks in one component that fly apart, each through many cells of 1 mm along every axis; a third at rest."""
    bodies = [_mpm.block("one", (15.3, 15.1, 14.6), (3, 2.5, 2), (-150, -190, -140), 0.5, "copper"),
              _mpm.block("two", (19.2, 18.1, 19.3), (2, 3, 2), (120, 160, 200), 0.5, "copper"),
              _mpm.block("rest", (30.25, 5.25, 5.25), (2, 2, 2), (0, 0, 0), 0.5, "copper")]
    output = f'<PostProcessing time_interval="{END}" h5part="1" var="SigmaX|SigmaY|SigmaZ|SigmaXY|SigmaYZ|SigmaXZ|pres|epef|density"/>'
    return _mpm.scene(bodies, _mpm.grid((-3, -8, -3), (45, 45, 45)), _mpm.solution(END, algorithm, 0.4), [COPPER],
                      output, more)


class FreeFlight(_mpm.Case):
    def fly(self, algorithm, ranks, more=""):
        case = self.write(flight(algorithm, more))
        folder = f"{algorithm}{ranks}{len(more)}"
        outcome = self.run_in(folder, [case], ranks=ranks)
        return outcome, _mpm.summary(self.folder / folder), _cases.States(self.folder / folder)

    def check(self, algorithm, ranks, more=""):
        outcome, summary, states = self.fly(algorithm, ranks, more)
        self.assertGreater(summary["steps"], 1000)
        self.assertEqual(summary["ranks"], ranks)

        # A step adds the round-off of a strain increment, speed x dt/cell = 0.03 times eps, now up and now down: over
        # 1300 steps that is about eps of the modulus. A hundred times as much would be no accident.
        stress = max(np.abs(states.column(name)).max() for name in
                     ("SigmaX", "SigmaY", "SigmaZ", "SigmaXY", "SigmaYZ", "SigmaXZ", "pres"))
        self.assertLess(stress, 100 * ROUND_OFF * YOUNG)
        self.assertEqual(states.column("epef").max(), 0)

        for body, first in zip(summary["bodies"], ((-150, -190, -140), (120, 160, 200), (0, 0, 0))):
            with self.subTest(body=body["name"]):
                self.assertEqual(body["particles"], {"one": 120, "two": 96, "rest": 64}[body["name"]])
                mass = body["particles"] * 0.5**3 * _cases.COPPER["density"]
                self.assertLess(abs(body["mass"] / mass - 1), 1e-12)  # asked for; the sums are exact
                speed = max(np.linalg.norm(first), 1)
                # 1e-12 is asked for: some thousand roundings of eps/2.
                self.assertLess(np.abs(np.subtract(body["velocity"], first)).max() / speed, 1e-12)
        momentum = [sum(b["mass"] * b["velocity"][a] for b in summary["bodies"]) for a in range(3)]
        scale = sum(b["mass"] for b in summary["bodies"]) * 300
        self.assertLess(np.abs(np.subtract(summary["momentum"], momentum)).max() / scale, 1e-12)
        self.assertLess(abs(summary["energy"]["relative_drift"]), 1e-12)

        # They have gone where their velocities say. Positions lie in the file in single precision, of 45 mm.
        first, last = (np.column_stack([states.column(a, w) for a in "xyz"]) for w in (0, -1))
        velocity = np.column_stack([states.column(f"velocity_{a}") for a in range(3)])
        self.assertLess(np.abs(last - first - END * velocity).max(), 45 * 4e-7)
        return outcome.state

    def test_one_rank(self):
        for algorithm in ("MUSL", "USF", "USL", "USAVG"):
            with self.subTest(algorithm=algorithm):
                self.check(algorithm, 1)

    def test_across_ranks(self):
        one = self.check("MUSL", 1)
        self.assertEqual(self.check("MUSL", 3), one)
        self.assertEqual(self.check("MUSL", 3, SLABS), one)


_mpm.main()
