"""A lead sphere strikes a lead plate at 6.58 km/s (apps/scenes/lead_on_lead; P. Huang, thesis, Tsinghua 2010, 3.5.2): the size of the cloud
of debris after 30.6 us, over spacing, cell size, shape, time step, equation of state and failure.

Targets, within 5 %: front 198 mm from the plate, width 142 mm (the thesis's 13.5 million particles; experiment 200, 145), checked with the
spacing of its 0.85 million particles and the front measured from the struck face; from the rear face it misses: docs/validation.md. What
becomes debris comes from within 12 mm of the axis, so most runs have a plate of 50 mm; two have the whole of 140 mm."""

import _common  # first: it says where the next one is
import _lead

COLUMNS = {"cell": ("cell mm", "g"), "spacing": ("spacing mm", "g"), "shape": ("shape", ""), "factor": ("time step factor", "g"), "plate": ("plate mm", "d"), "planes": ("symmetry planes", "d"),
           "law": ("law", ""), "particles": ("particles", "d"), "steps": ("steps", "d"), "front": ("front mm", ".1f"), "struck": ("from the struck face mm", ".1f"),
           "width": ("width mm", ".1f"), "farthest": ("farthest particle mm", ".1f"), "widest": ("widest mm", ".1f"), "drift": ("energy drift %", "+.1f"),
           "cpu_seconds": ("processor s", ".1f")}
# What a case has unless it says otherwise; the thesis's spacing and its smallest cells.
CHOICE = {"cell": 1.06, "spacing": 0.53, "shape": "SGMP", "factor": 0.5, "plate": 50, "full": False}
STRAIN, TENSION = (f".//FailureModel[@type='{kind}']" for kind in ("PlaStrain", "Pmin"))
LAWS = {"table 3.5": {}, "C0 2050, S1 1.46, gamma0 2.8": {".//EquationOfState": {"C0": 2050, "S1": 1.46, "gamma0": 2.8}},
        "no failure by strain": {STRAIN: {"epmax": 1e3}}, "pmin -150": {TENSION: {"pmin": -150}}, "no failure": {STRAIN: {"epmax": 1e3}, TENSION: {"pmin": -1e6}},
        "failed: no pressure": {".//StrengthModel": {"FailedType": 1}}}
COARSE = {"cell": 2.12, "spacing": 1.06}
CASES = [{**COARSE, "factor": 0.4}, {**COARSE, "factor": 0.4, "full": True}, {"cell": 2.12, "plate": 140}, {"factor": 0.3}, {}, {"plate": 140},
         {"cell": 1, "spacing": 0.21}, {"cell": 0.53, "spacing": 0.265}, {**COARSE, "shape": "linear", "factor": 0.4}, {"shape": "linear", "factor": 0.4},
         {"cell": 1.59, "shape": "linear", "factor": 0.9}, {"cell": 1.59, "shape": "linear", "factor": 0.4}, {"cell": 1.59},
         {"cell": 1, "spacing": 0.21, "shape": "linear", "factor": 0.4}, {"shape": "cpGIMP"},
         {"shape": "QuadraticBSpline"}, {"law": "C0 2050, S1 1.46, gamma0 2.8"}, {"law": "no failure by strain"}, {"law": "pmin -150"},
         {"law": "failed: no pressure"}, {**COARSE, "law": "no failure"}]


def main():
    parser = _common.arguments(__doc__, "lead_on_lead")
    parser.add_argument("--cases", nargs="+", type=int, default=range(len(CASES)), help="numbers of rows, from 0")
    options = parser.parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    rows = []
    for number in options.cases:
        case = CHOICE | {"law": "table 3.5"} | CASES[number]
        law = case.pop("law")
        seconds = _common.run(options.out / str(number), _lead.text(**case, changes=LAWS[law]), _lead.JOB)
        found = _lead.measure(options.out / str(number), case["spacing"])
        rows.append({**case, "law": law, "planes": 0 if case["full"] else 2, **found, "cpu_seconds": seconds})
        print(rows[-1], flush=True)
    _common.write(options.out, "debris", rows, COLUMNS)
    for row in rows:
        if all(row[key] == value for key, value in CHOICE.items() if key != "plate") and row["law"] == "table 3.5":
            name = f"plate of {row['plate']} mm"
            verdict.expect(abs(row["struck"] / 198 - 1) <= 0.05, f"{name}: front {row['struck']:.1f} mm from the struck face")
            verdict.expect(abs(row["width"] / 142 - 1) <= 0.05, f"{name}: width {row['width']:.1f} mm")
    verdict.finish()


main()
