"""A run that is requested to stop writes a restart file and exits with code 4; its continuation has the same bits."""

import re
import shutil
import signal

import _mpm
from _mpm import DONE, FILE_ERROR, INPUT_ERROR, STOPPED, Case

END = 9  # as long as the slowest machine allows; see Stop.until_stopped()
ENDLESS = 1e6  # of days: only what the test does ends such a run


def bounce(output="", end=END, **more):
    return _mpm.bounce(end, output, rows=30 * end / END, **more)


def stopped_by(signals, ranks=1, target=lambda process: [process.pid], arguments=(), percent=0, **more):
    """Outcome of a run that gets the signals when so much of it is done."""
    process = _mpm.start(arguments, ranks=ranks, **more)
    read = _mpm.read_until(process, percent)
    for number in signals:
        for pid in target(process):
            _mpm.send(pid, number)
    outcome = _mpm.finish(process)
    outcome.out = read + outcome.out
    return outcome


class Stop(Case):
    end, undisturbed = END, None

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        self.case = self.write(bounce(end=Stop.end))
        self.line = [self.case, "--output-dir", self.out]
        if not Stop.undisturbed:
            outcome = self.run_in("undisturbed", [self.case])
            Stop.undisturbed = outcome.state
            Stop.rows = _mpm.table(self.folder / "undisturbed/case.sta")
            self.assertIsNotNone(outcome.state)

    def until_stopped(self, attempt):
        """What an attempt gives whose run was not over before its signals came: each is four times as long as the
        one before."""
        while True:
            outcome = attempt()
            if outcome.code != DONE:
                return outcome
            Stop.end, Stop.undisturbed = 4 * Stop.end, None
            self.setUp()

    def stopped_by(self, signals, **more):
        return self.until_stopped(lambda: stopped_by(signals, arguments=self.line, **more))

    def continue_and_compare(self, restart, **more):
        self.case.unlink(missing_ok=True)  # a restart file needs no other
        outcome = self.run_in("out", [restart], **more)
        self.assertEqual(outcome.state, Stop.undisturbed)
        rows = _mpm.table(self.out / "case.sta")
        self.assertEqual(rows["step"], sorted(set(rows["step"])), "the .sta file goes on")
        last = {head: column[-1] for head, column in rows.items()}
        self.assertEqual(last, {head: column[-1] for head, column in Stop.rows.items()})
        self.assertEqual(_mpm.summary(self.out)["status"], "completed")

    def go_on_from_endless(self):
        """Some steps on from the newest restart file of a run without end, against the run that had that end."""
        outcome = _mpm.run([self.out / "case.pe", "--dry-run", "--output-dir", self.out])
        time = float(re.search(r"^continue .* time (\S+)$", outcome.out, re.MULTILINE).group(1))
        self.write(bounce(end=time + 0.1))
        state = self.run_in("other", [self.out / "case.pe", "-rt", self.case]).state
        self.assertEqual(state, self.run_in("undisturbed", [self.case]).state)

    def check_stopped(self, outcome, words, end=None):
        self.assertEqual(outcome.code, STOPPED, outcome)
        self.assertRegex(outcome.out, rf"stopped +{words}")
        found = _mpm.summary(self.out)
        self.assertEqual(found["status"], "stopped")
        self.assertRegex(found["reason"], words)
        self.assertLess(found["time"], end or Stop.end)
        [restart] = _mpm.restarts(self.out)
        self.assertEqual(restart.name, f"case_{found['steps']}.pe")
        return restart

    def test_signals_to_one_process(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1):
            with self.subTest(number.name):
                self.setUp()
                restart = self.check_stopped(self.stopped_by([number]), f"signal {int(number)}")
                self.continue_and_compare(restart)

    def test_interrupt_from_the_terminal(self):
        """Ctrl+C reaches the daemon that the MPI library has started, too."""
        outcome = self.stopped_by([signal.SIGINT], target=lambda process: [-process.pid],
                                  drop=["OMPI_MCA_ess_singleton_isolated"])
        self.continue_and_compare(self.check_stopped(outcome, "signal 2"))

    def test_user_signal_under_mpirun(self):
        """`kill -USR1` and `scancel --signal=USR1` of a job whose step is mpirun."""
        outcome = self.stopped_by([signal.SIGUSR1], ranks=2)
        self.continue_and_compare(self.check_stopped(outcome, "signal 10"), ranks=3)

    def test_user_signal_to_one_rank_of_two(self):
        outcome = self.stopped_by([signal.SIGUSR1], ranks=2, target=lambda p: _mpm.children(p)[-1:])
        self.continue_and_compare(self.check_stopped(outcome, "(signal|stop requested)"))

    def test_terminate_under_mpirun(self):
        """Open MPI's mpirun ends with a code of its own, and kills what is still there a second after it has passed
        the signal on: whether the run has written its restart file by then is the machine's matter. The file of an
        earlier step is whole in any case."""
        for number in (signal.SIGTERM, signal.SIGINT):
            with self.subTest(number.name):
                self.setUp()
                self.write(bounce('<Restart time_interval="0.1"/>', ENDLESS))
                process = _mpm.start(self.line, ranks=2)
                while not _mpm.restarts(self.out) and process.poll() is None:
                    process.stdout.readline()
                _mpm.send(process.pid, number)
                outcome = _mpm.finish(process)
                self.assertNotIn(outcome.code, (DONE, None), outcome)  # 1 in Open MPI 4.1
                self.go_on_from_endless()

    def test_wall_time(self):
        """Seconds since the program has begun: the step at which they are over is the last."""
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                self.setUp()
                outcome = _mpm.run([*self.line, "--max-wall-time", "1e-9"], ranks=ranks)
                self.continue_and_compare(self.check_stopped(outcome, "stop requested by .*--max-wall-time"))

    def test_wall_time_of_a_run_without_end(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                self.write(bounce(end=ENDLESS))
                shutil.rmtree(self.out, ignore_errors=True)
                outcome = _mpm.run([*self.line, "--max-wall-time", "0.5"], ranks=ranks)
                self.check_stopped(outcome, "stop requested by .*--max-wall-time", end=ENDLESS)
                self.assertGreaterEqual(_mpm.summary(self.out)["wall_seconds"]["total"], 0.5)
                self.go_on_from_endless()

    def test_wall_time_of_a_run_that_is_faster(self):
        outcome = _mpm.run([*self.line, "--max-wall-time", "1000"])
        self.assertEqual(outcome.code, DONE, outcome)
        self.assertEqual(outcome.state, Stop.undisturbed)

    def test_so_many_rows(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                outcome = _mpm.run([*self.line, "-nsteps", "3"], ranks=ranks)
                self.assertEqual(outcome.code, DONE, outcome)
                self.assertEqual(len(_mpm.table(self.out / "case.sta")["step"]), 3)
                self.assertEqual(_mpm.summary(self.out)["status"], "stopped")

    def test_reader_of_the_console_goes(self):
        """`mpm_run case | head -1` reads one line; the run has others to write for."""
        process = _mpm.start(self.line)
        process.stdout.readline()
        process.stdout.close()
        self.assertEqual(process.wait(600), DONE, process.stderr.read())
        process.stderr.close()
        self.assertIn(Stop.undisturbed, (self.out / "case.out").read_text())

    def test_stopped_twice(self):
        def attempt():
            first = stopped_by([signal.SIGUSR1], arguments=self.line)
            if first.code == DONE:
                return first
            self.check_stopped(first, "signal 10")
            return stopped_by([signal.SIGUSR1], arguments=[self.out / "case.pe", *self.line[1:]])

        again = self.until_stopped(attempt)
        self.assertEqual(again.code, STOPPED, again)
        self.continue_and_compare(_mpm.restarts(self.out)[-1])


class Restart(Case):
    def setUp(self):
        super().setUp()
        self.case = self.write(bounce(f'<Restart time_interval="{END / 40}"/>', END / 10))
        self.out = self.folder / "out"
        self.state = self.run_in("out", [self.case]).state
        self.files = _mpm.restarts(self.out)

    def test_the_newest_two_are_kept(self):
        self.assertEqual(len(self.files), 2)
        self.assertEqual([name for name in _mpm.names(self.out) if ".part" in name], [])

    def test_job_without_step_takes_the_newest(self):
        self.files[1].unlink()
        outcome = self.run_in("out", [self.out / "case.pe"])
        self.assertIn(f"from {self.files[0]}", outcome.out)
        self.assertEqual(outcome.state, self.state)

    def test_job_whose_name_ends_in_a_number(self):
        numbered = self.case.rename(self.folder / "case_17.xmp")
        self.assertEqual(self.run_in("numbered", [numbered]).state, self.state)
        for ranks in (1, 2):
            outcome = self.run_in("numbered", [self.folder / "numbered/case_17.pe"], ranks=ranks)
            self.assertEqual(outcome.state, self.state)

    def test_run_that_has_ended(self):
        """Going on from its last restart file changes nothing and repeats no row."""
        before = (self.out / "case.sta").read_text()
        outcome = self.run_in("out", [self.out / "case.pe"])
        self.assertEqual(outcome.state, self.state)
        self.assertEqual((self.out / "case.sta").read_text(), before)

    def test_from_the_folder_itself(self):
        self.files[1].unlink()
        for words in (["case.pe"], [self.files[0].name]):
            self.assertEqual(_mpm.run(words, cwd=self.out).state, self.state)

    def test_missing_file_does_not_start_anew(self):
        before = _mpm.contents(self.out)
        for name, words in [("case_7.pe", [str(self.files[1])]), ("other.pe", ["no readable restart file of the job was found"]),
                            ("other_7.pe", ["no readable restart file of the job was found"])]:
            for ranks in (1, 2):
                with self.subTest(name, ranks=ranks):
                    outcome = self.run_in("out", [self.out / name], code=FILE_ERROR, ranks=ranks)
                    for word in ["no such file", name, *words]:
                        self.assertEqual(outcome.complaint.count(word), 1, outcome)
                    self.assertEqual(_mpm.contents(self.out), before)

    def test_other_input_that_is_missing(self):
        outcome = self.run_in("new", [self.files[0], "-rt", self.folder / "none.xmp"], code=INPUT_ERROR)
        self.assertIn("none.xmp", outcome.complaint)
        self.assertFalse((self.folder / "new").exists())

    def test_other_input_of_the_same_name_goes_on_with_the_files(self):
        """The manual's own example: edit Job.xmp, then `-rt Job.xmp`. The rows before the restart are kept."""
        step = int(self.files[0].stem.split("_")[1])
        before = [s for s in _mpm.table(self.out / "case.sta")["step"] if s <= step]
        self.write(bounce(end=END / 8))
        self.run_in("out", [self.files[0], "-rt", self.case])
        rows = _mpm.table(self.out / "case.sta")
        self.assertEqual(rows["step"][: len(before)], before)
        self.assertEqual(rows["time"][-1], END / 8)

    def test_other_input_of_another_name_writes_its_own_files(self):
        before = _mpm.contents(self.out)
        longer = self.write(bounce(end=END / 8), "longer.xmp")
        self.run_in("out", [self.files[0], "-rt", longer])
        after = _mpm.contents(self.out)
        self.assertEqual({name: after[name] for name in before}, before)
        self.assertEqual(_mpm.table(self.out / "longer.sta")["time"][-1], END / 8)

    def test_other_input_that_asks_for_what_is_over(self):
        """What made the particles cannot change any more: a body's place or speed, where explosives are lit."""
        left, right = _mpm.BOUNCING
        lit = '<Detonation><Item type="point" x="0" y="0" z="0" time="0"/></Detonation></PeneBlast>'
        tag = ": differs from the input of the restart file"
        for text, complaints in [
                (bounce(end=END / 8, bodies=[left, right.replace('vx="-3"', 'vx="-2"')]), [f'<Body name="right">{tag} in its InitialVelocity']),
                (bounce(end=END / 8, bodies=[left.replace('lx="6"', 'lx="5"'), right]), [f'<Body name="left">{tag} in its geometry']),
                (bounce(end=END / 8).replace("</PeneBlast>", lit), [f"<Detonation>{tag}"])]:
            other = self.write(text, "other.xmp")
            for ranks in (1, 2):
                outcome = self.run_in("over", [self.files[0], "-rt", other], code=INPUT_ERROR, ranks=ranks)
                for words in complaints:
                    self.assertEqual(outcome.complaint.count(words), 1, outcome)
        self.assertFalse((self.folder / "over").exists())

    def test_units_do_not_change(self):
        """Those of an input without Unit are not known."""
        def text(unit):
            header = f"<Header>{unit}</Header><Material" if unit else "<Material"
            return bounce(end=END / 8, output=f'<Restart time_interval="{END / 32}"/>').replace("<Material", header, 1)

        metres, millimetres = ('<Unit length="{}" mass="{}" time="{}"/>'.format(*units.split()) for units in ("m kg s", "mm g ms"))
        self.write(text(metres), "metres.xmp")
        self.run_in("metres", [self.folder / "metres.xmp"])
        restart = _mpm.restarts(self.folder / "metres", "metres")[0]
        for unit in (metres, ""):
            self.run_in("same", [restart, "-rt", self.write(text(unit), "same.xmp")])
        outcome = self.run_in("others", [restart, "-rt", self.write(text(millimetres), "others.xmp")], code=INPUT_ERROR, ranks=2)
        self.assertEqual(outcome.complaint.count('<Header>: Unit is "mm g ms", but "m kg s" in the input of the restart file'), 1, outcome)

    def test_work_planes_are_compared_by_their_values(self):
        """A plane may get another place in the list or another name, or go where it changes nothing; it may not move."""
        left, right = _mpm.BOUNCING

        def text(planes, of_left, of_right):
            bodies = [body.replace('type="Block"', f'type="Block" workPlane="{plane}"') if plane else body
                      for body, plane in ((left, of_left), (right, of_right))]
            return bounce(end=END / 8, bodies=bodies, output=f'<Restart time_interval="{END / 32}"/>').replace(
                "<Component", planes + "<Component", 1)

        turned = '<WorkPlane name="turned" a11="1" a21="0.003" a31="0"/>'
        self.write(text('<WorkPlane name="spare"/><WorkPlane name="idle"/>' + turned, "idle", "turned"), "planes.xmp")
        alone = self.run_in("planes", [self.folder / "planes.xmp"]).state
        restart = _mpm.restarts(self.folder / "planes", "planes")[0]
        same = self.write(text(turned, None, "turned"), "same.xmp")
        self.assertEqual(self.run_in("same", [restart, "-rt", same]).state, alone)
        for planes, of_left in ((turned + '<WorkPlane name="moved" r0x="0.1"/>', "moved"),
                                (turned + turned.replace('"turned"', '"moved"'), "moved")):
            outcome = self.run_in("moved", [restart, "-rt", self.write(text(planes, of_left, "turned"), "moved.xmp")],
                                  code=INPUT_ERROR)
            self.assertEqual(outcome.complaint.count('<Body name="left">: differs from the input'), 1, outcome)
            self.assertEqual(outcome.complaint.count('differs from'), 1, outcome)

    def test_a_body_that_is_taken_out(self):
        """-rt with Deactive="1": the body is gone, and the ledger says what it took along."""
        left, right = _mpm.BOUNCING
        bodies = [left, right.replace('type="Block"', 'type="Block" Deactive="1"')]
        other = self.write(bounce(end=END / 8, bodies=bodies), "other.xmp")
        for ranks in (1, 2):
            outcome = self.run_in("other", [self.files[0], "-rt", other], ranks=ranks)
            found = _mpm.summary(self.folder / "other", "other")
            self.assertEqual(found["particles"], 768)
            self.assertEqual([body["name"] for body in found["bodies"]], ["left"])
            self.assertLess(abs(found["energy"]["relative_drift"]), 0.05, outcome)

    def test_a_body_that_comes_in(self):
        """-rt without the Deactive of before: the body comes in as its input states it, the same on any ranks and
        through another restart, and the balance of energy stays one of errors alone."""
        left, right = _mpm.BOUNCING
        apart = [left, right.replace('type="Block"', 'type="Block" Deactive="1"')]
        often = f'<Restart time_interval="{END / 32}"/>'
        self.write(bounce(end=END / 8, bodies=apart, output=often), "apart.xmp")
        self.run_in("apart", [self.folder / "apart.xmp"])
        early = _mpm.restarts(self.folder / "apart", "apart")[0]
        whole = self.write(bounce(end=END / 8, output=often), "whole.xmp")
        outcomes = []
        for ranks, threads in ((1, 1), (2, 1), (3, 2)):
            folder = f"in{ranks}"
            outcome = self.run_in(folder, [early, "-rt", whole], ranks=ranks, threads=threads)
            outcomes.append(outcome.state)
            self.assertIn("body 'right' was not in the restart file: its 768 particles are added now", outcome.out)
            found = _mpm.summary(self.folder / folder, "whole")
            self.assertEqual([body["particles"] for body in found["bodies"]], [768, 768])
            self.assertLess(abs(found["energy"]["relative_drift"]), 0.05, outcome)
        self.assertEqual(len(set(outcomes)), 1)
        self.assertEqual([body["mass"] for body in found["bodies"]], [96, 96])
        again = self.run_in("again", [_mpm.restarts(self.folder / "in3", "whole")[0]], ranks=2)
        self.assertEqual(again.state, outcomes[0])

    def test_a_body_that_comes_in_where_the_grid_is_not(self):
        left, right = _mpm.BOUNCING
        outside = right.replace('type="Block"', 'type="Block" Deactive="1"').replace('x0="9"', 'x0="900"')
        self.write(bounce(end=END / 8, bodies=[left, outside], output=f'<Restart time_interval="{END / 32}"/>'),
                   "apart.xmp")
        self.run_in("apart", [self.folder / "apart.xmp"])
        whole = self.write(bounce(end=END / 8, bodies=[left, outside.replace(' Deactive="1"', "")]), "whole.xmp")
        for ranks in (1, 2):
            outcome = self.run_in("in", [_mpm.restarts(self.folder / "apart", "apart")[0], "-rt", whole],
                                  code=INPUT_ERROR, ranks=ranks)
            self.assertEqual(outcome.complaint.count("the body is outside the grid"), 1, outcome)
        self.assertFalse((self.folder / "in").exists())


if __name__ == "__main__":
    _mpm.main()
