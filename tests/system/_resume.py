"""Runs that are killed and go on: long enough for any machine, and cut to length afterwards.

A run that is to be killed has no end; when it is dead, the same input with an end a little after its newest restart
file goes on from there (-rt), and runs undisturbed beside it."""

import os
import pathlib
import signal
import time

import h5py

import _mpm

ENDLESS = 1e6
PRINT = 0.05  # simulated time between rows of .sta; a step is about 0.011


def scene(end=ENDLESS, pictures="h5part", restart=0.2, histories=True):
    output = ""
    if pictures:
        kinds = 'h5part="1"' if pictures == "h5part" else 'vtk_data="1"' if pictures == "vtk" else \
            'h5part="1" vtk_data="1"'
        output += f'<PostProcessing time_interval="0.1" {kinds} var="seqv"/>'
    if histories:
        output += ('<TimeHistory var="pres|velocity_0"><Particle x="4" y="4" z="4"/><Point x="9" y="4" z="4"/>'
                   "</TimeHistory>")
    output += f'<Restart time_interval="{restart}"/>'
    return _mpm.bounce(end, output, rows=end / PRINT)


def wait_for(condition, process, seconds=100):
    """Until condition() or the process has ended; false then."""
    end = time.monotonic() + seconds
    while not condition():
        if process.poll() is not None or time.monotonic() > end:
            return False
        time.sleep(0.001)
    return True


def ranks_of(process, ranks):
    return [process.pid] if ranks == 1 else _mpm.children(process)


def kill(process, ranks=1):
    """mpirun and its ranks at once, as a power failure would."""
    victims = {process.pid, *ranks_of(process, ranks)}
    for pid in victims:
        os.kill(pid, signal.SIGKILL)
    return _mpm.finish(process)


def start_and_kill(case, out, ranks=1, files=1):
    """Kill a run when it has written so many restart files."""
    process = _mpm.start([case, "--output-dir", out], ranks=ranks)
    seen = set()

    def enough():
        seen.update(_mpm.restarts(out))
        return len(seen) >= files

    there = wait_for(enough, process)
    outcome = kill(process, ranks)
    assert there, outcome
    return outcome


def warnings(outcome):
    """What the run warned of, but for the error of its energy: whether that is notable depends on when the run ends."""
    return [line for line in outcome.out.splitlines() if line.startswith("warning") and "energy balance" not in line]


def time_of(restart):
    with h5py.File(restart) as file:
        return float(file.attrs["time"])


def rows(path):
    """The lines of a table without its comments."""
    return [line for line in pathlib.Path(path).read_text(errors="replace").splitlines()
            if line and not line.startswith("#")]


def states(path):
    """Everything that the times of an .h5part file hold, in order; and the names of its groups."""
    with h5py.File(path) as file:
        found = [(float(step.attrs["TimeValue"]), int(step.attrs["step"]),
                  {name: data[()].tobytes() for name, data in step.items()}) for step in _mpm.pictures(file)]
        return found, sorted(file)
