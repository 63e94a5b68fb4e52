"""The same bits on any ranks, threads and partition, and through restarts: a coarse copper Taylor bar.

The bar is that of benchmarks/taylor_bar with cells twice as large, over its first quarter. What is compared is the
log's hash of the whole state of all particles."""

import itertools

import _mpm
from _mpm import Case

COPPER = _mpm.material("copper", 8.93e-3, 'type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="157" TangMod="423.46"',
                       '<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>')
BAR = ('<Body name="bar" material="copper" type="Cylinder"><Geometry x0="0" y0="0" z0="0" dp_bottom="0.76" '
       'dp_top="0.76" Bottom_Outer_Radius="3.8" Top_Outer_Radius="3.8" height="25.4"/>'
       '<InitialVelocity vx="0" vy="0" vz="-190"/></Body>')
END = 0.015
FACTOR = {"MUSL": 0.8, "USF": 0.8, "USL": 0.4}  # of the critical step; USL is stable up to half of it
METIS = '<DomainDecomposition method="metis"/>'
DIMENSIONS = {1: (1, 1, 1), 2: (1, 1, 2), 3: (1, 3, 1), 4: (2, 1, 2), 8: (2, 2, 2)}


def uniform(ranks):
    return '<DomainDecomposition dimension0="{}" dimension1="{}" dimension2="{}"/>'.format(*DIMENSIONS[ranks])


def bar(algorithm="MUSL", decomposition="", restarts=False):
    output = f'<Console print_time="{END / 4}"/>' + (f'<Restart time_interval="{END / 2}"/>' if restarts else "")
    return _mpm.scene([BAR], _mpm.grid((-7.6, -7.6, 0), (7.6, 7.6, 27.36), "000020", 1.52),
                      _mpm.solution(END, algorithm, FACTOR[algorithm]), [COPPER], output, decomposition)


class TaylorBar(Case):
    def state(self, text, folder, **more):
        self.write(text)
        return self.run_in(folder, [self.folder / "case.xmp"], **more).state

    def compare(self, algorithm, combinations):
        expected = self.state(bar(algorithm), "alone")
        self.assertIsNotNone(expected)
        for ranks, threads, partition in combinations:
            decomposition = METIS if partition == "metis" else uniform(ranks)
            with self.subTest(algorithm=algorithm, ranks=ranks, threads=threads, partition=partition):
                state = self.state(bar(algorithm, decomposition), "other", ranks=ranks, threads=threads)
                self.assertEqual(state, expected)

    def test_musl_on_all_ranks_threads_and_partitions(self):
        # Each partition with one and with two threads, in turns over the ranks.
        pairs = itertools.product((1, 2, 3, 4, 8), ("uniform", "metis"))
        self.compare("MUSL", [(ranks, 1 + (n + n // 2) % 2, partition) for n, (ranks, partition) in enumerate(pairs)])

    def test_usf(self):
        self.compare("USF", [(1, 2, "metis"), (2, 1, "metis"), (3, 2, "uniform"), (8, 1, "metis")])

    def test_usl(self):
        self.compare("USL", [(1, 2, "metis"), (2, 1, "uniform"), (3, 2, "metis"), (8, 1, "uniform")])

    def test_halfway_restart_onto_other_ranks(self):
        """Written on 1, 4 and 3 ranks; read on others, also under another partition (-rt)."""
        expected = self.state(bar(restarts=True), "on1")
        self.assertEqual(self.state(bar(restarts=True, decomposition=uniform(4)), "on4", ranks=4), expected)
        self.assertEqual(self.state(bar("USL", restarts=True), "usl3", ranks=3), self.state(bar("USL"), "usl1"))
        usl = self.state(bar("USL"), "usl")
        halfway = {folder: _mpm.restarts(self.folder / folder)[0] for folder in ("on1", "on4", "usl3")}
        on_eight = self.write(bar(decomposition=uniform(8)), "eight.xmp")
        on_two = self.write(bar(decomposition=METIS), "two.xmp")
        for written, ranks, threads, other_input, state in [
                ("on1", 3, 1, [], expected), ("on1", 1, 2, [], expected), ("on1", 8, 1, ["-rt", on_eight], expected),
                ("on4", 2, 2, ["-rt", on_two], expected), ("on4", 4, 1, [], expected), ("usl3", 2, 1, [], usl)]:
            with self.subTest(written=written, read_on=ranks):
                outcome = self.run_in("again", [halfway[written], *other_input], ranks=ranks, threads=threads)
                self.assertEqual(outcome.state, state)

    def test_messages_that_never_travel_eagerly(self):
        """A blocking send that relies on the library's buffers hangs then."""
        expected = self.state(bar(), "alone")
        limits = ["--mca", "btl_vader_eager_limit", "64", "--mca", "btl_self_eager_limit", "64"]
        self.assertEqual(self.state(bar(), "rendezvous", ranks=4, mpirun=limits), expected)


if __name__ == "__main__":
    _mpm.main()
