"""Ogive and Bool bodies run: the same bits on one and two ranks, the masses of their shapes, and bad shapes at once."""

import math

import _mpm
from _mpm import INPUT_ERROR, Case

COPPER = _mpm.material("copper", 8.93e-3, 'type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="400" TangMod="100"',
                       '<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>')
VELOCITY = '<InitialVelocity vx="0" vy="0" vz="{}"/>'
NOSE = ('<Body name="nose" material="copper" type="Ogive" workPlane="down"><Geometry dp_bottom="0.4" dp_top="0.4" '
        'x0="0" y0="0" z0="0" Ogive_Radius="6" End_Radius="2.5"/>' + VELOCITY.format(-300) + "</Body>")
BLOCK = ('<Body name="solid" material="copper" type="Block" ForBoolBody="1"><Geometry dp="0.4" x0="0" y0="0" z0="0.8" '
         'lx="12" ly="12" lz="4"/></Body>')
BORE = ('<Body name="bore" material="copper" type="Cylinder" ForBoolBody="1"><Geometry dp_bottom="0.4" dp_top="0.4" '
        'x0="6" y0="6" z0="0" Bottom_Outer_Radius="2" Top_Outer_Radius="2" height="6"/></Body>')
TARGET = '<Body name="target" material="copper" type="Bool" BoolType="subtract" BoolBodyA="solid" BoolBodyB="{}"/>'
PLANE = '<WorkPlane name="down" r0x="6" r0y="6" r0z="10.4" ez="-1"/>'


def scene(bore="bore", nose=NOSE):
    return _mpm.scene([nose, BLOCK, BORE, TARGET.format(bore)], _mpm.grid((0, 0, 0), (12, 12, 16)),
                      _mpm.solution(0.004, "MUSL", 0.5), [COPPER], '<Console print_time="0.001"/>').replace(
                          "<Component", PLANE + "<Component", 1)


class Shapes(Case):
    def state(self, folder, **more):
        return self.run_in(folder, [self.folder / "case.xmp"], **more).state

    def test_same_bits_and_the_masses_of_the_shapes(self):
        self.write(scene())
        alone = self.state("alone")
        self.assertEqual(self.state("two", ranks=2), alone)
        self.assertEqual(self.state("threads", threads=2), alone)
        nose, target = _mpm.summary(self.folder / "alone")["bodies"]
        arc, base = 6, 2.5
        offset, length = arc - base, math.sqrt(base * (2 * arc - base))
        exact = math.pi * (length * (arc**2 + offset**2 - length**2 / 3)
                           - offset * (length * offset + arc**2 * math.asin(length / arc)))
        # A share of the particles, that on the surface, is counted or not: dp over the radius.
        self.assertAlmostEqual(nose["mass"] / (8.93e-3 * exact), 1, delta=0.05)
        self.assertAlmostEqual(target["mass"] / (8.93e-3 * (12 * 12 * 4 - math.pi * 4 * 4)), 1, delta=0.01)
        self.assertGreater(target["max_epef"], 0, "the nose strikes the rim of the bore")

    def test_restart(self):
        self.write(scene())
        alone = self.state("alone")
        self.run_in("stopped", [self.folder / "case.xmp", "--max-wall-time", "1e-9"], code=_mpm.STOPPED)
        self.assertEqual(self.run_in("stopped", [self.folder / "stopped/case.pe"]).state, alone)

    def test_restart_with_another_input(self):
        """Operands are compared by their names: another order is the same case, another bore is not."""
        self.write(scene())
        alone = self.state("alone")
        self.run_in("stopped", [self.folder / "case.xmp", "--max-wall-time", "1e-9"], code=_mpm.STOPPED)
        restart = next((self.folder / "stopped").glob("case_*.pe"))
        moved = self.write(scene().replace(BORE, "").replace("<Body", BORE + "<Body", 1), "moved.xmp")
        outcome = self.run_in("moved", [restart, "-rt", moved])
        self.assertEqual(outcome.state, alone)
        self.assertIn("particles keep their state", outcome.out)
        wide = self.write(scene().replace('Bottom_Outer_Radius="2"', 'Bottom_Outer_Radius="2.4"'), "wide.xmp")
        outcome = self.run_in("wide", [restart, "-rt", wide], code=INPUT_ERROR)
        self.assertIn('<Body name="bore">: differs from the input of the restart file', outcome.err)
        other = self.write(scene().replace('"bore"', '"hole"'), "other.xmp")
        outcome = self.run_in("other", [restart, "-rt", other], code=INPUT_ERROR)
        self.assertIn('<Body name="target">: differs from the input of the restart file', outcome.err)

    def test_wrong_shapes_come_at_once_in_both_programs(self):
        self.write(scene("solid", NOSE.replace('Ogive_Radius="6"', 'Ogive_Radius="2"')))
        for outcome in (_mpm.run([self.folder / "case.xmp"], program="mpm_check"),
                        self.run_in("out", [self.folder / "case.xmp"], code=INPUT_ERROR),
                        self.run_in("out", [self.folder / "case.xmp"], ranks=2, code=INPUT_ERROR)):
            self.assertEqual(outcome.code, INPUT_ERROR, outcome)
            self.assertEqual(outcome.err.count('<Geometry Ogive_Radius="2">: expected at least End_Radius, 2.5'), 1, outcome)
            self.assertEqual(outcome.err.count('<Body BoolBodyB="solid">: the body has no particles'), 1, outcome)

    def test_a_large_bool_body_of_which_nothing_is_left(self):
        """Too large to be tried while the input is read."""
        solid = BLOCK.replace('dp="0.4"', 'dp="0.05"')
        self.write(scene("solid").replace(BLOCK, solid))
        for outcome in (_mpm.run([self.folder / "case.xmp"], program="mpm_check"),
                        self.run_in("out", [self.folder / "case.xmp"], ranks=2, code=INPUT_ERROR)):
            self.assertEqual(outcome.code, INPUT_ERROR, outcome)
            self.assertEqual(outcome.err.count('<Body BoolBodyB="solid">: body `target`: the body has no particles'), 1,
                             outcome)


if __name__ == "__main__":
    _mpm.main()
