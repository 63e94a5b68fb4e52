"""A bar in uniaxial strain, along each axis and with each scheme, against the method on a line (_line.py).

The symmetry planes leave only one direction, so the solver in space must give what the method on a line gives,
particle by particle, the scheme's own noise included: any difference beyond round-off is a mistake in one of them."""

import functools

import numpy as np

import _cases
import _line
import _mpm

LENGTH, SPLIT, SPEED, FACTOR, BQ1, BQ2 = 30, 3, 300.0, 0.25, 1.5, 0.06
END = 0.8 * LENGTH / (_cases.COPPER["c0"] + _cases.COPPER["s1"] * SPEED)


def bar(axis, algorithm, limiter):
    """A column of 30 x 1 x 1 cells that runs into the wall at 0 of its axis."""
    along = [float(a == axis) for a in range(3)]
    size = [1 + (LENGTH - 1) * a for a in along]
    faces = "".join("20" if a else "22" for a in along)
    block = _mpm.block("bar", (0, 0, 0), size, [-SPEED * a for a in along], 1 / SPLIT, "copper")
    return _mpm.scene([block], _mpm.grid((0, 0, 0), [s + 2 * a for s, a in zip(size, along)], faces),
                      _mpm.solution(END, algorithm, FACTOR),
                      [_cases.copper(f'type="Null" bq1="{BQ1}" bq2="{BQ2}" limiter="{limiter}"')],
                      f'<PostProcessing time_interval="{END}" h5part="1" var="pres|density|engi"/>')


class OnALine(_mpm.Case):
    def test_every_axis_and_scheme(self):
        for algorithm in ("MUSL", "USF", "USL", "USAVG"):
            for axis in range(3):
                self.compare(axis, algorithm, "none")

    def test_limited_viscosity(self):
        for n, algorithm in enumerate(("MUSL", "USF", "USL", "USAVG")):
            self.compare(n % 3, algorithm, "shock")

    def compare(self, axis, algorithm, limiter):
        line = solved(algorithm, limiter)
        scale = {"x": LENGTH, "v": SPEED, "p": line.p.max(), "rho": line.density, "e": line.energy.max()}
        with self.subTest(algorithm=algorithm, axis="xyz"[axis], limiter=limiter):
            folder = f"{algorithm}{axis}{limiter}"
            self.run_in(folder, [self.write(bar(axis, algorithm, limiter))])
            states = _cases.States(self.folder / folder)
            self.assertEqual(_mpm.summary(self.folder / folder)["steps"], line.steps)
            first = states.column("xyz"[axis], 0)
            layer = np.rint(first * SPLIT - 0.5).astype(int)
            truth = {"x": ("xyz"[axis], line.x), "v": (f"velocity_{axis}", line.v), "p": ("pres", line.p),
                     "rho": ("density", line.mass / line.volume),
                     "e": ("engi", line.energy * line.first_volume / SPLIT**2)}
            scale["e"] = (line.energy * line.first_volume).max() / SPLIT**2
            # The file is in single precision, 6e-8; the method's own noise makes a little of round-off in
            # some hundred steps.
            for name, (column, expected) in truth.items():
                error = np.abs(states.column(column) - expected[layer]).max() / scale[name]
                self.assertLess(error, 1e-6, name)
            for other in {0, 1, 2} - {axis}:
                self.assertLess(np.abs(states.column(f"velocity_{other}")).max() / SPEED, 1e-12)


@functools.cache
def solved(algorithm, limiter):
    line = _line.Line(LENGTH, 1.0, SPLIT, -SPEED, algorithm, FACTOR, bq1=BQ1, bq2=BQ2, limited=limiter == "shock",
                      **_cases.COPPER)
    line.run(END)
    return line


_mpm.main()
