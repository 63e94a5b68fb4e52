#!/usr/bin/env python3
"""Energy of six inputs that users have written, at the program's defaults where they say nothing else (benchmarks/stability/inputs).

  user_inputs.py                   every row of the table; about ten minutes on a core, most of it sphere_on_plate
  user_inputs.py --input NAME ...  the rows of these inputs; --scheme, --shape choose rows alike
  user_inputs.py --docs            as above, and docs/stability/user_inputs.csv and the tables of docs/stability.md; rows that
                                   are not chosen stay as they are on file
  user_inputs.py --tables          the table of docs/stability.md from that file, without a run

  bounce, histories   a ball of copper that erodes, a plate and a flyer of aluminium; many restart files, time histories
  sand_column         dry sand that runs out; with USL, USF and USAVG the first 8 % of the time
  dam_break           water of the library's constants, made softer
  sphere_on_plate     steel through aluminium at 3 km/s, 316,000 particles that fail
  rigid_ram           a rigid block with a prescribed velocity presses an elastic column between walls to 94 % of its height

The inputs are as they were written, except for rigid_ram: without <Contact enable="1"/>, which has been added, the program refuses it.
*largest drift*: relative_drift of the row of the status file in which it is furthest from zero."""

import argparse
import pathlib
import re
import sys
import tempfile

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / part) for part in ("benchmarks", "tests/system")]

from common import results  # noqa: E402: found by the line above
import _mpm  # noqa: E402

FOLDER = pathlib.Path(__file__).with_name("inputs")
PAGE, TABLE = results.ROOT / "docs/stability.md", results.ROOT / "docs/stability/user_inputs.csv"
KEYS = ("input", "shape", "scheme")
ROWS = [("bounce", "linear", "MUSL", 1), ("histories", "linear", "MUSL", 1), ("sand_column", "linear", "MUSL", 1),
        ("sand_column", "linear", "USL", 0.08), ("sand_column", "linear", "USF", 0.08), ("sand_column", "linear", "USAVG", 0.08),
        *(("dam_break", "linear", scheme, 1) for scheme in ("MUSL", "USAVG")),
        *(("dam_break", shape, "MUSL", 1) for shape in ("CPDI", "CPDI2")),
        *(("sphere_on_plate", "linear", scheme, 1) for scheme in ("MUSL", "USAVG", "USF", "USL")), ("sphere_on_plate", "SGMP", "MUSL", 1),
        *(("rigid_ram", "linear", scheme, 1) for scheme in ("auto", "MUSL", "USAVG")),
        *(("rigid_ram", shape, "MUSL", 1) for shape in ("SGMP", "QuadraticBSpline", "uGIMP", "CPDI"))]


def scene(name, shape, scheme, share):
    """The input with this shape and scheme, over this share of its time."""
    text = (FOLDER / f"{name}.xmp").read_text()
    end = float(re.search(r'<EndTime value="([^"]*)"', text).group(1))
    text = re.sub(r'<EndTime value="[^"]*"', f'<EndTime value="{share * end!r}"', text)
    text = re.sub(r'<Solution( algorithm="\w+")?', f'<Solution algorithm="{scheme}"', text)
    return text.replace("<Grid>", f'<Grid shape="{shape}">')


def measure(name, shape, scheme, share, folder):
    """A row of the table."""
    (folder / "case.xmp").write_text(scene(name, shape, scheme, share))
    done = _mpm.run([folder / "case.xmp", "--output-dir", folder], timeout=6000)
    if done.code not in (0, 3):
        raise SystemExit(f"{name}: {done}")
    drifts = _mpm.table(folder / "case.sta")["relative_drift"]
    return {"input": name, "shape": shape, "scheme": scheme, "share": share, "code": done.code,
            "steps": _mpm.summary(folder)["steps"], "largest": max(drifts, key=abs), "last": drifts[-1]}


def merged(old, new):
    """The rows on file with these in the place of the same ones, in the order of ROWS."""
    rows = {tuple(row[key] for key in KEYS): row for row in [*old, *new]}
    return [rows[row[:3]] for row in ROWS if row[:3] in rows]


COLUMNS = {"input": (lambda r: f"[{r['input']}](../benchmarks/stability/inputs/{r['input']}.xmp)", ""),
           "shape": (lambda r: f"`{r['shape']}`", ""), "scheme": (lambda r: r["scheme"], ""),
           "of its time, %": (lambda r: 100 * r["share"], "g"), "exit code": (lambda r: r["code"], "g"),
           "steps": (lambda r: r["steps"], ".0f"), "largest drift, %": (lambda r: 100 * r["largest"], "+.2g"),
           "drift at the end, %": (lambda r: r["last"] and 100 * r["last"], "+.2g")}


def tables(rows):
    """The block of the page."""
    return {"user inputs": results.markdown(rows, COLUMNS)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for i, key in enumerate(KEYS):
        names = list(dict.fromkeys(row[i] for row in ROWS))
        parser.add_argument(f"--{key}", nargs="+", choices=names, default=names)
    parser.add_argument("--docs", action="store_true", help="write docs/stability/user_inputs.csv and the table of docs/stability.md")
    parser.add_argument("--tables", action="store_true", help="write the table of docs/stability.md from the file")
    options = parser.parse_args()
    if options.tables:
        return results.refresh(PAGE, tables(results.read(TABLE)[1]))
    chosen = [row for row in ROWS if all(row[i] in getattr(options, key) for i, key in enumerate(KEYS))]
    if not chosen:
        there_is = (" ".join(row[:len(KEYS)]) for row in ROWS if row[0] in options.input)
        parser.error(f"no row of the table has all of these; choose from {', '.join(there_is)}")
    rows = []
    for row in chosen:
        with tempfile.TemporaryDirectory() as folder:
            rows.append(measure(*row, pathlib.Path(folder)))
        print(", ".join(f"{v:.3g}" if isinstance(v, float) else str(v) for v in rows[-1].values()), flush=True)
        if options.docs:
            results.write(TABLE, merged(results.read(TABLE)[1] if TABLE.exists() else [], rows))
    if options.docs:
        results.refresh(PAGE, tables(results.read(TABLE)[1]))


if __name__ == "__main__":
    main()
