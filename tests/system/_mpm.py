"""Helpers of the end-to-end tests: scenes in few words, runs of the programs, and what they leave behind.

The scenes' units are nobody's: cells of 1, densities of 1, waves of about 37."""

import contextlib
import functools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("MPM_SOURCE", pathlib.Path(__file__).parents[2])).resolve()
BIN = pathlib.Path(os.environ.get("MPM_BIN", SOURCE / "build/release/bin")).resolve()

# Root in a container and more ranks than cores are normal here. Ranks that wait let others work: on a machine that
# is busy otherwise, a rank that spins keeps the one that it waits for from its core. Open MPI's own files go where
# no run of another test takes away the folder that they have in common, and nor does one of the same test (start).
MPI_FILES = tempfile.TemporaryDirectory(prefix="mpm-mpi-", ignore_cleanup_errors=True)
ENVIRONMENT = {
    **os.environ,
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_ess_singleton_isolated": "1",  # a program on its own needs no daemon: half a second less
    # Tests are on one machine: no search for adapters of fast networks, and none for graphics cards, takes half of the start.
    "OMPI_MCA_pml": "ob1",
    "HWLOC_COMPONENTS": "linux,stop",
    "OMPI_MCA_orte_tmpdir_base": MPI_FILES.name,
    "OMP_WAIT_POLICY": "passive",
}

DONE, INPUT_ERROR, NUMERICAL_FAILURE, STOPPED, FILE_ERROR = 0, 2, 3, 4, 5


# Scenes -----------------------------------------------------------------------------------------------------------


def material(name="soft", density=1.0, strength='type="IsoElastic" Young="1000" Poisson="0.3"', more=""):
    return (f'<Material name="{name}"><ReferenceDensity value="{density}"/>'
            f"<StrengthModel {strength}/>{more}</Material>")


def friction(first, second, value):
    """Of two materials: a coefficient, or "rough"."""
    surface = 'rough="1"' if value == "rough" else f'value="{value}"'
    return f'<Friction><Coefficient {surface} mat1="{first}" mat2="{second}"/></Friction>'


def block(name, lower, size, velocity=(0, 0, 0), dp=0.5, of="soft", more="", attributes=""):
    geometry = 'x0="{}" y0="{}" z0="{}" lx="{}" ly="{}" lz="{}"'.format(*lower, *size)
    speed = 'vx="{}" vy="{}" vz="{}"'.format(*velocity)
    return (f'<Body name="{name}" material="{of}" type="Block" {attributes}><Geometry dp="{dp}" {geometry}/>'
            f"<InitialVelocity {speed}/>{more}</Body>")


def grid(lower, upper, faces="000000", cell=1):
    """`faces`: the boundary types of x-, x+, y-, y+, z-, z+."""
    planes = ""
    for axis, letter in enumerate("XYZ"):
        planes += (f'<{letter}Min value="{lower[axis]}" boundary="{faces[2 * axis]}"/>'
                   f'<{letter}Max value="{upper[axis]}" boundary="{faces[2 * axis + 1]}"/>')
    return f'<Grid><Cell type="regular">{planes}<DCell dx="{cell}" dy="{cell}" dz="{cell}"/></Cell></Grid>'


def solution(end, algorithm="MUSL", factor=0.5, attributes="", more=""):
    return (f'<Solution algorithm="{algorithm}" {attributes}><EndTime value="{end}"/>'
            f'<TimeStep factor="{factor}"/>{more}</Solution>')


def scene(bodies, grid, solution, materials=None, output="", more=""):
    """Whole text of an input file; `bodies` and `materials` are lists of elements."""
    lines = ['<?xml version="1.0" encoding="utf-8"?>', '<PeneBlast version="1.0">',
             *(materials or [material()]), '<Component name="all">', *bodies, "</Component>",
             grid, solution, f"<Output>{output}</Output>", more, "</PeneBlast>", ""]
    return "\n".join(lines)


BOUNCING = [block("left", (1, 2, 2), (6, 4, 4), (2, 1, 0)), block("right", (9, 2, 2), (6, 4, 4), (-3, 0, 1))]


def bounce(end, output="", rows=10, bodies=None):
    """Two blocks that bounce between walls and off each other: 1536 particles, about 90 steps per unit of time."""
    return scene(bodies or BOUNCING, grid((0, 0, 0), (16, 8, 8), "222222"), solution(end),
                 output=f'<Console print_time="{end / rows}"/>' + output)


# Runs -------------------------------------------------------------------------------------------------------------


def command(arguments, ranks=1, mpirun=(), program="mpm_run"):
    words = [str(BIN / program), *map(str, arguments)]
    return words if ranks == 1 else ["mpirun", "--oversubscribe", "-n", str(ranks), *mpirun, *words]


def start(arguments, ranks=1, threads=1, mpirun=(), program="mpm_run", drop=(), **more):
    """A running program, with its own process group and its output in pipes; `drop` names parts of ENVIRONMENT."""
    environment = {**ENVIRONMENT, "OMP_NUM_THREADS": str(threads),
                   "OMPI_MCA_orte_tmpdir_base": tempfile.mkdtemp(prefix="", dir=MPI_FILES.name)}
    return subprocess.Popen(command(arguments, ranks, mpirun, program), stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True,
                            env={key: value for key, value in environment.items() if key not in drop}, **more)


def children(process):
    """Process numbers of the ranks that an mpirun has started."""
    path = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    return [int(word) for word in path.read_text().split()]


def send(pid, number):
    """Signals a process, unless it is over: the code with which it ended tells."""
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, number)


def read_until(process, percent):
    """Reads the progress table until the run is so far, or over; returns what was read."""
    read = ""
    for line in process.stdout:
        read += line
        done = re.search(r" (\d+\.\d)% ", line)
        if done and float(done.group(1)) >= percent:
            break
    return read


def finish(process, timeout=600):
    """Waits for the end; a program that hangs is killed, and its end is then None. The time is far more than any of
    these runs takes on a slow and busy machine: it tells a program that hangs from one that is slow."""
    try:
        out, err = process.communicate(timeout=timeout)
        code = process.returncode
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        out, err = process.communicate()
        code = None
    return Outcome(code, out, err)


def run(arguments, timeout=600, **more):
    return finish(start(arguments, **more), timeout)


class Outcome:
    """How a program ended and what it said."""

    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err

    @property
    def state(self):
        """The hash of all particles that the log names."""
        found = re.search(r"^state +([0-9a-f]{16})\b", self.out, re.MULTILINE)
        return found and found.group(1)

    @property
    def complaint(self):
        """Standard error without what mpirun adds: its paragraphs are between lines of dashes, or begin with it."""
        kept, inside = [], False
        for line in self.err.splitlines():
            if re.fullmatch(r"-{20,}", line):
                inside = not inside
            elif not inside and not re.match(r"mpirun|\[[^]]*\] |$", line):
                kept.append(line)
        return "\n".join(kept)

    def __str__(self):
        return f"exit code {self.code}\n--- output\n{self.out}--- errors\n{self.err}---"


def restarts(folder, job="case"):
    """Restart files of the job by ascending step."""
    found = {}
    for path in pathlib.Path(folder).glob(f"{job}_*.pe"):
        number = path.stem[len(job) + 1:]
        if number.isdigit():
            found[int(number)] = path
    return [found[step] for step in sorted(found)]


def names(folder):
    return sorted(str(p.relative_to(folder)) for p in pathlib.Path(folder).rglob("*"))


def contents(folder):
    """Bytes of every file in the folder."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in pathlib.Path(folder).rglob("*") if p.is_file()}


def summary(folder, job="case"):
    return json.loads((pathlib.Path(folder) / f"{job}.summary.json").read_text())


def table(path):
    """Columns by name of a text table whose last comment line names them; numbers as floats."""
    rows, heads = [], []
    for line in pathlib.Path(path).read_text().splitlines():
        if line.startswith("#"):
            heads = line.lstrip("# ").split()
        elif line.strip():
            rows.append([float(word) for word in line.split()])
    return {head: [row[i] for row in rows] for i, head in enumerate(heads)}


def pictures(file):
    """Groups of an open .h5part file in the order of their times."""
    return [file[name] for name in sorted((n for n in file if n.startswith("Step#")), key=lambda n: int(n[5:]))]


# Tests ------------------------------------------------------------------------------------------------------------


class Case(unittest.TestCase):
    """A test with a folder of its own, which goes when the test is over."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="mpm-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, text, name="case.xmp"):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def run_in(self, folder, arguments, code=DONE, **more):
        """Runs with the given output folder (made by the program) and expects the exit code."""
        outcome = run([*arguments, "--output-dir", self.folder / folder], **more)
        self.assertEqual(outcome.code, code, outcome)
        return outcome

    def state(self, text, folder, **more):
        """The state at the end of a run of this input."""
        return self.run_in(folder, [self.write(text)], **more).state

    def check_restart_onto_other_ranks(self, text):
        """Expects the state at the end from the first restart file, on three ranks instead of two, too."""
        expected = self.state(text, "on2", ranks=2)
        halfway = restarts(self.folder / "on2")[0]
        self.assertEqual(self.run_in("on3", [halfway], ranks=3).state, expected)


@functools.cache
def built_without_implicit_steps():
    """As mpm_check says of an implicit scene. A solver that is built and cannot be loaded fails the tests instead."""
    implicit = solution(1, attributes='Integration="impl"', more='<Implicit type="quasistatic" time_step="1"/>')
    with tempfile.TemporaryDirectory(prefix="mpm-") as folder:
        path = pathlib.Path(folder) / "case.xmp"
        path.write_text(scene([block("block", (0, 0, 0), (2, 2, 2))], grid((0, 0, 0), (2, 2, 2)), implicit))
        return "MPM_WITH_PETSC" in run([path], program="mpm_check").err


def needs_implicit_steps(test):
    """Decorator of a test or of a class of tests."""
    return unittest.skipIf(built_without_implicit_steps(), "built without implicit steps (MPM_WITH_PETSC=OFF)")(test)


def script(path, *arguments):
    """Runs a Python script of the source tree with the programs under test."""
    environment = {**ENVIRONMENT, "MPM_BIN": str(BIN), "MPM_SOURCE": str(SOURCE)}
    return subprocess.run([sys.executable, SOURCE / path, *map(str, arguments)], capture_output=True, text=True,
                          env=environment)


class RunOnce(Case):
    """Tests of the results of one run of a script, made once for the class in the folder `out`: `command` is the script
    and its arguments."""

    command = ()

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = pathlib.Path(tempfile.mkdtemp(prefix="mpm-once-"))
        cls.addClassCleanup(shutil.rmtree, cls.out, ignore_errors=True)
        cls.outcome = script(*cls.command, "--out", cls.out)

    def setUp(self):
        super().setUp()
        self.assertEqual(self.outcome.returncode, 0, self.outcome.stdout + self.outcome.stderr)


def main():
    unittest.main(verbosity=2)
