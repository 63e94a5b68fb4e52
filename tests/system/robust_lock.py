"""One run at a time writes a job's files, and the job that a restart file names in itself is the one it belongs to."""

import contextlib
import fcntl
import os
import pathlib
import shlex
import shutil
import signal
import struct
import subprocess
import time

import _mpm
import _resume
from _mpm import FILE_ERROR, Case

HELD = r"another run writes to this folder under the same job name.*case\.lock' is held by process {} on "


class Lock(Case):
    def setUp(self):
        super().setUp()
        self.case = self.write(_resume.scene(pictures=None, histories=False))
        self.out = self.folder / "out"
        self.lock = self.out / "case.lock"

    def start(self, ranks=1):
        """A run that computes, and goes on for ever."""
        process = _mpm.start([self.case, "--output-dir", self.out], ranks=ranks)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.assertTrue(_resume.wait_for(lambda: len(_mpm.restarts(self.out)) > 1, process))
        return process

    def test_second_run_is_refused(self):
        process = self.start()
        process.send_signal(signal.SIGSTOP)  # as long as it takes
        before = _mpm.contents(self.out)
        for ranks, words in ((1, [self.case]), (2, [self.case]), (1, [self.out / "case.pe"]),
                             (1, [_mpm.restarts(self.out)[0]])):
            outcome = self.run_in("out", words, code=FILE_ERROR, ranks=ranks)
            self.assertRegex(outcome.complaint, HELD.format(process.pid))
            self.assertEqual(_mpm.contents(self.out), before)
        # What only reads, what writes elsewhere, and another job in the same folder are let through.
        newest = _mpm.restarts(self.out)[-1]
        for words in ([self.case, "--dry-run"], [self.out / "case.pe", "--dry-run"]):
            self.run_in("out", words)
        for words in (newest, self.out / "case.pe"):
            self.run_in("converted", [words, "-h5pt"])
        self.run_in("elsewhere", [newest, "-nsteps", "1"])
        other = self.write(_resume.scene(0.1, pictures=None), "other.xmp")
        self.run_in("out", [other])
        self.assertFalse((self.out / "other.lock").exists(), "a clean end removes the lock")
        process.send_signal(signal.SIGCONT)
        process.send_signal(signal.SIGUSR1)
        self.assertEqual(_mpm.finish(process).code, _mpm.STOPPED)
        self.assertFalse(self.lock.exists())
        self.run_in("out", [self.out / "case.pe", "-nsteps", "1"])

    def test_rank_that_outlives_its_killed_run(self):
        """Every rank holds a share of the lock until it is gone. (A stopped rank would not do here: the system lets
        it go on, and ends it, when its mpirun is killed.)"""
        process = self.start(ranks=2)
        for pid in _resume.ranks_of(process, 2):
            held = ""
            for path in pathlib.Path(f"/proc/{pid}/fdinfo").iterdir():
                with contextlib.suppress(FileNotFoundError):  # closed since the folder was listed
                    held += path.read_text()
            self.assertRegex(held, "lock:.*OFDLCK +ADVISORY +READ .* 1 1\\n")
        _resume.kill(process, ranks=2)
        with self.lock.open("rb") as survivor:
            share = struct.pack("hhqqi0q", fcntl.F_RDLCK, os.SEEK_SET, 1, 1, 0)
            fcntl.fcntl(survivor, fcntl.F_OFD_SETLK, share)
            outcome = self.run_in("out", [self.out / "case.pe"], code=FILE_ERROR)
            self.assertRegex(outcome.complaint, "ranks of a killed run are still alive.*case.lock' is held by process ")
        # The lock file is there, and nobody holds it.
        self.assertTrue(self.lock.exists())
        for ranks in (1, 2):
            self.run_in("out", [self.out / "case.pe", "-nsteps", "1"], ranks=ranks)

    def test_ranks_without_their_mpirun_do_not_begin(self):
        """They have waited for the lock while another run ended, whose files stay as they are. Here a shell takes mpirun's part."""
        self.run_in("out", [self.write(_resume.scene(0.5, pictures=None, histories=False))])
        before = _mpm.contents(self.out)
        errors = self.folder / "errors"
        command = shlex.join(map(str, _mpm.command([self.case, "--output-dir", self.out], 1, (), "mpm_run")))
        with self.lock.open("wb") as holder:
            fcntl.fcntl(holder, fcntl.F_OFD_SETLK, struct.pack("hhqqi0q", fcntl.F_WRLCK, os.SEEK_SET, 0, 1, 0))
            shell = subprocess.Popen(["sh", "-c", f"{command} > {errors} 2>&1 & echo $!; wait"], stdout=subprocess.PIPE, text=True,
                                     env={**_mpm.ENVIRONMENT, "OMPI_COMM_WORLD_SIZE": "1"})
            rank = pathlib.Path("/proc", shell.stdout.readline().strip())
            self.assertTrue(_resume.wait_for(lambda: errors.exists() and "waiting up to" in errors.read_text(), shell))
            shell.kill()
            shell.communicate()
            self.lock.unlink()
        while rank.exists():
            time.sleep(0.05)
        self.assertIn("the mpirun that started its ranks has ended", errors.read_text())
        self.assertEqual(_mpm.contents(self.out), before)

    def test_killed_run(self):
        process = self.start()
        _resume.kill(process)
        self.assertTrue(self.lock.exists())
        self.run_in("out", [self.out / "case.pe", "-nsteps", "1"])
        self.assertFalse(self.lock.exists())


class Jobs(Case):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        scene = _resume.scene(0.5, pictures=None, histories=False, restart=0.2)
        self.state = self.run_in("out", [self.write(scene)]).state
        self.own = _mpm.restarts(self.out)
        self.assertEqual(len(self.own), 2)
        scene = _resume.scene(2, pictures=None, histories=False, restart=0.2)
        self.run_in("other", [self.write(scene, "other.xmp")])
        self.foreign = self.out / "case_900.pe"
        shutil.copy(_mpm.restarts(self.folder / "other", "other")[-1], self.foreign)  # younger, too

    def test_another_jobs_file_under_this_ones_name(self):
        for ranks in (1, 2):
            outcome = self.run_in("out", [self.out / "case.pe"], ranks=ranks)
            self.assertIn(f"from {self.own[-1]}", outcome.out)
            self.assertEqual(outcome.state, self.state)
        for path in self.own:
            path.unlink()
        outcome = self.run_in("out", [self.out / "case.pe"], code=FILE_ERROR)
        self.assertRegex(outcome.complaint, "case_900.pe' belongs to another job")

    def test_another_jobs_file_is_not_removed(self):
        self.run_in("out", [self.folder / "case.xmp"])
        self.assertTrue(self.foreign.exists())
        self.assertEqual(len(_mpm.restarts(self.out)), 3)

    def test_own_file_under_another_name(self):
        kept = self.out / "kept for later.pe"
        self.own[-1].rename(kept)
        self.own[0].unlink()
        outcome = self.run_in("out", [self.out / "case.pe"])
        self.assertIn(f"from {kept}", outcome.out)
        self.assertEqual(outcome.state, self.state)


if __name__ == "__main__":
    _mpm.main()
