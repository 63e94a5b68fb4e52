"""Rigid bodies that move freely: by themselves, on other rigid bodies, at walls, and damped.

Prints what it measures."""

import math

import numpy as np

import _cases
import _mpm
import physics_rigid
from physics_rigid import held

SOFT = _mpm.material("soft", 1.0, 'type="IsoElastic" Young="1000" Poisson="0.3"')
FAR = _mpm.block("far", (0, 0, 0), (1, 1, 1))  # contact needs a deformable body


def scene(bodies, end, step, size=(12, 12, 12), faces="000000", shape="linear", more="", friction=0.0):
    grid = _mpm.grid((0, 0, 0), size, faces).replace("<Grid>", f'<Grid shape="{shape}">')
    text = physics_rigid.scene([FAR, *bodies], grid, _mpm.solution(end, more=more), SOFT, friction, f'<Console print_time="{end / 20}"/>')
    return text.replace('<TimeStep factor="0.5"/>', f'<TimeStep specified="{step!r}"/>')


def iron(name, lower, size, velocity=(0, 0, 0), more=""):
    return _mpm.block(name, lower, size, velocity, of="iron", more=more)


def gravity(g):
    return f'<Gravity ax="0" ay="0" az="{-g}"/>'


class FreeRigid(_mpm.Case):
    def go(self, text, folder="run", **how):
        outcome = self.run_in(folder, [self.write(text)], **how)
        return outcome, _mpm.summary(self.folder / folder), _cases.status(self.folder / folder)

    def test_free_rotation(self):
        """About no principal axis: the kinetic energy is kept, and contact dissipates nothing without contact."""
        table = "".join(f'<Coefficient time="{t}" cx="0" cy="0" cz="0" crx="{c}" cry="{c}" crz="{c}"/>'
                        for t, c in ((0, 1), (0.1, 1), (0.1000001, 0)))
        law = f'<PrescribedAcceleration ax="0" ay="0" az="0" arx="20" ary="30" arz="10">{table}</PrescribedAcceleration>'
        _, summary, status = self.go(scene([iron("brick", (8, 8, 8), (2, 3, 4), more=law)], 20.0, 0.01, (20, 20, 20)))
        energy = status["kinetic[body:brick]"][2:]
        print(f"free rotation: kinetic energy {energy[0]:.2f}, from {energy.min():.2f} to {energy.max():.2f}")
        self.assertGreater(energy[0], 100)
        self.assertLess(np.ptp(energy), 2e-3 * energy[0])
        self.assertLess(abs(summary["energy"]["dissipated_by_contact"]), 2e-3 * energy[0])

    def test_on_a_fixed_body(self):
        """A brick falls on a fixed plate: contact is inelastic, the books close, and it lies still."""
        for shape in ("linear", "QuadraticBSpline"):
            for lower in (3.0, 3.4):
                with self.subTest(shape=shape, lower=lower):
                    bodies = [iron("brick", (3, 3, lower), (3, 4, 1)), iron("plate", (1, 1, 1), (8, 8, 2), more=held())]
                    _, summary, status = self.go(scene(bodies, 1.0, 0.01, shape=shape, more=gravity(10)))
                    brick = summary["bodies"][1]
                    print(f"brick on a plate, {shape}, from {lower - 3:.1f}: velocity {np.abs(brick['velocity']).max():.1e}, lowest particles "
                          f"{brick['lower'][2] - 3.25:+.3f} above it, dissipated {summary['energy']['dissipated_by_contact']:.2f}, "
                          f"drift {summary['energy']['relative_drift']:+.1e}")
                    self.assertLess(np.abs(brick["velocity"]).max(), 0.02)
                    self.assertGreater(brick["lower"][2], 3.0)
                    self.assertGreaterEqual(summary["energy"]["dissipated_by_contact"], 0)
                    self.assertLess(abs(summary["energy"]["relative_drift"]), 0.02)
                    weight = -status["fz[contact:plate]"][-5:].mean()
                    self.assertAlmostEqual(weight / (brick["mass"] * 10), 1, delta=0.01)

    def test_pushed_by_a_driven_body(self):
        """It takes the driver's velocity: the drive gives its momentum, and as much energy as it keeps is lost in the blow."""
        bodies = [iron("ram", (2, 3, 3), (2, 4, 4), more=held(2.0)), iron("block", (4.5, 3, 3), (2, 4, 4))]
        outcome, summary, _ = self.go(scene(bodies, 0.6, 0.01))
        block, energy = summary["bodies"][2], summary["energy"]
        kinetic = 0.5 * block["mass"] * 4
        print(f"driven block pushes a free one: velocity {block['velocity'][0]:.6f}, dissipated {energy['dissipated_by_contact']:.3f} of {kinetic}")
        self.assertAlmostEqual(block["velocity"][0], 2, delta=1e-4)
        self.assertAlmostEqual(energy["dissipated_by_contact"] / kinetic, 1, delta=0.01)
        self.assertLess(abs(energy["relative_drift"]), 0.01)
        self.assertEqual(self.run_in("ranks", [self.folder / "case.xmp"], ranks=3).state, outcome.state)

    def test_two_free_bodies(self):
        """They do not act on each other: the run stops once they are in each other."""
        bodies = [iron("left", (2, 3, 3), (3, 4, 4), (1, 0, 0)), iron("right", (6, 3, 3), (3, 4, 4), (-1, 0, 0))]
        text = self.write(scene(bodies, 2.0, 0.01))
        outcome = self.run_in("meet", [text], code=_mpm.NUMERICAL_FAILURE)
        self.assertIn("'left' and 'right', both moving freely, have met and overlap", outcome.complaint)

    def test_at_a_wall(self):
        """Walls hold no free rigid body: the run stops, on all ranks with the same words. Free faces let it out."""
        body = iron("block", (2, 4, 4), (3, 3, 3), (-3, 0, 0))
        for kind in "124":
            said = set()
            for ranks in (1, 2):
                outcome = self.run_in(f"wall{kind}", [self.write(scene([body], 1.0, 0.01, faces=kind + "00000"))], ranks=ranks,
                                      code=_mpm.NUMERICAL_FAILURE)
                said.add(next(line for line in outcome.complaint.splitlines() if "has come to the grid's face XMin" in line))
            self.assertEqual(len(said), 1)
            self.assertIn("'block'", said.pop())
        self.run_in("free", [self.write(scene([body], 1.0, 0.01))])

    def test_damping(self):
        """DynamicRelax acts on it as on others: v = exp(-damping t), and the books have it."""
        body = iron("block", (4, 4, 4), (2, 3, 4), (1, 0, 0))
        _, summary, _ = self.go(scene([body], 1.0, 0.002, more='<DynamicRelax damping="2"/>'))
        self.assertAlmostEqual(summary["bodies"][1]["velocity"][0], math.exp(-2), delta=0.002)
        self.assertLess(abs(summary["energy"]["relative_drift"]), 1e-3)

    def test_erosion_by_volume(self):
        """Volume erode removes small deformable particles, and no rigid ones."""
        text = scene([_mpm.block("block", (4, 4, 4), (2, 2, 2), dp=0.25, of="iron")], 0.1, 0.01, more='<Volume erode="0.02"/>')
        _, summary, _ = self.go(text)
        self.assertEqual(summary["bodies"][1]["particles"], 512)


if __name__ == "__main__":
    _mpm.main()
