"""What a run takes of the machine, and what it says when the machine has no more: memory, threads, file descriptors,
counts that do not fit in a number."""

import math
import pathlib
import re
import resource

from _mpm import (DONE, FILE_ERROR, INPUT_ERROR, Case, block, bounce, children, finish, grid, main, material, run, scene,
                  solution, start, summary)

OUT_OF_RESOURCES = 6
MB = 1e6


def dust(bodies, end, cells=None, speed=0.0):
    """Bodies of one particle each in neighbouring cells of a cube; with a speed, it expands so fast at its faces."""
    side = math.ceil(bodies ** (1 / 3))
    cells = cells or side
    low = (cells - side) // 2
    texts = []
    for i in range(bodies):
        place = [low + n + 0.25 for n in (i % side, i // side % side, i // side ** 2)]
        velocity = [speed * (2 * (x + 0.25) / cells - 1) * cells / side for x in place]
        texts.append(block(f"b{i}", place, (0.5, 0.5, 0.5), velocity))
    soft = material(strength='type="IsoElastic" Young="1" Poisson="0.3"')
    return scene(texts, grid((0, 0, 0), (cells,) * 3), solution(end), materials=[soft],
                 output=f'<Console print_time="{end}"/>')


def counted(outcome):
    """Bytes that the log's line on memory names."""
    number, unit = re.search(r"^memory +([\d.]+) ([kMG]B)", outcome.out, re.MULTILINE).groups()
    return float(number) * {"kB": 1e3, "MB": 1e6, "GB": 1e9}[unit]


def virtual_size(pid):
    """Bytes of address space that a process has."""
    pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[0])
    return pages * resource.getpagesize()


def limited(bytes_):
    """What sets the limit on address space in a child, before the program starts."""
    return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_AS, (int(bytes_), int(bytes_)))}


class Counts(Case):
    def test_parts_whose_product_overflows(self):
        # 1 modulo 2^64, the number of ranks.
        parts = '<DomainDecomposition method="uniform" dimension0="47205953" dimension1="1562003" ' \
                'dimension2="64544731"/>'
        path = self.write(bounce(0.01).replace("<Output>", parts + "<Output>"))
        outcome = self.run_in("out", [path], INPUT_ERROR)
        self.assertIn("dimension2 = more than 2^63 must equal", outcome.err, outcome)
        self.assertIn("which is 1", outcome.err, outcome)


class Memory(Case):
    def own(self):
        """Peak memory of the program with next to no particles."""
        path = self.write(bounce(0.001, bodies=[block("one", (1, 1, 1), (0.5, 0.5, 0.5))]), "one.xmp")
        self.run_in("one", [path])
        return summary(self.folder / "one", "one")["peak_memory_bytes"]["max"]

    def test_bodies_of_one_particle(self):
        # A pool of whole huge pages for each would be 2 MB a body, 6 GB.
        path = self.write(dust(3000, 0.02))
        own = self.own()
        alone = self.run_in("alone", [path])
        peak = summary(self.folder / "alone")["peak_memory_bytes"]["max"]
        self.assertLess(peak - own, 60 * MB)
        self.assertGreater(counted(alone), 3000 * 8 * 144)  # a block of eight particles each
        self.assertEqual(self.run_in("two", [path], ranks=2, threads=2).state, alone.state)

    def test_memory_is_counted_as_it_is_used(self):
        for scheme in ("MUSL", "USL"):
            text = scene([block("lump", (2, 2, 2), (32, 32, 28))], grid((0, 0, 0), (36, 36, 36)),
                         solution(0.05, scheme))
            outcome = self.run_in(scheme, [self.write(text)])
            used = summary(self.folder / scheme)["peak_memory_bytes"]["max"] - self.own()
            self.assertEqual(summary(self.folder / scheme)["particles"], 229376)
            self.assertLess(abs(counted(outcome) / used - 1), 0.2, (scheme, counted(outcome), used))

    def test_too_small_for_the_scene(self):
        # 229,376 particles are 33 MB; the program itself takes less than 1 GB of address space.
        text = scene([block("lump", (2, 2, 2), (320, 320, 280))], grid((0, 0, 0), (400, 400, 400)), solution(1))
        outcome = self.run_in("out", [self.write(text)], INPUT_ERROR, **limited(4e9))
        self.assertRegex(outcome.err, r"2\.29e\+08 particles need .* GiB per rank, but only [\d.]+ GiB are free")


class Exhausted(Case):
    """Limits on address space, which hold for every user and on every machine."""

    def start_and_look(self, arguments, ranks=1, **more):
        """Largest address space of the ranks of a run that has begun its steps; the run ends at once."""
        process = start([*arguments, "--output-dir", self.folder / "look"], ranks=ranks, **more)
        try:
            for line in process.stdout:
                if line.split()[:2] == ["step", "time"]:
                    break
            return max(map(virtual_size, [process.pid] if ranks == 1 else children(process)))
        finally:
            process.kill()
            finish(process)

    def test_memory_in_the_middle_of_a_run(self):
        # The particles fly apart, until each has a brick of its own: some 50 MB more than at the start.
        path = self.write(dust(3000, 2, cells=160, speed=32))
        self.assertEqual(run([path, "--output-dir", self.folder / "free"]).code, DONE)
        for ranks in (1, 2):
            limit = self.start_and_look([path], ranks) + 8 * MB
            outcome = run([path, "--output-dir", self.folder / f"out{ranks}"], ranks=ranks,
                          mpirun=["prlimit", f"--as={int(limit)}"], **(limited(limit) if ranks == 1 else {}))
            self.assertEqual(outcome.code, OUT_OF_RESOURCES, outcome)
            self.assertRegex(outcome.err, r"rank \d: out of memory")

    def test_threads(self):
        # Each thread's stack takes address space.
        path = self.write(bounce(5, rows=100))
        size = self.start_and_look([path])
        outcome = self.run_in("few", [path, "--nsteps", 2], threads=2, **limited(size + 1000 * MB))
        self.assertNotIn("refuses", outcome.err)
        outcome = self.run_in("many", [path], OUT_OF_RESOURCES, threads=900, **limited(size + 1000 * MB))
        self.assertIn("the system refuses 900 threads per rank", outcome.err)
        self.assertIn("request fewer", outcome.err)


class Descriptors(Case):
    def test_no_more_files_can_be_opened(self):
        path = self.write(bounce(0.01))
        for ranks in (1, 2):
            for most in (6, 9, 12, 20):
                more = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))}
                outcome = run([path, "--output-dir", self.folder / "out"], ranks=ranks,
                              mpirun=["prlimit", f"--nofile={most}"], **(more if ranks == 1 else {}))
                self.assertEqual(outcome.code, FILE_ERROR, (ranks, most, outcome))
                self.assertRegex(outcome.err, r"Too many open files: only \d+ more .*ulimit -n")


if __name__ == "__main__":
    main()
