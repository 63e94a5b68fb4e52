"""Strong and weak scaling of the copper Taylor bar over MPI ranks and over OpenMP threads, as one CSV file.

strong  the same bar on 1, 2, 4 ... cores         weak  as many particles per core on each of them
copies  as many programs that know nothing of each other, each with the bar of the strong study on a core of its own:
        what this machine's cores lose by sharing its memory, which no program can win back

core_ns is the time of a core per particle-step, time per step x cores / particles. Efficiency, strong or weak,
is that of the study's first case over that of the case: 1 where twice the cores do twice the work. Efficiency of
computing counts the busiest rank's own processor time, without what waits for others (ranks only). Shares are of
the time of a step, means over the ranks; waiting in end_halo and reduce holds what imbalance costs. Cases of the
same bar whose states differ in one bit end the study.

With more ranks and threads than cores the wall's time means nothing. The step is then the processor's time of the
busiest rank, as if there were cores enough and messages cost nothing; the table says so (clock: processor).

On a cluster:
  scaling.py --ranks 48 96 192 --launcher "srun -n {n} -c {t} --cpu-bind=cores" --strong 100e6 --weak 1e6"""

import argparse
import concurrent.futures
import pathlib
from math import nan

from common import results

PARTS = "begin_halo", "end_halo", "reduce", "bricks", "migrate"


def doubling(most):
    """1, 2, 4 ... and `most` itself."""
    return sorted({2**i for i in range(most.bit_length())} | {most})


def arguments(parser, cores=results.CORES):
    parser.add_argument("--ranks", type=int, nargs="*", default=doubling(cores), help="each with one thread")
    parser.add_argument("--threads", type=int, nargs="*", default=doubling(cores), help="each with one rank")
    parser.add_argument("--copies", type=int, nargs="*", default=[n for n in doubling(cores) if n <= results.CORES],
                        help="numbers of independent programs at the same time on this machine")
    parser.add_argument("--launcher", default="mpirun --oversubscribe --bind-to none -n {n}",
                        help="command that starts {n} ranks of {t} threads")
    parser.add_argument("--strong", type=float, default=1.3e6, help="particles of the strong studies; 0: none")
    parser.add_argument("--weak", type=float, default=200e3, help="particles per core of the weak ones; 0: none")
    parser.add_argument("--partitions", nargs="+", default=["metis", "uniform"], choices=["metis", "uniform"])
    parser.add_argument("--scaling-repeats", type=int, default=5, help="of 20 steps; the best one is taken")
    parser.add_argument("--rounds", type=int, default=3, help="over all cases in turn; the best of each is taken")


def cases(options):
    """(study, over, partition, ranks, threads, particles) of every run, the base of each study first."""
    for study, size in (("strong", options.strong), ("weak", options.weak)):
        if size <= 0:
            continue

        def particles(cores):
            return size * (cores if study == "weak" else 1)

        for partition in options.partitions:
            for n in options.ranks:
                yield study, "ranks", partition, n, 1, particles(n)
        for t in options.threads:
            yield study, "threads", options.partitions[0], 1, t, particles(t)
    if options.strong > 0:
        for n in options.copies:
            yield "copies", "programs", "", n, 1, options.strong


def program(options, particles, *more):
    return [results.BIN / "scaling", "--particles", particles, "--repeats", options.scaling_repeats, *more]


def copies(options, n, particles):
    """The case of the slowest of n programs that run at the same time."""
    with concurrent.futures.ThreadPoolExecutor(n) as pool:
        said = pool.map(lambda _: results.run(program(options, particles), OMP_NUM_THREADS="1"), range(n))
        return max(map(results.last_json, said), key=lambda case: case["step_s"])


def measure(options, partition, ranks, threads, particles):
    launcher = options.launcher.format(n=ranks, t=threads).split()
    # Waiting processes must yield the core to others.
    crowded = ranks * threads > results.CORES
    waiting = {"OMP_WAIT_POLICY": "passive", "OMPI_MCA_mpi_yield_when_idle": "1"} if crowded else {}
    return results.last_json(results.run(
        [*launcher, *program(options, particles, "--partition", partition, "--threads", threads)],
        OMP_NUM_THREADS=str(threads), **waiting))


def key_of(name, partition, ranks, threads, particles):
    """Key of a case: one rank has no partition, and one copy is one rank."""
    apart = name == "copies" and ranks > 1
    return "copies" if apart else partition if ranks > 1 else "", ranks, threads, particles


def measure_in_turn(options):
    """The best of several rounds of every case: varying other load on the machine affects all cases alike."""
    best = {}
    for _ in range(options.rounds):
        seen = set()
        for name, _, partition, ranks, threads, particles in cases(options):
            key = key_of(name, partition, ranks, threads, particles)
            if key in seen:
                continue
            seen.add(key)
            case = (copies(options, ranks, particles) if key[0] == "copies"
                    else measure(options, partition, ranks, threads, particles))
            if best.setdefault(key, case)["state"] != case["state"]:
                raise SystemExit(f"{key}: the state {case['state']} is not {best[key]['state']}, that of an earlier round")
            if case["step_s"] < best[key]["step_s"]:
                best[key] = case
    return best


def study(options):
    """Rows of the table, and the facts of the machine."""
    rows, first, states = [], {}, {}
    measured = measure_in_turn(options)
    for name, over, partition, ranks, threads, particles in cases(options):
        key = key_of(name, partition, ranks, threads, particles)
        case, apart = measured[key], key[0] == "copies"
        if states.setdefault(case["particles"], case["state"]) != case["state"]:
            raise SystemExit(f"{ranks} rank(s) x {threads} thread(s), {partition}: the state {case['state']} "
                             f"is not {states[case['particles']]}, that of the same bar before")
        cores, crowd = ranks * threads, case["oversubscribed"]
        particles = case["particles"] * (ranks if apart else 1)
        core_ns = 1e9 * case["step_s"] * cores / particles
        computing_ns = 1e9 * case["compute_s"]["max"] * cores / particles
        base, computing = first.setdefault((name, over, partition), (core_ns, computing_ns))
        of_ranks = over == "ranks"
        rows.append({"study": name, "over": over, "partition": partition if of_ranks else "", "ranks": ranks,
                     "threads": threads, "particles": int(particles), "bricks": int(case["bricks"]),
                     "oversubscribed": int(crowd), "clock": case["clock"],
                     "step_ms": 1e3 * case["step_s"], "step_median_ms": 1e3 * case["step_median_s"],
                     "core_ns": core_ns,
                     "million_particle_steps_per_s": 1e-6 * particles / case["step_s"],
                     "efficiency": (computing if crowd else base) / core_ns,  # by the same clock
                     "computing_efficiency": computing / computing_ns if of_ranks else nan,
                     "imbalance": case["imbalance"], "particle_imbalance": case["particle_imbalance"],
                     **{f"{part}_share": nan if crowd else case["parts_s"][part]["mean"] / case["step_s"]
                        for part in PARTS},
                     "state": case["state"]})
    return rows, [f"{name:10} {value}" for name, value in case["facts"].items()]


def heading(study, over):
    return "Programs beside each other" if study == "copies" else f"{study.capitalize()} scaling over {over}"


def columns():
    """For results.markdown."""
    get = lambda key, factor=1: lambda row: factor * row[key]
    return {"cores": (lambda r: f"{int(r['ranks'])} x {int(r['threads'])}", ""),
            "partition": (get("partition"), ""), "particles": (get("particles"), ".0f"),
            "clock": (get("clock"), ""), "ms per step": (get("step_ms"), ".3g"),
            "M particle-steps/s": (get("million_particle_steps_per_s"), ".1f"),
            "efficiency %": (get("efficiency", 100), ".1f"),
            "of computing %": (get("computing_efficiency", 100), ".1f"),
            "max/mean computing": (get("imbalance"), ".3f"),
            **{f"{part.replace('_', ' ')} %": (get(f"{part}_share", 100), ".2f") for part in PARTS}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments(parser)
    parser.add_argument("--csv", type=pathlib.Path, default=results.ROOT / "build/benchmarks/scaling.csv")
    options = parser.parse_args()
    rows, facts = study(options)
    results.write(options.csv, rows, facts)
    for name in dict.fromkeys((r["study"], r["over"]) for r in rows):
        print(f"\n{heading(*name)} (cores: ranks x threads)\n")
        print(results.markdown([r for r in rows if (r["study"], r["over"]) == name], columns()))
    if any(r["oversubscribed"] for r in rows):
        print("\nclock: processor. More ranks and threads than cores; see scaling.py --help.")
    print(f"\n{options.csv}")


if __name__ == "__main__":
    main()
