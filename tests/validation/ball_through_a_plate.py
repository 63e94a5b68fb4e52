"""A steel ball strikes a thin steel plate at 200 m/s (apps/scenes/ball_through_a_plate; P. Huang, thesis, Tsinghua 2010, 4.5.1): residual
velocity and the shape of the hole, over cell size, plate, shape and contact.

Targets: it perforates with contact and does not without; residual velocity near 89 m/s and h/D 0.84 +- 0.05 (experiment). The last two are
missed for the reasons in docs/validation.md; what is checked is the first, and that the ball stays whole."""

import _common  # first: it says where the next one is
import _ball_through_plate

COLUMNS = {"cell": ("cell mm", ".3g"), "radius": ("plate's radius mm", "d"), "shape": ("shape", ""), "contact": ("contact", ""),
           "particles": ("particles", "d"), "steps": ("steps", "d"),
           "speed": ("velocity at the end m/s", ".1f"), "through": ("perforated", ""), "h": ("h mm", ".2f"), "D": ("D mm", ".2f"),
           "ratio": ("h/D", ".2f"), "torn": ("h/D with torn edge", ".2f"), "failed": ("failed of the ball %", ".2f"), "drift": ("energy drift %", "+.2f"),
           "cpu_seconds": ("processor s", ".0f")}
CASES = [{"cell": 1.0}, {}, {"contact": False}, {"kind": 0}, {"normal": "mass_gradient"}, {"distance": 0, "normal": "mass_gradient", "end": 0.12},
         {"radius": 40, "end": 0.2}, {"radius": 89, "end": 0.2}, {"cell": 1 / 3}, {"distance": 1, "gap": 0.5}, {"gap": 0.5, "end": 0.2},
         {"gap": 0.5, "radius": 40, "end": 0.2}]


def main():
    parser = _common.arguments(__doc__, "ball_through_a_plate")
    parser.add_argument("--cases", nargs="+", type=int, default=range(len(CASES)), help="numbers of rows, from 0")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    rows = []
    for number in options.cases:
        case = {"cell": 0.5, "radius": 25, "shape": "linear", "kind": 1, "normal": "regression", "distance": 2, "gap": 0.05,
                "contact": True, "end": 0.15} | CASES[number]
        folder = options.out / str(number)
        seconds = _common.run(folder, _ball_through_plate.text(**case), _ball_through_plate.JOB)
        near = {0: ", at a distance", 1: f", centres within {case['gap']:g}", 2: f", faces within {case['gap']:g}" if case["gap"] != 0.05 else ""}
        how = f"type {case['kind']}, {case['normal']}{near[case['distance']]}"
        found = _ball_through_plate.measure(folder, case["cell"], case["radius"])
        rows.append({**case, **found, "contact": how if case["contact"] else "none", "cpu_seconds": seconds})
        print(rows[-1], flush=True)
    _common.write(options.out, "models", rows, COLUMNS)
    for r in rows:
        name = f"cells of {r['cell']:.3g} mm, plate of {r['radius']} mm, {r['shape']}, {r['contact']}"
        if r["cell"] < 1 and r["distance"] == 2 and r["gap"] == 0.05:
            verdict.expect(r["through"] == (r["contact"] != "none"), f"{name}: perforated: {r['through']}")
        verdict.expect(r["contact"] == "none" or r["failed"] < 0.1, f"{name}: {r['failed']:.2f} % of the ball failed")
    verdict.finish()


main()
