"""Failed particles in a component of their own are the same on any ranks and threads, and after a restart.

Two copper blocks whose damage counts as failure from a threshold meet over borders of bricks and ranks; their failed
particles, of both, then touch the others only by contact."""

import _mpm
from _mpm import Case

COPPER = _mpm.material(
    "copper", 8.93e-3,
    'type="JohnsonCook" Young="117e3" Poisson="0.35" Yield0="90" B="292" n="0.31" C="0.025" m="1.09" melt="1356" '
    'SpecHeat="383" epso="1e-3" D1="0.02" D2="0.05" D3="-1" D4="0.014" D5="1.12" FailedType="1" '
    'FailureDamageThreshold="{}"',
    '<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>')
BODIES = [_mpm.block("flyer", (1.1, 3.3, 4.2), (4, 4, 4), (600, 100, 0), of="copper"),
          '</Component><Component name="other">',
          _mpm.block("target", (5.6, 4.7, 3.4), (4, 5, 4), (-500, -100, 60), of="copper")]
END = 0.004  # to 0.006 it takes ten times as many steps


def collision(apart=1, threshold=0.6, algorithm="MUSL", output=""):
    contact = f'<Contact enable="1" failure_to_component="{apart}"/>'
    return _mpm.scene(BODIES, _mpm.grid((0, 0, 0), (18, 16, 12)), _mpm.solution(END, algorithm),
                      [COPPER.format(threshold)], f'<Console print_time="{END / 10}"/>' + output, contact)


class FailedComponent(Case):
    def test_any_ranks_and_threads(self):
        for algorithm in ("MUSL", "USF", "USL", "USAVG"):
            text = collision(algorithm=algorithm)
            expected = self.state(text, "alone")
            for body in _mpm.summary(self.folder / "alone")["bodies"]:
                self.assertGreater(body["failed"], 0, "some particles have failed")
                self.assertLess(body["failed"], body["particles"], "and some have not")
            for ranks, threads in [(2, 2), (3, 1)]:
                with self.subTest(algorithm=algorithm, ranks=ranks, threads=threads):
                    self.assertEqual(self.state(text, "other", ranks=ranks, threads=threads), expected)

    def test_the_setting_and_the_threshold_matter(self):
        expected = self.state(collision(), "apart")
        self.assertNotEqual(self.state(collision(apart=0), "together"), expected)
        self.assertNotEqual(self.state(collision(threshold=1), "later"), expected)
        self.assertEqual(self.state(collision(apart=0, threshold=1), "unread"),
                         self.state(collision(apart=0), "together"), "read only with the setting")

    def test_restart_onto_other_ranks(self):
        output = f'<Restart time_interval="{END / 2}"/>'
        self.check_restart_onto_other_ranks(collision(output=output))


if __name__ == "__main__":
    _mpm.main()
