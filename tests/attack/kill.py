"""Runs on 1 and 2 ranks are killed at random moments (kill -9) and go on until they reach their end; then the state
and every file must be those of a run that nobody disturbed.

    kill.py [trials, 300] [seed, 1]

The moments are uniform over the time that an undisturbed run takes, and it is made to take a few times what a start
takes, so that kills hit every phase on any machine. Runs that end before their moment shorten that time."""

import os
import pathlib
import random
import shutil
import signal
import time

import _attack
from _attack import _mpm, _resume

MOST_KILLS = 30  # of one trial; from then on it is left alone
PATIENCE = 20  # seconds for mpirun to end when none of its ranks lives any more


class Length:
    """A case that runs long enough, and what it leaves undisturbed on so many ranks."""

    def __init__(self, ground):
        self.folder = ground.folder
        self.case = self.folder / "case.xmp"
        self.seconds, self.states = {}, {}
        end = 1.0
        while True:
            self.case.write_text(_resume.scene(end, pictures="both", restart=end / 9))
            begun = time.monotonic()
            outcome = self.undisturbed(1)
            seconds = time.monotonic() - begun
            if seconds > 3 * self.start_takes():
                break
            end *= 2
        self.undisturbed(2)
        print(f"a run to time {end:g} takes {self.seconds[1]:.2f} s on one rank, {self.seconds[2]:.2f} s on two; state "
              f"{outcome.state}", flush=True)

    def undisturbed(self, ranks):
        begun = time.monotonic()
        outcome = _mpm.run([self.case, "--output-dir", self.folder / f"undisturbed{ranks}"], ranks=ranks)
        assert outcome.code == 0, outcome
        self.seconds[ranks] = time.monotonic() - begun
        self.states[ranks] = outcome.state
        return outcome

    def start_takes(self):
        begun = time.monotonic()
        _mpm.run([self.case, "--dry-run", "--output-dir", self.folder / "dry"])
        return time.monotonic() - begun


def strike(process, ranks, chance):
    """Everything at once; of several ranks, sometimes one of them or mpirun alone, which ends the rest in its way."""
    members = _resume.ranks_of(process, ranks)
    victims = {process.pid, *members}
    if ranks > 1 and members:
        victims = chance.choice([victims, {process.pid}, {chance.choice(members)}])
    for pid in victims:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def end_of_killed(process, ranks, count):
    """The outcome of a run of which something was killed. Now and then mpirun waits for ever for a rank that is dead
    (Open MPI 4.1): it is killed when it has no living rank for a while."""
    alone_since = None
    while ranks > 1 and process.poll() is None:
        now = time.monotonic()
        alone_since = None if any(map(lives, _resume.ranks_of(process, ranks))) else alone_since or now
        if alone_since and now - alone_since > PATIENCE:
            count["mpirun left over"] += 1
            os.killpg(process.pid, signal.SIGKILL)
        time.sleep(0.05)
    return _mpm.finish(process)


def lives(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def wait_until_gone(process):
    """Until no process of its session lives: a rank may outlive its mpirun by a moment, and write."""
    def is_member(stat):
        try:
            words = stat.read_text().rpartition(")")[2].split()
        except OSError:
            return False
        return words[0] not in "ZX" and int(words[3]) == process.pid

    while any(is_member(path) for path in pathlib.Path("/proc").glob("[0-9]*/stat")):
        time.sleep(0.01)


def trial(length, out, ranks, chance, count):
    """Kills until the run has ended; what is wrong, or nothing."""
    kills, process = 0, None
    while True:
        there = _mpm.restarts(out)
        if process and not there:
            # Whoever starts anew has to know that there is nothing to go on from; who goes on need not wait.
            wait_until_gone(process)
            there = _mpm.restarts(out)
        process = _mpm.start([out / "case.pe" if there else length.case, "--output-dir", out], ranks=ranks)
        begun = time.monotonic()
        if kills < MOST_KILLS:
            try:
                process.wait(chance.uniform(0, length.seconds[ranks]))
            except _mpm.subprocess.TimeoutExpired:
                kills += 1
                count["kills"] += 1
                count["before the first restart file"] += not there
                strike(process, ranks, chance)
                outcome = end_of_killed(process, ranks, count)
                if outcome.code is None:
                    return f"killed run does not end: {outcome}"
                if outcome.code != 0:
                    continue
            else:
                if not kills:
                    length.seconds[ranks] = min(length.seconds[ranks], time.monotonic() - begun)
                outcome = _mpm.finish(process)
        else:
            outcome = _mpm.finish(process)
        if outcome.code != 0:
            return f"exit code {outcome.code} after {kills} kill(s): {outcome}"
        if "warning" in outcome.out:
            return f"a warning after {kills} kill(s): {outcome}"
        if outcome.state != length.states[ranks]:
            return f"another state after {kills} kill(s): {outcome}"
        wrong = _attack.differences(out, length.folder / f"undisturbed{ranks}")
        return f"other contents after {kills} kill(s): {', '.join(wrong)}" if wrong else None


def main():
    trials, seed = _attack.trials(300)
    ground = _attack.Ground("kill")
    length = Length(ground)
    chance = random.Random(seed)
    count = {"kills": 0, "before the first restart file": 0, "mpirun left over": 0}
    for n in range(trials):
        out = ground.folder / f"trial{n}"
        wrong = trial(length, out, 1 + n % 2, chance, count)
        if wrong:
            ground.fault(n, wrong)
        else:
            shutil.rmtree(out)
    print(f"{trials} trials, {count['kills']} kills, {count['before the first restart file']} of them before the first "
          f"restart file; mpirun had to be killed {count['mpirun left over']} time(s)")
    ground.end()


if __name__ == "__main__":
    main()
