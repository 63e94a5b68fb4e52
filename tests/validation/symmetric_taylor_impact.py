"""Two rods of Al 6082-T6 meet end on at 225.5 m/s each (apps/scenes/symmetric_taylor_impact; P. Huang, thesis, Tsinghua 2010,
4.4.2): length and diameter against the experiment, and when they part, over cell size, shape and contact.

Targets: mean error of L and D at most 1.7 % (the thesis's contact), parted at 65 us. The first is met only where the sizes are read as
those of the thesis (docs/validation.md), so that reading is what is checked; the rods' own sizes are checked against finite elements with the
same law (_rod_elements.py)."""

import itertools
import time

import _common  # first: it says where the next one is
import _rod_elements
import _symmetric_impact

COLUMNS = {"layers": ("particles along a rod", "d"), "shape": ("shape", ""), "contact": ("contact", ""), "radius": ("radius mm", ".2f"), "yields": ("yield stress MPa", "d"),
           "particles": ("particles", ".0f"), "steps": ("steps", ".0f"), "L": ("L mm", ".2f"), "D": ("D mm", ".2f"),
           "error": ("mean error %", ".2f"), "L_centres": ("L of centres mm", ".2f"), "D_centres": ("D of centres mm", ".2f"),
           "error_centres": ("its mean error %", ".2f"), "released": ("force below 1 %, us", ".0f"), "parted": ("last force, us", ".0f"),
           "speed": ("velocity at 140 us, m/s", ".1f"), "gap": ("gap at 140 us, mm", ".2f"), "drift": ("energy drift %", "+.2f"),
           "cpu_seconds": ("processor s", ".1f")}
ELEMENTS = {"across": ("elements over the radius", "d"), "yields": ("yield stress MPa", "g"), "steps": ("steps", "d"), "L": ("L mm", ".2f"), "D": ("D mm", ".2f"),
            "error": ("mean error %", ".2f"), "released": ("force below 1 %, us", ".0f"), "parted": ("last force, us", ".0f"),
            "speed": ("velocity at 140 us, m/s", ".1f"), "gap": ("gap at 140 us, mm", ".2f"),
            "strain": ("largest plastic strain", ".2f"), "cpu_seconds": ("processor s", ".0f")}
WIDE = 6.79  # mm: 21,600 particles in a rod of 60 layers; the thesis has 21,840, and a cylinder of 6.35 mm holds 18,960


def elements(options):
    rows = []
    for across, yields in ((6, 311), (12, 311), (12, 260)):
        start = time.process_time()
        row = _rod_elements.strike(across, yields=yields)
        error = 50 * sum(abs(row[size] / measured - 1) for size, measured in _symmetric_impact.EXPERIMENT.items())
        rows.append({**row, "error": error, "gap": 2 * row["foot"], "cpu_seconds": time.process_time() - start})
        print(rows[-1], flush=True)
    _common.write(options.out, "elements", rows, ELEMENTS)
    return rows[1]


def main():
    parser = _common.arguments(__doc__, "symmetric_taylor_impact")
    parser.add_argument("--layers", nargs="+", type=int, default=[40, 60, 80])
    parser.add_argument("--shapes", nargs="+", default=["linear", "QuadraticBSpline"])
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    own = _symmetric_impact.RADIUS
    cases = [{"shape": shape, "layers": layers} for shape, layers in itertools.product(options.shapes, options.layers)]
    cases += [{"layers": 60, "shape": "cpGIMP"}, {"layers": 60, "kind": 0}, {"layers": 60, "normal": "mass_gradient"},
              {"layers": 60, "contact": False}, {"layers": 60, "radius": WIDE}, {"layers": 60, "radius": WIDE, "shape": "QuadraticBSpline"},
              {"layers": 60, "yields": 280}, {"layers": 60, "yields": 260}]
    rows, reference = [], elements(options)
    for case in cases:
        case = {"shape": "linear", "kind": 1, "normal": "regression", "contact": True, "radius": own, "yields": 311} | case
        folder = options.out / "-".join(str(word) for word in case.values())
        seconds = _common.run(folder, _symmetric_impact.text(**case), _symmetric_impact.JOB)
        found = _symmetric_impact.measure(folder, case["radius"])
        how = f"type {case['kind']}, {case['normal']}" if case["contact"] else "none"
        rows.append({**case, "contact": how, **found, "cpu_seconds": seconds})
        print(rows[-1], flush=True)
    _common.write(options.out, "models", rows, COLUMNS)
    for r in rows:
        name = f"{r['layers']} layers, {r['shape']}, {r['contact']}, radius {r['radius']}"
        if r["contact"] == "none":
            verdict.expect(abs(r["speed"]) < 3, f"{name}: parted without contact, {r['speed']:.1f} m/s")
            continue
        verdict.expect(r["speed"] > 10 and r["gap"] > 2, f"{name}: no rebound, {r['speed']:.2f} m/s")
        verdict.expect(50 <= r["released"] <= 70, f"{name}: parted at {r['released']:.0f} us, asked for about 65")
        if r["yields"] != 311:
            continue
        verdict.expect(abs(r["L"] / reference["L"] - 1) < 0.01, f"{name}: L {r['L']:.2f} mm, elements {reference['L']:.2f} mm")
        if r["radius"] == own and r["layers"] == max(options.layers):
            verdict.expect(abs(r["D"] / reference["D"] - 1) < 0.01, f"{name}: D {r['D']:.2f} mm, elements {reference['D']:.2f} mm")
        if r["radius"] == WIDE:
            verdict.expect(r["error_centres"] <= 1.7, f"{name}: mean error {r['error_centres']:.2f} %, asked for 1.7 %")
    verdict.finish()


main()
