"""Soil that opens and closes: DruckerPrager with closes="1"."""

import h5py
import numpy as np

import _mpm

YOUNG, POISSON = 1000.0, 0.3
BULK = YOUNG / (3 * (1 - 2 * POISSON))
SOIL = _mpm.material("soil", 1.0, f'type="DruckerPrager" Young="{YOUNG}" Poisson="{POISSON}" qfai="0.3" kfai="0" qpsi="0" ten_f="0" '
                     'closes="1" bq1="0" bq2="0"')
HISTORY = '<TimeHistory var="pres|density"><Particle x="8.25" y="8.25" z="8.25"/></TimeHistory>'


class Soil(_mpm.Case):
    def test_opens_and_closes(self):
        """A block is widened by a half along every axis and brought back, and then some more: it bears pressure again from its first
        density on, with every update of the volume."""
        rate = "0.5*3.141592653589793*sin(2*3.141592653589793*t)"
        motion = f'<PrescribedVelocity vx="(X-8)*{rate}" vy="(Y-8)*{rate}" vz="(Z-8)*{rate}"/>'
        block = _mpm.block("soil", (6, 6, 6), (4, 4, 4), of="soil", more=motion).replace('<InitialVelocity vx="0" vy="0" vz="0"/>', "")
        grid = _mpm.grid((0, 0, 0), (16, 16, 16)).replace("<Grid>", '<Grid shape="QuadraticBSpline">')
        for update in range(5):
            with self.subTest(update=update):
                solution = _mpm.solution(1.0, more=f'<Volume update_type="{update}"/>').replace('factor="0.5"', 'specified="0.02"')
                self.run_in("run", [self.write(_mpm.scene([block], grid, solution, [SOIL], HISTORY))])
                table = _mpm.table(self.folder / "run/case_curv.dat")
                pressure, density = (np.array(table[f"{name}[particle1]"]) for name in ("pres", "density"))
                late = np.arange(len(density)) > len(density) // 2
                exact = np.maximum(BULK * np.log(density), 0)
                off = np.abs(pressure - exact)[late].max() / BULK
                print(f"soil, update {update}: ends at density {density[-1]:.4f} with p {pressure[-1]:.2f}, K ln(rho) {exact[-1]:.2f}; off by {off:.1e} K")
                self.assertLess(density[1:-1].min(), 0.36)
                self.assertLess(off, 1e-6)

    def test_grains_in_flight(self):
        """Two grains part. The gradient of velocity between them stays in the matrix of an affine transfer when each has its cells for
        itself, and would open them further and further: here to 0.002 of their density."""
        grains = [_mpm.block(name, (x, 10, 10), (1, 1, 1), velocity, dp=1, of="soil") for name, x, velocity in
                  (("left", 10, (-1, 0, 0.5)), ("right", 11, (1, 0, -0.5)))]
        grid = _mpm.grid((0, 0, 0), (22, 22, 22)).replace("<Grid>", '<Grid shape="QuadraticBSpline">')
        solution = _mpm.solution(8.0, attributes='transfer="AFLIP"')
        out = '<PostProcessing time_interval="1" h5part="1" var="density"/>'
        self.run_in("run", [self.write(_mpm.scene(grains, grid, solution, [SOIL], out))])
        with h5py.File(self.folder / "run/case.h5part") as file:
            density = _mpm.pictures(file)[-1]["density"][:]
        print(f"soil in flight: density {density}")
        self.assertLess(np.abs(density - 1 / 8).max(), 1e-15)


if __name__ == "__main__":
    _mpm.main()
