"""A rigid ball is pushed slowly through deep clay (apps/scenes/ball_in_clay): what resists it against the plasticity solution, for a rough
and a smooth ball, over cells, the size of the rigid body, walls, speed, shape and contact.

Target: force within 5 % of the limit load of _ball_flow.py in von Mises' clay with the finest cells, without growth over the last half of the way
by more than 5 %. The factors, N = F/(pi R^2 k), have the strength in simple shear, k = Yield0/sqrt(3)."""

import _common  # first: it says where the next one is
import _ball_flow
import _ball_in_clay

COLUMNS = {"ball": ("ball", ""), "cells": ("cells over R", "d"), "inset": ("body smaller by, cells", "g"), "friction": ("friction", ""), "width": ("walls at, R", "g"),
           "speed": ("speed over c", "g"), "shape": ("shape", ""), "averaging": ("averaging", ""), "contact": ("contact", ""), "mapped": ("transfer", ""),
           "travel": ("way, R", ".2f"),
           "particles": ("particles", "d"), "steps": ("steps", "d"), "factor": ("N", ".2f"), "error": ("error %", "+.1f"), "growth": ("growth %", "+.1f"),
           "scatter": ("scatter %", ".1f"), "drift": ("energy drift %", "+.2f"), "cpu_seconds": ("processor s", ".1f")}
SAME = ("inset", "friction", "shape", "averaging", "contact", "mapped")  # in all rows of the first table

# What a case has unless it says otherwise.
CHOICE = {"width": 4, "speed": 0.01, "shape": "QuadraticBSpline", "averaging": "cell", "normal": "regression", "kind": 1, "transfer": "FLIP", "flip": 1, "inset": 0, "friction": None}
CELLS = [{"ball": "rough", "cells": 4, "travel": 0.5}, {"ball": "rough", "cells": 6, "travel": 0.35},
         {"ball": "smooth", "cells": 4, "travel": 0.5}, {"ball": "smooth", "cells": 5, "travel": 0.4}, {"ball": "smooth", "cells": 6, "travel": 0.35},
         {"ball": "smooth", "cells": 4, "travel": 0.5, "speed": 0.005}]
SMALL = {"cells": 4, "width": 3, "travel": 0.3}
ROUGH, SMOOTH = {"ball": "rough", **SMALL}, {"ball": "smooth", **SMALL}
CHOICES = [ROUGH | {"width": 4, "friction": 10}, ROUGH | {"cells": 6, "friction": 10},
           *({"ball": "rough", "cells": 4, "travel": 0.5, "width": width} for width in (3, 5)), ROUGH | {"cells": 6}, ROUGH | {"cells": 8},
           {"ball": "smooth", "cells": 4, "travel": 0.5, "inset": 0.35}, {"ball": "smooth", "cells": 4, "travel": 0.5, "transfer": "AFLIP"},
           {"ball": "smooth", "cells": 4, "travel": 0.5, "flip": 0.99},
           *({"ball": "smooth", **SMALL, "flip": 0.99, **what} for what in ({"cells": 6, "width": 4}, {"cells": 8, "width": 4}, {"cells": 6}, {"cells": 8})), {"ball": "smooth", **SMALL, "cells": 6},
           *(ball | what for ball in (ROUGH, SMOOTH)
             for what in ({}, {"width": 2.5}, {"speed": 0.0025}, {"averaging": "none"}, {"kind": 0}, {"normal": "mass_gradient"},
                          {"shape": "linear", "width": 4}, {"shape": "SGMP", "width": 4}))]


def run(folder, case):
    case = CHOICE | case
    seconds = _common.run(folder, _ball_in_clay.text(**case), _ball_in_clay.JOB)
    return row(folder, case, seconds)


def row(folder, case, seconds):
    mapped = case["transfer"] + (f" {case['flip']:g}" if case["flip"] < 1 else "")
    found = {**case, "friction": case["friction"] or case["ball"], "contact": f"type {case['kind']}, {case['normal']}", "mapped": mapped, **_ball_in_clay.measure(folder, case["ball"], case["speed"]), "cpu_seconds": seconds}
    print(" ".join(f"{key} {value}" for key, value in found.items()), flush=True)
    return found


def judge(rows, verdict):
    """The finest cells of each ball."""
    for ball in ("rough", "smooth"):
        mine = [r for r in rows if r["ball"] == ball]
        for r in (r for r in mine if r["cells"] == max(other["cells"] for other in mine)):
            name = f"{ball} ball, {r['cells']} cells, speed {r['speed']:g}"
            verdict.expect(abs(r["error"]) <= 5, f"{name}: force {r['error']:+.1f} % off, asked for 5 %")
            verdict.expect(abs(r["growth"]) <= 5, f"{name}: force still changes by {r['growth']:+.1f} %")


def main():
    parser = _common.arguments(__doc__, "ball_in_clay")
    parser.add_argument("--cells", nargs="*", type=int, default=range(len(CELLS)), help="numbers of rows of the first table, from 0")
    parser.add_argument("--choices", nargs="*", type=int, default=range(len(CHOICES)), help="of the second table")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    off = _ball_flow.check(_ball_in_clay.FACTORS)
    verdict.expect(off < 0.002, f"the factors are {100 * off:.1f} % off the elements, asked for 0.2 %")
    rough = _ball_in_clay.FACTORS["rough"]
    verdict.expect(abs(rough / _ball_flow.BERIS - 1) < 0.015, f"rough ball by elements: {rough:.2f}, Beris et al. {_ball_flow.BERIS:.2f}")
    for name, cases, chosen in (("cells", CELLS, options.cells), ("choices", CHOICES, options.choices)):
        rows = [run(options.out / f"{name}-{i}", cases[i]) for i in chosen]
        if rows:
            columns = {key: how for key, how in COLUMNS.items() if name != "cells" or key not in SAME}
            _common.write(options.out, name, rows, columns)
        if name == "cells":
            judge(rows, verdict)
    verdict.finish()


main()
