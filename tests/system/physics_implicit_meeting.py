"""Contact of deformable components with each other in implicit steps: against exact solutions, on any ranks, through a restart."""

import numpy as np

import _cases
import _mpm

YOUNG, POISSON = 1000.0, 0.3


def law(name, young=YOUNG, density=1.0):
    return _mpm.material(name, density, f'type="NeoHookean" Young="{young}" Poisson="{POISSON}"')


def scene(components, faces, grid, materials=(law("soft"), law("hard", 4 * YOUNG)), friction=0.0, kind="quasistatic", end=1.0, steps=1,
          shape="linear", more="", contact='enable="1"', output=""):
    """`components`: the bodies of each. Friction is that of the materials soft and hard."""
    solution = _mpm.solution(end, attributes='Integration="impl"', more=f'<Implicit type="{kind}" time_step="{end / steps}" {more}/>')
    rub = _mpm.friction("soft", "hard", friction) if friction else ""
    others = "".join(f'<Component name="c{i}">{bodies}</Component>\n' for i, bodies in enumerate(components[1:]))
    text = _mpm.scene([components[0]], _mpm.grid(*grid, faces).replace("<Grid>", f'<Grid shape="{shape}">'),
                      solution.replace('<TimeStep factor="0.5"/>', ""), list(materials), output,
                      f'<Contact {contact} record_contact_force="1"/>{rub}')
    return text.replace("<Grid ", others + "<Grid ", 1)


def stack(pressure, top="hard", size=3.0, below=2.0, above=2.0):
    """A block on another, both a quarter of the whole, and a pressure on top."""
    table = '<Coefficient time="0" c="0"/><Coefficient time="1" c="1"/>'
    load = f'<Traction tz="{-pressure}" normal="2" zmin="{below + above - 0.5}">{table}</Traction>'
    return [_mpm.block("low", (0, 0, 0), (size, size, below)),
            _mpm.block("top", (0, 0, below), (size, size, above), of=top, more=load)]


STRESS = '<PostProcessing time_interval="1" h5part="1" var="SigmaZ"/>'
ROOM = ((0, 0, 0), (7, 7, 7))
ELASTIC = (law("soft"), law("hard", 3 * YOUNG, 2.0))


@_mpm.needs_implicit_steps
class Meeting(_mpm.Case):
    def summary(self, folder):
        return _mpm.summary(self.folder / folder)

    def body(self, folder, name):
        return next(b for b in self.summary(folder)["bodies"] if b["name"] == name)

    def forces(self, folder, pair="1,2"):
        """On the second component, a row per step."""
        table = _mpm.table(self.folder / folder / "case_curv.dat")
        return np.array([table[f"contact_{axis}[{pair}]"] for axis in "xyz"]).T

    def picture(self, folder):
        states = _cases.States(self.folder / folder)
        return np.array([states.column(axis) for axis in "xyz"]), states.column("SigmaZ")

    def test_blocks_on_each_other_are_in_uniaxial_stress(self):
        """sigma = - P (1 - 2 nu P/E): the sides expand. With one field for both the harder one holds the softer one's sides."""
        pressure = 10.0
        for hard in (YOUNG, 4 * YOUNG):
            with self.subTest(young=hard):
                folder = f"stack{hard}"
                self.run_in(folder, [self.write(scene(stack(pressure), "202020", ROOM, (law("soft"), law("hard", hard)), output=STRESS))])
                self.assertLess(abs(self.forces(folder)[-1][2] / (9 * pressure) - 1), 1e-6)
                _, stress = self.picture(folder)
                low = np.arange(stress.size) < stress.size / 2  # as many particles in both
                for young, mine in ((YOUNG, stress[low]), (hard, stress[~low])):
                    np.testing.assert_allclose(mine, -pressure * (1 - 2 * POISSON * pressure / young), rtol=1e-3)

    def test_blocks_of_one_material_move_as_one_block(self):
        """With all shape functions: pictures have single precision. Splines enter the body by one node more; the mean gradients of DDMP are
        those of one block or of two."""
        for shape, error in (("linear", 2e-5), ("CPDI2", 2e-5), ("QuadraticBSpline", 3e-4), ("DDMP", 6e-4)):
            with self.subTest(shape=shape):
                places = []
                for name, bodies, contact in (("two", stack(10.0, "soft"), 'enable="1"'), ("one", ["".join(stack(10.0, "soft"))], 'enable="0"')):
                    text = scene(bodies, "202020", ROOM, shape=shape, contact=contact, output=STRESS)
                    self.run_in(name + shape, [self.write(text)])
                    places.append(self.picture(name + shape)[0])
                # Of 0.04 that the top moves.
                self.assertLess(np.abs(places[0] - places[1]).max(), error)

    def test_sides_do_not_plough_where_wide_functions_reach_beyond_faces(self):
        """A short block slides on a slab by its weight, (g_x - mu g_z) t: nodes above the slab's face, ahead of the block's front and
        behind its back, and nodes inside the slab are reached by both. Without these forces along x, which took 10 to 35 % of it."""
        slides, weighs, end = 5.0, 8.0, 0.5
        bodies = (_mpm.block("slab", (0, 0, 0), (14, 1, 2), of="hard"), _mpm.block("block", (5, 0, 2), (3, 1, 2)))
        materials = [_mpm.material(name, 1000, f'type="IsoElastic" Young="{young}" Poisson="0.2"') for name, young in (("soft", 1e7), ("hard", 1e8))]
        for shape, friction in (("QuadraticBSpline", 0.0), ("QuadraticBSpline", 0.3), ("CubicBSpline", 0.0), ("SGMP", 0.0)):
            with self.subTest(shape=shape, friction=friction):
                text = scene(bodies, "002210", ((-2, 0, 0), (16, 1, 8)), materials, friction, "dynamic", end, 25, shape)
                text = text.replace("<Implicit", f'<Gravity ax="{slides}" ay="0" az="{-weighs}"/><Implicit')
                self.run_in("slide", [self.write(text)])
                self.assertAlmostEqual(self.body("slide", "block")["velocity"][0], (slides - friction * weighs) * end, delta=2e-3)

    def test_blocks_that_are_pulled_apart_exert_no_force(self):
        """By a load that grows, to 90: in each step they part further. With splines nodes a cell beyond a face, which hardly any particle
        feels, move a little against it."""
        for shape, most in (("linear", 0), ("DDMP", 0), ("QuadraticBSpline", 90e-4)):
            with self.subTest(shape=shape):
                pulled = [_mpm.block("low", (0, 0, 0), (3, 3, 2), more='<BodyForce bz="-5*t"/>'),
                          _mpm.block("top", (0, 0, 2), (3, 3, 2), of="hard", more='<BodyForce bz="5*t"/>')]
                self.run_in(shape, [self.write(scene(pulled, "202022", ((0, 0, 0), (7, 7, 4)), steps=3, shape=shape))])
                self.assertLessEqual(np.abs(self.forces(shape)).max(), most)

    def test_the_gap_at_which_blocks_touch(self):
        """A block, led at its top, comes down on another, whose face is at a node, in steps of a tenth of a cell, presses, and goes up again.
        They touch across a gap of 0.7 cells, with splines of 1.2; pressed, faces are nearer by what the particles beside them are compressed;
        and no force holds the block that leaves."""
        way, down = 0.1, 8
        for shape, start, touches in (("linear", 1.05, 0.7), ("QuadraticBSpline", 1.45, 1.2)):
            with self.subTest(shape=shape):
                speed = f"t &lt; 0.5 ? {-2 * way * down} : {2 * way * down}"
                bodies = [_mpm.block("base", (1, 1, 0), (3, 3, 2)),
                          _mpm.block("block", (1, 1, 2 + start), (3, 3, 2))
                          + _mpm.block("grip", (1, 1, 4 + start), (3, 3, 1), more=f'<PrescribedVelocity vx="0" vy="0" vz="{speed}"/>')]
                output = f'<PostProcessing time_interval="{0.5 / down}" h5part="1" var="SigmaZ"/>'
                self.run_in(shape, [self.write(scene(bodies, "000010", ((0, 0, 0), (5, 5, 8)), steps=2 * down, shape=shape, output=output))])
                states = _cases.States(self.folder / shape)
                force, first = self.forces(shape)[:, 2], states.column("z", 0)
                low, high = first == first[first < 2].max(), first == first[first > 2].min()
                gap = np.array([z[high].mean() - z[low].mean() - 0.5 for z in (states.column("z", i) for i in range(len(states.steps)))])
                print(f"gap, {shape}: {gap.round(3)}, forces {force.round(3)}")
                touched = np.flatnonzero(force > 1e-6)[0]
                self.assertLess(abs(gap[touched] - touches), 0.1)
                self.assertGreater(gap.min(), 0.6 * touches)
                self.assertEqual(gap.argmin(), force.argmax())
                self.assertGreaterEqual(force.min(), -1e-6 * force.max())
                np.testing.assert_allclose(force[gap > gap[touched - 1] + 0.02], 0, atol=1e-6 * force.max())

    def test_sliding_friction_is_coulombs(self):
        """A block, led at its top, presses and drags on a larger one, along a direction off the axes. Its edges do not plough:
        without friction there is no force along the surface."""
        along = np.array([0.8, 0.6])
        for name, friction, way in (("smooth", 0.0, 0.4), ("slides", 0.3, 0.4), ("sticks", 0.3, 0.002)):
            with self.subTest(name=name):
                grip = '<PrescribedVelocity vx="{}" vy="{}" vz="-0.02"/>'.format(*(way * along))
                bodies = [_mpm.block("base", (1, 1, 0), (7, 7, 2)),
                          _mpm.block("slider", (3, 3, 2), (3, 3, 2), of="hard") + _mpm.block("grip", (3, 3, 4), (3, 3, 1), of="hard", more=grip)]
                self.run_in(name, [self.write(scene(bodies, "000010", ((0, 0, 0), (10, 10, 7)), friction=friction, steps=5))])
                for force in self.forces(name)[1:]:
                    self.assertGreater(force[2], 0)
                    ratio = np.hypot(*force[:2]) / force[2]
                    if name == "slides":  # friction settles to a thousandth
                        self.assertLess(abs(ratio / friction - 1), 1e-3)
                        np.testing.assert_allclose(-force[:2] / np.hypot(*force[:2]), along, atol=1e-2)
                    else:
                        self.assertLess(ratio, 0.5 * friction if friction else 1e-6)
                self.assertLess(abs(self.summary(name)["energy"]["relative_drift"]), 0.02)
                if name == "slides":
                    self.assertGreater(self.summary(name)["energy"]["dissipated_by_contact"], 0)

    def test_collisions_keep_momentum(self):
        """Two blocks of different mass, and three of which one is hit at its edge, so that three components share nodes: momentum,
        and impulses as recorded, to the tolerance of Newton's method. The energy does not grow; FLIP loses a part of it."""
        def block(name, lower, velocity, of="soft"):
            return _mpm.block(name, lower, (3, 3, 3), velocity, of=of)
        two = [block("left", (2, 3, 3), (0.2, 0.03, 0)), block("right", (5, 3, 3), (-0.1, 0, 0), "hard")]
        three = [block("left", (2, 3, 3), (0.2, 0.03, 0)), block("right", (5, 2, 3), (-0.1, 0.05, 0), "hard"), block("back", (5, 5, 3), (-0.1, -0.05, 0), "hard")]
        for name, blocks in (("two", two), ("three", three)):
            for friction in (0.0, 0.3):
                with self.subTest(name=name, friction=friction):
                    folder = f"{name}{friction}"
                    text = scene(blocks, "000000", ((-1, 0, 0), (12, 10, 9)), ELASTIC, friction, "dynamic", 0.5, 20, more='rtol="1e-11"')
                    self.run_in(folder, [self.write(text)])
                    end = {b["name"]: np.array(b["velocity"]) for b in self.summary(folder)["bodies"]}
                    change = {n: (27 if n == "left" else 54) * (v - start) for (n, v), start in zip(
                        end.items(), ([0.2, 0.03, 0], [-0.1, 0.05 * (name == "three"), 0], [-0.1, -0.05, 0]))}
                    self.assertLess(change["left"][0], -1)  # it is thrown back
                    np.testing.assert_allclose(sum(change.values()), 0, atol=1e-8)  # of 5.4 that the left one has
                    on_left = -sum(self.forces(folder, f"1,{k}").sum(axis=0) for k in range(2, len(blocks) + 1)) * 0.5 / 20
                    np.testing.assert_allclose(on_left, change["left"], atol=1e-8)
                    self.assertLess(self.summary(folder)["energy"]["relative_drift"], 1e-3)

    def test_ranks_and_restart_agree_to_the_tolerance(self):
        bodies = [_mpm.block("base", (1, 1, 0), (7, 7, 2)),
                  _mpm.block("slider", (3, 3, 2), (3, 3, 2), of="hard")
                  + _mpm.block("grip", (3, 3, 4), (3, 3, 1), of="hard", more='<PrescribedVelocity vx="0.2" vy="0.1" vz="-0.1"/>')]
        output = STRESS + '<Restart time_interval="0.5"/>'
        for friction, error in ((0.0, 1e-5), (0.4, 2e-3)):  # friction settles to a thousandth of all of it
            text = scene(bodies, "000010", ((0, 0, 0), (10, 10, 7)), friction=friction, steps=4, more='rtol="1e-10"', output=output)
            places = {}
            for ranks in (1, 2, 3):
                self.run_in(f"{friction}-{ranks}", [self.write(text)], ranks=ranks)
                places[ranks] = self.picture(f"{friction}-{ranks}")[0]
            self.run_in(f"{friction}-again", [_mpm.restarts(self.folder / f"{friction}-1")[0]], ranks=2)
            places["again"] = self.picture(f"{friction}-again")[0]
            for name, found in places.items():
                with self.subTest(run=name, friction=friction):
                    self.assertLess(np.abs(found - places[1]).max(), error)

    def test_with_a_rigid_body_averages_and_other_rules(self):
        """A rigid plate on a block on a block; volume changes are averaged. The plate's force passes through both."""
        plate = _mpm.block("plate", (0, 0, 4), (6, 6, 2), of="ram", more='<PrescribedVelocity vx="0" vy="0" vz="-0.02"/>')
        low, top = _mpm.block("low", (0, 0, 0), (3, 3, 2)), _mpm.block("top", (0, 0, 2), (3, 3, 2), of="hard")
        text = scene([low, top, plate], "202020", ROOM, (law("soft"), law("hard", 4 * YOUNG), _mpm.material("ram", 1.0, 'type="Rigid"')), steps=2)
        averaged = text.replace("<Implicit ", '<Volumetric averaging="cell"/><Implicit ')
        for name, each in (("plain", text), ("averaged", averaged), ("matrixfree", text.replace("<Implicit ", '<Implicit jacobian="matrixfree" '))):
            with self.subTest(name=name):
                self.run_in(name, [self.write(each)])
                below, above = self.forces(name)[-1], self.forces(name, "2,3")[-1]
                # 0.02 on 2 of E and 2 of 4 E.
                self.assertLess(abs(below[2] / (9 * 0.02 / (2 / YOUNG + 2 / (4 * YOUNG))) - 1), 0.03)
                self.assertLess(abs(below[2] / above[2] - 1), 1e-4)

    def test_weight_works_on_blocks_on_each_other(self):
        """Put on in one step it works with half of its force: what the blocks store, as without contact."""
        blocks = [_mpm.block("low", (1, 1, 0), (2, 2, 2)), _mpm.block("up", (1, 1, 2), (2, 2, 2))]
        weight = '<Gravity ax="0" ay="0" az="-5"/>'
        for shape in ("linear", "QuadraticBSpline"):
            with self.subTest(shape):
                text = scene(blocks, "222220", ((0, 0, 0), (4, 4, 8)), steps=2, shape=shape)
                self.run_in(shape, [self.write(text.replace("</Solution>", weight + "</Solution>"))])
                energy = self.summary(shape)["energy"]
                self.assertGreater(energy["internal"], 0.5)
                self.assertLess(abs(energy["relative_drift"]), 0.03)

    def test_what_contact_cannot_do_is_refused(self):
        base = scene(stack(10.0), "202020", ROOM)
        for change, words in ((('type="quasistatic"', 'type="semi"'), ["semi-implicit"]),
                              (('<Contact enable="1"', '<Contact enable="1" distance_type="1" min_distance="0.5" contact_normal="regression" '
                                'contact_time_step="1" failure_to_component="1"'), ["distance_type", "contact_normal", "contact_time_step"])):
            code = _mpm.run([self.write(base.replace(*change))], program="mpm_check")
            self.assertEqual(code.code, _mpm.INPUT_ERROR)
            for word in words:
                self.assertIn(word, code.out + code.err)


if __name__ == "__main__":
    _mpm.main()
