"""A drop of water strikes the edge of a rigid step at 100 m/s (apps/scenes/water_drop; P. Huang, thesis, Tsinghua 2010, 5.3.4), over
cell size, shape and contact.

Targets: the run reaches 3 ms; the drop's mass is exact and its momentum changes by the impulse of the contact force, to round-off."""

import _common  # first: it says where the next one is
import _water_drop

COLUMNS = {"cell": ("cell mm", ".3g"), "shape": ("shape", ""), "contact": ("contact", ""), "particles": ("particles", "d"),
           "steps": ("steps", "d"), "mass": ("mass, relative error", ".0e"), "momentum": ("momentum - impulse, over m v", ".0e"),
           "force": ("largest force kN", ".0f"), "stopped": ("kinetic energy lost %", ".1f"), "dissipated": ("by contact %", ".1f"),
           "drift": ("energy drift %", "+.1f"), "spread": ("spread, radii", ".2f"), "fastest": ("fastest particle / 100 m/s", ".1f"),
           "inside": ("inside the step %", ".2f"), "cpu_seconds": ("processor s", ".0f")}
CASES = [{"cell": 10.0}, {}, {"kind": 0}, {"normal": "regression"}, {"shape": "QuadraticBSpline"}, {"shape": "SGMP"}]


def main():
    parser = _common.arguments(__doc__, "water_drop")
    parser.add_argument("--cases", nargs="+", type=int, default=range(len(CASES)), help="numbers of rows, from 0")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    rows = []
    for number in options.cases:
        case = {"cell": 5.0, "shape": "linear", "normal": "mass_gradient", "kind": 1} | CASES[number]
        folder = options.out / str(number)
        seconds = _common.run(folder, _water_drop.text(**case), _water_drop.JOB)
        found = _water_drop.measure(folder, case["cell"])
        rows.append({**case, **found, "contact": f"type {case['kind']}, {case['normal']}", "cpu_seconds": seconds})
        print(rows[-1], flush=True)
    _common.write(options.out, "models", rows, COLUMNS)
    for r in rows:
        name = f"cells of {r['cell']:.3g} mm, {r['shape']}, {r['contact']}"
        verdict.expect(abs(r["end"] - 3) < 1e-12, f"{name}: ended at {r['end']} ms")
        verdict.expect(abs(r["mass"]) < 1e-14, f"{name}: mass {r['mass']:.1e}")
        verdict.expect(r["momentum"] < 1e-10, f"{name}: momentum {r['momentum']:.1e}")
    verdict.finish()


main()
