"""Normals of contact where gradients of mass have none: at edges and on curved surfaces of rigid bodies, in the middle of plates of two
cells, in bodies that overlap.

Prints what it measures."""

import _mpm
import numpy as np
from _contact import SHARED_NODE, SURFACES

BASE, TOP = "base", "top"


def scene(base, top, grid, solution, distance=SURFACES, friction=0.0, rigid=(), weights=(0, 0), shape="linear", normal="automatic"):
    """Two components; bodies named in `rigid` are, the others elastic."""
    materials = "".join(_mpm.material(name, 1000.0, 'type="Rigid"' if name in rigid else 'type="IsoElastic" Young="1e7" Poisson="0.2"')
                        for name in (BASE, TOP))
    rubs = _mpm.friction("base", "top", friction)
    components = "".join(f'<Component name="{name}" normal_vector_weight="{weight}">{body}</Component>'
                         for name, body, weight in ((BASE, base, weights[0]), (TOP, top, weights[1])))
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', '<PeneBlast version="1.0">', materials, rubs, components,
                      grid.replace("<Grid>", f'<Grid shape="{shape}">'),
                      f'<Contact enable="1" contact_type="1" {distance} contact_normal="{normal}"/>', solution,
                      '<Output><Console print_time="1"/></Output>', "</PeneBlast>", ""])


def sliding(friction, end=0.1, ball=False, **more):
    """A free rigid block, or ball, at 3 m/s on a wider elastic base."""
    velocity = (3, 0, 0)
    top = _mpm.block(TOP, (0.3, 0.2, 0.4), (0.4, 0.4, 0.2), velocity, 0.05, TOP)
    if ball:
        top = (f'<Body name="top" material="top" type="Sphere"><Geometry x0="0.5" y0="0.4" z0="0.6" Outer_Radius="0.2" dp="0.05" '
               'discretization="0"/><InitialVelocity vx="3" vy="0" vz="0"/></Body>')
    return scene(_mpm.block(BASE, (0, 0, 0), (1.4, 0.8, 0.4), dp=0.05, of=BASE), top,
                 _mpm.grid((-0.4, 0, 0), (1.8, 0.8, 1.2), "000010", 0.1),
                 _mpm.solution(end, more='<Gravity ax="0" ay="0" az="-10"/>'), friction=friction, rigid=(TOP,), **more)


def on_a_plate(friction, end=0.3, cell=(0.1, 0.1, 0.1), held='<PrescribedVelocity vx="0" vy="0" vz="0"/>', **more):
    """An elastic block on a plate that is two cells thick and held, under a body force with a slope of a half."""
    x, y, z = cell
    text = scene(_mpm.block(BASE, (0, 0, 4 * z), (1.2, 0.8, 2 * z), dp=min(cell) / 2, of=BASE, more=held),
                 _mpm.block(TOP, (0.3, 0.2, 6 * z), (0.4, 0.4, 2 * z), dp=min(cell) / 2, of=TOP),
                 _mpm.grid((-0.4, 0, 0), (2, 0.8, 14 * z), "000000", 0.1),
                 _mpm.solution(end, more='<Gravity ax="5" ay="0" az="-10"/>'), friction=friction, **more)
    text = text.replace('<DCell dx="0.1" dy="0.1" dz="0.1"/>', f'<DCell dx="{x}" dy="{y}" dz="{z}"/>')
    return text.replace('Young="1e7"', 'Young="1e6"')


def overlapping(mirrored, **more):
    """Two blocks of which one begins two cells within the other; or the same seen in a mirror."""

    def block(name, lower, speed, across):
        size = (0.6, 0.4, 0.4)
        if mirrored:
            lower, speed = (3 - lower - size[0]), -speed
        return _mpm.block(name, (lower, 0.4, 0.4), size, (speed, across, 0), 0.05, name)

    return scene(block(BASE, 1.0, 1, 0.3), block(TOP, 1.4, -1, 0), _mpm.grid((0, 0, 0), (3, 1.2, 1.2), cell=0.1), _mpm.solution(0.02),
                 distance=SHARED_NODE, friction=0.2, **more)


def between_walls(halves):
    """A block strikes another one that is a cell wide, at the middle of a grid of two cells between symmetry planes; or this and its mirror
    image beyond one of the planes."""
    base = "".join(_mpm.block(f"{BASE}{i}", (0.2, lower, 0.2), (0.4, 0.1, 0.2), dp=0.05, of=BASE) for i, lower in enumerate((0, 0.3)[:halves]))
    top = _mpm.block(TOP, (0.3, 0, 0.42), (0.4, 0.2 * halves, 0.2), (1, 0, -5), 0.05, TOP)
    return scene(base, top, _mpm.grid((0, 0, 0), (1, 0.2 * halves, 1), "002200", 0.1), _mpm.solution(0.02), friction=0.2, normal="regression")


class Normals(_mpm.Case):
    def go(self, text, folder="run", **how):
        outcome = self.run_in(folder, [self.write(text)], **how)
        return outcome.state, _mpm.summary(self.folder / folder)

    def test_rigid_block_on_a_wider_base(self):
        """Its velocity along the base is 3 - mu g t: neither its edges nor a ball's curve hold it. The weights of others change nothing."""
        for friction, more in ((0, {}), (0, {"distance": SHARED_NODE, "normal": "regression"}), (0, {"weights": (1, 0)}), (0, {"ball": True}),
                               (0.3, {"shape": "SGMP"})):
            with self.subTest(friction=friction, more=more):
                _, summary = self.go(sliding(friction, **more))
                velocity, drift = summary["bodies"][1]["velocity"], summary["energy"]["relative_drift"]
                print(f"rigid body on a base, mu {friction} {more}: velocity {velocity[0]:.4f} and {velocity[2]:+.4f}, drift {drift:+.1e}")
                self.assertAlmostEqual(velocity[0], 3 - friction, delta=0.03)
                self.assertLess(abs(velocity[2]), 0.06)
                self.assertLess(abs(drift), 5e-3)

    def test_given_weight_of_a_rigid_body(self):
        """Where it has been given the larger weight its gradients decide, which tilt at its edges."""
        _, summary = self.go(sliding(0, weights=(0, 1)))
        self.assertLess(summary["bodies"][1]["velocity"][0], 1)

    def test_plate_of_two_cells(self):
        """At the nodes in its middle the plate's gradient is round-off: whatever decides, the block slides with g_t - mu g_n."""
        for friction, more in ((0, {"rigid": (BASE,)}), (0, {"rigid": (BASE,), "normal": "mass_gradient"}),
                               (0.3, {"rigid": (BASE,), "distance": SHARED_NODE, "normal": "mass_gradient"}),
                               (0.3, {"rigid": (BASE,), "shape": "QuadraticBSpline"}), (0, {"weights": (1, 0)}),
                               (0, {"weights": (1, 0), "normal": "mass_gradient", "cell": (0.1, 0.1, 0.05)})):
            more = {"shape": "SGMP", **more}
            with self.subTest(friction=friction, more=more):
                _, summary = self.go(on_a_plate(friction, **more))
                top, drift = summary["bodies"][1], summary["energy"]["relative_drift"]
                found = top["velocity"][0] / 0.3
                print(f"plate of two cells, mu {friction} {more}: acceleration {found:.4f} of {5 - 10 * friction:.0f}, drift {drift:+.1e}")
                self.assertAlmostEqual(found, 5 - 10 * friction, delta=0.05)
                self.assertLess(abs(drift), 0.01)

    def test_node_between_two_walls(self):
        """Its cloud of particles has an image in both: what is beyond one of them alone would turn the normal."""
        half, whole = (self.go(between_walls(halves), str(halves))[1] for halves in (1, 2))
        for name in ("kinetic", "internal"):
            off = 2 * half["energy"][name] / whole["energy"][name] - 1
            print(f"between two walls: {name} energy off by {off:.1e}")
            self.assertLess(abs(off), 1e-10)

    def test_mirror_images_of_bodies_that_overlap(self):
        """They differ by round-off, whatever gives the normals."""
        for more in ({"normal": "mass_gradient"}, {"weights": (1, 0)}, {"rigid": (TOP,)}, {"rigid": (TOP,), "normal": "mass_gradient"}):
            with self.subTest(more=more):
                velocities = []
                for mirrored in (False, True):
                    _, summary = self.go(overlapping(mirrored, **more))
                    velocities.append(np.array([body["velocity"] for body in summary["bodies"]]) * ((-1 if mirrored else 1), 1, 1))
                apart = np.abs(velocities[0] - velocities[1]).max()
                print(f"overlap and its mirror image, {more}: velocities differ by {apart:.1e} of {np.abs(velocities[0]).max():.2f}")
                self.assertGreater(np.abs(velocities[0][0] - (1, 0.3, 0)).max(), 0.1)
                self.assertLess(apart, 1e-10)

    def test_same_bits(self):
        """On several ranks, where one component decides and particles give its missing normals."""
        text = on_a_plate(0.3, 0.05, weights=(1, 0), shape="SGMP", normal="mass_gradient")
        self.assertEqual(self.go(text, "one")[0], self.go(text, "three", ranks=3)[0])


if __name__ == "__main__":
    _mpm.main()
