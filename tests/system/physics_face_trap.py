"""A particle at a face of cells, with linear functions and USF.

Compressed, it pushes the face up from below it and down from above, and stays: it is trapped. Strained with the velocity
that its last kick has given the face it would be compressed in every step, and its stress would grow exponentially
(core/shape/face_traps.hpp)."""

import _mpm

YOUNG, POISSON = 1000.0, 0.3
BULK = YOUNG / (3 * (1 - 2 * POISSON))
WAVE = (YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))) ** 0.5  # density 1
COMPRESSED = 1.02  # density of all bodies at the start, over that at rest
STEPS = 1000
FACTOR, LIMIT = 0.9, 0.5


def trap(place):
    """Two cells between fixed ends, as full and as compressed as each other, and four particles near the face between
    them, 1 at `place`."""
    attributes = f'density="{COMPRESSED}"'
    bodies = [_mpm.block("left", (0, 0, 0), (1, 1, 1), attributes=attributes),
              _mpm.block("right", (1, 0, 0), (1, 1, 1), attributes=attributes),
              _mpm.block("trapped", (place - 0.25, 0, 0), (0.5, 1, 1), attributes=attributes)]
    end = STEPS * FACTOR * LIMIT / WAVE
    return _mpm.scene(bodies, _mpm.grid((0, 0, 0), (2, 1, 1), "112222"), _mpm.solution(end, "USF", FACTOR),
                      output='<TimeHistory var="pres"><Particle x="0.25" y="0.25" z="0.25"/></TimeHistory>')


class FaceTrap(_mpm.Case):
    def test_no_energy_from_a_face(self):
        for place in (0.9999, 1.0001):
            with self.subTest(place=place):
                folder = f"at{place}"
                self.run_in(folder, [self.write(trap(place))])
                history = _mpm.table(self.folder / folder / "case_curv.dat")
                energy = [k + i for k, i in zip(history["kinetic"], history["internal"])]
                self.assertGreater(len(energy), STEPS / 2)
                # Without the remedy it is 1571 times as much at the end, with it 1.01 times at most.
                self.assertLess(max(energy), 1.1 * energy[0])


_mpm.main()
