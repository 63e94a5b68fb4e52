"""The artificial viscosity in all compression, limited to shocks (limiter="shock"), and off: errors, heat and run time.

  viscosity.py              two shocks and a smooth wave, with linear functions and a quadratic spline; some minutes
  viscosity.py --quick      coarse, with the spline only; seconds
  viscosity.py --docs       also writes the tables into docs/methods.md; the times need an otherwise idle machine

Sod's tube and the plane shock in copper are those of accuracy.py and tests/validation; the wave is the first mode of a copper
bar between two walls, without a shock, against a Lagrangian solution in finite differences. Heat: the energy of the
particles above that of the isentrope of their start at the same density, which without shocks is what viscosity takes."""

import argparse
import dataclasses
import json
import pathlib
import shutil
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import numpy as np
from common import results, timed_run

import methods
import runner
from case import Point
from cases import riemann, support

import _blast
import _cases
import _line

GAMMA = 1.4
VISCOSITIES = {"all compression": {}, "shocks": {"limiter": "shock"}, "off": {"bq1": "0", "bq2": "0"}}
PAGE = results.ROOT / "docs/methods.md"


def mean_error(x, found, exact, scale):
    """Mean absolute error over the length, over `scale`."""
    length = np.abs(np.gradient(x))
    return (np.abs(found - exact) * length).sum() / length.sum() / scale


def gas_heat(mass, pressure, density, isentrope):
    """Energy above that of p = isentrope rho^gamma."""
    return (mass * (pressure / density - isentrope * density ** (GAMMA - 1))).sum() / (GAMMA - 1)


@dataclasses.dataclass(frozen=True)
class Sod:
    cells: int

    name = "Sod's tube"

    def point(self):
        return Point("riemann", "sod", None, self.cells, 2, 0.4)

    def text(self):
        return riemann.CASE.scene(self.point())

    def measure(self, folder):
        found, states = riemann.CASE.measure(self.point(), folder), _cases.States(folder)
        tube, cell = riemann.TUBES["sod"], riemann.LENGTH / self.cells
        left = states.column("x", 0) < 0.5 * riemann.LENGTH
        start = [np.where(left, tube.left[i], tube.right[i]) for i in (0, 2)]
        mass = start[0] * (cell / 2) ** 3
        heat = gas_heat(mass, states.column("pres"), states.column("density"), start[1] / start[0] ** GAMMA) / cell**2
        # Of the exact solution: the gas between the contact, which moves at the largest speed, and the shock.
        way = np.linspace(0, 0.5 / states.times[-1], 200001)
        exact = _blast.riemann(tube.left, tube.right, GAMMA)(way)
        behind = way > exact["v"].max()
        by_shock = gas_heat(exact["rho"][behind] * (way[1] * states.times[-1]), exact["p"][behind], exact["rho"][behind],
                            tube.right[2] / tube.right[0] ** GAMMA)
        return {"density": found["density"], "velocity": found["velocity"], "overshoot": found["overshoot"],
                "heat": heat / by_shock - 1}


class Isentrope:
    """Copper without strength compressed or stretched without heat from its reference state: `energy` per mass and
    `pressure` over density."""

    def __init__(self):
        eos = _line.Line(1, 1.0, 1, 0.0, "MUSL", 1.0, bq1=0, bq2=0, **_cases.COPPER)
        volume = np.linspace(1.3, 0.5, 80001)
        step = volume[1] - volume[0]
        one = np.argmin(np.abs(volume - 1))
        cold, energy = eos.cold(1 / volume - 1)[0], np.zeros_like(volume)
        for at in [*range(one, len(volume) - 1), *range(one, 0, -1)]:
            to, h = (at + 1, step) if at >= one else (at - 1, -step)
            # dE = -(cold + gamma0 E) dV by the trapezoidal rule
            a, b = 0.5 * h * (cold[at] + cold[to]), 0.5 * h * eos.gamma0
            energy[to] = (energy[at] * (1 - b) - a) / (1 + b)
        self.table = eos.density / volume, energy / eos.density, cold + eos.gamma0 * energy

    def energy(self, density):
        return np.interp(density, self.table[0], self.table[1])

    def pressure(self, density):
        return np.interp(density, self.table[0], self.table[2])


@dataclasses.dataclass(frozen=True)
class Copper:
    cells: int

    name = "plane shock in copper, 1 km/s"

    def shock(self):
        return _cases.Shock(1000.0, cell=100.0 / self.cells, split=4, factor=0.4)

    def text(self):
        return self.shock().text()

    def measure(self, folder):
        shock, states = self.shock(), _cases.States(folder)
        found, exact, at = shock.measure(folder), shock.exact(), shock.profiles(states)
        front = exact["Us"] * states.times[-1]
        behind, isentrope = at["X"] < front, Isentrope()
        rho = np.where(behind, exact["rho"], _cases.COPPER["density"])
        v = np.where(behind, 0, -shock.speed)
        layer = at["X"][1] - at["X"][0]
        heat = layer * (at["e"] - isentrope.energy(at["rho"])).sum()
        by_shock = front * (exact["e"] - isentrope.energy(exact["rho"]))
        return {"density": mean_error(at["X"], at["rho"], rho, exact["rho"]),
                "velocity": mean_error(at["X"], at["v"], v, shock.speed),
                "overshoot": found["overshoot"], "heat": heat / by_shock - 1}


@dataclasses.dataclass(frozen=True)
class Wave:
    """v = U sin(pi x/L) in a copper bar between walls at 0 and L: U is 5 % of the sound speed; it ends after 1.125 periods,
    long before a shock forms."""

    cells: int

    name = "smooth wave in copper"
    length, speed = 100.0, 0.05 * _cases.COPPER["c0"]
    end = 1.125 * 2 * length / _cases.COPPER["c0"]

    def text(self):
        h, length = self.length / self.cells, self.length
        bar = support.block("bar", (0, 0, 0), (length, h, h), h / 2, "copper",
                            f'<InitialVelocity vx="{self.speed!r}*sin(pi*x/{length!r})" vy="0" vz="0"/>')
        return support.scene([bar], support.grid((0, 0, 0), (length, h, h), "222222", h), support.solution(self.end, 0.4),
                             [_cases.copper('type="Null"')], support.pictures(self.end, ["density", "engi"]))

    def exact(self, zones=2000):
        """Places of zones and their density, and velocities between them: no viscosity, second order."""
        rho0, isentrope = _cases.COPPER["density"], Isentrope()
        x = np.linspace(0, self.length, zones + 1)
        v, mass = self.speed * np.sin(np.pi * x / self.length), rho0 * self.length / zones
        steps = round(self.end / (0.4 * self.length / zones / _cases.COPPER["c0"]))
        dt = self.end / steps

        def kick(by):
            v[1:-1] -= by / mass * np.diff(isentrope.pressure(mass / np.diff(x)))

        kick(dt / 2)
        for _ in range(steps - 1):
            x += dt * v
            kick(dt)
        x += dt * v
        kick(dt / 2)
        return 0.5 * (x[1:] + x[:-1]), mass / np.diff(x), x, v

    def measure(self, folder):
        states, h, rho0 = _cases.States(folder), self.length / self.cells, _cases.COPPER["density"]
        layer = np.rint(states.column("x", 0) * 2 / h - 0.5).astype(int)
        x, rho, energy, v = (np.bincount(layer, states.column(name)) / np.bincount(layer)
                             for name in ("x", "density", "engi", "velocity_0"))
        middles, density, nodes, velocity = self.exact()
        heat = (energy / (rho0 * (h / 2) ** 3) - Isentrope().energy(rho)).mean()
        return {"density": mean_error(x, rho, np.interp(x, middles, density), np.abs(density - rho0).max()),
                "velocity": mean_error(x, v, np.interp(x, nodes, velocity), np.abs(velocity).max()),
                "overshoot": np.abs(v).max() / np.abs(velocity).max() - 1, "heat": heat / (self.speed**2 / 4)}


def run(case, method, viscosity, folder):
    """Errors and seconds of the loop, on one core."""
    root = ElementTree.fromstring(case.text().encode())
    methods.choose(root, method)
    for law in root.iter("StrengthModel"):
        for name, value in VISCOSITIES[viscosity].items():
            law.set(name, value)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    file = folder / "case.xmp"
    file.write_text(ElementTree.tostring(root, encoding="unicode"))
    code, said, processor, wall = timed_run.execute(file, folder, runner.LIMIT)
    if code != 0:
        raise SystemExit(f"{file}: mpm_run ended with exit code {code}\n{said}")
    summary = json.loads((folder / "case.summary.json").read_text())
    return {**case.measure(folder), "steps": summary["steps"], "particles": summary["particles"],
            "seconds": runner.loop_seconds(summary, processor, wall)}


def measure(case, method, folder):
    """A row per viscosity."""
    return [{"case": case.name, "cells": case.cells, "shape": method.shape, "viscosity": viscosity,
             **run(case, method, viscosity, folder)} for viscosity in VISCOSITIES]


@dataclasses.dataclass(frozen=True)
class Timed:
    """A thick copper bar, for the time of a step."""

    across: int

    def text(self):
        return _cases.Shock(1000.0, length=30.0, across=self.across, split=4, factor=0.4).text()

    def measure(self, folder):
        return {}


def costs(method, across, repeats, folder):
    """Seconds per step and particle. The runs take turns, and of their times the shortest counts."""
    shortest = dict.fromkeys(VISCOSITIES, np.inf)
    for _ in range(repeats):
        for viscosity in VISCOSITIES:
            found = run(Timed(across), method, viscosity, folder)
            shortest[viscosity] = min(shortest[viscosity], found["seconds"] / found["steps"] / found["particles"])
    return {"shape": method.shape, **shortest}


def cost_table(rows):
    columns = {"shape": (lambda r: f"`{r['shape']}`", "")}
    for viscosity in VISCOSITIES:
        columns[f"{viscosity}, ns"] = (lambda r, v=viscosity: 1e9 * r[v], ".1f")
        if viscosity != "all compression":
            columns[f"{viscosity}, %"] = (lambda r, v=viscosity: 100 * (r[v] / r["all compression"] - 1), "+.1f")
    return results.markdown(rows, columns)


def table(rows):
    columns = {"case": (lambda r: f"{r['case']}, {r['cells']} cells", ""), "shape": (lambda r: f"`{r['shape']}`", ""),
               "viscosity in": (lambda r: r["viscosity"], "")}
    for name, heading, how in (("density", "L1 error of density, %", ".2f"), ("velocity", "L1 error of velocity, %", ".2f"),
                               ("overshoot", "overshoot, %", "+.1f"), ("heat", "heat too much, %", "+.2f")):
        columns[heading] = (lambda r, name=name: 100 * r[name], how)
    return results.markdown(rows, columns)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="coarse, with the spline only")
    parser.add_argument("--docs", action="store_true", help="write the table into docs/methods.md")
    parser.add_argument("--repeats", type=int, default=15, help="runs of each for the time of a step; default 15")
    parser.add_argument("--out", type=pathlib.Path, default=results.ROOT / "build/accuracy", help="folder of viscosity.csv and viscosity_cost.csv")
    options = parser.parse_args()
    if options.quick and options.docs:
        parser.error("--docs needs the whole benchmark, without --quick")
    cases = [Sod(50), Copper(50), Wave(25)] if options.quick else [Sod(200), Copper(100), Wave(100)]
    shapes = [methods.Method(shape) for shape in (("QuadraticBSpline",) if options.quick else ("linear", "QuadraticBSpline"))]
    across, repeats = (1, 1) if options.quick else (3, options.repeats)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "run"
        rows = [row for case in cases for shape in shapes for row in measure(case, shape, folder)]
        timed = [costs(shape, across, repeats, folder) for shape in shapes]
    results.write(options.out / "viscosity.csv", rows)
    results.write(options.out / "viscosity_cost.csv", timed)
    text = f"{table(rows)}\n\nTime of a step per particle, copper:\n\n{cost_table(timed)}"
    print(text)
    if options.docs:
        results.refresh(PAGE, {"viscosity": text})


if __name__ == "__main__":
    main()
