"""CSV files, tables of errors and orders, Pareto fronts and plots of the accuracy benchmark."""

import csv
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from common import plots, results

import methods
import runner
from case import order

STYLES = {"FLIP": "-", "APIC": "--", "TPIC": "-.", "AFLIP": ":", "PIC": (0, (1, 4)), "XPIC": (0, (5, 1, 1, 1)),
          "FMPM": (0, (3, 3)), "FMPM(5)": (0, (3, 1, 1, 1, 1, 1)), "FMPM(16)": (0, (1, 1)), methods.CONSISTENT: (0, (8, 2))}
MARKERS = {"MUSL": "o", "USF": "s", "USL": "^", "USAVG": "D"}


# CSV -------------------------------------------------------------------------------------------------------------


def identity(row):
    return tuple(str(row[c]) for c in ("study", "shape", "transfer", "scheme")) + tuple(
        float(row[c]) for c in ("cells", "split", "factor"))


def read(path):
    return results.read(path) if path.exists() else ([], [])


def part_of(rows, among):
    """Words for `rows`, some of those `among`: the transfers, studies or schemes that are all theirs, or how many they are."""
    mine = {identity(r) for r in rows}
    for column in ("transfer", "study", "scheme"):
        names = list(dict.fromkeys(r[column] for r in rows))
        if len(names) < len({r[column] for r in among}) and all(identity(r) in mine for r in among if r[column] in names):
            return ", ".join(names)
    return f"{len(mine)} of the rows"


def written(number):
    """Four digits; all of them of whole numbers, which are counts that were read from a file."""
    return f"{number:.0f}" if number.is_integer() else f"{number:.4g}"


def write(case, path, rows, head, earlier):
    """Rows of this run, and those of the `earlier` ones (as `read` gives them) that it did not measure, in the order of the
    case's points. The head says where each was measured."""
    before, had = earlier
    kept = {identity(r): r for r in had}
    kept.update({identity(r): r for r in rows})
    if len(kept) > len({identity(r) for r in rows}):
        words = part_of(rows, list(kept.values()))
        line = [] if before[:len(head)] == head else [f"{words}: {', '.join(head)}"]
        head = [*(line for line in before if not line.startswith(f"{words}: ")), *line]
    places = {}
    for point in case.all_points():
        m = point.method
        key = (point.study, m.shape, m.transfer, m.scheme, float(point.cells), float(point.split), float(point.factor))
        places.setdefault(key, len(places))
    rows = [kept[key] for key in sorted(kept, key=lambda key: places.get(key, math.inf)) if key in places]
    columns = [*runner.COLUMNS, *case.errors, "note"]
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        file.writelines(f"# {line}\n" for line in head)
        out = csv.DictWriter(file, columns, lineterminator="\n", extrasaction="ignore")
        out.writeheader()
        for row in rows:
            out.writerow({k: written(v) if isinstance(v, float) else v[:160] if k == "note" else v for k, v in row.items()})
    return rows


# Series ----------------------------------------------------------------------------------------------------------


def method_of(row):
    return methods.Method(row["shape"], row["transfer"], row["scheme"])


def series(case, rows, study):
    """{(method, split): rows by falling cell size or time step} of a study; only runs that were done or failed."""
    found = {}
    for row in rows:
        if row["study"] == study and row["status"] != runner.REFUSED:
            found.setdefault((method_of(row), int(row["split"])), []).append(row)
    axis = case.studies[study].axis
    for mine in found.values():
        mine.sort(key=lambda r: r["cells"] if axis == "cells" else -r["factor"])
    return found


def is_number(found):
    return isinstance(found, float) and math.isfinite(found)


def value(row, error):
    """Absolute value of the error; None where there is none."""
    found = row[error]
    return abs(found) if row["status"] == runner.DONE and is_number(found) else None


def orders(case, rows, study, error):
    """Observed orders between neighbours of one series; None where there is none."""
    axis = case.studies[study].axis
    found = []
    for before, row in zip(rows, rows[1:]):
        ratio = row["cells"] / before["cells"] if axis == "cells" else before["factor"] / row["factor"]
        found.append(order(value(before, error), value(row, error), ratio))
    return found


def pareto(rows, error):
    """Rows that no other beats in both time and error, from the fastest on."""
    front, best = [], math.inf
    for row in sorted((r for r in rows if value(r, error) is not None), key=lambda r: (r["seconds"], r[error])):
        if abs(row[error]) < best:
            best = abs(row[error])
            front.append(row)
    return front


def refusals(rows):
    """{(shape, transfer): message} of what the program refused."""
    found = {}
    for row in rows:
        if row["status"] == runner.REFUSED:
            found.setdefault((row["shape"], row["transfer"]), row["note"])
    return found


# Tables ----------------------------------------------------------------------------------------------------------


def study_table(case, rows, study):
    """Error of every method at every resolution, its orders, and the other errors at the finest."""
    axis, main, *others = case.studies[study].axis, *case.errors
    spec = case.errors[main]
    at = "cells" if axis == "cells" else "factor"
    found = series(case, rows, study)
    if not found:
        return ""
    places = sorted({r[at] for mine in found.values() for r in mine}, reverse=axis != "cells")
    splits = {split for _, split in found}

    def cell(mine, place):
        for row in mine:
            if row[at] == place:
                v = value(row, main)
                return "failed" if row["status"] == runner.FAILED else None if v is None else format(spec.factor * v, spec.how)
        return None

    lines = []
    for (method, split), mine in found.items():
        line = {"shape": method.shape, "transfer": method.transfer, "scheme": method.scheme, "split": split}
        line |= {f"at {place:g}": cell(mine, place) for place in places}
        line["orders"] = " ".join("–" if o is None else f"{o:.2f}" for o in orders(case, mine, study, main))
        done = [r for r in mine if r["status"] == runner.DONE]
        line |= {name: done[-1][name] if done and is_number(done[-1][name]) else None for name in others}
        line["seconds"] = done[-1]["seconds"] if done else None
        lines.append(line)
    columns = {name: (lambda r, name=name: r[name], "") for name in ("shape", "transfer", "scheme")}
    if len(splits) > 1:
        columns["particles along a cell"] = (lambda r: f"{r['split']}", "")
    words = "{:g} cells" if axis == "cells" else "factor {:g}"
    columns |= {words.format(p): (lambda r, p=p: r[f"at {p:g}"], "") for p in places}
    if spec.order and len(places) > 1:
        columns["orders"] = (lambda r: r["orders"], "")
    for name in others:
        e = case.errors[name]
        columns[e.heading] = (lambda r, name=name, e=e: None if r[name] is None else e.factor * r[name], e.how)
    columns["seconds"] = (lambda r: r["seconds"], ".2g")
    return results.markdown(lines, columns)


def front_table(case, rows, study):
    main = next(iter(case.errors))
    spec = case.errors[main]
    front = pareto([r for r in rows if r["study"] == study], main)
    return results.markdown(front, {
        "seconds": (lambda r: r["seconds"], ".2g"), spec.heading: (lambda r: spec.factor * r[main], spec.how),
        "method": (lambda r: str(method_of(r)), ""), "cells": (lambda r: f"{r['cells']:.0f}", ""),
        "particles along a cell": (lambda r: f"{r['split']:.0f}", "")}) if front else ""


def plotted(case):
    return case.plotted or tuple(name for name, s in case.studies.items() if s.axis == "cells" and len(s.cells) > 1)


def case_block(case, rows):
    """Markdown of a case: what it is and its tables."""
    main = next(iter(case.errors))
    text = [case.about.strip()]
    for name, study in case.studies.items():
        table = study_table(case, rows, name)
        if not table:
            continue
        text.append(f"**{name}**: {study.about} *{case.errors[main].heading}*:\n\n{table}")
        if name in plotted(case):
            text.append(f"The front of {name}: no run has both a smaller error and less time.\n\n"
                        f"{front_table(case, rows, name)}")
    left_out = {}
    for method in case.methods():
        if case.excluded(method):
            left_out.setdefault(case.excluded(method), []).append(method.transfer)
    text += [f"Left out: {', '.join(dict.fromkeys(names))}: {why}." for why, names in left_out.items()]
    return "\n\n".join(text)


LOW_SCATTER = 0.1  # asked for: of the mean pressure
SHOWN = 4  # rows of a study shown
PRESSURE = {"water": ("rest", "water"), "water, averaged": ("rest", "water_averaged"), "water, relaxed": ("rest", "water_relaxed"),
            "sand": ("rest", "sand"), "sand, averaged": ("rest", "sand_averaged"), "sand, relaxed": ("rest", "sand_relaxed"),
            "plate": ("flying_plate", "plate"), "plate, averaged": ("flying_plate", "plate_averaged"),
            "plate, relaxed 0.5": ("flying_plate", "plate_relaxed"), "plate, relaxed 1": ("flying_plate", "plate_relaxed_1")}
COMPARED = (("linear", "FLIP"), ("SGMP", "FLIP"), ("QuadraticBSpline", "FLIP"), ("QuadraticBSpline", "AFLIP"), ("CubicBSpline", "AFLIP"),
            ("CubicBSpline", "APIC"))


def finest_done(rows, study):
    """{method: its row on the finest grid that every method of the study has, where the run was done}."""
    mine = [r for r in rows if r["study"] == study]
    grids = {}
    for row in mine:
        grids.setdefault(row["cells"], set()).add(method_of(row))
    every = {m for found in grids.values() for m in found}
    common = max((n for n, found in grids.items() if found == every), default=None)
    return {method_of(r): r for r in mine if r["cells"] == common and r["status"] == runner.DONE}


def pressure_block(rows_of):
    """What runs with little scatter of the pressure cost: energy, and what else is off. Damped water comes to rest, whatever energy that
    takes: what counts is its pressure."""
    lines = []
    for name, (case, study) in PRESSURE.items():
        done = finest_done(rows_of.get(case, []), study)
        if not done:
            continue
        low = [(m, r) for m, r in done.items() if value(r, "scatter") < LOW_SCATTER]
        counts = "hydrostatic" if name.startswith("water") else "drift"
        low.sort(key=lambda pair: abs(pair[1][counts]))
        lines += [{"case": name, "method": str(m), "of": f"{len(low)}" if i == 0 else "", **r} for i, (m, r) in enumerate(low[:SHOWN])]
        if not low:
            lines.append({"case": name, "method": "–", "of": "0"})

    if not lines:
        return "Not measured."

    def part(column, how, factor=1):
        return (lambda r: factor * r[column] if is_number(r.get(column)) else None, how)

    return results.markdown(lines, {
        "case": (lambda r: r["case"], ""), "methods below 10 %": (lambda r: r["of"] or " ", ""), "method": (lambda r: r["method"], ""),
        "scatter, % of the mean": part("scatter", ".2f", 100), "energy drift, %": part("drift", "+.1f", 100),
        "off the hydrostatic pressure, %": part("hydrostatic", ".1f", 100),
        "velocity left (plate: its error)": part("velocity", ".1e")})


def scatter_block(rows_of):
    """For docs/methods.md: scatter and energy drift without averages, with them and with relaxation."""
    lines = []
    for matter in ("water", "sand"):
        found = [finest_done(rows_of.get("rest", []), f"{matter}{what}") for what in ("", "_averaged", "_relaxed")]
        for shape, transfer in COMPARED:
            rows = [f.get(methods.Method(shape, transfer)) for f in found]
            lines.append({"case": f"{matter}, `{shape}` {transfer}", "rows": rows})

    def part(which, column, how):
        return (lambda r: None if r["rows"][which] is None else 100 * r["rows"][which][column], how)

    columns = {"": (lambda r: r["case"], "")}
    for column, word, how in (("scatter", "scatter, %", ".3g"), ("drift", "energy drift, %", "+.2f")):
        for which, what in enumerate(("none", "averages", "and relaxation")):
            columns[f"{word}: {what}"] = part(which, column, how)
    return results.markdown(lines, columns)


def refusal_block(rows_of):
    """What the program refused in any case, with its message."""
    found = {}
    for rows in rows_of.values():
        for row in rows:
            if row["status"] == runner.REFUSED:
                message = row["note"]
                found.setdefault(message[message.find("<"):] if "<" in message else message, None)
    lines = [f"- `{message.replace('`', '')}`" for message in sorted(found)]
    return "\n".join(lines) if lines else "Nothing."


# Plots -----------------------------------------------------------------------------------------------------------


def plot(case, rows, path):
    """Error against run time, a line per method; the Pareto front is the grey band with rings."""
    main = next(iter(case.errors))
    names = [name for name in plotted(case) if any(r["study"] == name and value(r, main) is not None for r in rows)]
    if not names:
        return False
    palette = plt.get_cmap("tab10")
    shapes = {shape: palette(i % 10) for i, shape in enumerate(methods.shapes())}
    figure, panels = plt.subplots(1, len(names), figsize=(5.4 * len(names) + 1.6, 4.6), squeeze=False)
    for axes, name in zip(panels[0], names):
        for (method, _), mine in series(case, rows, name).items():
            done = [r for r in mine if value(r, main) is not None]
            axes.plot([r["seconds"] for r in done], [abs(r[main]) for r in done], color=shapes[method.shape],
                      ls=STYLES.get(method.transfer, "-"), marker=MARKERS.get(method.scheme, "x"), ms=3.5, lw=1)
        front = pareto([r for r in rows if r["study"] == name], main)
        axes.plot([r["seconds"] for r in front], [abs(r[main]) for r in front], "o-", color=plots.GREY, lw=5, ms=9,
                  alpha=0.25, zorder=0)
        axes.set(xscale="log", yscale="log", xlabel="seconds of the loop", ylabel=case.errors[main].heading, title=name)
    used = {method_of(r) for r in rows if r["status"] == runner.DONE}
    for shape in dict.fromkeys(m.shape for m in sorted(used)):
        axes.plot([], [], color=shapes[shape], label=shape)
    for transfer in dict.fromkeys(m.transfer for m in sorted(used)):
        axes.plot([], [], color="0.3", ls=STYLES.get(transfer, "-"), label=transfer)
    for scheme in dict.fromkeys(m.scheme for m in sorted(used)):
        axes.plot([], [], color="0.3", ls="", marker=MARKERS.get(scheme, "x"), label=scheme)
    axes.plot([], [], color=plots.GREY, lw=5, alpha=0.25, label="Pareto front")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize=8)
    figure.suptitle(case.title)
    plots.save(figure, path)
    return True
