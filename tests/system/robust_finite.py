"""Files hold finite numbers: what would make them hold others is refused before the first step, ends the run with exit
code 3 or is cut and said; a particle that is gone leaves its last values."""

import json

import h5py

import _mpm
import numpy as np
from _mpm import INPUT_ERROR, NUMERICAL_FAILURE, Case

FLIGHT = [_mpm.block("bird", (9, 2, 2), (4, 4, 4), (10, 3, 1))]  # leaves through the face at x = 16 until t = 0.7


def refuse(constant):
    raise ValueError(f"{constant} is no JSON")


def scene(bodies, end=1.0, faces="222222", output=""):
    return _mpm.scene(bodies, _mpm.grid((0, 0, 0), (16, 8, 8), faces), _mpm.solution(end),
                      output=f'<Console print_time="{end / 10}"/>' + output)


class Start(Case):
    def check_refusal(self, text, pattern):
        """Refused before anything is written, with the same message on any ranks."""
        path = self.write(text)
        complaints = set()
        for n in (1, 2):
            outcome = self.run_in(f"out{n}", [path], code=INPUT_ERROR, ranks=n)
            self.assertRegex(outcome.complaint, pattern)
            self.assertFalse((self.folder / f"out{n}").exists())
            complaints.add(outcome.complaint)
        self.assertEqual(len(complaints), 1, complaints)

    def test_first_step_that_leads_nowhere(self):
        name = r'^[^ ]*case\.xmp:\d+: <Body name="right">: '
        for speed, pattern in (("1e200", name + "its initial state is not finite.*: particle 768 of body"),
                               ("-1e100", name + r"with the first time step of 5e-101, EndTime .* would require more than .*: particle 768 at "
                                r"\([^)]*\) has the velocity \(-1e\+100, 0, 1\)")):
            with self.subTest(speed):
                bodies = [_mpm.BOUNCING[0], _mpm.block("right", (9, 2, 2), (6, 4, 4), (speed, 0, 1))]
                self.check_refusal(scene(bodies), pattern)

    def test_other_first_steps_that_lead_nowhere(self):
        with self.subTest("specified"):
            text = scene(_mpm.BOUNCING).replace('<TimeStep factor="0.5"/>', '<TimeStep specified="1e-30"/>')
            self.check_refusal(text, r'case\.xmp:\d+: <TimeStep>: with the first time step of 1e-30, EndTime 1 would require more than')
        with self.subTest("heat"):
            law = 'type="IsoElastic" Young="1000" Poisson="0.3" SpecHeat="1" CoefficientOfThermalConductivity="1e60"'
            text = scene(_mpm.BOUNCING).replace(_mpm.material(), _mpm.material(strength=law))
            self.check_refusal(text, r"case\.xmp:\d+: <Solution>: .* heat conduction limits the step")
        with self.subTest("energy"):
            bodies = [_mpm.block("bird", (1, 2, 2), (6, 4, 4), (2, 1, 0), attributes='density="1e308"')]
            self.check_refusal(scene(bodies), r'case\.xmp:\d+: <Body name="bird">: its initial state')


class Files(Case):
    def test_no_file_of_a_failed_run_holds_what_is_no_number(self):
        """Wherever the run ends: steps that are too long by more and more, with pictures and histories at all times."""
        output = ('<PostProcessing time_interval="1e-9" h5part="1" vtk_data="1" var="seqv|tria|density|engk|engi"/>'
                  '<TimeHistory var="pres|seqv|tria"><Particle x="9" y="4" z="4"/><Point x="9" y="4" z="4"/>'
                  '</TimeHistory>')
        for step in (0.06, 0.1, 0.25):
            for history in (True, False):
                with self.subTest(step=step, history=history):
                    shown = output if history else output[:output.index("<TimeHistory")]
                    text = scene(_mpm.BOUNCING, end=50, output=shown).replace('print_time="5.0"', 'print_time="1e-9"')
                    text = text.replace('<TimeStep factor="0.5"/>', f'<TimeStep specified="{step}"/>')
                    self.write(text)
                    self.run_in("out", [self.folder / "case.xmp"], code=NUMERICAL_FAILURE)
                    self.check_numbers(self.folder / "out")

    def check_numbers(self, folder):
        for name in ("case.sta", "case_curv.dat"):
            rows = np.loadtxt(folder / name, ndmin=2)
            self.assertGreater(len(rows), 1)
            self.assertTrue(np.isfinite(rows).all(), name)
        json.loads((folder / "case.summary.json").read_text(), parse_constant=refuse)
        with h5py.File(folder / "case.h5part") as file:
            for group in _mpm.pictures(file):
                for name in group:
                    self.assertTrue(np.isfinite(group[name][:]).all(), (group.name, name))

    def test_pictures_of_what_floats_do_not_hold(self):
        """Cut to the largest, and said once, on any ranks."""
        law = 'type="IsoElastic" Young="1e42" Poisson="0.3"'
        output = '<PostProcessing time_interval="0.05" h5part="1" vtk_data="1" var="density|SigmaX"/>'
        said = set()
        for ranks in (1, 2):
            self.write(scene(_mpm.BOUNCING, end=0.2, output=output).replace(_mpm.material(), _mpm.material(density=1e39,
                                                                                                     strength=law)))
            out = self.run_in("out", [self.folder / "case.xmp"], ranks=ranks).out
            warnings = [line.replace(str(self.folder), "") for line in out.splitlines() if line.startswith("warning: ")]
            self.assertRegex("\n".join(warnings),
                             r"step 0: out of the range of numbers in '/out/case\.h5part': 1536 value\(s\) of density; written")
            self.assertLessEqual(len(warnings), 4)  # density and SigmaX, in either kind of picture
            said.add("\n".join(warnings))
            with h5py.File(self.folder / "out/case.h5part") as file:
                for group in _mpm.pictures(file):
                    self.assertEqual(set(group["density"][:]), {np.finfo(np.float32).max})
                    self.assertTrue(np.isfinite(group["SigmaX"][:]).all())
        self.assertEqual(len(said), 1)

    def check_leaver(self, table):
        """Its columns keep their last values; a column tells, and the log."""
        self.assertTrue(np.isfinite(np.loadtxt(self.folder / "out/case_curv.dat")).all())
        present, place = table["present[particle1]"], table["posx[particle1]"]
        gone = present.index(0.0)
        self.assertEqual(present, [1.0] * gone + [0.0] * (len(present) - gone))
        self.assertEqual(set(place[gone:]), {place[gone - 1]})
        log = (self.folder / "out/case.out").read_text()
        self.assertRegex(log, rf"step {int(table['step'][gone])}, .*: particle1 of the time histories \(identity \d+\) is eroded")

    def test_history_of_a_leaver_through_a_restart(self):
        """From before it leaves and from after, on other ranks: the same file."""
        output = ('<Restart time_interval="0.1"/><TimeHistory var="posx|seqv|velocity_0"><Particle x="13" y="4" z="4"/>'
                  '<Point x="13" y="4" z="4"/></TimeHistory>')
        self.write(scene(FLIGHT, faces="000000", output=output))
        self.run_in("out", [self.folder / "case.xmp"])
        whole = self.history_rows()
        table = _mpm.table(self.folder / "out/case_curv.dat")
        self.assertGreater(table["posx[particle1]"][-1], 15)
        self.check_leaver(table)
        for status_rows, ranks, which in ((3, 2, 0), (6, 1, 0), (6, 2, 1)):
            self.run_in("out", [self.folder / "case.xmp", "-nsteps", str(status_rows)])
            self.assertLess(len(self.history_rows()), len(whole))
            self.run_in("out", [_mpm.restarts(self.folder / "out")[which]], ranks=ranks)
            self.assertEqual(self.history_rows(), whole)

    def history_rows(self):
        return [line for line in (self.folder / "out/case_curv.dat").read_text().splitlines() if line[0] != "#"]

    def test_energies_without_histories(self):
        """The energies of .sta, at its times; a run that is resumed writes the same."""
        restart = '<Restart time_interval="0.3"/>'
        self.write(scene(_mpm.BOUNCING, output=restart))
        self.run_in("out", [self.folder / "case.xmp"])
        whole = self.history_rows()
        curves, status = (_mpm.table(self.folder / f"out/case{ending}") for ending in ("_curv.dat", ".sta"))
        self.assertEqual(list(curves), ["step", "time", "kinetic", "internal"])
        self.assertEqual(len(curves["step"]), 11)
        for name, values in curves.items():
            self.assertEqual(values, status[name])
        self.run_in("out", [_mpm.restarts(self.folder / "out")[0]], ranks=2)
        self.assertEqual(self.history_rows(), whole)


_mpm.main()
