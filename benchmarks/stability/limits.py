#!/usr/bin/env python3
"""The largest stable time step of every shape, transfer and scheme, by bisection.

A step counts as stable if the run completes and its energy does not grow: the mean drift over the last quarter of the
rows of the status file is at most 5 %. That is looser than the 1 % of verdicts.py: linear functions gain 2 to 4 % in the
block by crossing cells at steps far below the largest, and would have none with a bound of 1 %. A step that is stable here
may therefore drift by more than 1 %. The scenes:

  block   an elastic block that vibrates at strains of some per cent while it drifts obliquely across the cells
  fluid   a block of fluid with artificial viscosity that starts under pressure, drifting as well
  bar     a copper cylinder that hits a wall at 190 m/s (benchmarks/taylor_bar, with coarse particles)
  shock   a copper slab that hits a wall at 1500 m/s, with the default artificial viscosity

Steps are in units of h/(c + |v|), with c the wave speed at rest and |v| the largest speed at the start, and constant
over the run (TimeStep specified), so that the result does not depend on the program's own limit. Only the shock, where
sound speed and viscosity change greatly, runs with TimeStep factor: its numbers are fractions of the program's limit,
up to 1.

Beside them the limit of a linear analysis (theory.py) and the program's own, k of h/(c/k + |v|).

  limits.py                        every shape and scheme with FLIP in every scene, about a quarter of an hour on a core; --shape,
                                   --scheme, --transfer, --mass, --scene choose
  limits.py --docs                 as above, and docs/stability/limits.csv and the tables of docs/stability.md: what this run
                                   measured replaces the same numbers there, and the others stay. What the program refuses is
                                   left out
  limits.py --tables               the tables of docs/stability.md from that file, without a run"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))
PAGE, TABLE = ROOT / "docs/stability.md", ROOT / "docs/stability/limits.csv"

from accuracy import methods  # noqa: E402: found by the line above
from common import results  # noqa: E402
import theory  # noqa: E402

BIN = pathlib.Path(os.environ.get("MPM_BIN", ROOT / "build/release/bin"))
GROWTH = 0.05  # looser than the 1 % of verdicts.py, as said above


def grid(lower, upper, faces, cell, shape):
    sides = "".join(f'<{a}{end} value="{v[i]}" boundary="{faces[2 * i + k]}"/>' for i, a in enumerate("XYZ")
                    for k, (end, v) in enumerate((("Min", lower), ("Max", upper))))
    return f'<Grid shape="{shape}"><Cell type="regular">{sides}<DCell dx="{cell}" dy="{cell}" dz="{cell}"/></Cell></Grid>'


def scene(material, body, grid, method, end, step):
    """`step`: the attribute of TimeStep."""
    shape, transfer, scheme, mass = method
    return f"""<?xml version="1.0"?>
<PeneBlast version="1.0">
{material}
<Component name="all">{body}</Component>
{grid}
<Solution algorithm="{scheme}" transfer="{transfer}" mass="{mass}"><EndTime value="{end!r}"/><TimeStep {step}/></Solution>
<Output><Console print_time="{end / 40!r}"/></Output>
</PeneBlast>
"""


def drifting(material, size, velocity, cell, steps, unit):
    """A cube of `size` cells that crosses some of them; `velocity`: the expressions of its components."""
    def make(method, factor):
        low, spacing = 4.1, 0.47  # incommensurate with the cell
        count = round(size / spacing)
        body = (f'<Body name="b" material="m" type="Block"><Geometry dp="{spacing}" x0="{low}" y0="{low}" z0="{low}" '
                f'lx="{count * spacing}" ly="{count * spacing}" lz="{count * spacing}"/>'
                f'<InitialVelocity vx="{velocity[0]}" vy="{velocity[1]}" vz="{velocity[2]}"/></Body>')
        return scene(material, body, grid((0, 0, 0), (18, 18, 18), "000000", cell, method[0]), method, steps * unit,
                     f'specified="{factor * unit!r}"')
    return make


def block():
    c = (1000 * 0.7 / (1.3 * 0.4)) ** 0.5  # of longitudinal waves
    material = ('<Material name="m"><ReferenceDensity value="1"/>'
                '<StrengthModel type="IsoElastic" Young="1000" Poisson="0.3"/></Material>')
    wave = [f"{drift} + 1.2*cos(pi*({a}-4.1)/5.64)" for drift, a in zip((0.13, 0.09, 0.05), "xyz")]
    return drifting(material, 5.64, wave, 1, 2000, 1 / (c + 2.2))


def fluid():
    c = 30.0
    material = ('<Material name="m"><ReferenceDensity value="1"/><StrengthModel type="Null" mu="0"/>'
                f'<EquationOfState type="Polynomial" c0="0" c1="{c * c}" c2="0" c3="0" c4="0" c5="0" c6="0"/></Material>')
    wave = [f"{drift} + 1.0*cos(pi*({a}-4.1)/5.64)" for drift, a in zip((0.13, 0.09, 0.05), "xyz")]
    return drifting(material, 5.64, wave, 1, 600, 1 / (c + 1.8))


COPPER = ('<Material name="m"><ReferenceDensity value="8.93e-3"/>'
          '<StrengthModel type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="157" TangMod="423.461758"/>'
          '<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/></Material>')


def bar():
    body = ('<Body name="b" material="m" type="Cylinder"><Geometry x0="0" y0="0" z0="0" dp_bottom="0.76" dp_top="0.76" '
            'Bottom_Outer_Radius="3.8" Top_Outer_Radius="3.8" height="25.4"/><InitialVelocity vx="0" vy="0" vz="-190"/></Body>')
    c = (3940.0**2 + 4 / 3 * 117e3 / 2.7 / 8.93e-3) ** 0.5

    def make(method, factor):
        cells = grid((-9.12, -9.12, 0), (9.12, 9.12, 27.36), "000020", 1.52, method[0])
        return scene(COPPER, body, cells, method, 0.06, f'specified="{factor * 1.52 / (c + 190)!r}"')
    return make


def shock(method, factor):
    body = ('<Body name="b" material="m" type="Block"><Geometry dp="0.5" x0="0" y0="0" z0="0" lx="60" ly="2" lz="2"/>'
            '<InitialVelocity vx="-1500" vy="0" vz="0"/></Body>')
    return scene(COPPER, body, grid((0, 0, 0), (64, 2, 2), "202222", 1, method[0]), method, 0.009,
                 f'factor="{min(factor, 1)!r}"')


SCENES = {"block": block(), "fluid": fluid(), "bar": bar(), "shock": shock}


class Refused(Exception):
    """The program does not have this method."""


def run(text, folder):
    """The columns of the status file; None for a run that fails."""
    path = pathlib.Path(folder, "limit.xmp")
    path.write_text(text)
    done = subprocess.run([BIN / "mpm_run", "--output-dir", folder, path], capture_output=True, text=True)
    if done.returncode == 2:
        raise Refused(results.reason(done.stderr))
    if done.returncode != 0:
        return None
    lines = [line.split() for line in pathlib.Path(folder, "limit.sta").read_text().splitlines() if line.strip()]
    head = [[word for word in line if word != "#"] for line in lines if "relative_drift" in line][0]
    return {name: [float(line[at]) for line in lines if line[0].isdigit()] for at, name in enumerate(head)}


def growth(name, method, factor):
    """Of the energy, relative to the initial one; infinity for a run that fails."""
    with tempfile.TemporaryDirectory() as folder:
        rows = run(SCENES[name](method, factor), folder)
    if rows is None:
        return float("inf")
    drifts = rows["relative_drift"]
    last = drifts[-len(drifts) // 4:]
    return sum(last) / len(last)


def of_program(method):
    """The program's k: its critical step of a body at rest, in h/c."""
    material = ('<Material name="m"><ReferenceDensity value="1"/>'
                '<StrengthModel type="IsoElastic" Young="1" Poisson="0"/></Material>')
    make = drifting(material, 2.82, (0, 0, 0), 1, 1, 8.0)
    with tempfile.TemporaryDirectory() as folder:
        return run(make(method, 1).replace('specified="8.0"', 'factor="1"'), folder)["dt"][1]


def limit(name, method, low=0.2, high=3.2, within=0.05):
    """The largest stable factor, to the relative accuracy `within`; 0 if there is none above `low`."""
    if growth(name, method, low) > GROWTH:
        return 0.0
    if name == "shock":
        high = 1.0
        if growth(name, method, high) <= GROWTH:
            return high
    while high / low > 1 + within:
        middle = (low * high) ** 0.5
        if growth(name, method, middle) > GROWTH:
            high = middle
        else:
            low = middle
    return low


def measure(method, scenes):
    """A row of the table."""
    shape, transfer, scheme, mass = method
    in_theory = theory.limit(shape, scheme, transfer) if mass == "lumped" else None
    row = {"shape": shape, "transfer": transfer, "scheme": scheme, "mass": mass, "theory": in_theory,
           **{name: limit(name, method) for name in scenes}}
    return {**row, "program": of_program(method)}


KEYS = ("shape", "transfer", "scheme", "mass")
COLUMNS = {"shape": (lambda r: f"`{r['shape']}`", ""), "scheme": (lambda r: r["scheme"], ""),
           **{name: (lambda r, name=name: r[name], ".2f") for name in ("theory", *SCENES)},
           "limit": (lambda r: r["program"], "g")}


def merged(old, new):
    """The rows on file, with what was measured of the same methods in their place; new ones follow, in the order of the program's
    own lists."""
    rows = {tuple(row[key] for key in KEYS): row for row in old}
    for row in new:
        key = tuple(row[name] for name in KEYS)
        rows[key] = {**rows.get(key, dict.fromkeys(("theory", *SCENES), "")), **row}
    lists = methods.shapes(), methods.choices("Solution", "transfer"), methods.schemes(), ("lumped", "consistent")
    ordered = sorted(rows.items(), key=lambda item: [lists[i].index(item[0][i]) for i in (3, 1, 0, 2)])
    return [{name: row[name] for name in (*KEYS, "theory", *SCENES, "program")} for _, row in ordered]


def name_of_transfer(row):
    return row["transfer"] if row["mass"] == "lumped" else f"{row['transfer']}, consistent mass"


def of_transfers(rows):
    """Shapes and schemes in rows, transfers in columns: what the fluid bears, and the program's limit."""
    by_method = {}
    for row in sorted(rows, key=lambda row: methods.shapes().index(row["shape"])):
        by_method.setdefault((row["shape"], row["scheme"]), {})[name_of_transfer(row)] = row

    def of(transfer):
        def value(method):
            row = method[1].get(transfer)
            return None if row is None else f"{row['fluid']:.2f} / {row['program']:g}"
        return value

    columns = {"shape": (lambda m: f"`{m[0][0]}`", ""), "scheme": (lambda m: m[0][1], ""),
               **{name: (of(name), "") for name in dict.fromkeys(map(name_of_transfer, rows))}}
    return results.markdown(list(by_method.items()), columns)


def tables(rows):
    """The blocks of the page."""
    flip = [row for row in rows if name_of_transfer(row) == "FLIP"]
    return {"limits": results.markdown(flip, COLUMNS), "limits of transfers": of_transfers([r for r in rows if r not in flip])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shape", nargs="+", choices=methods.shapes(), default=methods.shapes())
    parser.add_argument("--scheme", nargs="+", choices=methods.schemes(), default=methods.schemes())
    parser.add_argument("--transfer", nargs="+", choices=methods.choices("Solution", "transfer"), default=["FLIP"])
    parser.add_argument("--mass", choices=["lumped", "consistent"], default="lumped")
    parser.add_argument("--scene", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--csv", type=pathlib.Path)
    parser.add_argument("--factor", type=float, help="report the energy growth at this factor instead")
    parser.add_argument("--docs", action="store_true", help="write docs/stability/limits.csv and the tables of docs/stability.md")
    parser.add_argument("--tables", action="store_true", help="write the tables of docs/stability.md from the file")
    options = parser.parse_args()
    if options.tables:
        return results.refresh(PAGE, tables(results.read(TABLE)[1]))
    chosen = [(s, t, a, options.mass) for t in options.transfer for s in options.shape for a in options.scheme]
    rows, refused = [], 0
    for method in chosen:
        try:
            if options.factor:
                print(*method, *(f"{growth(name, method, options.factor):.4g}" for name in options.scene), flush=True)
                continue
            rows.append(measure(method, options.scene))
        except Refused as refusal:
            refused += 1
            if options.docs and refused < len(chosen):
                continue
            parser.error(f"the program refuses {' '.join(method)}: {refusal}")
        print(*(f"{v:.4g}" if isinstance(v, float) else v for v in rows[-1].values()), flush=True)
        if options.csv:
            results.write(options.csv, rows)
        if options.docs:
            results.write(TABLE, merged(results.read(TABLE)[1] if TABLE.exists() else [], rows))
    if options.docs and not options.factor:
        results.refresh(PAGE, tables(results.read(TABLE)[1]))


if __name__ == "__main__":
    sys.exit(main())
