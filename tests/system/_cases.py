"""Scenes with known answers, for the physics tests here and for the validations, and how their results are read.

Units: mm, g, ms; so velocities in m/s, forces in N, stresses in MPa, energies in microjoule."""

import dataclasses
import pathlib

import h5py
import numpy as np

import _mpm

COPPER = {"density": 8.93e-3, "c0": 3940.0, "s1": 1.49, "gamma0": 1.96}


# What a run leaves -------------------------------------------------------------------------------------------------


class States:
    """The times in an H5Part file; columns in the order of the particles' identities, at which they never change."""

    def __init__(self, path):
        self.file = h5py.File(path)
        names = sorted((n for n in self.file if n.startswith("Step#")), key=lambda n: int(n[5:]))
        self.steps = [self.file[name] for name in names]
        self.times = np.array([float(step.attrs["TimeValue"]) for step in self.steps])

    def column(self, name, which):
        step = self.steps[which]
        return step[name][:][np.argsort(step["id"][:])].astype(float)


def status(folder, job="case"):
    """Rows of the .sta file by column name."""
    return {name: np.array(values) for name, values in _mpm.table(pathlib.Path(folder) / f"{job}.sta").items()}


# Plane shock -------------------------------------------------------------------------------------------------------


@dataclasses.dataclass
class Shock:
    """A copper bar in uniaxial strain (symmetry planes at its sides) that hits a wall, a symmetry plane, at x = 0.

    The copper has no strength (StrengthModel Null), so the jump conditions with Us = c0 + s1 up are its whole story:
    p = rho0 Us up, rho/rho0 = Us/(Us - up), e = up^2/2 (thesis 2-60 to 2-62)."""

    speed: float  # of the bar, and of the particles behind the shock seen from those before it
    cell: float = 1.0
    cells: int = 100  # along the bar
    across: int = 2
    split: int = 2  # particles along a cell
    algorithm: str = "MUSL"
    factor: float = 0.4
    bq1: float = 1.5
    bq2: float = 0.06

    @property
    def length(self):
        return self.cells * self.cell

    @property
    def shock_speed(self):
        return COPPER["c0"] + COPPER["s1"] * self.speed

    @property
    def end(self):
        """The shock has passed 0.8 of the bar; the wave from its free end, which starts then at the earliest at the
        end, is still to come."""
        return 0.8 * self.length / self.shock_speed

    def exact(self):
        up, us, rho0 = self.speed, self.shock_speed, COPPER["density"]
        return {"Us": us, "p": rho0 * us * up, "rho": rho0 * us / (us - up), "e": up * up / 2}

    def text(self):
        width, c = self.across * self.cell, COPPER
        copper = _mpm.material("copper", c["density"], f'type="Null" bq1="{self.bq1}" bq2="{self.bq2}"',
                               f'<EquationOfState type="Gruneisen" C0="{c["c0"]}" S1="{c["s1"]}" gamma0="{c["gamma0"]}"/>')
        bar = _mpm.block("bar", (0, 0, 0), (self.length, width, width), (-self.speed, 0, 0), self.cell / self.split, "copper")
        # Eight pictures on the second half of the way.
        output = (f'<PostProcessing time_interval="{self.end / 16!r}" h5part="1" var="pres|density|engi|SigmaX"/>')
        return _mpm.scene([bar], _mpm.grid((0, 0, 0), (self.length + 2 * self.cell, width, width), "202222", self.cell),
                          _mpm.solution(self.end, self.algorithm, self.factor), [copper], output)

    def measure(self, folder):
        """Shock speed, mean state of the plateau, its oscillation and the width of the front, from the run's files.

        Everything over the particles' first places X: the shock runs through them at Us."""
        states = States(pathlib.Path(folder) / "case.h5part")
        first = states.column("x", 0)
        layers, layer = np.unique(np.round(first / self.cell, 3), return_inverse=True)
        count = np.bincount(layer)
        exact = self.exact()

        def profile(values):
            return np.bincount(layer, values) / count

        mass = COPPER["density"] * (self.cell / self.split) ** 3
        fronts = []
        for which in range(len(states.times) // 2, len(states.times)):
            fronts.append(crossing(layers, -profile(states.column("SigmaX", which)), 0.5 * exact["p"]) * self.cell)
        speed = np.polyfit(states.times[len(states.times) // 2:], fronts, 1)[0]

        last = len(states.times) - 1
        stress, p, rho = -profile(states.column("SigmaX", last)), profile(states.column("pres", last)), profile(states.column("density", last))
        e = profile(states.column("engi", last)) / mass
        x = profile(states.column("x", last))
        width = crossing(layers, stress, 0.1 * exact["p"]) - crossing(layers, stress, 0.9 * exact["p"])
        # Clear of the first ten cells, which remember how the shock began, and of the front.
        plateau = np.flatnonzero((layers > 10) & (layers < fronts[-1] / self.cell - 15))
        v = 1 / rho
        state = {"Us": speed, "p": (p * v)[plateau].sum() / v[plateau].sum(), "rho": 1 / v[plateau].mean(), "e": e[plateau].mean()}
        a, b = plateau[0], plateau[-1]
        geo = COPPER["density"] * (layers[b] - layers[a]) * self.cell / (x[b] - x[a])
        return {"error": {name: state[name] / exact[name] - 1 for name in exact}, "width": width,
                "ripple": p[plateau].std() / exact["p"], "peak": stress.max() / exact["p"] - 1,
                "layers": layers, "pressure": p, "stress": stress, "geo": geo / exact["rho"] - 1, "pm": p[plateau].mean()/exact["p"]-1,"u":states.column("velocity_0",last)}


def crossing(x, values, level):
    """The largest x at which `values` falls through `level`, by linear interpolation."""
    i = np.flatnonzero(values >= level)[-1]
    return x[i] + (x[i + 1] - x[i]) * (values[i] - level) / (values[i] - values[i + 1])
