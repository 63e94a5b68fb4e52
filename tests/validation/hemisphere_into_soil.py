"""A hemispherical shell strikes soil at 200 and 45 m/s (apps/scenes/hemisphere_into_soil; P. Huang, thesis, Tsinghua 2010, 6.4.2): the
crater's depth after 0.62 ms, and when the shell comes to rest, over cell size, shell, contact, shape and the soil's walls.

Targets: 95 to 98 mm after 0.62 ms at 200 m/s (the thesis's material points and finite elements); at rest near 20 ms at 45 m/s."""

import _common  # first: it says where the next one is
import _hemisphere

SHELL = {"cell": ("cell mm", "g"), "shell": ("shell", "")}
STEPS = {"particles": ("particles", "d"), "steps": ("steps", "d")}
REST = {"drift": ("energy drift %", "+.1f"), "cpu_seconds": ("processor s", ".1f")}
EARLY = SHELL | {"shape": ("shape", ""), "contact": ("contact", "")} | STEPS | {
    "crater": ("depth of the crater mm", ".1f"), "pole": ("of the shell mm", ".1f"), "speed_left": ("speed left m/s", ".1f"),
    "densest": ("greatest density over the first", ".1f")} | REST
LATE = {"speed": ("speed m/s", "d")} | SHELL | {"walls": ("soil's walls", ""), "factor": ("time step factor", "g")} | STEPS | {
    "rest": ("at rest after ms", ".1f"), "rest_depth": ("depth then mm", ".0f")} | REST

# What a case has unless it says otherwise.
CHOICE = {"speed": 200, "cell": 20, "shape": "linear", "shell": "elastic", "contact": True, "kind": 1, "normal": "regression", "sides": 2, "bottom": 1,
          "width": 600, "depth": 960, "factor": 0.9}
WALLS = {0: "free", 1: "fixed", 2: "smooth", 3: "non-reflecting"}


def run(folder, case):
    seconds = _common.run(folder, _hemisphere.text(**case), _hemisphere.JOB)
    found = _hemisphere.measure(folder)
    how = f"type {case['kind']}, {case['normal']}" if case["contact"] else "none"
    row = {**case, **found, "contact": how, "speed": case["speed"], "speed_left": found["speed"], "walls": WALLS[case["sides"]], "cpu_seconds": seconds}
    print(row, flush=True)
    return row


# To 0.62 ms at 200 m/s, when the soil moves in a layer of some centimetres only: a smaller block gives the same numbers.
EARLY_CASES = [{"cell": 24, "width": 312, "depth": 312}, {}, {"cell": 15}, {"cell": 12}, {"cell": 10}, {"shell": "rigid"}, {"cell": 12, "shell": "rigid"},
               {"normal": "mass_gradient"}, {"kind": 0}, {"contact": False}, {"shape": "QuadraticBSpline"}, {"shell": "rigid", "kind": 0}]
# Until the shell is at rest.
LATE_CASES = [{"cell": 40}, {"cell": 40, "shell": "rigid"}, {"cell": 24, "shell": "rigid"}, {"cell": 24, "shell": "rigid", "factor": 0.4},
              {"cell": 24, "shell": "rigid", "sides": 3, "bottom": 3}, {"shell": "rigid"}, {"cell": 12, "shell": "rigid", "end": 22},
              {"speed": 200, "end": 10, "cell": 24, "shell": "rigid"}]


def early(options, verdict):
    rows = [run(options.out / f"early-{i}", CHOICE | {"end": 0.62, "width": 300, "depth": 300} | EARLY_CASES[i]) for i in options.early]
    _common.write(options.out, "early", rows, EARLY)
    for row in rows:
        if row["cell"] == 12:  # the thesis's cells
            verdict.expect(95 <= row["crater"] <= 98, f"200 m/s, {row['shell']} shell: crater {row['crater']:.1f} mm deep after 0.62 ms")


def late(options, verdict):
    rows = [run(options.out / f"late-{i}", CHOICE | {"speed": 45, "end": 24} | LATE_CASES[i]) for i in options.late]
    _common.write(options.out, "late", rows, LATE)
    for row in rows:
        if row["speed"] == 45 and row["cell"] <= 24:
            verdict.expect(abs(row["rest"] - 20) <= 2, f"45 m/s, cells of {row['cell']} mm, {row['shell']} shell: at rest after {row['rest']:.1f} ms")


def main():
    parser = _common.arguments(__doc__, "hemisphere_into_soil")
    parser.add_argument("--early", nargs="*", type=int, default=range(len(EARLY_CASES)), help="numbers of rows of the first table, from 0")
    parser.add_argument("--late", nargs="*", type=int, default=range(len(LATE_CASES)), help="of the second table")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    print(f"all soil taken along, nothing else: {_hemisphere.inelastic_depth(200, 0.62):.1f} mm deep after 0.62 ms\n", flush=True)
    if options.early:
        early(options, verdict)
    if options.late:
        late(options, verdict)
    verdict.finish()


main()
