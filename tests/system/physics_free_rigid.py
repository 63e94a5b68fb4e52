"""Rigid bodies that move freely: by themselves, on other rigid bodies, at walls, and damped.

Prints what it measures."""

import math

import h5py
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


def spun_up(x, y, z):
    """An angular acceleration until t = 0.1; then the body turns by itself."""
    table = "".join(f'<Coefficient time="{t}" cx="0" cy="0" cz="0" crx="{c}" cry="{c}" crz="{c}"/>' for t, c in ((0, 1), (0.1, 1), (0.1000001, 0)))
    return f'<PrescribedAcceleration ax="0" ay="0" az="0" arx="{x}" ary="{y}" arz="{z}">{table}</PrescribedAcceleration>'


def gravity(g):
    return f'<Gravity ax="0" ay="0" az="{-g}"/>'


def on_a_base(body, end, friction=0.0, acceleration=None, shape="linear", distance="", step=None, more=()):
    """Rigid bodies alone: `body` on a fixed base whose upper face is at z = 1."""
    base = _mpm.block("base", (0, 0, 0.6), (3, 0.8, 0.4), dp=0.05, of="iron", more=held())
    grid = _mpm.grid((-1, -1, 0), (4, 1.8, 2), cell=0.1).replace("<Grid>", f'<Grid shape="{shape}">')
    gravity = "" if acceleration is None else '<Gravity ax="{}" ay="{}" az="{}"/>'.format(*acceleration)
    text = physics_rigid.scene([base, body, *more], grid, _mpm.solution(end, more=gravity), "", friction,
                               f'<Console print_time="{end / 20}"/><Restart time_interval="{end / 2}"/>', distance=distance)
    text = text.replace('mat1="soft"', 'mat1="iron"')
    return text.replace('<TimeStep factor="0.5"/>', "" if step is None else f'<TimeStep specified="{step!r}"/>')


class FreeRigid(_mpm.Case):
    def go(self, text, folder="run", **how):
        outcome = self.run_in(folder, [self.write(text)], **how)
        return outcome, _mpm.summary(self.folder / folder), _cases.status(self.folder / folder)

    def test_free_rotation(self):
        """About no principal axis: the kinetic energy is kept, and contact dissipates nothing without contact."""
        law = spun_up(20, 30, 10)
        _, summary, status = self.go(scene([iron("brick", (8, 8, 8), (2, 3, 4), more=law)], 20.0, 0.01, (20, 20, 20)))
        energy = status["kinetic[body:brick]"][2:]
        print(f"free rotation: kinetic energy {energy[0]:.2f}, from {energy.min():.2f} to {energy.max():.2f}")
        self.assertGreater(energy[0], 100)
        self.assertLess(np.ptp(energy), 2e-3 * energy[0])
        self.assertLess(abs(summary["energy"]["dissipated_by_contact"]), 2e-3 * energy[0])
        body = summary["bodies"][1]
        spin, centre = (np.array([status[f"{name}{a}[rigid:brick]"] for a in "xyz"]).T for name in "wc")
        np.testing.assert_array_equal(spin[-1], body["angular_velocity"])
        np.testing.assert_allclose(centre[-1], body["centre"], rtol=1e-9)
        rotational = 0.5 * body["mass"] / 12 * np.array([3**2 + 4**2, 2**2 + 4**2, 2**2 + 3**2])  # about the brick's own axes
        self.assertGreater(energy[-1], rotational.min() * spin[-1] @ spin[-1])
        self.assertLess(energy[-1], rotational.max() * spin[-1] @ spin[-1])

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

    def test_slides_without_friction(self):
        """On a fixed body, its edges over that one: velocity and energy stay, to round-off."""
        regression = 'contact_normal="regression" distance_type="2" min_distance="0.05"'
        block = _mpm.block("block", (0.3, 0.2, 1), (0.4, 0.4, 0.2), (3, 0, 0), 0.05, "iron")
        for shape, distance, acceleration in (("linear", "", None), ("SGMP", regression, None), ("linear", "", (0, 0, -10))):
            with self.subTest(shape=shape, distance=distance, acceleration=acceleration):
                _, summary, _ = self.go(on_a_base(block, 0.05, 0.0, acceleration, shape, distance, 1e-3))
                velocity, energy = summary["bodies"][1]["velocity"], summary["energy"]
                print(f"slides without friction, {shape}: velocity {velocity}, kinetic energy {energy['kinetic']!r}")
                self.assertLess(np.abs(np.subtract(velocity, (3, 0, 0))).max(), 1e-11)
                self.assertAlmostEqual(energy["kinetic"], 0.5 * summary["bodies"][1]["mass"] * 9, delta=1e-9)

    def test_slides_with_friction(self):
        """(F - mu N)/m from rest, with given steps and its own; and it slows down. The same bits on any ranks and from a restart."""
        for start, push, step, law in ((0, 5, 1e-3, 2), (0, 5, None, 2), (3, 0, None, -3), (0, 2, None, 0)):
            with self.subTest(start=start, push=push, step=step):
                block = _mpm.block("block", (0.3, 0.2, 1), (0.4, 0.4, 0.2), (start, 0, 0), 0.05, "iron")
                text = on_a_base(block, 0.1, 0.3, (push, 0, -10), step=step)
                one, summary, _ = self.go(text, "one")
                acceleration = (summary["bodies"][1]["velocity"][0] - start) / 0.1
                print(f"slides with friction: acceleration {acceleration:.12f}, exact {law}, {summary['steps']} steps")
                self.assertGreater(summary["steps"], 50)
                self.assertAlmostEqual(acceleration, law, delta=1e-9)
                self.assertGreaterEqual(summary["energy"]["dissipated_by_contact"], -1e-12)
        for ranks in (2, 3):
            self.assertEqual(self.run_in(f"r{ranks}", [self.folder / "case.xmp"], ranks=ranks).state, one.state)
        restart = self.folder / "one" / _mpm.restarts(self.folder / "one")[0]
        self.assertEqual(self.run_in("resumed", [restart], ranks=2).state, one.state)

    def test_topples(self):
        """A column tips over its edge, falls on its side and lies still: contact gives no energy in any row."""
        column = _mpm.block("column", (0.3, 0.2, 1), (0.2, 0.4, 0.6), dp=0.05, of="iron")
        gaps = 'distance_type="2" min_distance="0.05"'
        one, summary, status = self.go(on_a_base(column, 0.8, 1.0, (6, 0, -10), distance=gaps))
        dissipated, body = status["contact_dissipation"], summary["bodies"][1]
        print(f"topples: centre {body['centre']}, velocity {body['velocity']}, dissipated {dissipated[-1]:.3f}")
        self.assertLess(body["centre"][2], 1.15)
        self.assertLess(np.abs(body["velocity"]).max(), 1e-6)
        self.assertGreaterEqual(np.diff(dissipated).min(), -1e-9 * dissipated[-1])
        self.assertLess(abs(summary["energy"]["relative_drift"]), 1e-9)
        self.assertEqual(self.run_in("ranks", [self.folder / "case.xmp"], ranks=3).state, one.state)

    def test_pressed_from_two_sides(self):
        """No motion leaves both: the run stops and names them."""
        block = _mpm.block("block", (0.3, 0.2, 1), (0.4, 0.4, 0.2), dp=0.05, of="iron")
        lid = _mpm.block("lid", (0, 0, 1.2), (1, 0.8, 0.2), dp=0.05, of="iron", more=held(vz=-1.0))
        outcome = self.run_in("pressed", [self.write(on_a_base(block, 0.1, more=[lid]))], code=_mpm.NUMERICAL_FAILURE)
        self.assertIn("keep the free rigid body 'block' from entering the rigid bodies of prescribed motion that it touches ('base', 'lid')",
                      outcome.complaint)

    def test_all_particles_leave(self):
        """A body that flies out of the grid: the log says that nothing is left of it."""
        block = _mpm.block("block", (0.3, 0.2, 1.2), (0.4, 0.4, 0.2), (60, 0, 0), 0.05, "iron")
        outcome, _, _ = self.go(on_a_base(block, 0.1))
        self.assertIn("note       body 'block' has no particles left", outcome.out)

    def test_two_free_bodies(self):
        """They do not act on each other: the run stops once they are in each other."""
        bodies = [iron("left", (2, 3, 3), (3, 4, 4), (1, 0, 0)), iron("right", (6, 3, 3), (3, 4, 4), (-1, 0, 0))]
        text = self.write(scene(bodies, 2.0, 0.01))
        outcome = self.run_in("meet", [text], code=_mpm.NUMERICAL_FAILURE)
        self.assertIn("'left' and 'right', both moving freely, have met and overlap", outcome.complaint)

    def test_thin_free_bodies_on_planes_of_symmetry(self):
        """Quarters of bodies 1.6 cells wide: around a node on a plane only half a cell can be filled."""
        bodies = [iron("left", (2, 0, 0), (3, 0.8, 0.8), (1, 0, 0)), iron("right", (6, 0, 0), (3, 0.8, 0.8), (-1, 0, 0))]
        text = scene(bodies, 2.0, 0.01)
        for axis in "YZ":
            text = text.replace(f'<{axis}Min value="0" boundary="0"/>', f'<{axis}Min value="0" boundary="2"/>')
        outcome = self.run_in("meet", [self.write(text)], code=_mpm.NUMERICAL_FAILURE)
        self.assertIn("'left' and 'right', both moving freely, have met and overlap", outcome.complaint)

    def test_two_free_bodies_of_given_mass(self):
        """Bodies pass without touching, or stop the run where they have entered each other, whatever mass they are given."""
        for factor in (0.1, 1, 10):
            inertia = f'<RigidInertia mass="{108 * factor!r}"/>'
            with self.subTest(factor=factor):
                one = iron("one", (3, 3, 3), (3, 3, 3), more=inertia)
                self.go(scene([one, iron("two", (6.6, 3, 3), (3, 3, 3), (0, 0.1, 0), inertia)], 0.1, 0.01, (14, 12, 12)))
                outcome = self.run_in("met", [self.write(scene([one, iron("two", (7.5, 3, 3), (3, 3, 3), (-5, 0, 0), inertia)], 0.6, 0.01,
                                                               (14, 12, 12)))], code=_mpm.NUMERICAL_FAILURE)
                self.assertIn("have met and overlap", outcome.err)
                self.assertLess(_mpm.summary(self.folder / "met")["bodies"][2]["centre"][0], 8.2)

    def test_domains_turn_with_the_body(self):
        """Edges and corners of all particles as the lattice of their places has turned."""
        law = spun_up(0, 0, 50)
        for shape, first, vectors in (("CPDI", "edge_1x", 3), ("CPDI2", "corner_0x", 8)):
            with self.subTest(shape):
                text = scene([iron("brick", (6, 6, 6), (3, 3, 3), more=law)], 0.25, 0.01, (14, 14, 14), shape=shape)
                self.go(text.replace("</Output>", '<Restart time_interval="0.25"/></Output>'))
                [restart] = _mpm.restarts(self.folder / "run")
                with h5py.File(restart) as file:
                    body = file["bodies/1"]
                    names = body.attrs["columns"].decode().split()
                    rows = body["particles"][:]
                rows = rows[np.argsort(rows[:, names.index("identity")])]
                place, at = rows[:, :3] - rows[:, :3].mean(axis=0), names.index(first)
                begun = np.array([[(i % 6), (i // 6 % 6), i // 36] for i in range(216)]) * 0.5 - 1.25
                turn = np.linalg.lstsq(begun, place, rcond=None)[0].T
                np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-9)
                self.assertGreater(abs(turn[1, 0]), 0.3)
                domains = rows[:, at:at + 3 * vectors].reshape(-1, vectors, 3) @ turn  # turned back
                np.testing.assert_allclose(domains, np.broadcast_to(domains[0], domains.shape), atol=1e-9)
                np.testing.assert_allclose(np.sort(np.abs(domains[0]), axis=1)[:, -1], 0.25, atol=1e-9)

    def test_a_body_joins_at_a_restart(self):
        """The state of the others is that of the restart file: inertia as it has turned, and spin."""
        law = spun_up(100, 30, 50)
        brick = iron("brick", (8, 8, 8), (2, 3, 4), more=law + '<RigidInertia mass="100" Ixx="60" Iyy="240" Izz="250" Ixy="0" Iyz="0" Ixz="0"/>')
        texts = [scene(bodies, 0.4, 0.01, (20, 20, 20)).replace("</Output>", '<Restart time_interval="0.2"/></Output>')
                 for bodies in ([brick], [brick, iron("late", (15, 15, 15), (2, 2, 2))])]
        _, alone, _ = self.go(texts[0], "alone")
        halfway = _mpm.restarts(self.folder / "alone")[0]
        self.run_in("joined", [halfway, "-rt", self.write(texts[1], "more.xmp")])
        joined = _mpm.summary(self.folder / "joined", "more")
        self.assertEqual(joined["bodies"][1]["angular_velocity"], alone["bodies"][1]["angular_velocity"])
        self.assertEqual(joined["bodies"][1]["kinetic"], alone["bodies"][1]["kinetic"])
        self.assertGreater(joined["bodies"][1]["kinetic"], 1000)

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
