"""Whole runs by four threads: two bodies that melt, break, leave and are shown in every output, by each scheme; every
law; conduction. The thread sanitizer ends a program that has a data race with exit code 66 and says where."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "system"))

import _mpm  # noqa: E402: found by the line above
import bits_collision  # noqa: E402
import bits_laws  # noqa: E402


class Race(_mpm.Case):
    def check(self, text):
        self.write(text)
        outcome = self.run_in("out", [self.folder / "case.xmp"], threads=4)
        self.assertNotIn("ThreadSanitizer", outcome.err)
        self.assertEqual(_mpm.summary(self.folder / "out")["threads"], 4)

    def test_collision(self):
        for scheme in ("MUSL", "USF", "USL", "USAVG"):
            with self.subTest(scheme):
                self.check(bits_collision.collision("", scheme, bits_collision.EVERYTHING, bits_collision.END / 3))

    def test_restart(self):
        self.check(bits_collision.collision(output=bits_collision.EVERYTHING, end=bits_collision.END / 3))
        for restart in _mpm.restarts(self.folder / "out"):
            self.run_in("again", [restart], threads=4)

    def test_laws(self):
        self.check(bits_laws.scene())


if __name__ == "__main__":
    _mpm.main()
