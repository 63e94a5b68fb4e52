"""A projectile with an ogive nose perforates a slab of concrete (apps/scenes/projectile_through_concrete; experiment of Hanchak et al.
1992, law and constants of Holmquist, Johnson and Cook 1993): residual velocity over striking velocity, cells, slab, shape and contact.

Target: within 10 % of the experiment at 434, 606, 749 and 1058 m/s."""

import _common  # first: it says where the next one is
import _projectile_through_concrete as concrete

COLUMNS = {"speed": ("striking m/s", "d"), "cells": ("cells through the slab", "d"), "radius": ("slab's radius mm", "d"),
           "D1": ("D1", ".3g"), "shape": ("shape", ""), "contact": ("contact", ""), "particles": ("particles", "d"), "steps": ("steps", "d"),
           "mass": ("projectile g", ".1f"), "residual": ("residual m/s", ".1f"), "error": ("over the experiment %", "+.1f"),
           "drift": ("energy drift %", "+.2f"), "cpu_seconds": ("processor s", ".0f")}
DEFAULT = {"speed": 749, "cells": 32, "radius": 200, "shape": "linear", "kind": 1, "normal": "regression", "strength": {}}
SPEEDS = [{"speed": speed} for speed in concrete.EXPERIMENT]
COARSE = {"cells": 22}
CASES = [*SPEEDS, *(COARSE | speed for speed in SPEEDS), COARSE | {"speed": 434, "strength": {"D1": 1000}}, COARSE | {"radius": 120},
         COARSE | {"normal": "mass_gradient"}, COARSE | {"kind": 0}, COARSE | {"shape": "QuadraticBSpline"}]


def main():
    parser = _common.arguments(__doc__, "projectile_through_concrete")
    parser.add_argument("--cases", nargs="+", type=int, default=range(len(CASES)), help="numbers of rows, from 0")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    rows = []
    for number in options.cases:
        case = DEFAULT | CASES[number]
        folder = options.out / str(number)
        seconds = _common.run(folder, concrete.text(**case), concrete.JOB)
        rows.append({**case, **concrete.measure(folder, case["speed"]), "contact": f"type {case['kind']}, {case['normal']}",
                     "D1": case["strength"].get("D1", 0.04), "cpu_seconds": seconds})
        print(rows[-1], flush=True)
    _common.write(options.out, "models", rows, COLUMNS)
    for number, row in zip(options.cases, rows):
        if number < len(SPEEDS):
            verdict.expect(abs(row["error"]) <= 10, f"{row['speed']} m/s: {row['error']:+.1f} % over the experiment")
    verdict.finish()


main()
