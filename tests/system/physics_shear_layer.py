"""The layer between two fluids that slide past each other: its exact profile (Newtonian), and that of a line solver
(power law)."""

import math

import _cases
import _mpm
import numpy as np

START, END, SPEED, SOUND = 1.0, 4.0, 1.0, 40.0  # density 1
HALF, LONG = 16.0, 40.0  # of the body: to either side of the layer, and along the flow


def newtonian(x, mu, time):
    return SPEED * np.array([math.erf(s / (2 * math.sqrt(mu * time))) for s in x])


def power_law(x, ck, nn, duration, points=641):
    """dv/dt = d/dx (ck |dv/dx|^(nn-1) dv/dx) by differences on a line, from the profile of a Newtonian layer at START."""
    line = np.linspace(-HALF, HALF, points)
    h = line[1] - line[0]
    v = newtonian(line, 1.0, START)
    time = 0.0
    while time < duration:
        rate = np.abs(np.diff(v)) / h
        eta = ck * np.maximum(rate, 2e-3) ** (nn - 1)  # slower shear carries nothing that shows
        dt = min(0.2 * h * h / eta.max(), duration - time)
        v[1:-1] += dt / h * np.diff(eta * np.diff(v) / h)
        time += dt
    return np.interp(x, line, v)


class ShearLayer(_mpm.Case):
    def profile(self, law, cells, folder):
        """x and v of the particles in the middle of the body, where its ends have not been felt. A body for each layer
        of particles starts with the velocity of the profile there: a jump between two particles of a cell is more than
        a grid can see, and leaves an error of first order."""
        cell = HALF / cells
        dp = cell / 2
        fluid = _mpm.material("fluid", strength=f'type="Null" bq1="0" bq2="0" {law}',
                              more=f'<EquationOfState type="Polynomial" c0="0" c1="{SOUND**2}" c2="0" c3="0" c4="0" c5="0" c6="0"/>')
        layers = -HALF + dp * np.arange(round(2 * HALF / dp))
        bodies = [_mpm.block(f"layer{i}", (x, -LONG / 2, 0), (dp, LONG, cell), (0, v, 0), dp, "fluid")
                  for i, (x, v) in enumerate(zip(layers, newtonian(layers + dp / 2, 1.0, START)))]
        text = _mpm.scene(bodies, _mpm.grid((-HALF - 2, -LONG / 2 - 8, 0), (HALF + 2, LONG / 2 + 8, cell), "000022", cell),
                          _mpm.solution(END - START, factor=0.4), [fluid],
                          output=f'<Console print_time="1"/><PostProcessing time_interval="{END - START}" h5part="1" var="pres"/>')
        self.run_in(folder, [self.write(text)])
        states = _cases.States(self.folder / folder)
        middle = np.abs(states.column("y")) < LONG / 8
        return states.column("x")[middle], states.column("velocity_1")[middle]

    def test_newtonian(self):
        errors = []
        for cells in (8, 16, 32):
            x, v = self.profile('mu="1"', cells, f"newton{cells}")
            errors.append(np.abs(v - newtonian(x, 1.0, END)).mean() / SPEED)
        self.assertLess(errors[1], 0.006)
        self.assertLess(errors[2], 0.0025)
        self.assertGreater(min(_cases.order((1 / 8, 1 / 16, 1 / 32), errors)), 1.0)  # 1.9, then 1.2: noise of crossings

    def test_power_law(self):
        for nn in (0.6, 1.5):
            with self.subTest(nn=nn):
                x, v = self.profile(f'ck="1" nn="{nn}"', 16, f"power{nn}")
                self.assertLess(np.abs(v - power_law(x, 1.0, nn, END - START)).mean() / SPEED, 0.006)


_mpm.main()
