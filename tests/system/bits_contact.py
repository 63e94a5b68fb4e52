"""The same bits on any ranks, threads, partition and restart: three bodies that meet over borders of bricks and ranks, with
friction and gaps; the forces between them and the books too."""

import itertools

import _mpm
from _mpm import Case

MATERIALS = [_mpm.material("soft", 1.0, 'type="IsoElastic" Young="1000" Poisson="0.3"'),
             _mpm.material("firm", 2.0, 'type="ElaPlastic" Young="4000" Poisson="0.3" Yield0="20"')]
FRICTION = ('<Friction><Coefficient value="0.3" mat1="soft" mat2="firm"/><Coefficient value="0.2" mat1="soft" mat2="soft"/>'
            "</Friction>")
# Bricks are of four cells: the faces that meet are at x = 8 and z = 4.
BODIES = {"left": _mpm.block("left", (2.1, 2.2, 4.1), (5.7, 6, 4), (6, 1, -2)),
          "right": _mpm.block("right", (8.2, 2.6, 4.3), (5, 5, 4), (-5, 0, -3)),
          "base": _mpm.block("base", (1, 1, 1), (14, 9, 3), (0, 0, 1), of="firm")}
CONSISTENT = 'mass="consistent"'
END = 0.4
DIMENSIONS = {2: (2, 1, 1), 4: (2, 1, 2)}


def scene(shape, algorithm, kind, distance, partition="", more=""):
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', '<PeneBlast version="1.0">', *MATERIALS, FRICTION,
                      *(f'<Component name="{name}">{body}</Component>' for name, body in BODIES.items()),
                      _mpm.grid((0, 0, 0), (16, 12, 12), "000010").replace("<Grid>", f'<Grid shape="{shape}">'),
                      f'<Contact enable="1" contact_type="{kind}" {distance} record_contact_force="1" {more}/>',
                      _mpm.solution(END, algorithm, more='<Gravity ax="0" ay="0" az="-2"/>'),
                      f'<Output><Console print_time="{END / 4}"/><TimeHistory var="pres"><Point x="1" y="1" z="1"/></TimeHistory>'
                      f'<Restart time_interval="{END / 2}"/></Output>', partition, "</PeneBlast>", ""])


def rows(path):
    return [line for line in path.read_text().splitlines() if line and not line.startswith("#")]


class Contact(Case):
    def run_of(self, text, folder, **more):
        state = self.run_in(folder, [self.write(text)], **more).state
        return state, rows(self.folder / folder / "case_curv.dat"), rows(self.folder / folder / "case.sta")

    def test_all_ranks_threads_and_partitions(self):
        for normal in ("mass_gradient", "regression"):
            with self.subTest(normal=normal):
                self.compare_all(normal)

    def compare_all(self, normal):
        arguments = ("linear", "MUSL", 1, f'distance_type="2" min_distance="0.1" contact_normal="{normal}"')
        alone = self.run_of(scene(*arguments), "alone")
        energy = _mpm.summary(self.folder / "alone")["energy"]
        self.assertGreater(energy["dissipated_by_contact"], 0)
        forces = _mpm.table(self.folder / "alone/case_curv.dat")
        for pair in ("1,2", "1,3", "2,3"):
            self.assertGreater(max(map(abs, forces[f"contact_z[{pair}]"])), 0, pair)
        # Each partition with one and with two threads, in turns over the ranks and the two kinds of normals.
        for n, (ranks, metis) in enumerate(itertools.product((1, 2, 4), (False, True))):
            threads = 1 + (n + n // 2 + (normal == "regression")) % 2
            partition = ""
            if not metis and ranks > 1:
                partition = '<DomainDecomposition dimension0="{}" dimension1="{}" dimension2="{}"/>'.format(*DIMENSIONS[ranks])
            with self.subTest(ranks=ranks, threads=threads, metis=metis):
                self.assertEqual(self.run_of(scene(*arguments, partition), "other", ranks=ranks, threads=threads), alone)

    def test_overlaps_are_named(self):
        """Once for each pair, and the same on any ranks; not in a run that goes on."""
        text = scene("linear", "MUSL", 1, "").replace('x0="8.2"', 'x0="6.7"')
        said = []
        for ranks in (1, 3):
            outcome = self.run_in(f"on{ranks}", [self.write(text)], ranks=ranks)
            said.append([line for line in (outcome.out + outcome.err).splitlines() if "overlap at the start" in line])
        self.assertEqual(said[0], said[1])
        self.assertEqual(len(said[0]), 1)
        self.assertIn("'left' and 'right'", said[0][0])
        again = self.run_in("again", [_mpm.restarts(self.folder / "on1")[0]])
        self.assertNotIn("overlap at the start", again.out + again.err)

    def test_other_methods_and_restart(self):
        corrected = 'transfer="{}" xpic_order="3" xpic_interval="2"'
        for n, (shape, algorithm, kind, distance, more, *transfer) in enumerate((
                ("QuadraticBSpline", "MUSL", 0, "", 'auto_normal_vector_weight="1"'),
                ("linear", "MUSL", 1, "", 'contact_normal="regression"', corrected.format("FMPM")),
                ("QuadraticBSpline", "USF", 0, 'distance_type="2" min_distance="0.1"', "", corrected.format("XPIC")),
                ("uGIMP", "USF", 2, 'distance_type="1" min_distance="0.9"', 'contact_time_step="1"'),
                ("SGMP", "USL", 1, 'distance_type="2" min_distance="0.1"', ""),
                ("uGIMP", "MUSL", 0, 'distance_type="2" min_distance="0.1"', 'contact_normal="regression"'),
                ("DDMP", "MUSL", 0, 'distance_type="2" min_distance="0.1"', 'contact_normal="regression"'),
                ("DDMP", "MUSL", 1, 'distance_type="2" min_distance="0.1"', "", corrected.format("FMPM")),
                ("linear", "MUSL", 0, 'distance_type="2" min_distance="0.1"', "", CONSISTENT),
                ("QuadraticBSpline", "USF", 1, "", 'contact_normal="regression"', CONSISTENT),
                ("QuadraticBSpline", "USF", 1, "", 'contact_normal="regression"'))):
            with self.subTest(shape=shape, algorithm=algorithm, kind=kind, transfer=transfer):
                text = scene(shape, algorithm, kind, distance, more=more).replace("<Solution ", f"<Solution {' '.join(transfer)} ")
                alone = self.run_of(text, f"alone{n}")
                self.assertEqual(self.run_of(text, f"other{n}", ranks=3 - n % 2, threads=1 + n % 2), alone)
                halfway = _mpm.restarts(self.folder / f"other{n}")[0]
                self.assertEqual(self.run_in(f"again{n}", [halfway]).state, alone[0])
                rest = rows(self.folder / f"again{n}/case_curv.dat")
                self.assertTrue(0 < len(rest) < len(alone[1]))
                self.assertEqual(rest, alone[1][-len(rest):])


if __name__ == "__main__":
    _mpm.main()
