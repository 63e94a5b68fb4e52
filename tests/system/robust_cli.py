"""The command line, and what the files of a run hold: each well-formed, each with its provenance."""

import re
import struct
import xml.etree.ElementTree as ElementTree

import h5py
import numpy

import _cases
import _mpm
from _mpm import BIN, DONE, FILE_ERROR, INPUT_ERROR, NUMERICAL_FAILURE, Case

# Names that would break a carelessly written file.
TITLE = "a -- b <c> & \u201cd\u201d \u706b"
BODY = 'bolt "A" & <B>, 100%'
HEADER = ('<Header><Name value="case"/><Heading value="{}"/><Unit time="ms" length="mm" mass="g"/></Header>'
          .format(TITLE.replace("&", "&amp;").replace("<", "&lt;")))
ESCAPED = BODY.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
OUTPUT = ('<Console print_time="0.1" print_momentum="1"/>'
          '<PostProcessing time_interval="0.25" h5part="1" vtk_data="{vtk}" var="seqv|pres|SigmaXY"/>'
          '<TimeHistory var="pres|velocity_0"><Particle x="2" y="3" z="3"/><Point x="8" y="4" z="4"/></TimeHistory>'
          '<Restart time_interval="0.25"/><Statistics memory="1" cell_occupy="1"/>')
END = 1.0
PROVENANCE = ["program", "version", "git", "build", "job", "input", "input_hash", "heading", "time_unit", "length_unit",
              "mass_unit", "written"]
FIELDS = ["SigmaXY", "body", "id", "pres", "seqv", "velocity_0", "velocity_1", "velocity_2", "x", "y", "z"]
# The contract at the end of keywords.md.
SUMMARY = ["job", "version", "git", "status", "reason", "ranks", "threads", "steps", "time", "end_time", "particles",
           "wall_seconds", "particle_steps_per_second", "bytes_per_particle", "peak_memory_bytes", "energy", "momentum",
           "angular_momentum", "bodies"]
SUMMARY_MORE = ["input_hash", "units"]
ENERGY = ["kinetic", "internal", "external_work", "dissipated_by_contact", "total", "initial_total", "relative_drift"]
SUMMARY_BODY = ["name", "material", "component", "particles", "active", "failed", "eroded", "mass", "centre",
                "velocity", "lower", "upper", "kinetic", "internal", "max_epef", "max_temperature"]


def collision(vtk=1):
    """Two blocks; the second one's name is harmless."""
    bodies = [_mpm.block(ESCAPED, (1, 2, 2), (4, 4, 4), (2, 1, 0)),
              _mpm.block("right", (9, 2, 2), (4, 4, 4), (-3, 0, 1))]
    return _mpm.scene(bodies, _mpm.grid((0, 0, 0), (16, 8, 8), "222222"), _mpm.solution(END),
                      output=OUTPUT.format(vtk=vtk), more=HEADER)


def heads(text):
    """The comment lines of a text table as a dictionary."""
    return dict(re.findall(r"^# (\w+): (.*)$", text, re.MULTILINE))


def read_vtu(path):
    """Arrays of a .vtu file with appended raw data: {name: array}."""
    data = path.read_bytes()
    head, appended = data.split(b'<AppendedData encoding="raw">', 1)
    appended = appended[appended.index(b"_") + 1:]
    root = ElementTree.fromstring(head + b"</VTKFile>")
    assert root.get("byte_order") == "LittleEndian" and root.get("header_type") == "UInt64"
    points = int(root.find(".//Piece").get("NumberOfPoints"))
    arrays = {}
    for item in root.iter("DataArray"):
        if item.get("format") != "appended":
            continue
        offset = int(item.get("offset"))
        (size,) = struct.unpack_from("<Q", appended, offset)
        kind = numpy.dtype({"Float": "f", "UInt": "u", "Int": "i"}[item.get("type").rstrip("0123456789")]
                           + str(int(re.search(r"\d+$", item.get("type")).group()) // 8)).newbyteorder("<")
        values = numpy.frombuffer(appended, kind, size // kind.itemsize, offset + 8)
        width = int(item.get("NumberOfComponents", "1"))
        arrays[item.get("Name")] = values.reshape(-1, width) if width > 1 else values
        assert len(arrays[item.get("Name")]) == points, (path, item.get("Name"))
    tail = appended[offset + 8 + size:]
    assert tail.split() == [b"</AppendedData>", b"</VTKFile>"], tail
    return arrays


class CommandLine(Case):
    def test_help_and_version(self):
        for program in ("mpm_run", "mpm_check", "mpm_point", "mpm_hjc"):
            if not (BIN / program).exists():
                print(f"{program} is not built: left out")
                continue
            outcome = _mpm.run(["--help"], program=program)
            self.assertEqual(outcome.code, DONE, outcome)
            self.assertEqual(outcome.err, "")
            self.assertIn("Usage", outcome.out)
        for ranks in (1, 2):
            outcome = _mpm.run(["--help"], ranks=ranks)
            self.assertEqual(outcome.out.count("Usage"), 1, "said by one rank")
            for word in ("-h5pt", "-lsdyna", "-rt", "-nsteps", "--max-wall-time", "--output-dir", "--dry-run",
                         "Exit codes"):
                self.assertIn(word, outcome.out)
        outcome = _mpm.run(["--version"])
        self.assertEqual(outcome.code, DONE, outcome)
        self.assertRegex(outcome.out, r"^\d+\.\d+\.\d+ \(([0-9a-f]+|unknown)\)\n$")

    def test_dry_run(self):
        case = self.write(collision())
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                outcome = self.run_in("out", [case, "--dry-run"], ranks=ranks)
                self.assertEqual(_mpm.names(self.folder / "out"), ["case.out"])
                self.assertIn(f"particles  1024, on {ranks} rank(s)", outcome.out)
                self.assertRegex(outcome.out, r"16 x 8 x 8 cells.* \d+ bricks .* in use")
                self.assertRegex(outcome.out, r"memory +[\d.]+ [kMG]B")
                self.assertRegex(outcome.out, r'body +"right" of "soft": \d+ bytes per particle')
                critical = float(re.search(r"time step +critical ([\d.e+-]+)", outcome.out).group(1))
                # Smallest cell over elastic wave speed and fastest particle.
                wave = (1000 * 0.7 / (1.3 * 0.4)) ** 0.5
                self.assertAlmostEqual(critical, 1 / (wave + 10**0.5), delta=1e-6)

                # A density in other units shows in the speed of waves.
                self.assertIn(f'material   "soft": density 1, speed of waves at rest {wave:.4g}\n', outcome.out)

    def test_dry_run_names_the_columns_of_a_material(self):
        hard = _mpm.material("soft", strength='type="IsoHarden" Young="1000" Poisson="0.3" Yield0="1" TangMod="10"')
        text = _mpm.scene([_mpm.block("cube", (2, 2, 2), (4, 4, 4))], _mpm.grid((0, 0, 0), (8, 8, 8)),
                          _mpm.solution(1), [hard])
        outcome = self.run_in("out", [self.write(text), "--dry-run"])
        self.assertRegex(outcome.out, r'body .*beyond the mechanics.* effective_plastic_strain')

    def test_dry_run_costs_nothing(self):
        """Neither the results of an earlier run nor its log."""
        case = self.write(collision())
        self.run_in("out", [case])
        before = _mpm.contents(self.folder / "out")
        for argument in (case, self.folder / "out/case.pe"):
            self.run_in("out", [argument, "--dry-run"])
        for name, data in before.items():
            now = (self.folder / "out" / name).read_bytes()
            self.assertEqual(now[: len(data)] if name == "case.out" else now, data, name)

    def test_a_history_of_a_particle_far_from_its_point(self):
        # The cube's corner at (6, 6, 6) is less than a spacing of 0.5 from the nearest particle.
        points = '<TimeHistory var="pres"><Particle x="6" y="6" z="6"/><Particle x="6" y="6" z="7"/></TimeHistory>'
        text = _mpm.scene([_mpm.block("cube", (2, 2, 2), (4, 4, 4))], _mpm.grid((0, 0, 0), (8, 8, 8)),
                          _mpm.solution(0.01), output=points)
        for ranks in (1, 2):
            outcome = self.run_in("out", [self.write(text)], ranks=ranks)
            found = [line for line in outcome.out.splitlines() if "nearest to" in line]
            self.assertEqual(found, ["note       particle2 of the time histories, the one nearest to (6, 6, 7), is 1.299 "
                                     "away, more than the distance 0.5 of particles: no body is at this point"])

    def test_volumes_of_accumulated_strains(self):
        """The error that the log gives is that of the strains: 1 + e against exp(e) along each axis."""
        for speed in (0.1, 1.5):
            body = _mpm.block("bar", (0, 0, 0), (8, 2, 2)).replace(
                '<InitialVelocity vx="0" vy="0" vz="0"/>', f'<PrescribedVelocity vx="-{speed}*X/8" vy="0" vz="0"/>')
            text = _mpm.scene([body], _mpm.grid((0, 0, 0), (10, 4, 4), "202020"),
                              _mpm.solution(1, more='<Volume update_type="4"/>'),
                              output='<PostProcessing time_interval="1" h5part="1" var="exx|eyy|ezz"/>')
            outcome = self.run_in(f"at {speed}", [self.write(text)])
            states = _cases.States(self.folder / f"at {speed}")
            strains = [states.column(name) for name in ("exx", "eyy", "ezz")]
            errors = numpy.abs(numpy.prod([(1 + e) * numpy.exp(-e) for e in strains], axis=0) - 1)
            found = re.search("warning: Volume update_type 4 is for small strains: at the end the volumes of "
                              r"(\d+) particle\(s\) are wrong by more than 1 %, of one by ([\d.e-]+) %", outcome.out)
            if speed < 1:
                self.assertLess(errors.max(), 0.01)
                self.assertIsNone(found)
            else:
                self.assertIsNotNone(found, outcome)
                self.assertEqual(int(found.group(1)), (errors > 0.01).sum())
                self.assertAlmostEqual(float(found.group(2)) / (100 * errors.max()), 1, delta=0.005)

    def test_name_without_ending_and_with_dots_and_spaces(self):
        self.write(collision(), "my case.v2.xmp")
        for argument in ("my case.v2", "my case.v2.xmp"):
            outcome = _mpm.run([argument, "--output-dir", "my results"], cwd=self.folder)
            self.assertEqual(outcome.code, DONE, outcome)
            self.assertTrue((self.folder / "my results/my case.v2.summary.json").exists())

    def test_results_go_to_the_current_folder(self):
        self.write(collision())
        self.assertEqual(_mpm.run(["case"], cwd=self.folder).code, DONE)
        self.assertIn("case.sta", _mpm.names(self.folder))

    def test_check(self):
        if not (BIN / "mpm_check").exists():
            self.skipTest("mpm_check is not built")
        good = self.write(collision(), "good.xmp")
        bad = self.write(collision().replace('dp="0.5"', 'dp="-1"').replace("soft", "sofft", 1), "bad.xmp")
        outcome = _mpm.run([good], program="mpm_check")
        self.assertEqual((outcome.code, outcome.err), (DONE, ""), outcome)
        self.assertRegex(outcome.out, r"good\.xmp: ok: .*bodies 2, grid 16 x 8 x 8 cells")
        outcome = _mpm.run([good, bad], program="mpm_check")
        self.assertEqual(outcome.code, INPUT_ERROR, outcome)
        self.assertIn("good.xmp: ok", outcome.out)
        self.assertEqual(outcome.err.count('<Geometry dp="-1">'), 2)
        self.assertEqual(outcome.err.count("did you mean 'sofft'?"), 2)
        self.assertEqual(_mpm.run([self.folder / "none"], program="mpm_check").code, INPUT_ERROR)
        self.assertEqual(_mpm.run([], program="mpm_check").code, INPUT_ERROR)

    def test_point(self):
        if not (BIN / "mpm_point").exists():
            self.skipTest("mpm_point is not built")
        case = self.write(collision())
        outcome = _mpm.run([case, "-m", "soft", "-p", "uniaxial_strain 0.001 steps 10"], program="mpm_point")
        self.assertEqual(outcome.code, DONE, outcome)
        head, units, *rows = outcome.out.splitlines()
        self.assertEqual(len(units.split(",")), len(head.split(",")))
        last = dict(zip(head.split(","), map(float, rows[-1].split(","))))
        modulus = 1000 * 0.7 / (1.3 * 0.4)
        self.assertAlmostEqual(last["stress_xx"] / (0.001 * modulus), 1, delta=2e-3)
        outcome = _mpm.run([case, "-m", "steel", "-p", "hold time 1"], program="mpm_point")
        self.assertEqual(outcome.code, INPUT_ERROR)
        self.assertIn("the file contains no material 'steel'; it contains", outcome.err)
        for bad in (["-p", "nonsense 1"], ["-p", "hold time 1", "--set", "Young=-1"], []):
            self.assertEqual(_mpm.run([case, "-m", "soft", *bad], program="mpm_point").code, INPUT_ERROR, bad)
        library = ["--library", "Al-plastic", "--units", "mm g ms"]
        outcome = _mpm.run([*library, "-p", "uniaxial_stress stress 500 time 1"], program="mpm_point")
        self.assertEqual(outcome.code, NUMERICAL_FAILURE, outcome)
        self.assertIn("a stress of 500 MPa cannot be reached, the nearest is 290", outcome.err)
        self.assertEqual(_mpm.run([*library, "-p", "hold time 1", "-o", "/nowhere/a.csv"],
                                  program="mpm_point").code, FILE_ERROR)

    def test_materials(self):
        outcome = _mpm.run(["--materials"], program="mpm_check")
        self.assertEqual((outcome.code, outcome.err), (DONE, ""), outcome)
        self.assertIn("OFHC-Cu-JC: JohnsonCook", outcome.out)


class Results(Case):
    """One run on two ranks; every test looks at some of its files."""

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        self.ended = self.run_in("out", [self.write(collision())], ranks=2)

    def check_provenance(self, found, names=PROVENANCE):
        self.assertEqual([name for name in names if not found.get(name)], [], found)
        self.assertEqual(found["program"], "mpm_run")
        self.assertEqual(found["input"], str(self.folder / "case.xmp"))
        self.assertRegex(found["input_hash"], "^[0-9a-f]{16}$")

    def test_log(self):
        log = (self.out / "case.out").read_text()
        self.check_provenance(dict(re.findall(r"^(\w+) +(.*)$", log, re.MULTILINE)))
        for line in self.ended.out.splitlines():
            self.assertIn(line, log, "what the console says is in the log")
        self.assertRegex(log, r"(?m)^phase +min s +mean s +max s +share +imbalance$")
        self.assertRegex(log, r"(?m)^ +momentum ")
        self.assertRegex(log, r"(?m)^completed ")

    def test_status_table(self):
        text = (self.out / "case.sta").read_text()
        self.check_provenance(heads(text))
        rows = _mpm.table(self.out / "case.sta")
        self.assertEqual(len(rows["step"]), 11)
        self.assertEqual((rows["time"][0], rows["time"][-1]), (0, END))
        for column in rows.values():
            self.assertEqual(len(column), 11)
        for first, second in zip(rows["total"], zip(rows["kinetic"], rows["internal"])):
            self.assertAlmostEqual(first, sum(second), delta=1e-9)
        self.assertIn("px[body:right]", rows)
        self.assertIn("memory_max", rows)
        self.assertTrue(all(0 < part <= 1 for part in rows["cell_occupancy"]))
        self.assertRegex(text.splitlines()[-1], r"\d\.\d{16}e[+-]\d\d")

    def test_histories(self):
        self.check_provenance(heads((self.out / "case_curv.dat").read_text()))
        rows = _mpm.table(self.out / "case_curv.dat")
        steps = _mpm.summary(self.out)["steps"]
        self.assertEqual(rows["step"], list(range(steps + 1)))
        self.assertEqual(rows["velocity_0[particle1]"][0], 2)
        self.assertIn("pres[point1]", rows)

    def test_h5part(self):
        with h5py.File(self.out / "case.h5part") as file:
            self.check_provenance({name: value.decode() for name, value in file.attrs.items() if name in PROVENANCE})
            steps = _mpm.pictures(file)
            times = [float(step.attrs["TimeValue"][()]) for step in steps]
            self.assertEqual((len(times), times[0], times[-1]), (5, 0, END))
            self.assertEqual(times, sorted(times))
            for step in steps:
                self.assertEqual(sorted(step), FIELDS)
                self.assertEqual({item.shape for item in step.values()}, {(1024,)})
                self.assertEqual(len(set(step["id"][()])), 1024)
                self.assertTrue(all(numpy.isfinite(item[()]).all() for item in step.values()))

    def check_vtk(self, per_body):
        collection = ElementTree.parse(self.out / "case.pvd").getroot()
        entries = list(collection.iter("DataSet"))
        self.assertEqual(len(entries), 10 if per_body else 5)
        with h5py.File(self.out / "case.h5part") as file:
            for n, entry in enumerate(entries):
                index = self.out / entry.get("file")
                parallel = ElementTree.parse(index).getroot()
                declared = {item.get("Name") for item in parallel.iter("PDataArray")}
                pieces = [read_vtu(index.parent / piece.get("Source")) for piece in parallel.iter("Piece")]
                for piece in pieces:
                    self.assertLessEqual(declared, set(piece))
                joined = {name: numpy.concatenate([piece[name] for piece in pieces]) for name in declared}
                step = file[f"Step#{n // 2 if per_body else n}"]
                self.assertAlmostEqual(float(entry.get("timestep")), float(step.attrs["TimeValue"][()]), delta=1e-12)
                wanted = step["body"][()] == n % 2 if per_body else numpy.full(1024, True)
                order, other = numpy.argsort(joined["id"]), numpy.argsort(step["id"][()][wanted])
                for name in ("pres", "seqv", "SigmaXY", "body"):
                    self.assertTrue((joined[name][order] == step[name][()][wanted][other]).all(), name)
                for axis, name in enumerate("xyz"):
                    self.assertTrue((joined["Position"][order, axis] == step[name][()][wanted][other]).all(), name)
        names = {entry.get("name") for entry in entries}
        if per_body:
            self.assertIn(BODY, names)
        self.check_provenance(dict(re.findall(r"^  (\w+): (.*)$", (self.out / "case.pvd").read_text(), re.MULTILINE)))
        listed = {entry.get("file") for entry in entries}
        self.assertEqual({f"case_vtu/{p.name}" for p in (self.out / "case_vtu").glob("*.pvtu")}, listed)

    def test_vtk_series(self):
        self.check_vtk(per_body=False)

    def test_vtk_series_per_body(self):
        self.out = self.folder / "bodies"
        self.run_in("bodies", [self.write(collision(vtk=2))], ranks=2)
        self.check_vtk(per_body=True)

    def test_summary(self):
        found = _mpm.summary(self.out)
        self.assertEqual([key for key in found if key not in SUMMARY_MORE], SUMMARY)
        self.assertEqual(list(found["energy"]), ENERGY)
        self.assertEqual(list(found["peak_memory_bytes"]), ["max", "sum"])
        self.assertEqual(list(found["wall_seconds"])[:4], ["total", "setup", "loop", "output"])
        phases = re.search(r"^step +(.*)$", self.ended.out, re.MULTILINE).group(1).split(" | ")
        self.assertEqual(list(found["wall_seconds"])[4:], phases)
        self.assertEqual([list(body) for body in found["bodies"]], 2 * [SUMMARY_BODY])
        self.assertEqual([body["name"] for body in found["bodies"]], [BODY, "right"])
        self.assertEqual((found["job"], found["status"], found["reason"]), ("case", "completed", ""))
        self.assertEqual((found["ranks"], found["threads"], found["particles"], found["time"]), (2, 1, 1024, END))
        self.assertEqual(found["bodies"][1]["mass"], 64)
        self.assertEqual(found["units"], {"time": "ms", "length": "mm", "mass": "g"})
        self.assertGreater(found["wall_seconds"]["total"], found["wall_seconds"]["loop"])
        for numbers in (found["momentum"], found["angular_momentum"], found["bodies"][0]["upper"]):
            self.assertEqual(len(numbers), 3)

    def test_restart_to_h5part(self):
        """-h5pt: the last restart file holds the state of the last picture."""
        newest = _mpm.restarts(self.out)[-1]
        with h5py.File(newest) as file:
            self.assertTrue(file.attrs["input"])
        for ranks in (1, 2):
            outcome = self.run_in("converted", [newest, "-h5pt"], ranks=ranks)
            target = self.folder / f"converted/{newest.stem}.h5part"
            self.assertIn(str(target), outcome.out)
            self.assertEqual(_mpm.names(self.folder / "converted"), [target.name])
            with h5py.File(target) as new, h5py.File(self.out / "case.h5part") as old:
                self.assertEqual(len(_mpm.pictures(new)), 1)
                self.assertEqual(sorted(new["Step#0"]), sorted(old["Step#4"]))
                for name, item in old["Step#4"].items():
                    self.assertTrue((new["Step#0"][name][()] == item[()]).all(), name)
        self.run_in("converted", [self.out / "none.pe", "-h5pt"], code=FILE_ERROR)


if __name__ == "__main__":
    _mpm.main()
