"""Which method to choose: the error that each reaches in the time that linear shape functions take, by use."""

import math

from common import results

import methods
import runner
import tables

BASE = methods.Method("linear")
MOST_ROWS = 10
SIGNIFICANT = 1.3  # ratio of run times that other programs on the machine do not explain

# {use: [(case, study, error)]}: what a user of that kind looks at.
USES = {
    "impact": [("taylor_bar", "cells", "mean"), ("colliding_discs", "cells", "loss"), ("plane_shock", "cells", "energy")],
    "blast": [("detonation", "two particles", "pressure"), ("riemann", "sod", "density"), ("riemann", "ratio 10", "density"),
              ("sedov", "cells", "density")],
    "fluids": [("dam_break", "cells", "front"), ("dam_break", "cells", "drift"), ("dam_break", "cells", "scatter")],
    "soil": [("column", "cells", "place"), ("column", "cells", "stress")],
    "elastic": [("standing_wave", "cells", "phase"), ("elastic_statics", "cylinder", "stress"),
                ("vortex", "steps as cells", "displacement"), ("manufactured_cube", "cube, steps as cells", "displacement"),
                ("crossing", "carried 10 %", "stress")],
}


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
    """({method: its error over linear's at the run time of linear's finest run}, {methods that failed})."""
    limit = finest(rows, error)
    if limit is None:
        return {}, set()
    by_method = {}
    for row in rows:
        if row["status"] != runner.REFUSED:
            by_method.setdefault(tables.method_of(row), []).append(row)
    base = tables.value(limit, error)
    found = {}
    for method, mine in by_method.items():
        reached = error_within(mine, error, limit["seconds"])
        if reached is not None and base > 0:
            found[method] = max(reached, 1e-6 * base) / base  # round-off is as good as a millionth
    return found, {m for m, mine in by_method.items() if any(r["status"] == runner.FAILED for r in mine)}


def ranking(rows_of, use):
    """[(method, geometric mean of its ratios, [ratio or None], failed)], the best first; methods with all measures."""
    columns, failed = [], set()
    for case, study, error in USES[use]:
        found, fails = ratios([r for r in rows_of[case] if r["study"] == study], error)
        columns.append(found)
        failed |= fails
    complete = set.intersection(*(set(c) for c in columns))
    ranked = []
    for method in complete:
        mine = [c[method] for c in columns]
        ranked.append((method, math.exp(sum(map(math.log, mine)) / len(mine)), mine, method in failed))
    return sorted(ranked, key=lambda r: r[1])


def block(cases, rows_of, use):
    """Markdown: the best methods, and linear with FLIP and MUSL."""
    ranked = ranking(rows_of, use)
    shown = ranked[:MOST_ROWS] + [r for r in ranked[MOST_ROWS:] if r[0] == BASE]
    columns = {"shape": (lambda r: r[0].shape, ""), "transfer": (lambda r: r[0].transfer, ""),
               "scheme": (lambda r: r[0].scheme, ""), "mean": (lambda r: r[1], ".2g")}
    for i, (case, study, error) in enumerate(USES[use]):
        heading = f"{cases[case].title}, {study}: {cases[case].errors[error].heading}"
        columns[heading] = (lambda r, i=i: r[2][i], ".2g")
    columns["failures"] = (lambda r: "some" if r[3] else "none", "")
    return results.markdown(shown, columns)


def blocks(cases, rows_of):
    return {use: block(cases, rows_of, use) for use in USES}
