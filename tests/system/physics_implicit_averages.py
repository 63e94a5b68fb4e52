"""Volumes averaged over cells in implicit steps: no locking, and Newton's order."""

import math

import _cases
import _mpm
from _implicit import RAM, YOUNG, implicit, residuals


@_mpm.needs_implicit_steps
class Averaged(_mpm.Case):
    """Volume changes averaged over cells, against locking."""

    def bend(self, folder, poisson, averaging="cell", shape="linear", ranks=1, threads=1, material=None, load=1e-3):
        """A plate in plane strain, 2 wide and 8 high, clamped below and bent by a load on its upper eighth: how far that
        moves, and the residuals of the steps."""
        plate = _mpm.block("plate", (0, 0, 0), (1, 2, 8),
                           more=f'<BodyForce bx="0" by="Z&gt;7 ? {load * YOUNG!r}*t : 0" bz="0"/>')
        material = material or _mpm.material("soft", 1.0, f'type="NeoHookean" Young="{YOUNG}" Poisson="{poisson}"')
        text = _mpm.scene([plate], _mpm.grid((0, -2, 0), (1, 6, 10), "220010").replace("<Grid>", f'<Grid shape="{shape}">'),
                          implicit(1.0, step=0.5, more='rtol="1e-9"', extra=f'<Volumetric averaging="{averaging}"/>'),
                          [material], '<PostProcessing time_interval="1" h5part="1" var="pres"/>')
        self.run_in(folder, [self.write(text)], ranks=ranks, threads=threads)
        states = _cases.States(self.folder / folder)
        moved = states.column("y") - states.column("y", 0)
        return moved[states.column("z", 0) > 7].mean(), residuals(self.folder / folder)

    def test_bending_does_not_lock(self):
        """Over what it is at Poisson's ratio 0.3: the modulus of bending in plane strain, E/(1 - nu^2), is 1.21 times as large at
        0.4999, 1/1.21 = 0.82, and a coarse grid of functions with kinks is stiffer at any ratio."""
        soft, _ = self.bend("compressible", 0.3)
        for shape in ("linear", "QuadraticBSpline", "CPDI2"):
            with self.subTest(shape=shape):
                self.assertGreater(self.bend("averaged", 0.4999, shape=shape)[0] / soft, 0.75)
        self.assertLess(self.bend("locked", 0.4999, "none")[0] / soft, 0.3)

    def test_newton_converges_quadratically(self):
        laws = {"NeoHookean": "", "IsoElastic": "", "ElaPlastic": 'Yield0="16"', "IsoHarden": 'Yield0="14" TangMod="100"'}
        for law, parameters in laws.items():
            for shape in ("linear", "QuadraticBSpline", "CPDI2"):
                with self.subTest(law=law, shape=shape):
                    material = _mpm.material("soft", 1.0, f'type="{law}" Young="{YOUNG}" Poisson="0.49" {parameters}')
                    _, found = self.bend(law, 0.49, shape=shape, material=material)
                    for norms in found:
                        self.assertLessEqual(len(norms), 9, norms)
                        small = [n for n in norms if n < 1e-2]
                        orders = [math.log(b) / math.log(a) for a, b in zip(small, small[1:]) if b > 1e-13]
                        if orders:
                            self.assertGreater(max(orders), 1.6, norms)

    def test_ranks_and_threads_agree(self):
        alone, _ = self.bend("1x1", 0.4999)
        for ranks, threads in ((1, 2), (2, 1), (3, 1)):
            with self.subTest(ranks=ranks, threads=threads):
                again, _ = self.bend(f"{ranks}x{threads}", 0.4999, ranks=ranks, threads=threads)
                self.assertAlmostEqual(again / alone, 1, delta=1e-5)

    def test_volume_stays(self):
        """The volume of a nearly incompressible column that is pressed between walls on two sides."""
        bodies = [_mpm.block("column", (0, 0, 0), (2, 2, 4)),
                  _mpm.block("ram", (0, 0, 4), (4, 2, 1), of="ram", more='<PrescribedVelocity vx="0" vy="0" vz="-0.2"/>')]
        material = _mpm.material("soft", 1.0, f'type="NeoHookean" Young="{YOUNG}" Poisson="0.4999"')
        text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), (5, 2, 6), "202210"),
                          implicit(1.0, step=0.25, extra='<Volumetric averaging="cell"/>'), [material, RAM],
                          '<PostProcessing time_interval="1" h5part="1" var="density"/>')
        self.run_in("pressed", [self.write(text)])
        states = _cases.States(self.folder / "pressed")
        density = states.column("density")[states.column("z", 0) < 4]
        self.assertLess(abs((1 / density).mean() - 1), 2e-3)


if __name__ == "__main__":
    _mpm.main()
