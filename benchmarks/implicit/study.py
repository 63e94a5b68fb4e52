"""What a study of the implicit benchmark states, and pieces of its tables."""

import math

from common import results

import run_one


class Study:
    """`name`, `title`, `about` (text of the page), `labels` (columns that tell runs apart), `measured` (columns)."""

    name = title = about = ""
    labels = ()
    measured = ()

    def runs(self):
        """Of run_one.Run."""
        raise NotImplementedError

    def block(self, rows):
        """The tables of the page, Markdown."""
        raise NotImplementedError

    @property
    def columns(self):
        return (*self.labels, *run_one.COMMON, *self.measured, "note")


def smooth_growth(length):
    """Of a load from 0 to 1 in this time, as an expression of an input file."""
    return f"if(t&lt;{length!r},(t/{length!r})^2*(3-2*t/{length!r}),1)"


def smooth_speed(length):
    """The slope of that."""
    return f"if(t&lt;{length!r},{6 / length!r}*(t/{length!r})*(1-t/{length!r}),0)"


def order(coarse, fine, ratio):
    """Observed order between two errors whose sizes have this ratio; None where there is none."""
    if not all(isinstance(v, float) and math.isfinite(v) and v != 0 for v in (coarse, fine)):
        return None
    return math.log(abs(coarse / fine)) / math.log(ratio)


def where(rows, **labels):
    return [r for r in rows if all(r[k] == v for k, v in labels.items())]


def values(rows, name):
    """In the order of labels, each once."""
    return list(dict.fromkeys(r[name] for r in rows))


def done(row):
    return row["status"] == run_one.DONE


def shown(row, name, how, factor=1.0):
    """The value of a row as a text; why there is none."""
    if not done(row):
        return row["status"]
    measured = isinstance(row[name], float) and math.isfinite(row[name])
    return format(factor * row[name], how) if measured else "–"


def orders(rows, name, axis):
    """Observed orders between neighbouring rows, as a text."""
    found = [order(a[name], b[name], b[axis] / a[axis]) if done(a) and done(b) else None for a, b in zip(rows, rows[1:])]
    return " ".join("–" if o is None else f"{o:.2f}" for o in found)


def convergence(rows, name, axis, lead, how=".2e", factor=1.0):
    """A line for each value of the labels `lead`: the error at each place of `axis`, its orders, seconds at the last."""
    places = sorted(set(values(rows, axis)))
    lines = []
    for labels in dict.fromkeys(tuple(r[k] for k in lead) for r in rows):
        mine = sorted(where(rows, **dict(zip(lead, labels))), key=lambda r: r[axis])
        at = {r[axis]: shown(r, name, how, factor) for r in mine}
        last = [r for r in mine if done(r)]
        lines.append([*map(str, labels), *(at.get(p, "–") for p in places), orders(mine, name, axis),
                      f"{last[-1]['seconds']:.2g}" if last else "–"])
    return table([*lead, *(f"{p:g}" for p in places), "orders", "seconds"], lines)


def beside(rows, name, lead, how=".2e", factor=1.0, alone=False):
    """A line for each value of the labels `lead` that implicit and explicit runs have (`alone`: or implicit ones only): value
    and seconds of each, and the time of the explicit ones over that of the implicit one."""
    kinds, lines = values(rows, "steps by"), []
    implicit = kinds[0]
    for labels in dict.fromkeys(tuple(r[k] for k in lead) for r in rows):
        at = {r["steps by"]: r for r in where(rows, **dict(zip(lead, labels)))}
        if implicit not in at or len(at) == 1 and not alone:
            continue
        line = [f"{v:g}" if isinstance(v, float) else v for v in labels]
        for kind in kinds:
            line += [shown(at[kind], name, how, factor), shown(at[kind], "seconds", ".2g")] if kind in at else ["–", "–"]
            if kind != implicit:
                both = kind in at and done(at[kind]) and done(at[implicit])
                line.append(f"{at[kind]['seconds'] / at[implicit]['seconds']:.2g}" if both else "–")
        lines.append(line)
    heads = [*lead]
    for kind in kinds:
        heads += [kind, f"seconds, {kind}", *([f"time over, {kind}"] if kind != implicit else [])]
    return table(heads, lines) if lines else ""


def against_explicit(rows, errors):
    """A line for each implicit run of a given number of steps: the fastest explicit one, of any shape functions and grid, whose
    error is no larger, and its time over that of the implicit run; for each of these errors. Behind it, the price of an
    iteration."""
    others = [r for r in rows if "explicit" in r["steps by"] and done(r)]
    lines, costs = [], []
    for row in (r for r in rows if r["steps by"].startswith("implicit ") and done(r)):
        line = [row["steps by"], row["shape"], *(f"{row[name]:g}" for name in ("cells", "steps", "newton")),
                f"{row['seconds']:.2g}"]
        for name in errors:
            best = min((r for r in others if r[name] <= row[name]), key=lambda r: r["seconds"], default=None)
            line += [f"{row[name]:.1e}", "none" if best is None else
                     f"{best['steps by'].removeprefix('explicit ')}, {best['shape']}, {best['cells']:g}: {best['seconds']:.2g} s",
                     "–" if best is None else f"{best['seconds'] / row['seconds']:.2g}"]
        lines.append(line)
        same = [r for r in others if r["shape"] == row["shape"] and r["cells"] == row["cells"]]
        costs += [row["seconds"] / row["newton"] / (r["seconds"] / r["steps"]) for r in same]
    if not lines or not costs:
        return ""
    heads = ["steps by", "shape", "cells", "steps", "Newton iterations", "seconds",
             *(head for name in errors for head in (name, f"explicit, {name} no larger", f"time over, {name}"))]
    return f"{table(heads, lines)}\n\nA Newton iteration takes as long as {min(costs):.0f} to {max(costs):.0f} explicit steps."


def table(heads, lines):
    return results.markdown(lines, {head: (lambda line, i=i: line[i], "") for i, head in enumerate(heads)})


def failures(rows):
    """What was not done, with the program's message."""
    found = dict.fromkeys((r["note"] for r in rows if not done(r)))
    return "\n".join(f"- `{note.replace('`', '')}`" for note in found if note)
