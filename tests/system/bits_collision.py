"""The same bits on any ranks, threads and partition: two bodies that fly over brick and rank borders and collide.

A copper block with damage, heat and erosion (Johnson-Cook) meets a harder one obliquely, under gravity. Beside the
hash of the state, the totals in .sta, the .summary.json and the files of particles agree to the last bit."""

import itertools

import h5py

import _mpm
from _mpm import Case

SOFT = _mpm.material(
    "copper", 8.93e-3,
    'type="JohnsonCook" Young="117e3" Poisson="0.35" Yield0="90" B="292" n="0.31" C="0.025" m="1.09" melt="1356" '
    'SpecHeat="383" epso="1e-3" D1="0.02" D2="0.1" D3="-1" D4="0.014" D5="1.12" FailedType="1"',
    '<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>'
    '<FailureModel type="PlaStrain" epmax="0.8" Erosion="1"/>')
HARD = _mpm.material("steel", 7.85e-3, 'type="ElaPlastic" Young="210e3" Poisson="0.3" Yield0="400"',
                     '<EquationOfState type="Polynomial" c0="0" c1="175e3" c2="0" c3="0" c4="0" c5="0" c6="0"/>')
END = 0.011
DIMENSIONS = {1: (1, 1, 1), 2: (2, 1, 1), 3: (3, 1, 1), 4: (2, 2, 1), 8: (4, 2, 1)}
PRINT = f'<Console print_time="{END / 10}"/>'
EVERYTHING = (f'<PostProcessing time_interval="{END / 7}" h5part="1" vtk_data="2" '
              'var="seqv|epef|exx|cp|damg|kelv|sigy"/>'
              '<TimeHistory var="pres|SigmaXY"><Particle x="2" y="4" z="5"/><Point x="12" y="6" z="5"/></TimeHistory>'
              f'<Restart time_interval="{END / 5}"/><Statistics memory="1" cell_occupy="1"/>')


def uniform(ranks):
    return '<DomainDecomposition dimension0="{}" dimension1="{}" dimension2="{}"/>'.format(*DIMENSIONS[ranks])


def collision(decomposition="", algorithm="MUSL", output=PRINT, end=END, faster=1):
    bodies = [_mpm.block("projectile", (1.1, 3.3, 4.2), (4, 4, 4), (900 * faster, 150 * faster, 0), of="copper"),
              _mpm.block("target", (19.3, 7.7, 3.4), (4, 5, 4), (-700 * faster, -180 * faster, 60 * faster), of="steel")]
    gravity = '<Gravity ax="0" ay="0" az="-2e4"/>'
    return _mpm.scene(bodies, _mpm.grid((0, 0, 0), (26, 16, 12)), _mpm.solution(end, algorithm, 0.5, more=gravity),
                      [SOFT, HARD], output, decomposition)


def rows(path):
    return [line for line in path.read_text().splitlines() if not line.startswith("#")]


def datasets(path):
    """Names and bytes of all that an HDF5 file holds."""
    with h5py.File(path) as file:
        names = []
        file.visit(names.append)
        return {name: file[name][()].tobytes() for name in names if isinstance(file[name], h5py.Dataset)}


class Collision(Case):
    def test_the_case_is_what_it_is_meant_to_be(self):
        """Else the comparisons below would show little."""
        self.state(collision(), "alone")
        found = _mpm.summary(self.folder / "alone")
        copper, steel = found["bodies"]
        self.assertGreater(copper["max_temperature"], 300)
        self.assertGreater(copper["eroded"], 0, "some particles are eroded")
        self.assertGreater(copper["failed"], 0, "some particles have failed")
        self.assertGreater(copper["particles"], 256)
        self.assertGreater(steel["max_epef"], 0.01)
        self.assertGreater(copper["centre"][0], 8, "over at least two borders of bricks")
        self.assertLess(found["energy"]["relative_drift"], 0.05)

    def test_all_ranks_threads_and_partitions(self):
        expected = self.state(collision(), "alone")
        totals = _mpm.summary(self.folder / "alone")
        # Each partition with one and with two threads, in turns over the ranks.
        for n, (ranks, partition) in enumerate(itertools.product((1, 2, 3, 4, 8), ("uniform", "metis"))):
            threads = 1 + (n + n // 2) % 2
            with self.subTest(ranks=ranks, threads=threads, partition=partition):
                decomposition = uniform(ranks) if partition == "uniform" else ""
                state = self.state(collision(decomposition), "other", ranks=ranks, threads=threads)
                self.assertEqual(state, expected)
                self.assertEqual(rows(self.folder / "other/case.sta"), rows(self.folder / "alone/case.sta"))
                found = _mpm.summary(self.folder / "other")
                for key in ("steps", "time", "particles", "energy", "momentum", "angular_momentum", "bodies"):
                    self.assertEqual(found[key], totals[key], key)

    def test_usf_and_usl(self):
        for algorithm, ranks, threads in [("USF", 4, 2), ("USL", 3, 1), ("USAVG", 2, 2)]:
            with self.subTest(algorithm):
                expected = self.state(collision("", algorithm), "alone")
                text = collision(uniform(ranks), algorithm)
                self.assertEqual(self.state(text, "other", ranks=ranks, threads=threads), expected)

    def test_where_the_strain_limits_the_steps(self):
        """At 10 km/s (core/step/strain_limit.hpp)."""
        for algorithm in ("MUSL", "USF", "USL", "USAVG"):
            with self.subTest(algorithm):
                output = PRINT + f'<Restart time_interval="{END / 12}"/>'
                text = collision("", algorithm, output, END / 4, faster=6)
                alone = self.run_in("alone", [self.write(text)])
                self.assertIn("| limit strain |", alone.out)
                self.assertEqual(self.state(text, "other", ranks=4, threads=2), alone.state)
                first = _mpm.restarts(self.folder / "other")[0]
                self.assertEqual(self.run_in("again", [first], ranks=2).state, alone.state)

    def test_outputs_do_not_change_the_run(self):
        """Output variables add columns to the particles, hence to the hash; the totals have to agree all the same."""
        self.state(collision(), "few")
        one = self.state(collision(output=PRINT + EVERYTHING), "one")
        three = self.state(collision(output=PRINT + EVERYTHING), "three", ranks=3)
        self.assertEqual(one, three)
        few, many = (_mpm.table(self.folder / f / "case.sta") for f in ("few", "one"))
        self.assertEqual({head: many[head] for head in few}, few)
        self.assertEqual(rows(self.folder / "one/case_curv.dat"), rows(self.folder / "three/case_curv.dat"))
        self.assertEqual(*(datasets(self.folder / f / "case.h5part") for f in ("one", "three")))

    def test_only_the_interval_of_outputs_differs(self):
        seldom = self.state(collision(output='<Console print_time="1"/>'), "seldom")
        self.assertEqual(seldom, self.state(collision(), "often"))

    def test_restart_onto_other_ranks(self):
        expected = self.state(collision(output=PRINT + f'<Restart time_interval="{END / 2}"/>'), "on3", ranks=3)
        halfway = _mpm.restarts(self.folder / "on3")[0]
        for ranks, threads in [(1, 2), (2, 1), (8, 1)]:
            with self.subTest(ranks=ranks):
                self.assertEqual(self.run_in(f"on{ranks}", [halfway], ranks=ranks, threads=threads).state, expected)

    def test_restart_with_another_end_time(self):
        self.state(collision(output=PRINT + f'<Restart time_interval="{END / 2}"/>'), "first", ranks=2)
        halfway = _mpm.restarts(self.folder / "first")[0]
        longer = self.write(collision(end=1.3 * END), "longer.xmp")
        continued = self.run_in("continued", [halfway, "-rt", longer], ranks=3)
        direct = self.run_in("direct", [longer])
        self.assertEqual(continued.state, direct.state)

    def test_ranks_without_particles(self):
        """One brick of particles flies through the room; most ranks have nothing to do, and then it is their turn."""
        output = PRINT + EVERYTHING
        text = _mpm.scene([_mpm.block("mote", (1, 4, 4), (4, 4, 4), (900, 0, 0), of="copper")],
                          _mpm.grid((0, 0, 0), (26, 16, 12)), _mpm.solution(END, factor=0.5), [SOFT, HARD], output)
        expected = self.state(text, "alone")
        for ranks in (2, 5):
            self.assertEqual(self.state(text, "some", ranks=ranks), expected)
            halfway = _mpm.restarts(self.folder / "some")[0]
            self.assertEqual(self.run_in("again", [halfway], ranks=6 - ranks).state, expected)

    def test_messages_that_never_travel_eagerly(self):
        limits = ["--mca", "btl_vader_eager_limit", "64", "--mca", "btl_self_eager_limit", "64"]
        state = self.state(collision(), "rendezvous", ranks=4, mpirun=limits)
        self.assertEqual(state, self.state(collision(), "alone"))


if __name__ == "__main__":
    _mpm.main()
