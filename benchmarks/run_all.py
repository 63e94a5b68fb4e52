"""All benchmarks by one command: throughput, scaling, feature costs, and error against run time.

Writes to the output folder: a CSV file per table, the output of the programs (.txt), all tables in benchmarks.md, and
plots (.png). --docs also writes the tables into docs/benchmarks.md, between their marks. Tables and plots are made from
every CSV file in the folder, so parts may be measured one at a time, and `--parts` alone only renders them.

  run_all.py --quick        a few minutes, small sizes: a functional check
  run_all.py --docs         about twenty minutes, on an otherwise idle machine"""

import argparse
import os
import pathlib
import sys

import scaling
from common import plots, results

PARTS = "throughput", "scaling", "feature_cost", "accuracy"
LAWS = "strength law", "equation of state", "failure law"


# Measurements ------------------------------------------------------------------------------------------


def measure_throughput(options):
    size = {"quick": ["--sizes", "20e3,200e3", "--seconds", 1, "--empty-space", 50e3, "--rounds", 2,
                      "--shapes", 50e3],
            "tiny": ["--sizes", "2e3", "--seconds", 0, "--repeats", 1, "--empty-space", 0, "--reference-limit", 0,
                     "--rounds", 1, "--shapes", 2e3],
            "full": []}[options.size]
    said = results.run([results.BIN / "throughput", *size, "--csv", options.out / "throughput.csv",
                        "--shapes-csv", options.out / "shapes.csv", "--phases-csv", options.out / "phases.csv"], echo=True)
    (options.out / "throughput.txt").write_text(said)


def measure_scaling(options):
    if options.size != "full":
        small = {"quick": (200e3, 50e3, 5), "tiny": (4e3, 2e3, 1)}[options.size]
        options.strong, options.weak, options.scaling_repeats = small
        options.rounds = 1
    rows, facts = scaling.study(options)
    results.write(options.out / "scaling.csv", rows, facts)


def measure_feature_cost(options):
    size = {"quick": ["--particles", 20e3, "--pairs", 4],
            "tiny": ["--particles", 1e3, "--pairs", 2, "--warm-up", 1], "full": ["--pairs", 12]}[options.size]
    said = results.run([results.BIN / "feature_cost", *size, "--csv", options.out / "feature_cost.csv"], echo=True)
    (options.out / "feature_cost.txt").write_text(said)


def measure_accuracy(options):
    models = {"tiny": ["default"], "quick": ["default"], "full": ["default", "M1", "M2"]}[options.size]
    schemes = ["MUSL"] if options.size == "tiny" else ["MUSL", "USF", "USL"]
    results.run([sys.executable, results.ROOT / "tests/validation/taylor_bar.py",
                 "--out", options.out / "taylor_bar", "--factors", "--models", *models,
                 "--schemes", *schemes], MPM_BIN=str(results.BIN))


# Tables: {name: Markdown} of what the folder holds -----------------------------------------------


def of(key, factor=1):
    return lambda row: factor * row[key] if factor != 1 else row[key]


def throughput_blocks(out):
    _, rows = results.read(out / "throughput.csv")
    ceilings = (f"Ceilings of one core in the same run: {1e-9 * rows[0]['triad_bytes_per_s']:.1f} GB/s triad, "
                f"{1e-9 * rows[0]['in_place_bytes_per_s']:.1f} GB/s read and written in place, "
                f"{1e-9 * rows[0]['fma_flops']:.0f} GFLOP/s.")
    table = results.markdown(rows, {
        "scheme": (of("scheme"), ""), "particles": (of("particles"), ".0f"), "best ns": (of("best_ns"), ".2f"),
        "median ns": (of("median_ns"), ".2f"), "M/s per core": (of("million_particle_steps_per_s_core"), ".1f"),
        "state B": (of("state_bytes"), ".0f"), "moved B": (of("moved_bytes"), ".0f"),
        "FLOP": (of("operations"), ".0f"),
        "of memory %": (of("share_dram", 100), ".0f"), "of FLOP %": (of("share_flop", 100), ".0f"),
        "x floor": (of("ratio_to_floor"), ".2f"), "naive ns": (of("reference_best_ns"), ".1f"),
        "x naive": (of("ratio_to_reference"), ".1f"), "peak over state": (of("peak_over_state"), ".2f")})
    _, phases = results.read(out / "phases.csv")
    largest = max(r["particles"] for r in phases)
    phase_table = results.markdown([r for r in phases if r["particles"] == largest and r["ns"] >= 0.05], {
        "scheme": (of("scheme"), ""), "phase": (of("phase"), ""), "ns": (of("ns"), ".2f"),
        "moved B": (lambda r: r["moved_bytes"] or None, ".0f"),
        "GB/s": (lambda r: r["moved_bytes"] / r["ns"] or None, ".1f"),
        "GFLOP/s": (lambda r: r["operations"] / r["ns"] or None, ".1f")})
    plots.throughput(rows, out / "throughput.png")
    said = (out / "throughput.txt").read_text()
    _, _, empty = said.partition("\nempty space: ")
    empty = "; ".join(" ".join(line.split()) for line in empty.splitlines())
    _, by_shape = results.read(out / "shapes.csv")
    shape_table = results.markdown(by_shape, {
        "scheme": (of("scheme"), ""), "shape": (of("shape"), ""), "best ns": (of("best_ns"), ".1f"),
        "median ns": (of("median_ns"), ".1f"), "x linear": (of("ratio_to_linear"), ".2f"), "state B": (of("state_bytes"), ".0f")})
    return {"shapes": f"{by_shape[0]['particles']:.0f} particles, {by_shape[0]['rounds']:.0f} turns:\n\n{shape_table}",
            "throughput": f"{ceilings}\n\n{table}" + (f"\n\nEmpty space: {empty}." if empty else ""),
            "phases": f"{largest:.0f} particles:\n\n{phase_table}"}


def scaling_blocks(out):
    _, rows = results.read(out / "scaling.csv")
    plots.scaling(rows, out / "scaling.png")
    parts = []
    for study, over in dict.fromkeys((r["study"], r["over"]) for r in rows):
        mine = [r for r in rows if (r["study"], r["over"]) == (study, over)]
        parts.append(f"{scaling.heading(study, over)}:\n\n{results.markdown(mine, scaling.columns())}")
    return {"scaling": "\n\n".join(parts)}


def feature_blocks(out):
    head, rows = results.read(out / "feature_cost.csv")
    case = next(line for line in head if line.startswith("case")).split(maxsplit=1)[1] + "."
    missing = [line.split(None, 2)[2].split(":")[0] for line in head if line.startswith("left out")]
    if missing:
        case += f" Left out, feature_cost.csv says why: {', '.join(missing)}."

    columns = {"family": (of("family"), ""), "feature": (of("feature"), ""), "against": (of("against"), ""),
               "ns": (of("ns"), ".2f"), "added ns": (of("added_ns"), "+.2f"), "± ns": (of("error_ns"), ".2f"),
               "law alone ns": (of("law_ns"), ".2f"), "state B": (of("state_bytes"), ".0f"),
               "added B": (of("added_state_bytes"), "+.0f"), "added B, held": (of("added_held_bytes"), "+.1f"),
               "same bits": (lambda r: "yes" if r["same_bits"] else "", "")}

    def some(*keys):
        return {key: columns[key] for key in columns if key not in keys}

    laws = [r for r in rows if r["family"] in LAWS]
    off = [r for r in rows if r["family"] == "off"]
    features = [r for r in rows if r not in laws and r not in off]
    blocks = {}
    if features:
        blocks["features"] = case + "\n\n" + results.markdown(features, some("law alone ns"))
        plots.costs(features, out / "features.png", "Features of the Taylor bar")
    if laws:
        laws.sort(key=lambda r: LAWS.index(r["family"]))
        blocks["laws"] = results.markdown(laws, some("same bits", "added B, held"))
        plots.costs(laws, out / "laws.png", "Laws, in the step of the Taylor bar")
    if off:
        blocks["off"] = results.markdown(off, some("family", "law alone ns", "against"))
    return blocks


def accuracy_blocks(out):
    return {"accuracy": (out / "taylor_bar/models.md").read_text()}


BLOCKS = {"throughput.csv": throughput_blocks, "scaling.csv": scaling_blocks,
          "feature_cost.csv": feature_blocks, "taylor_bar/models.md": accuracy_blocks}
PICTURES = {"throughput": "throughput.png", "scaling": "scaling.png", "features": "features.png",
            "laws": "laws.png", "accuracy": "taylor_bar/error_against_time.png"}


def tables(out):
    blocks = {}
    for file, make in BLOCKS.items():
        if not (out / file).exists():
            continue
        if file.endswith(".csv"):
            facts = [line for line in results.read(out / file)[0] if not line.startswith(("case", "left out"))]
            blocks.setdefault("machine", "\n".join(f"- {line}" for line in facts))
        blocks.update(make(out))
    text = "# Benchmarks\n"
    for name, block in blocks.items():
        picture = f"\n![]({PICTURES[name]})\n" if name in PICTURES else ""
        text += f"\n## {name.capitalize()}\n\n{block.rstrip()}\n{picture}"
    (out / "benchmarks.md").write_text(text)
    return blocks


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=results.ROOT / "build/benchmarks")
    parser.add_argument("--parts", nargs="*", choices=PARTS, default=PARTS,
                        help="what is measured; none: tables only")
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quick", dest="size", action="store_const", const="quick", default="full",
                      help="small sizes")
    size.add_argument("--tiny", dest="size", action="store_const", const="tiny",
                      help="seconds; the results are meaningless")
    parser.add_argument("--docs", action="store_true", help="refresh the tables of docs/benchmarks.md")
    scaling.arguments(parser)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    load = os.getloadavg()[0]
    if options.parts and load > 0.25:
        print(f"The machine has a load of {load:.2f}: others are at work, and the numbers will show it.",
              file=sys.stderr)
    for part in options.parts:
        globals()[f"measure_{part}"](options)
    blocks = tables(options.out)
    if options.docs:
        results.refresh(results.ROOT / "docs/benchmarks.md", blocks)
    print(f"{options.out}/benchmarks.md")


if __name__ == "__main__":
    main()
