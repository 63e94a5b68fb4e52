"""A hemispherical shell strikes soil at 200 and 45 m/s (apps/scenes/hemisphere_into_soil; P. Huang, thesis, Tsinghua 2010, 6.4.2): the
crater's depth after 0.62 ms, and when the shell comes to rest, over cell size, shell, contact, shape and the soil's walls.

Targets: 95 to 98 mm after 0.62 ms at 200 m/s (the thesis's material points and finite elements); at rest near 20 ms at 45 m/s."""

import _common  # first: it says where the next one is
import _hemisphere

CASE = {"speed": ("speed m/s", "d"), "cell": ("cell mm", "g"), "shape": ("shape", ""), "shell": ("shell", ""), "contact": ("contact", ""),
        "soil's walls": ("soil's walls", ""), "particles": ("particles", "d"), "steps": ("steps", "d")}
REST = {"drift": ("energy drift %", "+.1f"), "cpu_seconds": ("processor s", ".0f")}
EARLY = CASE | {"crater": ("depth of the crater mm", ".1f"), "pole": ("of the shell mm", ".1f"), "speed_left": ("speed left m/s", ".1f"),
                "densest": ("greatest density ratio", ".3g")} | REST
LATE = CASE | {"rest": ("at rest after ms", ".2f"), "rest_depth": ("depth then mm", ".0f"), "kinetic": ("least kinetic energy of the shell %", ".2f")} | REST


def run(options, name, case):
    case = {"speed": 200, "cell": 20, "shell": "elastic", "contact": True, "end": 0.62} | case
    folder = options.out / name
    seconds = _common.run(folder, _hemisphere.text(**case), _hemisphere.JOB)
    found = _hemisphere.measure(folder, case["speed"])
    how = f"type {case.get('kind', 1)}, {case.get('normal', 'regression')}" if case["contact"] else "none"
    walls = {2: "smooth", 0: "free", 3: "non-reflecting", 1: "fixed"}[case.get("sides", 2)]
    row = {**case, **found, "shape": case.get("shape", "linear"), "contact": how, "soil's walls": walls, "speed": case["speed"],
           "speed_left": found["speed"], "cpu_seconds": seconds}
    print(row, flush=True)
    return row


# To 0.62 ms at 200 m/s: cell size, then one change after the other.
CELLS = [24, 20, 15, 12]
CHANGES = {"gradient": {"normal": "mass_gradient"}, "type0": {"kind": 0}, "stuck": {"contact": False},
           "quadratic": {"shape": "QuadraticBSpline"}, "sgmp": {"shape": "SGMP"}, "rigid": {"shell": "rigid"},
           "open": {"sides": 3, "bottom": 3}}
# Until the shell has come to rest.
SLOW = [{"cell": 24}, {"cell": 20}, {"cell": 24, "shell": "rigid"}, {"cell": 20, "shell": "rigid"}, {"cell": 12, "shell": "rigid"},
        {"cell": 12, "shell": "rigid", "sides": 3, "bottom": 3}]


def early(options, verdict):
    rows = [run(options, f"early-{cell}", {"cell": cell}) for cell in CELLS]
    finest = rows[-1]
    verdict.expect(95 <= finest["crater"] <= 98, f"200 m/s, cells of {finest['cell']} mm: crater {finest['crater']:.1f} mm deep after 0.62 ms")
    rows += [run(options, f"early-{name}", change) for name, change in CHANGES.items()]
    _common.write(options.out, "early", rows, EARLY)


def late(options, verdict):
    rows = []
    for speed, end in ((45, 30), (200, 10)):
        for case in SLOW:
            name = f"late-{speed}-{case['cell']}-{case.get('shell', 'elastic')}-{case.get('sides', 2)}"
            rows.append(run(options, name, {"speed": speed, "end": end, **case}))
    _common.write(options.out, "late", rows, LATE)
    for row in rows:
        if row["speed"] == 45 and row["cell"] == 12:
            verdict.expect(abs(row["rest"] - 20) <= 2, f"45 m/s, {row['shell']} shell: at rest after {row['rest']:.1f} ms")


def main():
    parser = _common.arguments(__doc__, "hemisphere_into_soil")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    print(f"all soil taken along, nothing else: {_hemisphere.inelastic_depth(200, 0.62):.1f} mm deep after 0.62 ms\n", flush=True)
    early(options, verdict)
    late(options, verdict)
    verdict.finish()


main()
