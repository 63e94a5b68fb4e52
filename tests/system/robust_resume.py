"""What goes on from a restart file leaves the same files as a run that nobody disturbed, and says so where it cannot."""

import os
import random
import shutil
import signal
import time

import _mpm
import _resume
from _mpm import STOPPED, Case


class Resume(Case):
    def setUp(self):
        super().setUp()
        self.case = self.write(_resume.scene())
        self.out = self.folder / "out"

    def shorten(self, more=0.35, **options):
        """The input gets an end a little after the newest restart file. Runs it undisturbed; its end."""
        end = round(_resume.time_of(_mpm.restarts(self.out)[-1]) + more, 6)
        self.write(_resume.scene(end, **options))
        self.state = self.run_in("undisturbed", [self.case]).state
        return end

    def go_on(self, restart=None, **more):
        return self.run_in("out", [restart or self.out / "case.pe", "-rt", self.case], **more)

    def check_same_files(self, out="out"):
        for name in ("case.sta", "case_curv.dat"):
            ours, theirs = (_resume.rows(self.folder / folder / name) for folder in (out, "undisturbed"))
            self.assertEqual(ours, theirs, name)
        if (self.folder / "undisturbed/case.h5part").exists():
            self.assertEqual(*(_resume.states(self.folder / folder / "case.h5part") for folder in (out, "undisturbed")))
        if (self.folder / "undisturbed/case.pvd").exists():
            lists = [[line for line in (self.folder / folder / "case.pvd").read_text().splitlines() if "<DataSet" in line]
                     for folder in (out, "undisturbed")]
            self.assertEqual(*lists)


class Killed(Resume):
    def test_no_row_and_no_picture_is_lost_or_doubled(self):
        """Histories wait in memory: a restart file may only count when what came before it is on the disk."""
        for ranks, pictures in ((1, "both"), (2, "h5part"), (1, None)):
            with self.subTest(ranks=ranks, pictures=pictures):
                self.setUp()
                self.write(_resume.scene(pictures=pictures))
                _resume.start_and_kill(self.case, self.out, ranks, files=3)
                self.shorten(pictures=pictures)
                outcome = self.go_on(ranks=ranks)
                self.assertEqual(outcome.state, self.state)
                self.assertEqual(_resume.warnings(outcome), [])
                self.check_same_files()

    def test_killed_again_and_again(self):
        for _ in range(3):
            there = _mpm.restarts(self.out)
            process = _mpm.start([self.out / "case.pe" if there else self.case, "--output-dir", self.out])
            self.assertTrue(_resume.wait_for(lambda: set(_mpm.restarts(self.out)) - set(there), process))
            _resume.kill(process)
        self.shorten()
        outcome = self.go_on()
        self.assertEqual(outcome.state, self.state)
        self.assertEqual(_resume.warnings(outcome), [])
        self.check_same_files()
        groups = _resume.states(self.out / "case.h5part")[1]
        self.assertEqual([name for name in groups if not name.startswith("Step#")], [])

    def test_older_restart_file(self):
        _resume.start_and_kill(self.case, self.out, files=3)
        self.shorten()
        outcome = self.go_on(_mpm.restarts(self.out)[0])
        self.assertEqual(outcome.state, self.state)
        self.assertEqual(_resume.warnings(outcome), [])
        self.check_same_files()


    def test_killed_while_going_on_from_an_older_restart_file(self):
        """What the later file refers to is overwritten by then: it does not count any more."""
        _resume.start_and_kill(self.case, self.out, files=3)
        older, *later = _mpm.restarts(self.out)
        process = _mpm.start([older, "--output-dir", self.out])
        self.assertTrue(_resume.wait_for(lambda: not any(path.exists() for path in later), process))
        _resume.kill(process)
        for path in later:
            self.assertTrue(path.with_name(path.name + ".superseded").exists())
        self.shorten()
        outcome = self.go_on()
        self.assertEqual(outcome.state, self.state)
        self.assertEqual(_resume.warnings(outcome), [])
        self.check_same_files()

    def test_killed_when_nothing_is_left_but_the_last_row(self):
        """A run with no steps left removes its last row and writes it again."""
        self.write(_resume.scene(0.5))
        self.state = self.run_in("undisturbed", [self.case]).state
        self.run_in("out", [self.case])
        rows = (self.out / "case.sta").read_text().splitlines(keepends=True)
        (self.out / "case.sta").write_text("".join(rows[:-1]))
        outcome = self.run_in("out", [self.out / "case.pe"])
        self.assertEqual(outcome.state, self.state)
        self.assertEqual(_resume.warnings(outcome), [])
        self.check_same_files()

    def test_killed_before_its_first_restart_file_where_an_older_run_was(self):
        _resume.start_and_kill(self.case, self.out, files=2)
        there = _mpm.restarts(self.out)
        process = _mpm.start([self.case, "--output-dir", self.out])
        self.assertTrue(_resume.wait_for(lambda: not any(path.exists() for path in there), process))
        _resume.kill(process)
        outcome = self.run_in("out", [self.out / "case.pe"], code=_mpm.FILE_ERROR)
        self.assertIn("no such file", outcome.err)


class Stopped(Resume):
    def test_stopped_runs_leave_no_trace_in_the_files(self):
        """The row and the picture at the stop are for the user; what goes on has those of its intervals."""
        process = _mpm.start([self.case, "--output-dir", self.out])
        self.assertTrue(_resume.wait_for(lambda: _mpm.restarts(self.out), process))
        process.send_signal(signal.SIGUSR1)
        self.assertEqual(_mpm.finish(process).code, STOPPED)
        self.shorten()
        outcome = self.go_on()
        self.assertEqual(outcome.state, self.state)
        self.assertEqual(_resume.warnings(outcome), [])
        self.check_same_files()


class Damaged(Resume):
    """Whatever happens to the other files, a good restart file goes on, and what is lost is said."""

    def setUp(self):
        super().setUp()
        self.write(_resume.scene(pictures="both"))
        _resume.start_and_kill(self.case, self.out, files=3)
        self.shorten(pictures="both")
        shutil.copytree(self.out, self.folder / "killed")

    def go_on_after(self, name, damage):
        """`damage` makes other bytes of a file's, or none for no file; what the run said of it."""
        shutil.rmtree(self.out)
        shutil.copytree(self.folder / "killed", self.out)
        path = self.out / name
        damaged = damage(path.read_bytes())
        if damaged is None:
            path.unlink()
        else:
            path.write_bytes(damaged)
        outcome = self.go_on()
        self.assertEqual(outcome.state, self.state)
        log = (self.out / "case.out").read_text(errors="replace")
        warnings = _resume.warnings(outcome)
        for line in warnings:
            self.assertIn(line, log)
        return "\n".join(warnings)

    def test_tables_that_were_emptied_cut_or_changed_or_are_gone(self):
        for name in ("case.sta", "case_curv.dat"):
            text = (self.folder / "killed" / name).read_bytes()
            first_row = next(i for i, line in enumerate(text.split(b"\n")) if not line.startswith(b"#"))
            cut = lambda data: b"\n".join(data.split(b"\n")[: first_row + 5]) + b"\n   1"
            changed = lambda data: b"\n".join(
                line.replace(b"e", b"E", 1) if i == first_row + 2 else line for i, line in enumerate(data.split(b"\n")))
            for damage, words in ((lambda data: b"", r"is empty; it had \d+ row\(s\) up to step \d+"),
                                  (lambda data: None, r"is missing; it had \d+ row\(s\) up to step \d+"),
                                  (cut, r"has 5 row\(s\) up to step \d+, but had \d+ row\(s\) up to step \d+"),
                                  (changed, "has been changed: its first .* do not match the checksum")):
                with self.subTest(name, words=words):
                    self.assertRegex(self.go_on_after(name, damage), f"{name}' {words}")
                    steps = _mpm.table(self.out / name)["step"]
                    self.assertEqual(steps, sorted(set(steps)))
                    self.assertEqual(steps[-1], _mpm.summary(self.out)["steps"])

    def test_log(self):
        for damage, words in ((lambda data: b"", "has 0 bytes, but had"), (lambda data: None, "is missing")):
            self.assertRegex(self.go_on_after("case.out", damage), f"case.out' {words}")

    def test_list_of_pictures(self):
        for damage in (lambda data: b"", lambda data: None, lambda data: data[: len(data) // 2],
                       lambda data: data.replace(b'timestep="0.', b'timestep="1.')):
            self.assertEqual(self.go_on_after("case.pvd", damage), "")
            self.check_same_files()

    def test_pictures_that_are_gone(self):
        victim = next(path for path in sorted((self.out / "case_vtu").glob("*_0.pvtu")))
        self.assertIn("1 of the", self.go_on_after(str(victim.relative_to(self.out)), lambda data: None))

    def test_h5part(self):
        """Damage to what HDF5 needs is put right, damage to values puts the file aside; it is never a refusal."""
        chance = random.Random(3)
        size = (self.folder / "killed/case.h5part").stat().st_size
        aside = 0
        for place in [9, 30, 100, 200, 600, 1000, 5000] + [chance.randrange(size) for _ in range(20)]:
            def flipped(data):
                return data[:place] + bytes([data[place] ^ (1 << chance.randrange(8))]) + data[place + 1:]

            with self.subTest(place):
                said = self.go_on_after("case.h5part", flipped)
                if said:
                    aside += 1
                    self.assertRegex(said, "case.h5part' is damaged.*it has been renamed to .*case.h5part.damaged', and a new file is started")
                    self.assertTrue((self.out / "case.h5part.damaged").exists())
                    self.assertGreater(len(_resume.states(self.out / "case.h5part")[0]), 0)
                else:
                    self.check_same_files()
        self.assertGreater(aside, 0)
        for damage, words in ((lambda data: b"", "has 0 bytes instead of"), (lambda data: None, "is missing; it had"),
                              (lambda data: data[:-70000], "has .* bytes instead of|^$")):
            self.assertRegex(self.go_on_after("case.h5part", damage), words)

    def test_in_another_folder_nothing_is_missing(self):
        outcome = self.run_in("elsewhere", [self.out / "case.pe", "-rt", self.case])
        self.assertEqual(outcome.state, self.state)
        self.assertEqual(_resume.warnings(outcome), [])
        self.assertIn("some files of the earlier run are missing in this folder",
                      (self.folder / "elsewhere/case.out").read_text())


class WhileWriting(Case):
    """A stop may be asked for in the middle of a restart file, and its writing may take as long as it likes."""

    def start_until_writing(self, ranks, *arguments):
        """A run that is stopped while it writes a restart file, whatever the machine; or one that has ended."""
        process = _mpm.start([self.case, "--output-dir", self.out, *arguments], ranks=ranks)
        _resume.wait_for(lambda: any(self.out.glob("case_*.pe*")), process)
        while process.poll() is None:
            members = _resume.ranks_of(process, ranks)
            for pid in members:
                os.kill(pid, signal.SIGSTOP)
            time.sleep(0.01)
            if any(self.out.glob("case_*.pe.part")):
                return process, members
            for pid in members:
                os.kill(pid, signal.SIGCONT)
            time.sleep(0.002)
        return process, []

    def check(self, process, members):
        for pid in members:
            os.kill(pid, signal.SIGCONT)
        outcome = _mpm.finish(process)
        self.assertEqual(outcome.code, STOPPED, outcome)
        self.assertEqual([name for name in _mpm.names(self.out) if ".part" in name], [])
        newest = _mpm.restarts(self.out)[-1]
        # To where it is already: every byte of the file is checked and read, and the state is the one it had.
        self.write(_resume.scene(_resume.time_of(newest), **self.options))
        self.assertEqual(self.run_in("out", [newest, "-rt", self.case]).state, outcome.state)

    def setUp(self):
        super().setUp()
        self.options = {"pictures": None, "restart": 1e-9}  # one after every step
        self.case = self.write(_resume.scene(**self.options))
        self.out = self.folder / "out"

    def test_signals(self):
        for ranks, signals in ((1, [signal.SIGUSR1] * 20), (1, [signal.SIGTERM, signal.SIGINT, signal.SIGUSR1]),
                               (2, [signal.SIGUSR1] * 3)):
            with self.subTest(ranks=ranks, signals=signals):
                self.setUp()
                process, members = self.start_until_writing(ranks)
                self.assertTrue(members, "the run has ended by itself")
                for number in signals:
                    for pid in members:
                        os.kill(pid, number)
                time.sleep(0.2)
                self.check(process, members)

    def test_wall_time(self):
        """It is over while the file is being written."""
        begun = time.monotonic()
        process, members = self.start_until_writing(1, "--max-wall-time", "2")
        time.sleep(max(0, begun + 3 - time.monotonic()))
        self.check(process, members)


if __name__ == "__main__":
    _mpm.main()
