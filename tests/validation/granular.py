"""Collapse of granular columns in plane strain: sand of three proportions (apps/scenes/sand_column; G. Lube et al. 2005)
and aluminium rods (apps/scenes/aluminium_rods; P. Huang, thesis, Tsinghua 2010, 6.4.1), over
cell size and base; and which settings lead from the defaults to these results.

Targets, with the finest cells: run-out within 10 % of Lube's and Lajeunesse's laws; at rest, with less than 1e-4 of the energy that gravity
released; no sand under pressure below 0.99 of its density; the rods' repose 14 +- 1 degrees."""

import _common  # first: it says where the next one is
import _granular

SAND = {"a": ("height / foot", "g"), "cells": ("cells along the foot", "d"),
        "particles": ("particles", "d"), "steps": ("steps", "d"), "run_out": ("run-out / foot", ".2f"), "error": ("over Lube %", "+.1f"), "lajeunesse": ("over Lajeunesse %", "+.1f"),
        "thick": ("to 5 % of the foot", ".2f"), "two": ("to 2 %", ".2f"), "most": ("98 % of the sand within", ".2f"),
        "height": ("height at the end / foot", ".2f"), "height_error": ("over Lajeunesse %", "+.1f"), "kinetic": ("kinetic energy left", ".1e"), "heap": ("of the heap", ".1e"),
        "density": ("mean density", ".3f"), "pressed": ("least under pressure", ".3f"), "loose": ("loose %", ".1f"), "drift": ("energy drift %", "+.1f"),
        "cpu_seconds": ("processor s", ".1f")}
RODS = {"base": ("base", ""), "cells": ("cells over the height", "d"), "particles": ("particles", "d"), "steps": ("steps", "d"),
        "repose": ("repose, degrees", ".1f"), "foot": ("foot of the slope m", ".3f"), "flow": ("flow s", ".2f"),
        "kinetic": ("kinetic energy left", ".1e"), "density": ("mean density", ".3f"), "drift": ("energy drift %", "+.1f"),
        "cpu_seconds": ("processor s", ".1f")}
SHEETS = {"floor": ("floor", ""), "layers": ("layers", "d"), "way": ("way over Coulomb's", ".2f"), "top": ("of the top layer", ".2f"), "left": ("velocity left", ".3f")}
# The coefficient of friction of a rigid body, or None: the scene's fixed wall.
FLOORS = {"wall": None, "rigid body, sticks": 10, "rigid body, friction of the sand": _granular.FRICTION}

# From the defaults to the scene, one change after the other: name, changes of the scene.
ANGLE = {"qfai": 0.4937, "closes": 0, "VarSoundspeed": 0}  # what phi=31 psi=0 match=3 (inscribed cone) mean
STEPS = [("linear, FLIP, inscribed cone", {".//Grid": {"shape": "linear"}, ".//Solution": {"transfer": "FLIP"}, ".//StrengthModel": ANGLE}),
         ("QuadraticBSpline", {".//Solution": {"transfer": "FLIP"}, ".//StrengthModel": ANGLE}),
         ("AFLIP", {".//StrengthModel": ANGLE}),
         ("closes", {".//StrengthModel": {**ANGLE, "closes": 1, "VarSoundspeed": 1}}),
         ("qfai = tan 31 degrees: the scene", {}),
         ("APIC", {".//Solution": {"transfer": "APIC"}})]


def without(*names):
    return {key: how for key, how in SAND.items() if key not in names}


def sand_run(options, a, cells, name, changes):
    folder = options.out / f"sand-{a:g}-{cells}-{name.split(',')[0].split()[0]}"
    seconds = _common.run(folder, _granular.sand_column(a, cells, changes), "sand_column")
    row = {"name": name, "a": a, "cells": cells, **_granular.measure_sand_column(folder, a), "cpu_seconds": seconds}
    print(row, flush=True)
    return row


def sand(options, verdict):
    rows = []
    for a, most in zip(options.a, options.cells):
        rows += [sand_run(options, a, cells, "scene", {}) for cells in (most // 2, most)]
        name, row = f"sand {a:g}, {most} cells", rows[-1]
        for law, whose in (("error", "Lube"), ("lajeunesse", "Lajeunesse")):
            verdict.expect(abs(row[law]) <= 10, f"{name}: run-out {row[law]:+.1f} % over {whose}, asked for 10 %")
        verdict.expect(row["kinetic"] < 1e-4, f"{name}: kinetic energy {row['kinetic']:.1e} of the released one")
        verdict.expect(row["pressed"] > 0.99, f"{name}: density {row['pressed']:.3f} under pressure")
    _common.write(options.out, "sand", rows, SAND)


def floors(options):
    rows = []
    for floor, friction in FLOORS.items():
        for layers in (1, 2, 4):
            folder = options.out / f"sheet-{layers}-{friction}"
            _common.run(folder, _granular.sand_sheet(layers, friction=friction), "sand_column")
            rows.append({"floor": floor, "layers": layers, **_granular.measure_sand_sheet(folder)})
    _common.write(options.out, "sheets", rows, SHEETS)
    rows = []
    for floor, friction in FLOORS.items():
        folder = options.out / f"floor-{friction}"
        seconds = _common.run(folder, _granular.sand_column(1, options.floors, friction=friction), "sand_column")
        rows.append({"floor": floor, "a": 1, "cells": options.floors, **_granular.measure_sand_column(folder, 1), "cpu_seconds": seconds})
    _common.write(options.out, "floors", rows, {"floor": ("floor", ""), **without("lajeunesse", "height_error")})


def settings(options):
    rows = [sand_run(options, 1, options.settings, name, changes) for name, changes in STEPS]
    _common.write(options.out, "settings", rows, {"name": ("setting", ""), **without("two", "most", "lajeunesse", "height_error")})


def rods(options, verdict):
    rows = []
    for base in options.bases:
        for cells in options.rods:
            folder = options.out / f"rods-{base}-{cells}"
            seconds = _common.run(folder, _granular.aluminium_rods(cells, base), "aluminium_rods")
            rows.append({"base": base, "cells": cells, **_granular.measure_aluminium_rods(folder), "cpu_seconds": seconds})
            print(rows[-1], flush=True)
            name, row = f"rods on {base}, {cells} cells", rows[-1]
            if cells == max(options.rods):
                verdict.expect(abs(row["repose"] - 14) <= 1, f"{name}: repose {row['repose']:.1f} degrees, asked for 14 +- 1")
    _common.write(options.out, "rods", rows, RODS)


def main():
    parser = _common.arguments(__doc__, "granular")
    parser.add_argument("--a", nargs="*", type=float, default=[0.5, 1, 3], help="height of the sand over its foot")
    parser.add_argument("--cells", nargs="*", type=int, default=[20, 20, 10], help="finest cells along the foot, one for each")
    parser.add_argument("--settings", type=int, default=20, help="cells along the foot, from the defaults to the scene; 0: none")
    parser.add_argument("--floors", type=int, default=20, help="cells along the foot, on other floors; 0: none")
    parser.add_argument("--rods", nargs="*", type=int, default=[10, 20], help="cells over the height of the rods; 40: the thesis's 25,600 particles")
    parser.add_argument("--bases", nargs="+", default=["contact", "wall"], choices=["contact", "wall"], help="below the rods")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    if options.a:
        sand(options, verdict)
    if options.floors:
        floors(options)
    if options.rods:
        rods(options, verdict)
    if options.settings:
        settings(options)
    verdict.finish()


main()
