"""A limited artificial viscosity: the same bits on any ranks, threads and partition and through a restart; a scene that does
not choose it keeps its bits and its bytes.

Copper blocks run into a wall and into each other: shocks, release, shear and separation."""

import _cases
import _mpm
from _mpm import Case

END = 1.6e-3
GRID = _mpm.grid((0, 0, 0), (14, 8, 7), "200020")


def scene(limiter='limiter="shock"', algorithm="MUSL", more="", restart=END / 2):
    bodies = [_mpm.block("left", (0.3, 1.2, 0.6), (5, 4, 4), (-600, 0, 90), of="strong"),
              _mpm.block("right", (5.6, 2.1, 1.1), (5, 4, 4), (-1100, -60, 0), of="fluid")]
    materials = [_cases.copper(f'type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="157" TangMod="423" {limiter}', "strong"),
                 _cases.copper(f'type="Null" {limiter}', "fluid")]
    return _mpm.scene(bodies, GRID, _mpm.solution(END, algorithm), materials,
                      f'<Console print_time="{END / 4}"/><Restart time_interval="{restart}"/>', more)


class LimitedViscosity(Case):
    def test_any_ranks_threads_and_partition(self):
        for algorithm in ("MUSL", "USF", "USL", "USAVG"):
            alone = self.state(scene(algorithm=algorithm), f"alone {algorithm}")
            self.assertNotEqual(alone, self.state(scene("", algorithm), "full"), "the limiter does nothing")
            for ranks, threads, how in [(1, 2, ""), (2, 1, 'dimension0="2" dimension1="1" dimension2="1"'),
                                        (2, 2, 'method="metis"'), (3, 1, 'dimension0="1" dimension1="3" dimension2="1"'),
                                        (4, 1, 'dimension0="2" dimension1="2" dimension2="1"')]:
                with self.subTest(algorithm=algorithm, ranks=ranks, threads=threads, how=how):
                    text = scene(algorithm=algorithm, more=f"<DomainDecomposition {how}/>" if how else "")
                    self.assertEqual(self.state(text, "other", ranks=ranks, threads=threads), alone)

    def test_restarts(self):
        alone = self.state(scene(restart=END / 7), "alone")
        files = _mpm.restarts(self.folder / "alone")
        self.assertEqual(len(files), 2)  # the newest two are kept
        for ranks, file in enumerate(files, start=1):
            with self.subTest(file=file.name):
                self.assertEqual(self.run_in(f"on{ranks}", [file], ranks=ranks).state, alone)
        self.check_restart_onto_other_ranks(scene(algorithm="USL"))

    def test_a_scene_without_it_pays_nothing(self):
        self.assertEqual(self.state(scene('limiter="none"'), "none"), self.state(scene(""), "unsaid"))
        taken = {}
        for limiter in ("", 'limiter="none"', 'limiter="shock"', 'limiter="shock" bq1="0" bq2="0"'):
            outcome = self.run_in("dry", [self.write(scene(limiter)), "--dry-run"])
            taken[limiter] = [int(line.split(" bytes")[0].split()[-1]) for line in outcome.out.splitlines()
                              if "bytes per particle" in line]
        self.assertEqual(taken[""], taken['limiter="none"'])
        self.assertEqual(taken[""], taken['limiter="shock" bq1="0" bq2="0"'])
        self.assertEqual([n + 16 for n in taken[""]], taken['limiter="shock"'])

    def test_a_restart_file_without_its_columns_is_refused(self):
        """State that a limited viscosity reads back cannot start at zero."""
        self.run_in("full", [self.write(scene(""))])
        other = self.write(scene(), "other.xmp")
        outcome = self.run_in("on", [_mpm.restarts(self.folder / "full")[0], "-rt", other], _mpm.INPUT_ERROR)
        self.assertIn("viscosity_factor, velocity_divergence", outcome.err)


if __name__ == "__main__":
    _mpm.main()
