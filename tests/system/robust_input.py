"""Bad input: the right exit code, one clear message however many ranks there are, soon, and nothing left behind."""

import os
import re
import shutil

import _mpm
from _mpm import FILE_ERROR, INPUT_ERROR, Case

ROOMY = _mpm.grid((0, 0, 0), (8, 8, 8))
SHORT = _mpm.solution(0.1)


def cube(name="cube", x=2, **more):
    return _mpm.block(name, (x, 2, 2), (4, 4, 4), **more)


BODY = cube()
GOOD = _mpm.scene([BODY], ROOMY, SHORT)
GRAINS = '<Body name="grains" material="soft" type="Point"><Geometry file="grains.txt"/></Body>'
DIMENSIONS = '<DomainDecomposition dimension0="3" dimension1="2" dimension2="1"/>'
BOMB = ('<?xml version="1.0"?>\n<!DOCTYPE PeneBlast [<!ENTITY a0 "ha">'
        + "".join(f'<!ENTITY a{i} "{10 * f"&a{i - 1};"}">' for i in range(1, 12)) + "]>\n"
        + GOOD.split("\n", 1)[1].replace('name="cube"', 'name="&a11;"'))
OUTSIDER = ('<?xml version="1.0"?>\n<!DOCTYPE PeneBlast [<!ENTITY secret SYSTEM "file:///etc/passwd">]>\n'
            + GOOD.split("\n", 1)[1].replace('name="cube"', 'name="&secret;"'))


def changed(old, new):
    """The good scene with one thing changed."""
    assert old in GOOD, old
    return GOOD.replace(old, new)


def one_body(body):
    return _mpm.scene([body], ROOMY, SHORT)


def in_grid(grid):
    return _mpm.scene([BODY], grid, SHORT)


# Name, text of the file, what the message has to say.
SCENES = [
    ("empty file", "", ["case.xmp", "empty"]),
    ("text that is no XML", "Hello", ["case.xmp:1"]),
    ("zeros", b"\0" * 4096, ["case.xmp"]),
    ("another root", '<?xml version="1.0"?><html/>', ["case.xmp:1", "PeneBlast"]),
    ("infinite", changed('vx="0"', 'vx="inf"'), ["vx", "inf"]),
    ("a word for a number", changed('Young="1000"', 'Young="stiff"'), ["Young", "stiff"]),
    ("negative density of a body", one_body(cube(attributes='density="-1"')), ["density", "-1"]),
    ("dp below 0", one_body(cube(dp=-0.5)), ["dp", "-0.5"]),
    ("unknown element", changed("<EndTime", '<EndTim value="1"/><EndTime'), ["EndTim", "EndTime"]),
    ("unknown attribute", changed("Young=", 'Yuong="1" Young='), ["Yuong", "Young"]),
    ("unknown strength model", changed("IsoElastic", "IsoElastik"), ["IsoElastik", "IsoElastic"]),
    ("missing attribute", changed('Poisson="0.3"', ""), ["Poisson"]),
    ("missing Grid", in_grid(""), ["Grid"]),
    ("missing Material", GOOD.replace(_mpm.material(), ""), ["Material"]),
    ("cells larger than the grid", in_grid(_mpm.grid((0, 0, 0), (8, 8, 8), cell=10)), ["DCell", "10"]),
    ("too many cells", in_grid(_mpm.grid((0, 0, 0), (8, 8, 8), cell=1e-12)), ["cells"]),
    ("a wall between nodes", in_grid(_mpm.grid((0, 0, 0), (8.5, 8, 8), "020000")), ["XMax", "8.5"]),
    ("the end before the beginning", changed('EndTime value="0.1"', 'EndTime value="-0.1"'), ["EndTime", "-0.1"]),
    ("too many threads", changed("<EndTime", '<OpenMPSetting nthread="100000"/><EndTime'),
     ["OpenMPSetting", "100000", "1024"]),
    ("two bodies of one name", _mpm.scene([BODY, BODY], ROOMY, SHORT), ["cube", "already"]),
    ("known, but not implemented", changed("<DCell", '<MovingGrid enable="1"/><DCell'),
     ["MovingGrid", "not implemented"]),
    ("contact with one component", changed("<Output>", '<Contact enable="1"/><Output>'),
     ["Contact", "enable", "components"]),
    ("twelve million cells along an axis", in_grid(_mpm.grid((0, 0, 0), (8, 8, 8), cell=8 / 12e6)),
     ["DCell", "1.2e+07 cells", "at most 4194304"]),
    ("a number that would become 0", changed('vx="0"', 'vx="1e-310"'), ["vx", "1e-310", "out of the range", "write 0"]),
    ("particles of no mass", one_body(_mpm.block("cube", (2, 2, 2), (1e-120,) * 3, dp=1e-120)), ["dp", "1e-120", "other units"]),
    ("a material for bars", changed("IsoElastic", "Elastic_1D"), ["case.xmp:", "Body", "for bars", "without _1D"]),
    ("a rigid body beside others", _mpm.scene([BODY, cube("ram", 1, of="iron")], ROOMY, SHORT,
                                              [_mpm.material(), _mpm.material("iron", 8.0, 'type="Rigid"')]),
     ['material="iron"', "through contact", "pass through 'cube'"]),
    ("an explosive that is not lit", changed('type="IsoElastic" Young="1000" Poisson="0.3"', 'type="HighExpBurn" D="6930"'),
     ["HighExpBurn", "add a Detonation"]),
    ("a particle file that is not there", one_body(GRAINS), ["grains.txt", "no such file"]),
]
SCENES_ON_TWO_RANKS_TOO = [
    ("cut in half", GOOD[: len(GOOD) // 2], ["case.xmp:"]),
    ("a tag that is not closed", changed("</Component>", ""), ["case.xmp:", "Component"]),
    ("entity bomb", BOMB, ["case.xmp:", "DOCTYPE"]),
    ("external entity", OUTSIDER, ["case.xmp:", "DOCTYPE"]),
    ("not a number", changed('Young="1000"', 'Young="nan"'), ["Young", "nan"]),
    ("negative density", changed('Density value="1.0"', 'Density value="-1"'), ["ReferenceDensity", "-1"]),
    ("dp 0", one_body(cube(dp=0)), ["dp", "0"]),
    ("a body outside the grid", one_body(cube("far", 20)), ["far", "outside the grid", "from 20 to 24"]),
    ("a body half outside", one_body(cube("half", 6)), ["half", "outside", "256 particles"]),
    ("a billion billion particles", one_body(cube("dust", dp=4e-6)), ["1e+18", "dp"]),
    ("more particles than memory", one_body(cube("dust", dp=4e-4)), ["1e+12", "GiB", "dp"]),
    ("unknown material", one_body(cube(of="sofft")), ["sofft", "did you mean 'soft'"]),
    ("dimensions that are not the number of ranks", _mpm.scene([BODY], ROOMY, SHORT, more=DIMENSIONS),
     ["dimension0", "= 6", "number of ranks"]),
]

# Reasons of the machine, not of the input: mpm_check lets them pass.
MACHINES = {"more particles than memory", "dimensions that are not the number of ranks"}

# Name, the command line behind the program's name, exit code, what the message has to say. {} is the test's folder,
# which holds good.xmp and a file named `file`.
LINES = [
    ("nothing", [], INPUT_ERROR, ["job"]),
    ("an empty name", [""], INPUT_ERROR, ["name of the job is empty", "Job.xmp"]),
    ("a file named .xmp", ["{}/hidden/.xmp"], INPUT_ERROR, [".xmp", "empty before .xmp", "rename"]),
    ("missing file", ["{}/none.xmp"], INPUT_ERROR, ["none.xmp", "no such file"]),
    ("missing file, no ending", ["{}/none"], INPUT_ERROR, ["none", "no such file"]),
    ("a folder", ["{}"], INPUT_ERROR, []),
    ("unknown option", ["{}/good.xmp", "--ranks", "3"], INPUT_ERROR, ["--ranks"]),
    ("two inputs", ["{}/good.xmp", "{}/good.xmp"], INPUT_ERROR, ["good.xmp"]),
    ("-nsteps without a number", ["{}/good.xmp", "-nsteps"], INPUT_ERROR, ["nsteps"]),
    ("-nsteps 0", ["{}/good.xmp", "-nsteps", "0"], INPUT_ERROR, ["nsteps", "0"]),
    ("-nsteps many", ["{}/good.xmp", "-nsteps", "many"], INPUT_ERROR, ["nsteps", "many"]),
    ("no wall time", ["{}/good.xmp", "--max-wall-time", "-1"], INPUT_ERROR, ["max-wall-time", "-1"]),
    ("-rt with an input", ["{}/good.xmp", "-rt", "{}/good.xmp"], INPUT_ERROR, ["-rt", ".pe"]),
    ("-h5pt of an input", ["{}/good.xmp", "-h5pt"], INPUT_ERROR, ["-h5pt", ".pe"]),
    ("-h5pt without a run", ["{}/case_1.pe", "-h5pt", "--dry-run", "-nsteps", "1", "--max-wall-time", "1"], INPUT_ERROR,
     ["--dry-run", "-nsteps", "--max-wall-time", "runs no steps"]),
    ("-lsdyna", ["{}/good.xmp", "-lsdyna"], INPUT_ERROR, ["-lsdyna", "not implemented"]),
    ("output folder is a file", ["{}/good.xmp", "--output-dir", "{}/file"], FILE_ERROR, ["{}/file"]),
    ("output folder below a file", ["{}/good.xmp", "--output-dir", "{}/file/out"], FILE_ERROR, ["{}/file"]),
    ("output folder of the kernel's", ["{}/good.xmp", "--output-dir", "/proc/1/out"], FILE_ERROR, ["/proc/1/out"]),
]


class BadInput(Case):
    def expect(self, arguments, code, words, ranks):
        outcome = _mpm.run(arguments, ranks=ranks)
        self.assertEqual(outcome.code, code, outcome)
        self.assertNotRegex(outcome.out + outcome.complaint, r"terminate called|Assertion|what\(\)|Segmentation")
        lines = [line for line in (outcome.out + outcome.complaint).splitlines() if line.strip()]
        for word in words:
            self.assertTrue(any(word.lower() in line.lower() for line in lines), f"{word!r} is not in: {outcome}")
        complaints = [line for line in lines if not re.match(r"(grid|particles|memory|body|step|time step|  ) ", line)]
        self.assertGreater(len(complaints), 0, outcome)
        self.assertEqual(len(complaints), len(set(complaints)), f"said more than once: {outcome}")
        self.assertLess(len(complaints), 5, outcome)

    def same_verdict(self, name, words):
        """mpm_check finds what a run refuses, and says the same."""
        outcome = _mpm.run([self.folder / "case.xmp"], program="mpm_check", timeout=20)
        self.assertEqual(outcome.code, _mpm.DONE if name in MACHINES else INPUT_ERROR, outcome)
        for word in words if outcome.code == INPUT_ERROR else []:
            self.assertIn(word.lower(), outcome.err.lower())

    def nothing_left(self, names):
        found = _mpm.names(self.folder)
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        self.assertEqual(found, names, "something was left behind")

    def check_scene(self, name, text, words, all_ranks=(1, 2)):
        self.write(text)
        with self.subTest(name, program="mpm_check"):
            self.same_verdict(name, words)
        for ranks in all_ranks:
            with self.subTest(name, ranks=ranks):
                self.expect([self.folder / "case.xmp", "--output-dir", self.folder / "out"], INPUT_ERROR, words, ranks)
                self.nothing_left(["case.xmp"])

    def test_scenes(self):
        for scene in SCENES:
            self.check_scene(*scene, all_ranks=(1,))

    def test_scenes_on_two_ranks_too(self):
        for scene in SCENES_ON_TWO_RANKS_TOO:
            self.check_scene(*scene)

    def test_all_faults_of_a_file_at_once(self):
        text = changed('Young="1000"', 'Young="nan"').replace('dp="0.5"', 'dp="0"')
        text = text.replace('material="soft"', 'material="sooft"')
        self.check_scene("three faults", text, ['Young="nan"', 'dp="0"', 'material="sooft"'])

    def test_faults_of_contact_at_once(self):
        """No second component, friction below zero, and friction with a material that is not there: each said once, nothing else."""
        more = ('<Friction><Coefficient value="-0.3" mat1="soft" mat2="soft"/><Coefficient value="0.3" mat1="soft" mat2="sofd"/></Friction>'
                '<Contact enable="1"/>')
        self.check_scene("contact", _mpm.scene([BODY], ROOMY, SHORT, more=more),
                         ['value="-0.3">: expected a number of at least 0', 'mat2="sofd"', "did you mean 'soft'",
                          "components of their own, or set enable to 0"])

    def test_contact_warns(self):
        """Of what it can do, but hardly as meant: in the log and by mpm_check, in the same words on any ranks."""
        components = "".join(f'<Component name="{name}">{_mpm.block(name, lower, (2, 2, 2))}</Component>'
                             for name, lower in (("a", (1, 1, 1)), ("b", (3.2, 1, 1)), ("c", (1, 3.2, 1))))
        ram = _mpm.block("ram", (1, 1, 3), (2, 2, 2), of="iron").replace('<InitialVelocity vx="0" vy="0" vz="0"/>', "")
        text = _mpm.scene([ram], ROOMY, SHORT, [_mpm.material(), _mpm.material("iron", 8.0, 'type="Rigid"')],
                          more=components + '<Contact enable="1" contact_type="1" distance_type="2" contact_normal="mass_gradient"/>')
        self.write(text)
        checked = _mpm.run([self.folder / "case.xmp"], program="mpm_check")
        notes = [line for line in checked.out.splitlines() if line.startswith("note ")]
        for words in (["rigid body 'ram' has no law of motion", "moves freely", "PrescribedVelocity"],
                      ['distance_type="2"', "without min_distance", "up to two cells apart", "0.05"],
                      ["components 'a', 'b' and 'c' have the same normal_vector_weight", "three of them meet"]):
            self.assertEqual(len([line for line in notes if all(word in line for word in ["case.xmp:", *words])]), 1, (words, checked.out))
        self.assertEqual(len(notes), 3, checked.out)
        for ranks in (1, 2):
            outcome = self.run_in("out", [self.folder / "case.xmp"], ranks=ranks)
            for note in notes:
                self.assertEqual(outcome.out.count(note), 1, note)

    def test_command_lines(self):
        here = str(self.folder)
        self.write(GOOD, "good.xmp")
        self.write("", "file")
        (self.folder / "hidden").mkdir()
        self.write(GOOD, "hidden/.xmp")
        for name, line, code, words in LINES:
            for ranks in (1, 2) if name in ("missing file", "unknown option", "output folder is a file") else (1,):
                with self.subTest(name, ranks=ranks):
                    arguments = [word.format(here) for word in line]
                    if "--output-dir" not in line:
                        arguments += ["--output-dir", f"{here}/out"]
                    self.expect(arguments, code, [word.format(here) for word in words], ranks)
                    self.nothing_left(["file", "good.xmp", "hidden", "hidden/.xmp"])

    def test_folders_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        self.write(GOOD, "good.xmp")
        closed = self.folder / "closed"
        closed.mkdir(mode=0o500)
        for folder in (closed, closed / "out"):
            self.expect([self.folder / "good.xmp", "--output-dir", folder], FILE_ERROR, [str(closed), "ermission"], 1)

    def test_bad_particle_files(self):
        self.write(one_body(GRAINS))
        for name, lines, words in [("not a number", "1 2 2 2\n1 3 nan 2\n", ["grains.txt:2"]),
                                   ("too few", "1 2 2 2\n1 3 2\n", ["grains.txt:2"]),
                                   ("too small", "1 2 2 2\n1 1e-310 2 2\n", ["grains.txt:2", "1e-310", "write 0"]),
                                   ("mass below zero", "-1 2 2 2\n", ["grains.txt:1"]),
                                   ("empty", "", ["grains.txt"]),
                                   ("outside", "1 2 2 2\n1 30 2 2\n", ["grains", "outside"])]:
            for ranks in (1, 2) if name == "outside" else (1,):
                with self.subTest(name, ranks=ranks):
                    self.write(lines, "grains.txt")
                    line = [self.folder / "case.xmp", "--output-dir", self.folder / "out"]
                    self.same_verdict(name, words)
                    self.expect(line, INPUT_ERROR, words, ranks)
                    self.nothing_left(["case.xmp", "grains.txt"])

    def test_what_has_no_effect_is_said(self):
        """In the log and by mpm_check, in the same words."""
        more = ('<Contact enable="0" contact_type="2"/><Friction><Coefficient value="0.1" mat1="soft" mat2="soft"/></Friction>')
        two = _mpm.scene([BODY], ROOMY, SHORT, more=more).replace("</Component>", '</Component><Component name="other">'
                                                                   + _mpm.block("lid", (2, 2, 6), (4, 4, 1)) + "</Component>")
        self.write(two)
        checked = _mpm.run([self.folder / "case.xmp"], program="mpm_check")
        self.assertEqual(checked.code, _mpm.DONE, checked)
        notes = [line for line in checked.out.splitlines() if line.startswith("note ")]
        for words in (['<Contact contact_type="2">', "Contact is off"], ["<Friction>", "used only by Contact"],
                      ["<Component>", "bodies 'cube' and 'lid' touch at the start", "stick"]):
            self.assertEqual(len([line for line in notes if all(word in line for word in words)]), 1, (words, checked.out))
        self.assertEqual(len(notes), 3, checked.out)
        for ranks in (1, 2):
            outcome = self.run_in("out", [self.folder / "case.xmp"], ranks=ranks)
            log = (self.folder / "out/case.out").read_text()
            for note in notes:
                self.assertEqual((outcome.out.count(note), log.count(note)), (1, 1), note)

    def test_specification_of_the_users(self):
        good = self.write(GOOD, "good.xmp")
        text = (_mpm.SOURCE / "io/input/Specification.xml").read_text()
        mine = self.write(text.replace('<InitialVelocity spec=', '<Magnet spec="OPTIONAL, NO_DATA" attribute1="strength, '
                                       'REQUIRED, DOUBLE, 0:3"/>\n      <InitialVelocity spec='), "mine.xml")
        magnet = self.write(GOOD.replace("<InitialVelocity", '<Magnet strength="2"/><InitialVelocity'), "magnet.xmp")

        def check(specification, *files):
            return _mpm.run(["--specification", specification, *files], program="mpm_check")

        outcome = check(mine, good, magnet)
        self.assertEqual(outcome.code, _mpm.DONE, outcome)
        self.assertIn(f", by {mine}", outcome.out)
        self.assertRegex(outcome.out, r"note .*magnet.xmp:\d+: <Magnet>: defined in the Specification, but not in this program")
        self.assertEqual(_mpm.run([magnet], program="mpm_check").code, INPUT_ERROR)
        self.write(magnet.read_text().replace('"2"', '"4"'), "magnet.xmp")
        outcome = check(mine, magnet)
        self.assertEqual(outcome.code, INPUT_ERROR, outcome)
        self.assertIn('<Magnet strength="4">: expected a number in [0, 3]', outcome.err)
        self.write(mine.read_text().replace("DOUBLE, 0:3", "FLOAT"), "mine.xml")
        outcome = check(mine, good)
        self.assertEqual(outcome.code, INPUT_ERROR, outcome)
        line = next(n for n, text in enumerate(mine.read_text().splitlines(), 1) if "FLOAT" in text)
        self.assertIn(f"{mine}:{line}: <Magnet attribute1=", outcome.err)
        # The one beside the program is read by itself.
        beside = self.folder / "bin"
        beside.mkdir()
        shutil.copy(_mpm.BIN / "mpm_check", beside)
        shutil.copy(mine, beside / "Specification.xml")
        outcome = _mpm.run([good], program=beside / "mpm_check")
        self.assertEqual(outcome.code, INPUT_ERROR, outcome)
        self.assertIn("bin/Specification.xml:", outcome.err)

    def test_files_of_an_earlier_run_stay(self):
        """Bad input must not cost the results of the good input before it."""
        self.write(GOOD)
        self.run_in("out", [self.folder / "case.xmp"])
        before = _mpm.contents(self.folder / "out")
        self.write(one_body(cube("half", 6)))
        self.run_in("out", [self.folder / "case.xmp"], code=INPUT_ERROR)
        self.assertEqual(_mpm.contents(self.folder / "out"), before)


if __name__ == "__main__":
    _mpm.main()
