"""Random scenes of bodies that meet leave the same bits on any ranks, threads and after a restart.

The attack tests/attack/random_meetings.py runs them by the hundred."""

import _meetings
import _mpm


class Meetings(_mpm.Case):
    def test_some_random_scenes(self):
        ends = []
        for number in range(10):
            with self.subTest(number=number):
                end, wrong = _meetings.judge(number, 1, self.folder / str(number))
                self.assertEqual(wrong, "")
                ends.append(end)
        self.assertGreater(ends.count("completed"), 5)

    def test_blocks_that_are_partly_filled(self):
        """CPDI and CPDI2: what particles that had left a block had been decided how the sums over the others were rounded."""
        for number in (82, 92):
            with self.subTest(number=number):
                self.assertEqual(_meetings.judge(number, 31, self.folder / str(number)), ("completed", ""))


_mpm.main()
