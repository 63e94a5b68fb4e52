"""Period, energy and order of convergence of a fixed-free elastic bar in its first mode."""

import _cases
import _line
import _mpm


class ElasticBar(_mpm.Case):
    def test_period_and_energy(self):
        cells = (8, 16, 32)
        for algorithm in ("MUSL", "USF", "USAVG"):
            with self.subTest(algorithm=algorithm):
                errors = []
                for count in cells:
                    bar = _cases.ElasticBar(count, algorithm, 0.4 / _line.WAVE_LIMIT[algorithm], rows=100)
                    folder = f"{algorithm}{count}"
                    self.run_in(folder, [self.write(bar.text())])
                    found = bar.measure(self.folder / folder)
                    errors.append(found["period"])
                    self.assertLess(max(abs(found["drift"])), 1e-3)  # asked for, per period
                    # What linear elements, particles and leapfrog make of the wave; terms of (k h)^4 are 1e-3 of it.
                    self.assertAlmostEqual(found["period"] / bar.dispersion(), 1, delta=0.01)
                self.assertLess(max(map(abs, errors)), 0.005)  # asked for
                # Second order in space, and the time step goes with the cell: 2 but for terms of fourth order.
                for observed in _cases.order([1 / c for c in cells], errors):
                    self.assertGreater(observed, 1.9)
                    self.assertLess(observed, 2.1)


_mpm.main()
