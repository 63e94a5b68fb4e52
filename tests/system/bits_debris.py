"""A body that flies apart into lone particles, so that most bricks hold few of them: the same bits on any ranks and threads and across
a restart, exact momentum, and those of a run that treats every brick as full."""

import _mpm
from _mpm import Case

END = 0.3
SOFT = _mpm.material("soft", 1.0, 'type="IsoElastic" Young="2" Poisson="0.3"')
SHAPES = ("linear", "uGIMP", "QuadraticBSpline", "CubicBSpline", "SGMP")


def scene(shape, algorithm, more=""):
    """Each particle with the velocity of its place from (14, 13, 12), and a part that differs between neighbours."""
    velocity = [f"20*({axis}-{middle})+9*sin({n + 5}*({other}-{middle}))"
                for n, (axis, other, middle) in enumerate((("x", "y", 14), ("y", "z", 13), ("z", "x", 12)))]
    body = _mpm.block("cloud", (12.6, 11.7, 10.8), (3, 3, 3), velocity, 0.5, more=more)
    end = f'<Console print_time="{END / 3}"/><Restart time_interval="{END / 2}"/>'
    return _mpm.scene([body], _mpm.grid((-10, -10, -10), (40, 40, 40)).replace("<Grid>", f'<Grid shape="{shape}">'),
                      _mpm.solution(END, algorithm, 0.2), [SOFT], end)


class Debris(Case):
    def test_same_bits(self):
        for n, (shape, algorithm) in enumerate([*((shape, "MUSL") for shape in SHAPES), ("linear", "USF"), ("SGMP", "USF"),
                                                ("linear", "USL"), ("SGMP", "USL"), ("linear", "USAVG"), ("SGMP", "USAVG")]):
            with self.subTest(shape=shape, algorithm=algorithm):
                path = self.write(scene(shape, algorithm))
                alone = self.run_in(f"alone{n}", [path]).state
                ranks, threads = (3, 1) if n % 2 else (2, 2)
                self.assertEqual(self.run_in(f"other{n}", [path], ranks=ranks, threads=threads).state, alone)
                halfway = _mpm.restarts(self.folder / f"other{n}")[0]
                self.assertEqual(self.run_in(f"again{n}", [halfway]).state, alone)
                status = _mpm.table(self.folder / f"alone{n}" / "case.sta")
                for axis in "xyz":
                    self.assertLess(abs(status[f"p{axis}"][-1] - status[f"p{axis}"][0]), 1e-11)

    def test_a_brick_is_as_if_it_were_full(self):
        """Loads make every brick full, as their forces act on all nodes; here they are zero."""
        load = '<BodyForce bx="0" by="0" bz="0*t"/>'
        for shape in SHAPES:
            with self.subTest(shape=shape):
                for folder, more in (("few", ""), ("full", load)):
                    self.run_in(f"{folder} {shape}", [self.write(scene(shape, "MUSL", more))])
                few, full = (_mpm.summary(self.folder / f"{folder} {shape}") for folder in ("few", "full"))
                self.assertEqual(few["steps"], full["steps"])
                self.assertGreater(few["bodies"][0]["upper"][0], 20, "it flies apart")
                for key in ("kinetic", "internal"):
                    self.assertAlmostEqual(few["energy"][key] / full["energy"][key], 1, delta=1e-9)


if __name__ == "__main__":
    _mpm.main()
