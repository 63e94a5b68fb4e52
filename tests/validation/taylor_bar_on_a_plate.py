"""The copper Taylor bar on a rigid plate, from which it rebounds (apps/scenes/taylor_bar_on_a_plate; P. Huang, thesis,
Tsinghua 2010, 5.3.3): L, D and W against the experiment, over cell size, shape and contact.

Measured as on the wall (benchmarks/taylor_bar/bar.py), heights from the foot. Targets: the bar rebounds; mean error of L
and D at most 1.5 % with the finest cells."""

import itertools

import _common  # first: it says where the next one is
import _bar_on_plate

COLUMNS = {"layers": ("particles along the bar", "d"), "shape": ("shape", ""), "kind": ("contact_type", "d"), "normal": ("normals", ""),
           "particles": ("particles of the bar", "d"), "steps": ("steps", "d"), "L": ("L mm", ".2f"), "D": ("D mm", ".2f"),
           "W": ("W mm", ".2f"), "error_LD": ("mean error of L, D %", ".2f"), "mean_error": ("of L, D, W %", ".2f"),
           "parted": ("parted us", ".0f"), "speed": ("velocity at 200 us, m/s", ".2f"), "height": ("height above the plate mm", ".2f"),
           "drift": ("energy drift %", "+.2f"), "cpu_seconds": ("processor s", ".1f")}


def main():
    parser = _common.arguments(__doc__, "taylor_bar_on_a_plate")
    parser.add_argument("--layers", nargs="+", type=int, default=[46, 68, 92])
    parser.add_argument("--kinds", nargs="+", type=int, default=[0, 1], help="contact types")
    parser.add_argument("--normals", nargs="+", default=["regression"])
    parser.add_argument("--shapes", nargs="*", default=["uGIMP", "QuadraticBSpline", "SGMP"],
                        help="besides linear, but with the finest cells")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    rows = []
    finest = max(options.layers)
    for shape, normal, kind, layers in itertools.product(["linear", *options.shapes], options.normals, options.kinds,
                                                         options.layers):
        if shape != "linear" and layers == finest:
            continue
        folder = options.out / f"{shape}-{layers}-{kind}-{normal}"
        text = _bar_on_plate.text(layers, shape=shape, normal=normal, kind=kind)
        seconds = _common.run(folder, text, _bar_on_plate.JOB)
        rows.append({"layers": layers, "shape": shape, "kind": kind, "normal": normal, **_bar_on_plate.measure(folder),
                     "cpu_seconds": seconds})
        print(rows[-1], flush=True)
    _common.write(options.out, "models", rows, COLUMNS)
    for r in rows:
        name = f"{r['layers']} layers, {r['shape']}, contact_type {r['kind']}, {r['normal']}"
        verdict.expect(r["speed"] > 1 and r["height"] > 0.1, f"{name}: no rebound, {r['speed']:.2f} m/s")
        if r["layers"] == finest:
            verdict.expect(r["error_LD"] <= 1.5, f"{name}: mean error of L and D {r['error_LD']:.2f} %, asked for 1.5 %")
    verdict.finish()


main()
