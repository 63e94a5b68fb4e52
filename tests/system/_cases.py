"""Scenes with known answers, for the physics tests here and for the validations, and how their results are read.

Units: mm, g, ms; so velocities in m/s, forces in N, stresses in MPa, energies in microjoule."""

import dataclasses
import pathlib

import h5py
import numpy as np

from _line import WAVE_LIMIT
import _mpm

COPPER = {"density": 8.93e-3, "c0": 3940.0, "s1": 1.49, "gamma0": 1.96}


def copper(strength, name="copper"):
    """Copper with the shock Hugoniot of table 3.1 of the thesis and the given StrengthModel."""
    eos = '<EquationOfState type="Gruneisen" C0="{c0}" S1="{s1}" gamma0="{gamma0}"/>'.format(**COPPER)
    return _mpm.material(name, COPPER["density"], strength, eos)


# What a run leaves -------------------------------------------------------------------------------------------------


class States:
    """The pictures of an H5Part file; columns in the order of the particles' identities."""

    def __init__(self, folder, job="case"):
        self.file = h5py.File(pathlib.Path(folder) / f"{job}.h5part")
        names = sorted((n for n in self.file if n.startswith("Step#")), key=lambda n: int(n[5:]))
        self.steps = [self.file[name] for name in names]
        self.times = np.array([float(step.attrs["TimeValue"]) for step in self.steps])

    def column(self, name, which=-1):
        step = self.steps[which]
        return step[name][:][np.argsort(step["id"][:])].astype(float)


def status(folder, job="case"):
    """Rows of the .sta file, as arrays by column name."""
    return {name: np.array(values) for name, values in _mpm.table(pathlib.Path(folder) / f"{job}.sta").items()}


def order(sizes, errors):
    """Observed order of convergence: the slope of log |error| over log size between neighbours."""
    return np.diff(np.log(np.abs(errors))) / np.diff(np.log(sizes))


# Plane shock -------------------------------------------------------------------------------------------------------


@dataclasses.dataclass
class Shock:
    """A copper bar in uniaxial strain (symmetry planes at its sides) that hits a wall, a symmetry plane, at x = 0.

    The copper is without strength (Null), so that the jump conditions with Us = c0 + s1 up are the whole truth:
    p = rho0 Us up, rho/rho0 = Us/(Us - up), e = up^2/2 (thesis 2-60 to 2-62)."""

    speed: float  # up: of the bar, and of the matter behind the shock as seen from that before it
    cell: float = 1.0
    length: float = 100.0
    across: int = 1  # cells
    split: int = 6  # particles along a cell
    algorithm: str = "MUSL"
    factor: float = 0.2
    bq1: float = 1.5
    bq2: float = 0.06
    pictures: int = 32

    @property
    def shock_speed(self):
        return COPPER["c0"] + COPPER["s1"] * self.speed

    @property
    def end(self):
        """The shock has then run through 0.8 of the bar; nothing has come from the free end yet."""
        return 0.8 * self.length / self.shock_speed

    def exact(self):
        up, us, rho0 = self.speed, self.shock_speed, COPPER["density"]
        return {"Us": us, "p": rho0 * us * up, "rho": rho0 * us / (us - up), "e": up * up / 2}

    def text(self):
        width = self.across * self.cell
        bar = _mpm.block("bar", (0, 0, 0), (self.length, width, width), (-self.speed, 0, 0), self.cell / self.split, "copper")
        return _mpm.scene(
            [bar],
            _mpm.grid((0, 0, 0), (self.length + 2 * self.cell, width, width), "202222", self.cell),
            _mpm.solution(self.end, self.algorithm, self.factor),
            [copper(f'type="Null" bq1="{self.bq1}" bq2="{self.bq2}"')],
            f'<PostProcessing time_interval="{self.end / self.pictures!r}" h5part="1" var="pres|density|engi|SigmaX"/>')

    def profiles(self, states, which=-1):
        """Columns over the layers of particles: X (first place, through which the shock runs at Us), x, pressure,
        density, energy per mass and -SigmaX."""
        first, layer = np.unique(np.round(states.column("x", 0), 4), return_inverse=True)
        count = np.bincount(layer)
        mean = {name: np.bincount(layer, states.column(name, which)) / count
                for name in ("x", "velocity_0", "pres", "density", "engi", "SigmaX")}
        mass = COPPER["density"] * (self.cell / self.split) ** 3
        return {"X": first, "x": mean["x"], "v": mean["velocity_0"], "p": mean["pres"], "rho": mean["density"],
                "e": mean["engi"] / mass, "stress": -mean["SigmaX"]}

    def measure(self, folder):
        """Relative errors of the shock speed and of the plateau, its ripple, and the front's width in cells."""
        states = States(folder)
        exact = self.exact()
        late = range(len(states.times) // 4, len(states.times))
        fronts = []
        for which in late:
            at = self.profiles(states, which)
            fronts.append(crossing(at["X"], at["v"] + self.speed, 0.5 * self.speed))
        speed = np.polyfit(states.times[late], fronts, 1)[0]

        end = self.profiles(states)
        # Clear of the first cells, which remember how the shock began, and of the front.
        flat = (end["X"] > 10 * self.cell) & (end["X"] < fronts[-1] - 15 * self.cell)
        volume = 1 / end["rho"][flat]  # of a unit of mass; all layers have the same mass
        found = {"Us": speed, "p": (end["p"][flat] * volume).sum() / volume.sum(), "rho": 1 / volume.mean(),
                 "e": end["e"][flat].mean()}
        near, far = (crossing(end["X"], end["stress"], level * exact["p"]) for level in (0.9, 0.1))
        return {"error": {name: found[name] / exact[name] - 1 for name in exact},
                "width": (far - near) / self.cell,
                "ripple": end["p"][flat].std() / exact["p"],
                "overshoot": end["stress"][end["X"] > fronts[-1] - 15 * self.cell].max() / exact["p"] - 1}


def crossing(x, values, level):
    """The largest x at which `values` falls through `level`, by linear interpolation."""
    i = np.flatnonzero(values >= level)[-1]
    return x[i] + (x[i + 1] - x[i]) * (values[i] - level) / (values[i] - values[i + 1])


# Elastic bar -------------------------------------------------------------------------------------------------------


@dataclasses.dataclass
class ElasticBar:
    """A bar, fixed at x = 0 and free at x = L, in its first mode: v = V sin(pi x/(2 L)) cos(omega t), omega =
    pi c/(2 L), c^2 = E/rho (Poisson's ratio is zero). Each layer of particles is a body with a velocity of its own.

    V is 1e-4 c: displacements are far below the particles' spacing, so nothing crosses a cell, and the laws' second
    order terms, of the size of the strain V/c, stay below what is measured. No artificial viscosity: it would damp."""

    cells: int
    algorithm: str = "MUSL"
    factor: float = 0.4
    periods: int = 4
    length: float = 25.0
    modulus: float = 117e3
    density: float = COPPER["density"]
    rows: int = 200  # of the .sta file per period

    @property
    def wave_speed(self):
        return (self.modulus / self.density) ** 0.5

    @property
    def period(self):
        return 4 * self.length / self.wave_speed

    def dispersion(self):
        """Relative error of the period to second order in k h and omega dt, k = pi/(2 L), omega dt = factor
        times the scheme's limit times k h.

        Along the bar nodes see u'' through linear elements, 1 - (k h)^2/12 of it, and their velocities come back from
        particles at h/4 and 3h/4 with 1 - 3 (k h)^2/16: omega^2 falls by both. The leapfrog raises omega by
        (omega dt)^2/24."""
        kh = np.pi / (2 * self.cells)
        return (13 / 96 - (self.factor * WAVE_LIMIT[self.algorithm]) ** 2 / 24) * kh**2

    def text(self):
        h = self.length / self.cells
        layers = []
        for i in range(2 * self.cells):
            speed = 1e-4 * self.wave_speed * np.sin(np.pi * (i + 0.5) / (4 * self.cells))
            layers.append(_mpm.block(f"layer{i}", (i * h / 2, 0, 0), (h / 2, h, h), (speed, 0, 0), h / 2, "elastic"))
        elastic = _mpm.material("elastic", self.density, f'type="IsoElastic" Young="{self.modulus}" Poisson="0" bq1="0" bq2="0"')
        return _mpm.scene(layers, _mpm.grid((0, 0, 0), (self.length + 2 * h, h, h), "102222", h),
                          _mpm.solution(self.periods * self.period, self.algorithm, self.factor), [elastic],
                          f'<Console print_time="{self.period / self.rows!r}"/>')

    def measure(self, folder):
        """Relative error of the period, and the relative change of energy from one period to the next.

        The period from the zeros of the momentum. The energy as its mean over a period: within one it swings by
        about omega dt, because velocities stand half a step from stresses."""
        rows = status(folder)
        t, p = rows["time"], rows["px"]
        fall = np.flatnonzero(p[:-1] * p[1:] < 0)
        zeros = t[fall] - p[fall] * (t[fall + 1] - t[fall]) / (p[fall + 1] - p[fall])
        period = 2 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
        even = np.linspace(0, period, 400, endpoint=False)
        start = np.arange(int(t[-1] / period)) * period
        energy = np.array([np.interp(s + even, t, rows["total"]).mean() for s in start])
        return {"period": period / self.period - 1, "drift": np.diff(energy) / energy[:-1]}


def impulse_time(time, algorithm="MUSL"):
    """The times up to which the impulses act, from the times of all explicit steps (core/step/step_length.hpp)."""
    time = np.array(time)
    if algorithm == "USF":
        return time
    steps = np.diff(time)
    lag = np.concatenate([steps[:1], steps]) / 2
    lag[-1] = np.clip(lag[0], lag[-2] - steps[-1], lag[-2] + (1 - 1 / 64) * steps[-1])
    return time + (lag[0] - lag)
