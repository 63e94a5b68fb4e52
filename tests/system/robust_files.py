"""Full disks, killed processes and damaged files: exit code 5 says so, and the last good restart file is found.

Every test ends by going on from what is left and comparing the state's hash with the undisturbed run."""

import contextlib
import random
import re
import resource
import shutil
import signal
import subprocess
import time

import h5py

import _mpm
from _mpm import DONE, FILE_ERROR, Case

END = 2.0
PICTURES = f'<PostProcessing time_interval="{END / 30}" h5part="1" vtk_data="1" var="seqv"/>'


def restarts_every(interval):
    return f'<Restart time_interval="{interval}"/>'


def run_limited(arguments, size, ranks):
    """No file of the ranks may grow beyond `size` bytes, once they have begun to compute: MPI has its own files."""
    process = _mpm.start(arguments, ranks=ranks)
    read = _mpm.read_until(process, 0)
    for pid in [process.pid] if ranks == 1 else _mpm.children(process):
        with contextlib.suppress(ProcessLookupError):  # it is over already
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (size, size))
    outcome = _mpm.finish(process)
    outcome.out = read + outcome.out
    return outcome


def times_of(path):
    """TimeValue of every step of an .h5part file, all of whose datasets are read."""
    with h5py.File(path) as file:
        steps = _mpm.pictures(file)
        for step in steps:
            for item in step.values():
                item[()]
        return [float(step.attrs["TimeValue"][()]) for step in steps]


class Files(Case):
    undisturbed = None

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        if not Files.undisturbed:
            outcome = self.run_in("undisturbed", [self.write(_mpm.bounce(END, PICTURES))])
            Files.undisturbed = outcome.state
            Files.times = times_of(self.folder / "undisturbed/case.h5part")

    def go_on(self, folder="out", into=None, **more):
        """From the newest good restart file to the same end."""
        outcome = self.run_in(into or folder, [self.folder / folder / "case.pe"], **more)
        self.assertEqual(outcome.state, Files.undisturbed)
        self.assertEqual(_mpm.summary(self.folder / (into or folder))["status"], "completed")
        return outcome

    def check_failed(self, outcome, words):
        self.assertEqual(outcome.code, FILE_ERROR, outcome)
        self.assertRegex(outcome.complaint, words)
        lines = outcome.complaint.splitlines()
        self.assertEqual(len(lines), len(set(lines)), f"said more than once: {outcome}")
        self.assertNotRegex(outcome.complaint, "HDF5-DIAG|terminate|Segmentation")
        self.assertEqual([name for name in _mpm.names(self.out) if name.endswith(".pe.part")], [])


class FullDisk(Files):
    def test_limit_that_the_pictures_reach(self):
        """The .h5part file grows to the limit; restart files are smaller."""
        case = self.write(_mpm.bounce(END, PICTURES + restarts_every(END / 9)))
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                shutil.rmtree(self.out, ignore_errors=True)
                outcome = run_limited([case, "--output-dir", self.out], 700_000, ranks)
                self.check_failed(outcome, r"cannot write '?.*case\.h5part.*File too large")
                found = _mpm.summary(self.out)
                self.assertEqual(found["status"], "failed")
                self.assertIn("case.h5part", found["reason"])
                times = times_of(self.out / "case.h5part")
                self.assertEqual(times, Files.times[: len(times)])
                self.assertGreater(len(times), 2)
                self.go_on()
                self.assertEqual(times_of(self.out / "case.h5part"), Files.times)

    def test_limit_below_a_restart_file(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                for end in (END, 8 * END, 64 * END):  # longer, where the first file was there before the limit
                    shutil.rmtree(self.out, ignore_errors=True)
                    case = self.write(_mpm.bounce(end, restarts_every(end / 4)))
                    outcome = run_limited([case, "--output-dir", self.out], 100_000, ranks)
                    if not _mpm.restarts(self.out):
                        break
                self.check_failed(outcome, r"cannot write '?.*case_\d+\.pe.*File too large")
                self.assertEqual(_mpm.restarts(self.out), [])

    def test_limit_below_everything(self):
        case = self.write(_mpm.bounce(END, ""))
        forbid = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
        outcome = _mpm.run([case, "--output-dir", self.out], preexec_fn=forbid)
        self.check_failed(outcome, r"cannot write '?.*case\.(out|sta).*File too large")

    def test_tables_on_a_device_that_is_full(self):
        history = '<TimeHistory var="pres"><Point x="4" y="4" z="4"/></TimeHistory>'
        case = self.write(_mpm.bounce(END, history + restarts_every(END / 4)))
        for name in ("case.out", "case.sta", "case_curv.dat"):
            for ranks in (1, 2):
                with self.subTest(name, ranks=ranks):
                    shutil.rmtree(self.out, ignore_errors=True)
                    self.out.mkdir()
                    (self.out / name).symlink_to("/dev/full")
                    outcome = _mpm.run([case, "--output-dir", self.out], ranks=ranks)
                    self.check_failed(outcome, rf"cannot write '?.*{re.escape(name)}.*No space left on device")

    def mount(self, size):
        self.out.mkdir(exist_ok=True)
        command = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", self.out]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            self.skipTest(f"no right to mount a small disk: {done.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", "-l", self.out], check=False)

    def test_disk_that_the_pictures_fill(self):
        self.mount("3m")
        case = self.write(_mpm.bounce(END, PICTURES + restarts_every(END / 9)))
        outcome = _mpm.run([case, "--output-dir", self.out], ranks=2)
        self.check_failed(outcome, "No space left on device")
        self.assertEqual(len(_mpm.restarts(self.out)), 2)
        self.go_on(into="elsewhere")
        again = _mpm.run([self.out / "case.pe", "--output-dir", self.out])
        self.check_failed(again, "No space left on device")
        # A file of pictures that the full disk has cut is set aside as .damaged, never deleted.
        kept = [name for name in _mpm.names(self.out) if name.startswith("case.h5part")]
        self.assertTrue({"case.h5part", "case.h5part.damaged"} & set(kept), again)
        for name in kept:
            (self.out / name).unlink()
        shutil.rmtree(self.out / "case_vtu")
        self.assertGreater(len(_mpm.restarts(self.out)), 0)
        self.go_on(into="elsewhere")

    def test_disk_that_restart_files_fill(self):
        """Two fit; the third, for which 300 kB more than it needs are reserved, does not: the two stay."""
        self.mount("900k")
        case = self.write(_mpm.bounce(END, restarts_every(END / 9)))
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                outcome = _mpm.run([case, "--output-dir", self.out], ranks=ranks)
                self.check_failed(outcome, r"cannot write '?.*case_\d+\.pe.*No space left on device")
                self.assertEqual(len(_mpm.restarts(self.out)), 2)
                self.go_on(into="elsewhere")
                for path in _mpm.restarts(self.out):
                    path.unlink()


class Killed(Files):
    def test_killed_ten_times_while_restart_files_are_written(self):
        """A restart file after every step, so that most of the time one is being written."""
        case = self.write(_mpm.bounce(END, restarts_every(1e-9)))
        moments = random.Random(1)
        kills, longest = 0, 0.05  # seconds until a kill: fewer where runs end before it, more where it is too early
        while kills < 10 or not _mpm.restarts(self.out):
            there = _mpm.restarts(self.out)
            process = _mpm.start([self.out / "case.pe" if there else case, "--output-dir", self.out])
            _mpm.read_until(process, 0)  # it has begun to compute
            time.sleep(moments.uniform(0, longest))
            process.kill()
            outcome = _mpm.finish(process)
            self.assertIn(outcome.code, (DONE, -signal.SIGKILL), outcome)
            kills += outcome.code != DONE
            if there:
                self.assertGreater(len(_mpm.restarts(self.out)), 0)
            if outcome.code != DONE and not _mpm.restarts(self.out):
                longest *= 2
            if outcome.code == DONE and kills < 10:
                longest /= 2
                shutil.rmtree(self.out)  # and once more from the start
        self.go_on()
        self.assertEqual([name for name in _mpm.names(self.out) if ".part" in name], [], "what the killed runs left")

    def test_one_of_two_ranks_killed(self):
        case = self.write(_mpm.bounce(END, PICTURES + restarts_every(END / 20)))
        for percent in (30, 20, 10, 10, 10):  # earlier, where the run is over before the kill
            shutil.rmtree(self.out, ignore_errors=True)
            process = _mpm.start([case, "--output-dir", self.out], ranks=2)
            _mpm.read_until(process, percent)
            for rank in _mpm.children(process)[-1:]:
                _mpm.send(rank, signal.SIGKILL)
            outcome = _mpm.finish(process)
            if outcome.code != DONE:
                break
        self.assertNotIn(outcome.code, (0, None), outcome)
        self.go_on(ranks=2)
        self.assertEqual(times_of(self.out / "case.h5part"), Files.times)


class Damaged(Files):
    def setUp(self):
        super().setUp()
        case = self.write(_mpm.bounce(END, restarts_every(END / 4)))
        self.run_in("out", [case])
        self.old, self.new = _mpm.restarts(self.out)
        self.bytes = self.new.read_bytes()

    def damages(self):
        """What may happen to a file, in words, and its bytes then."""
        size = len(self.bytes)
        for kept in (0, 100, size // 2, size - 1):
            yield f"cut to {kept} bytes", self.bytes[:kept]
        places = random.Random(2)
        for place in [0, 20, 600, size - 1] + [places.randrange(size) for _ in range(4)]:
            broken = bytearray(self.bytes)
            broken[place] ^= 1 << places.randrange(8)
            yield f"bit flipped in byte {place}", bytes(broken)
        yield "a kilobyte of zeros", self.bytes[: size // 3] + bytes(1000) + self.bytes[size // 3 + 1000:]
        yield "a byte more", self.bytes + b"\0"
        yield "something else", b"Hello\n" * 1000

    def test_refused_by_name_and_passed_over_by_job(self):
        for count, (what, damaged) in enumerate(self.damages()):
            with self.subTest(what):
                self.new.write_bytes(damaged)
                ranks = 2 if count % 5 == 2 else 1
                outcome = self.run_in("again", [self.new], code=FILE_ERROR, ranks=ranks)
                self.assertEqual(outcome.complaint.count(self.new.name), 1, outcome)
                self.assertFalse((self.folder / "again").exists(), "a damaged file starts nothing")
                if count % 3 == 0:
                    outcome = self.go_on(into="other")
                    self.assertIn(f"from {self.old}", outcome.out)
                    # A file whose very head is gone is not known to be a newer one.
                    if outcome.complaint:
                        self.assertRegex(outcome.complaint, rf"^skipped: .*{self.new.name}")

    def test_all_damaged(self):
        for path in (self.old, self.new):
            path.write_bytes(self.bytes[:5000])
        outcome = self.run_in("again", [self.out / "case.pe"], code=FILE_ERROR)
        for words in (self.old.name, self.new.name, "no readable restart file of the job was found"):
            self.assertIn(words, outcome.complaint)
        self.assertFalse((self.folder / "again").exists())

    def test_nothing_to_convert(self):
        self.new.write_bytes(self.bytes[:5000])
        outcome = self.run_in("again", [self.new, "-h5pt"], code=FILE_ERROR)
        self.assertIn(self.new.name, outcome.complaint)
        self.assertEqual(_mpm.names(self.folder / "again") if (self.folder / "again").exists() else [], [])


if __name__ == "__main__":
    _mpm.main()
