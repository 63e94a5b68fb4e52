"""An elastic bar, fixed-free, in its first mode: period, energy and order over resolution, scheme and time step.

Targets, with MUSL and USF: period within 0.5 % and energy drift per period below 1e-3, second order, and the error that
the dispersion of the scheme explains (tests/system/_cases.py has the scene and that formula). USL is reported."""

import math

import _common  # first: it says where the next ones are
import _cases
import _mpm

COLUMNS = {"scheme": ("scheme", ""), "factor": ("time step factor", "g"), "cells": ("cells", "d"), "steps": ("steps", "d"),
           "period": ("period error %", "+.4f"), "theory": ("by dispersion %", "+.4f"), "order": ("observed order", ".3f"),
           "drift": ("energy drift per period", "+.1e")}


def main():
    options = _common.arguments(__doc__, "elastic_bar").parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    rows = []
    for scheme in ("MUSL", "USF", "USL"):
        for factor in (0.8, 0.4, 0.2):
            before = None
            for cells in (8, 16, 32, 64):
                bar = _cases.ElasticBar(cells, scheme, factor, rows=100)
                folder = options.out / f"{scheme}-{factor}-{cells}"
                _common.run(folder, bar.text())
                found = bar.measure(folder)
                drift = max(found["drift"], key=abs)
                order = _cases.order([2, 1], [before, found["period"]])[0] if before else math.nan
                before = found["period"]
                rows.append({"scheme": scheme, "factor": factor, "cells": cells, "steps": _mpm.summary(folder)["steps"],
                             "period": 100 * found["period"], "theory": 100 * bar.dispersion(),
                             "order": float(order), "drift": float(drift)})
                if scheme == "USL":
                    continue
                name = f"{scheme}, factor {factor}, {cells} cells"
                verdict.expect(cells == 8 or abs(found["period"]) < 0.005, f"{name}: period {100 * found['period']:+.3f} %")
                verdict.expect(abs(found["period"] - bar.dispersion()) < 0.01 * bar.dispersion() + 2e-6,
                               f"{name}: not what dispersion explains")
                verdict.expect(abs(drift) < 1e-3, f"{name}: energy drift {drift:+.1e} per period")
                verdict.expect(cells == 8 or abs(order - 2) < 0.1, f"{name}: observed order {order:.2f}")
    _common.write(options.out, "elastic_bar", rows, COLUMNS)
    verdict.finish()


main()
