"""Every shape function with every transfer that goes with it: the same bits on other ranks and threads and through a
restart; what each damps, and what it carries.

A warm block and a cold one meet in a corner of walls of each kind, under gravity and with conduction of heat. Schemes
take turns over the pairs, so that each shape meets each scheme."""

import _mpm
from _mpm import INPUT_ERROR, Case

# Those that affine transfers do not go with, and the others.
PLAIN_SHAPES, AFFINE_SHAPES = ("linear", "SGMP", "DDMP", "CPDI", "CPDI2"), ("uGIMP", "cpGIMP", "QuadraticBSpline", "CubicBSpline")
PLAIN = ("FLIP", "PIC", 'FLIP flip_fraction="0.95"', 'XPIC xpic_order="3" xpic_interval="3"', 'FMPM xpic_order="4"',
         'FLIP mass="consistent"')
AFFINE = ("APIC", "TPIC", "AFLIP")
SCHEMES = ("MUSL", "USF", "USL", "USAVG")
SHAPES = PLAIN_SHAPES + AFFINE_SHAPES
PAIRS = [(shape, transfer) for shape in SHAPES for transfer in PLAIN + (AFFINE if shape in AFFINE_SHAPES else ())
         if not ("consistent" in transfer and "CPDI" in shape)]
END = 0.35
HEAT = 'SpecHeat="2" CoefficientOfThermalConductivity="3" roomt="{}"'
MATERIALS = [_mpm.material("warm", 1.0, 'type="IsoElastic" Young="1000" Poisson="0.3" ' + HEAT.format(400)),
             _mpm.material("cold", 2.0, 'type="IsoElastic" Young="1000" Poisson="0.3" ' + HEAT.format(300))]
# Both end beside brick borders; the corner is at the lower x and z and the upper y.
BODIES = [_mpm.block("left", (0.2, 5.2, 0.4), (3, 3, 3), (-2, 3, -4), of="warm"),
          _mpm.block("right", (3.7, 5.7, 0.9), (3, 2.5, 3), (-6, 1, -1), of="cold")]
GRID = _mpm.grid((0, 0, 0), (12, 9, 8), "200140")


def scene(shape, transfer, algorithm, end=END, bodies=BODIES, gravity=-9.8, grid=GRID, averaging="none", materials=MATERIALS):
    word, _, more = transfer.partition(" ")
    attributes = f'transfer="{word}" {more}'
    volumetric = f'<Volumetric averaging="{averaging}" relaxation="{0.5 if averaging == "cell" else 0}"/>'
    return _mpm.scene(bodies, grid.replace("<Grid>", f'<Grid shape="{shape}">'),
                      _mpm.solution(end, algorithm, 0.4, attributes, f'<Gravity ax="0" ay="0" az="{gravity}"/>{volumetric}'), materials,
                      f'<Console print_time="{END / 2}"/><Restart time_interval="{END / 2}"/>')


class Methods(Case):
    def test_same_bits(self):
        for n, (shape, transfer) in enumerate(PAIRS):
            schemes = [s for s in SCHEMES if s != "USL" or "consistent" not in transfer]
            algorithm = schemes[(n + n // len(PLAIN)) % len(schemes)]
            averaging = ("none", "cell")[n // 2 % 2]
            with self.subTest(shape=shape, transfer=transfer, algorithm=algorithm, averaging=averaging):
                path = self.write(scene(shape, transfer, algorithm, averaging=averaging))
                alone = self.run_in(f"alone{n}", [path]).state
                how = {"ranks": 3} if n % 2 else {"ranks": 2, "threads": 2}
                # The second half on other ranks; in one case of three all of it, and the second half on one.
                if n % 3:
                    halfway = _mpm.restarts(self.folder / f"alone{n}")[0]
                else:
                    self.assertEqual(self.run_in(f"other{n}", [path], **how).state, alone)
                    halfway, how = _mpm.restarts(self.folder / f"other{n}")[0], {}
                self.assertEqual(self.run_in(f"again{n}", [halfway], **how).state, alone)

    def test_same_bits_beside_lighter_material(self):
        """In cells beside lighter ones particles act from inside, also where these are in bricks of other ranks."""
        heavy = [_mpm.material("warm", 100.0, 'type="IsoElastic" Young="1e6" Poisson="0.3" ' + HEAT.format(400)), MATERIALS[1]]
        for shape in ("linear", "DDMP"):
            for algorithm in SCHEMES:
                with self.subTest(shape=shape, algorithm=algorithm):
                    path = self.write(scene(shape, "FLIP", algorithm, materials=heavy))
                    alone = self.run_in(f"alone {shape} {algorithm}", [path]).state
                    other = self.run_in(f"other {shape} {algorithm}", [path], ranks=3, threads=2)
                    self.assertEqual(other.state, alone)
                    halfway = _mpm.restarts(self.folder / f"other {shape} {algorithm}")[0]
                    self.assertEqual(self.run_in(f"again {shape} {algorithm}", [halfway], ranks=2).state, alone)

    def test_same_bits_where_light_cells_are_of_another_rank(self):
        """A heavy body above and below the border of two bricks; one across it, with USL, for which empty cells count; and
        bricks of few particles, whose nodes are not all cleared in every step."""
        materials = [_mpm.material("heavy", 100.0, 'type="IsoElastic" Young="1e6" Poisson="0.3"'),
                     _mpm.material("light", 1.0, 'type="IsoElastic" Young="1000" Poisson="0.3"')]

        def check(name, shape, algorithm, bodies, end, upper, ranks):
            text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), upper, "000000").replace("<Grid>", f'<Grid shape="{shape}">'),
                              _mpm.solution(end, algorithm, 0.4), materials)
            with self.subTest(name=name, shape=shape, algorithm=algorithm):
                path = self.write(text)
                states = [self.run_in(f"{name} {shape} {algorithm} {n}", [path], ranks=n).state for n in (1, ranks)]
                self.assertEqual(states[1], states[0])

        for shape in ("linear", "DDMP"):
            for name, lower, higher in (("above", "light", "heavy"), ("below", "heavy", "light")):
                bodies = [_mpm.block("lower", (0.75, 0, 0), (3, 4, 4), (0, 0, 0), 0.5, lower),
                          _mpm.block("higher", (3.82, 0, 0), (3, 4, 4), (-1, 0, 0), 0.5, higher)]
                check(name, shape, "MUSL", bodies, 0.02, (8, 4, 4), 2)
            bodies = [_mpm.block("across", (1.82, 0, 0), (4, 4, 4), ("0.3*x", 0, 0), 0.5, "heavy"),
                      _mpm.block("far", (13, 0, 0), (2, 4, 4), (0, 0, 0), 0.5, "light")]
            check("across", shape, "USL", bodies, 0.02, (16, 4, 4), 3)
        single = [_mpm.block("moves", (2.2, 1.2, 1.2), (1, 1, 1), (-10, 0, 0), 1, "light"),
                  _mpm.block("rests", (6.2, 1.2, 1.2), (1, 1, 1), (0, 0, 0), 1, "heavy")]
        for algorithm in SCHEMES:
            check("single", "linear", algorithm, single, 0.2, (8, 4, 4), 2)

    def test_restarts_between_corrections(self):
        """Wherever a run stops between two steps that correct, it goes on to the same bits."""
        for algorithm in SCHEMES:
            text = scene("QuadraticBSpline", 'FMPM xpic_order="3" xpic_interval="3"', algorithm)
            alone = self.run_in(f"alone {algorithm}", [self.write(text)]).state
            stops = {}
            for parts in (3, 5, 7, 11, 13, 17, 19, 23):
                if len(stops) == 3:
                    break
                folder = f"stops {algorithm} {parts}"
                self.run_in(folder, [self.write(text.replace(f'time_interval="{END / 2}"', f'time_interval="{END / parts}"'))])
                for file in _mpm.restarts(self.folder / folder):
                    stops.setdefault(int(file.stem.rpartition("_")[2]) % 3, file)
            self.assertEqual(set(stops), {0, 1, 2})
            for rest, file in stops.items():
                with self.subTest(algorithm=algorithm, steps_since_the_last=rest):
                    self.assertEqual(self.run_in(f"again {algorithm} {rest}", [file], ranks=1 + rest).state, alone)

    def test_energy_of_a_collision(self):
        """Two blocks collide and part. The energy that FMPM and XPIC lose falls from order to order; that of order 1 is
        PIC's; every tenth step costs less than every step."""
        blocks = [_mpm.block("left", (2, 3, 3), (3, 3, 3), (4, 0, 0), of="warm"),
                  _mpm.block("right", (6, 3.5, 2.5), (3, 3, 3), (-2, 0, 0), of="cold")]
        free = GRID.replace("200140", "000000")

        def lost(shape, transfer):
            self.run_in("out", [self.write(scene(shape, transfer, "MUSL", 0.5, blocks, 0, free))])
            return -_mpm.summary(self.folder / "out")["energy"]["relative_drift"]

        for shape in ("linear", "QuadraticBSpline"):
            pic, flip = lost(shape, "PIC"), lost(shape, "FLIP")
            for transfer in ("XPIC", "FMPM"):
                with self.subTest(shape=shape, transfer=transfer):
                    orders = [lost(shape, f'{transfer} xpic_order="{n}"') for n in (1, 2, 4, 8)]
                    self.assertEqual(orders[0], pic)
                    for lower, higher in zip(orders, orders[1:]):
                        self.assertLess(higher, 0.9 * lower, f"{orders}")
                    self.assertGreater(orders[-1], flip)
                    seldom = lost(shape, f'{transfer} xpic_order="2" xpic_interval="10"')
                    self.assertTrue(flip < seldom < 0.9 * orders[1], f"{flip} {seldom} {orders}")

    def test_energy(self):
        """A block vibrates freely in its longest mode: FLIP keeps its energy, PIC loses it, AFLIP loses little of it."""
        bar = _mpm.block("bar", (1.3, 2.2, 2.1), (8, 3, 3), ("0.5*cos(pi*(x-1.3)/8)", 0, 0), of="warm")
        lost = {}
        for shape in SHAPES:
            for transfer in ("FLIP", "PIC") + (("AFLIP",) if shape in AFFINE_SHAPES else ()):
                self.run_in("out", [self.write(scene(shape, transfer, "MUSL", 0.5, [bar], 0))])
                lost[shape, transfer] = -_mpm.summary(self.folder / "out")["energy"]["relative_drift"]
        for (shape, transfer), share in lost.items():
            least, most = {"FLIP": (-0.001, 0.06), "PIC": (0.5, 1), "AFLIP": (0, 0.12)}[transfer]
            self.assertTrue(least < share < most, f"{shape} with {transfer}: {share}; all: {lost}")

    def test_energy_of_rotation(self):
        """A cube turns by a radian: what each transfer loses, in the order that docs/methods.md reports."""
        cube = _mpm.block("cube", (3, 3, 3), (5, 5, 5), ("-(y-5.5)", "x-5.5", 0), of="warm")
        free = _mpm.grid((0, 0, 0), (11, 11, 11))
        transfers = ("FLIP", "AFLIP", "APIC", 'FMPM xpic_order="5"', 'FMPM xpic_order="2"', "PIC")
        kept = []
        for transfer in transfers:
            self.run_in("out", [self.write(scene("QuadraticBSpline", transfer, "MUSL", 1, [cube], 0, free))])
            kept.append(1 + _mpm.summary(self.folder / "out")["energy"]["relative_drift"])
        for more, less in zip(kept, kept[1:]):
            self.assertLess(less, 0.999 * more, f"{transfers}: {kept}")

    def test_what_a_method_carries(self):
        """No column that the method does not need."""
        said = {}
        for shape, transfer in (("linear", "FLIP"), ("SGMP", "FLIP"), ("QuadraticBSpline", "PIC"), ("uGIMP", "FLIP"),
                                ("CPDI", "FLIP"), ("CPDI2", "FLIP"), ("CubicBSpline", "APIC"),
                                ("cpGIMP", 'FMPM xpic_order="5"')):
            outcome = self.run_in("out", [self.write(scene(shape, transfer, "MUSL")), "--dry-run"])
            said[shape] = next(line for line in outcome.out.splitlines() if "bytes per particle" in line)
        plain = said["linear"]
        self.assertEqual(said["SGMP"], plain)
        self.assertEqual(said["QuadraticBSpline"], plain)
        bytes_of = {shape: int(line.split(" bytes")[0].split()[-1]) for shape, line in said.items()}
        self.assertEqual(bytes_of["uGIMP"], bytes_of["linear"] + 3 * 8)
        self.assertEqual(bytes_of["CPDI"], bytes_of["linear"] + 9 * 8)
        self.assertEqual(bytes_of["CPDI2"], bytes_of["linear"] + 24 * 8)
        self.assertEqual(bytes_of["cpGIMP"], bytes_of["uGIMP"])
        self.assertEqual(bytes_of["CubicBSpline"], bytes_of["linear"] + 9 * 8)

    def test_pairs_that_do_not_go_together(self):
        for shape in PLAIN_SHAPES:
            for transfer in AFFINE:
                outcome = self.run_in("out", [self.write(scene(shape, transfer, "MUSL"))], INPUT_ERROR)
                self.assertIn(f'transfer="{transfer}">: is not available with this shape function', outcome.err)
        outcome = self.run_in("out", [self.write(scene("linear", 'APIC mass="consistent"', "USL"))], INPUT_ERROR)
        self.assertIn("is available only with transfer FLIP, not with APIC", outcome.err)
        self.assertIn("is not available with algorithm USL", outcome.err)
        outcome = self.run_in("out", [self.write(scene("linear", 'PIC flip_fraction="0.5"', "MUSL"))], INPUT_ERROR)
        self.assertIn("is available only with transfer FLIP, not with PIC", outcome.err)

    def test_domains_wider_than_their_support(self):
        """A bar that is drawn to several times its length: the log and the restart say how often domains were too wide."""
        bar = _mpm.block("bar", (3, 3, 3), (3, 3, 2), ("3*(x-4.5)", 0, 0), of="soft")
        soft = [_mpm.material("soft", 1.0, 'type="IsoElastic" Young="1e-3" Poisson="0"')]
        grid = _mpm.grid((-20, 0, 0), (50, 9, 8))
        for shape, words in (("cpGIMP", "with a domain wider than a cell"), ("CPDI", "with a domain that extends more than a cell"),
                             ("CPDI2", "with a domain that extends more than a cell")):
            text = _mpm.scene([bar], grid.replace("<Grid>", f'<Grid shape="{shape}">'), _mpm.solution(1.5, "MUSL", 0.4), soft,
                              '<Console print_time="0.5"/>')
            outcome = self.run_in("out", [self.write(text)])
            self.assertIn(words, outcome.out)

    def test_spherical_shells_have_no_boxes(self):
        ball = ('<Body name="ball" material="warm" type="Sphere"><Geometry dp="0.5" x0="4" y0="4" z0="4" Outer_Radius="2" '
                'discretization="1"/></Body>')
        for shape in ("cpGIMP", "CPDI", "CPDI2"):
            text = scene(shape, "FLIP", "MUSL").replace("<Component", f"<Component name='b'>{ball}</Component><Component", 1)
            outcome = self.run_in("out", [self.write(text)], INPUT_ERROR)
            self.assertIn("spherical shells", outcome.err)


if __name__ == "__main__":
    _mpm.main()
