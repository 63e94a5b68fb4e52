"""Which method to choose, by use: the error that each reaches in the time that linear shape functions take; and what averages,
more particles and longer steps do to the one that leads. All of docs/choosing.md that states a number comes from here."""

import dataclasses
import math

from common import results

import methods
import runner
import tables

BASE = methods.Method("linear")
MOST_ROWS = 10
SIGNIFICANT = 1.3  # ratio of run times that other programs on the machine do not explain; the least that counts for errors too
DEFAULT_FACTOR = 0.9


@dataclasses.dataclass(frozen=True)
class Use:
    """What a user of that kind looks at: `measures` of (case, study, error), and the studies that vary what goes with the
    method, of one of these cases: (case, study as ranked, varied study, error)."""

    problem: str
    measures: tuple
    averaging: tuple = ()
    particles: tuple = ()
    factor: tuple = ()  # (case, study over the factor, error)
    least: float = 0.0  # difference of errors that means something: a reference has an error of its own


USES = {
    "impact": Use("impact, penetration",
                  (("taylor_bar", "cells", "mean"), ("colliding_discs", "cells", "loss"), ("plane_shock", "cells", "energy")),
                  ("taylor_bar", "cells", "averaged", "mean"), ("taylor_bar", "cells", "particles", "mean"), ("taylor_bar", "time", "mean"), least=0.005),
    "blast": Use("blast, gases, explosives",
                 (("detonation", "two particles", "pressure"), ("riemann", "sod", "density"), ("riemann", "ratio 10", "density"),
                  ("sedov", "cells", "density")),
                 ("detonation", "two particles", "averaged", "pressure"), ("detonation", "two particles", "four particles", "pressure"),
                 ("detonation", "time", "pressure")),
    "fluids": Use("water and other fluids",
                  (("dam_break", "cells", "front"), ("dam_break", "cells", "drift"), ("dam_break", "cells", "scatter")),
                  ("dam_break", "cells", "averaged", "scatter"), ("dam_break", "cells", "particles", "scatter"),
                  ("dam_break", "time", "scatter")),
    "soil": Use("soil, large settlements", (("column", "cells", "place"), ("column", "cells", "stress")),
                ("column", "cells", "averaged", "stress"), ("column", "cells", "particles", "stress"), ("column", "time", "stress")),
    "elastic": Use("elastic bodies",
                   (("standing_wave", "cells", "phase"), ("elastic_statics", "cylinder", "stress"),
                    ("vortex", "steps as cells", "displacement"), ("manufactured_cube", "cube, steps as cells", "displacement")),
                   ("incompressible", "cook 0.3 none", "cook 0.3 cell", "deflection"),
                   ("manufactured_cube", "slab, fine steps", "slab, four particles", "displacement"), ("standing_wave", "time", "phase")),
    "incompressible": Use("nearly incompressible solids (Poisson's ratio above 0.45)",
                          (("incompressible", "cook 0.4999 cell", "deflection"), ("incompressible", "block 0.4999 cell", "deflection")),
                          ("incompressible", "cook 0.4999 none", "cook 0.4999 cell", "deflection")),
}


# Errors at a run time --------------------------------------------------------------------------------------------


def finest(rows, error):
    """The row of linear functions with the most cells that was done."""
    done = [r for r in rows if tables.method_of(r) == BASE and tables.value(r, error) is not None]
    return max(done, key=lambda r: (r["cells"], -r["factor"]), default=None)


def error_within(rows, error, seconds):
    """Error of a method at this run time: between two of its runs by powers of the time, else that of its longest run, or of its
    shortest one where that is not significantly longer; None where none is short enough."""
    done = sorted((r["seconds"], tables.value(r, error)) for r in rows if tables.value(r, error) is not None)
    shorter, longer = [d for d in done if d[0] <= seconds], [d for d in done if d[0] > seconds]
    if not shorter:
        return next((error for time, error in done if time <= SIGNIFICANT * seconds), None)
    (t, e), (u, f) = shorter[-1], (longer or [shorter[-1]])[0]
    if u == t or e <= 0 or f <= 0:
        return e
    return e * (f / e) ** (math.log(seconds / t) / math.log(u / t))


def ratios(rows, error):
    """({method: its error over linear's at the run time of linear's finest run}, {methods that failed}). Where linear fails on
    its finest grid, the time is the one up to which every method without a failure was measured, and its error that of the finest
    grid that it ended on."""
    limit = finest(rows, error)
    if limit is None:
        return {}, set()
    failed = {tables.method_of(r) for r in rows if r["status"] == runner.FAILED}
    by_method = {}
    for row in rows:
        if row["status"] != runner.REFUSED:
            by_method.setdefault(tables.method_of(row), []).append(row)
    base, seconds = tables.value(limit, error), limit["seconds"]
    if BASE in failed:
        seconds = max(seconds, min(max(r["seconds"] for r in mine) for m, mine in by_method.items() if m not in failed))
    found = {}
    for method, mine in by_method.items():
        reached = error_within(mine, error, seconds)
        if reached is not None and base > 0:
            found[method] = max(reached, 1e-6 * base) / base  # round-off is as good as a millionth
    return found, failed


# Ranking ---------------------------------------------------------------------------------------------------------


def of_study(rows_of, case, study):
    return [r for r in rows_of[case] if r["study"] == study]


def ranked_by(rows_of, measures):
    """[(method, geometric mean of its ratios, [ratio], failed)], the best first; methods with all measures."""
    columns, failed = [], set()
    for case, study, error in measures:
        found, fails = ratios(of_study(rows_of, case, study), error)
        columns.append(found)
        failed |= fails
    complete = set.intersection(*(set(c) for c in columns))
    ranked = []
    for method in complete:
        mine = [c[method] for c in columns]
        ranked.append((method, math.exp(sum(map(math.log, mine)) / len(mine)), mine, method in failed))
    return sorted(ranked, key=lambda r: r[1])


def ranking(rows_of, use):
    return ranked_by(rows_of, USES[use].measures)


def block(cases, rows_of, use):
    """Markdown: the best methods, and linear with FLIP and MUSL."""
    ranked = ranking(rows_of, use)
    shown = ranked[:MOST_ROWS] + [r for r in ranked[MOST_ROWS:] if r[0] == BASE]
    columns = {"shape": (lambda r: r[0].shape, ""), "transfer": (lambda r: r[0].transfer, ""),
               "scheme": (lambda r: r[0].scheme, ""), "mean": (lambda r: r[1], ".2g")}
    for i, (case, study, error) in enumerate(USES[use].measures):
        heading = f"{cases[case].title}, {study}: {cases[case].errors[error].heading}"
        columns[heading] = (lambda r, i=i: r[2][i], ".2g")
    columns["failures"] = (lambda r: "some" if r[3] else "none", "")
    return f"{results.markdown(shown, columns)}\n\nMethods with all columns: {len(ranked)}."


# Advice ----------------------------------------------------------------------------------------------------------


def advised(rows_of, use):
    """([those of the default scheme that never failed and are within SIGNIFICANT of the best of these], the best first)."""
    sound = [r for r in ranking(rows_of, use) if r[0].scheme == BASE.scheme and not r[3]]
    return [r for r in sound if r[1] <= SIGNIFICANT * sound[0][1]]


def better_scheme(rows_of, use):
    """The best of the ranking with another scheme that never failed, where its error is significantly smaller; else None."""
    best = next(r for r in ranking(rows_of, use) if not r[3])
    return best if best[0].scheme != BASE.scheme and best[1] * SIGNIFICANT < advised(rows_of, use)[0][1] else None


def written(method):
    return f"`{method.shape}` {method.transfer}"


@dataclasses.dataclass(frozen=True)
class Compared:
    """Errors of a method in two studies, and where they are compared."""

    method: methods.Method
    plain: float
    varied: float
    where: str

    def gains(self, least):
        return self.varied * SIGNIFICANT < self.plain and self.plain - self.varied > least


def candidates(rows_of, use):
    """Methods of the ranking with the default scheme and without failures: the first, those with its shape, the others, each the
    best first. Evidence comes from the first of these that was measured."""
    found = [r[0] for r in ranking(rows_of, use) if r[0].scheme == BASE.scheme and not r[3]]
    return sorted(found, key=lambda m: (m != found[0], m.shape != found[0].shape))


def both(rows_of, method, measure):
    """Rows of the method in the two studies of the measure, where its runs were done."""
    case, plain, varied, error = measure
    return [[r for r in of_study(rows_of, case, study) if tables.method_of(r) == method and tables.value(r, error) is not None]
            for study in (plain, varied)]


def on_same_grid(rows_of, leaders, measure):
    """Of the first of these methods with a grid of both studies, on the finest such: Compared; None where there is none."""
    for method in leaders:
        plain, varied = ({r["cells"]: tables.value(r, measure[3]) for r in rows} for rows in both(rows_of, method, measure))
        common = plain.keys() & varied.keys()
        if common:
            return Compared(method, plain[max(common)], varied[max(common)], f"on {max(common):g} cells")
    return None


def in_same_time(rows_of, leaders, measure):
    """The same in the run time up to which both studies go."""
    for method in leaders:
        rows = both(rows_of, method, measure)
        if all(rows):
            seconds = min(max(r["seconds"] for r in mine) for mine in rows)
            found = [error_within(mine, measure[3], seconds) for mine in rows]
            if None not in found:
                return Compared(method, *found, f"in {seconds:.2g} s")
    return None


def factors(rows_of, leaders, measure):
    """(method, {factor: error}) of the first of these methods that was measured; (None, {})."""
    case, study, error = measure
    for method in leaders:
        found = {r["factor"]: tables.value(r, error) for r in of_study(rows_of, case, study)
                 if tables.method_of(r) == method and tables.value(r, error) is not None}
        if found:
            return method, found
    return None, {}


def longest(found):
    """The largest factor with which the error is not significantly above that of the smallest one."""
    return max(f for f, e in found.items() if e <= SIGNIFICANT * found[min(found)])


def heading_of(cases, measure):
    return cases[measure[0]].errors[measure[-1]].heading.replace(", %", "")


def cell_of(cases, measure, value):
    """The error in the units of its heading, which say what it is."""
    spec = cases[measure[0]].errors[measure[-1]]
    shown = spec.factor * value
    return f"{shown:{'.0f' if shown >= 100 else '.2g'}}{' %' if spec.factor == 100 else ''}"


def numbers_of(cases, measure, of):
    plain, varied = (cell_of(cases, measure, value) for value in (of.plain, of.varied))
    return f"{of.where} with {written(of.method)}: {plain} without, {varied} with"


def choice(cases, rows_of, use):
    """{column: text} of the advice: averaging, particles along a cell and factor, each with the numbers that decide."""
    u, leaders = USES[use], candidates(rows_of, use)
    found = {"averaging": "none", "particles": "2", "factor": f"{DEFAULT_FACTOR}"}
    evidence = []
    for name, measure, compared, words, values in (
            ("averaging", u.averaging, on_same_grid, "Averages over cells", ("none", "cell")),
            ("particles", u.particles, in_same_time, "Four particles along a cell", ("2", "4"))):
        of = compared(rows_of, leaders, measure) if measure else None
        if of is None:
            evidence.append(f"**{words}** were not measured here: the default stays")
            continue
        gains = of.gains(u.least)
        found[name] = values[gains]
        little = 0 < of.plain - of.varied < u.least
        verdict = "gain" if gains else f"gain less than the {100 * u.least:g} % that mean something" if little else "do not gain"
        title, error = cases[measure[0]].title, heading_of(cases, measure)
        line = f"**{words}** {verdict}: {title}, {error} {numbers_of(cases, measure, of)}"
        default = compared(rows_of, [BASE], measure)
        evidence.append(f"{line}; {numbers_of(cases, measure, default)}" if default and of.method != BASE else line)
    method, by_factor = factors(rows_of, leaders, u.factor) if u.factor else (None, {})
    if by_factor:
        best = longest(by_factor)
        found["factor"] = f"{min(best, DEFAULT_FACTOR):g}" if best < max(by_factor) else f"{DEFAULT_FACTOR}"
        title, error = cases[u.factor[0]].title, heading_of(cases, u.factor)
        numbers = ", ".join(f"{cell_of(cases, u.factor, e)} at {f:g}" for f, e in sorted(by_factor.items(), reverse=True))
        evidence.append(f"**Factor**: {title}, {error} with {written(method)}: {numbers}")
    else:
        evidence.append("**Factor**: not varied here, the default stays")
    return found, evidence


def advice(cases, rows_of):
    """Markdown: a line per use."""
    lines = []
    for use, u in USES.items():
        (first, *others), better = advised(rows_of, use), better_scheme(rows_of, use)
        found, _ = choice(cases, rows_of, use)
        lines.append({"problem": f"[{u.problem}](#{use})", "first": f"{written(first[0])}: {first[1]:.2g}",
                      "others": ", ".join(f"{written(r[0])} {r[1]:.2g}" for r in others if r[0] != BASE) or "–",
                      "scheme": f"{better[0].scheme} with {written(better[0])}: {better[1]:.2g}" if better else "–", **found})
    return results.markdown(lines, {
        "problem": (lambda r: r["problem"], ""), "shape and transfer: error over the default's": (lambda r: r["first"], ""),
        "as good": (lambda r: r["others"], ""), "better scheme": (lambda r: r["scheme"], ""), "averaging": (lambda r: r["averaging"], ""),
        "particles along a cell": (lambda r: r["particles"], ""), "factor": (lambda r: r["factor"], "")})


def reasons(cases, rows_of, use):
    """Markdown: what decides on the other columns."""
    _, evidence = choice(cases, rows_of, use)
    return "\n".join(f"- {line}." for line in evidence)


def without(rows_of, use, left_out):
    """The order without the measures of one case, in a sentence."""
    found = ranked_by(rows_of, tuple(m for m in USES[use].measures if m[0] != left_out))
    words = ", ".join(f"{written(r[0])}{'' if r[0].scheme == BASE.scheme else ' ' + r[0].scheme} {r[1]:.2g}" for r in found[:6])
    return f"Of the {len(found)} methods that have all other columns the first are {words}."


def blocks(cases, rows_of):
    made = {"advice": advice(cases, rows_of), "without sedov": without(rows_of, "blast", "sedov")}
    for use in USES:
        made |= {use: block(cases, rows_of, use), f"{use} reasons": reasons(cases, rows_of, use)}
    return made
