"""Failure thresholds that scatter are the same on any ranks and threads, and a restart keeps them.

A brittle copper block, its thresholds drawn per particle (Gauss), meets one drawn per cell (Weibull); both cross
borders of bricks and ranks on the way and break in the collision."""

import _mpm
from _mpm import Case

ELASTIC = 'type="IsoElastic" Young="117e3" Poisson="0.35" FailedType="0"'
CRITERIA = ('<FailureModel type="PriStress" PriStressMax="6000" PriStressMin="0" ShearStressMax="6000"/>'
            '<FailureModel type="InstGeoStrain" ErosionStrain="0.6" Erosion="1"/>')
BODIES = [_mpm.block("gaussian", (1.1, 3.3, 4.2), (4, 4, 4), (600, 100, 0), of="gaussian"),
          _mpm.block("weibull", (9.3, 4.7, 3.4), (4, 5, 4), (-500, -100, 60), of="weibull")]
END = 0.011


def scatter(attributes):
    return CRITERIA + f'<RandomFailure enable="1" {attributes}/>'


def materials(gauss='FailDistribution="1" GaussStd="0.3"', weibull='FailDistribution="2" RandomType="2"'):
    return [_mpm.material("gaussian", 8.93e-3, ELASTIC, scatter(gauss)),
            _mpm.material("weibull", 8.93e-3, ELASTIC, scatter(weibull))]


def collision(of=None, output=f'<Console print_time="{END / 10}"/>'):
    return _mpm.scene(BODIES, _mpm.grid((0, 0, 0), (18, 16, 12)), _mpm.solution(END), of or materials(), output)


class RandomFailure(Case):
    def test_any_ranks_and_threads(self):
        expected = self.state(collision(), "alone")
        bodies = _mpm.summary(self.folder / "alone")["bodies"]
        self.assertGreater(sum(body["eroded"] for body in bodies), 0, "some particles are eroded")
        for body in bodies:
            self.assertGreater(body["failed"], 0, "some particles have failed")
            self.assertLess(body["failed"], body["particles"], "and some have not")
        for ranks, threads in [(2, 1), (3, 2), (4, 1)]:
            with self.subTest(ranks=ranks, threads=threads):
                self.assertEqual(self.state(collision(), "other", ranks=ranks, threads=threads), expected)

    def test_the_draws_matter(self):
        expected = self.state(collision(), "alone")
        self.assertNotEqual(self.state(collision(materials('FailDistribution="0"')), "constant"), expected)
        self.assertNotEqual(self.state(collision(materials(weibull='FailDistribution="2"')), "particle"), expected)

    def test_restart_onto_other_ranks(self):
        output = f'<Console print_time="{END / 10}"/><Restart time_interval="{END / 2}"/>'
        self.check_restart_onto_other_ranks(collision(output=output))


if __name__ == "__main__":
    _mpm.main()
