"""The size of the box does not matter: a bar that hits the wall of its box, and the same in a box ten times as large."""

import _cases
import _mpm


def impact(box, lower=(0, 0, 0)):
    """A copper block of 4 x 4 x 12 mm on the wall z = 0, in cells of 1 mm."""
    bar = _mpm.block("bar", (3, 3, 0), (4, 4, 12), (0, 0, -150), 0.5, "copper")
    strength = 'type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="157" TangMod="423"'
    return _mpm.scene([bar], _mpm.grid(lower, box, "000020"), _mpm.solution(0.02, "MUSL", 0.4), [_cases.copper(strength)])


class EmptySpace(_mpm.Case):
    def state(self, name, *box):
        outcome = self.run_in(name, [self.write(impact(*box))])
        return outcome.state, _mpm.summary(self.folder / name)

    def test_same_bits(self):
        small, of_small = self.state("small", (10, 10, 20))
        large, of_large = self.state("large", (100, 100, 200))
        self.assertEqual(large, small)
        # With the lower faces moved too, coordinates count from another origin and round differently; some hundred steps
        # make little of that.
        _, of_moved = self.state("moved", (60, 60, 200), (-40, -40, 0))
        for name in ("kinetic", "internal"):
            self.assertLess(abs(of_moved["energy"][name] / of_small["energy"][name] - 1), 1e-9)
        self.assertEqual(of_large["particles"], of_small["particles"])
        # What grows with the box are bits for bricks in the parallel decomposition, not nodes: those alone would be
        # 2 million of 64 bytes.
        more = of_large["peak_memory_bytes"]["max"] - of_small["peak_memory_bytes"]["max"]
        self.assertLess(more, 10e6)


_mpm.main()
