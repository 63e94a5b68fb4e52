"""Explosives and gases on a line, with known answers, for physics_detonation.py and the validation.

A column one cell wide between symmetry planes, with one particle to a layer in its middle: uniaxial strain to the last
bit, at the price of a line. Units: mm, g, ms; so velocities in m/s, stresses in MPa."""

import dataclasses

import numpy as np

import _cases
import _mpm

# Manual, table 6.5: density, CJ state and JWL of TNT.
TNT = {"density": 1.63e-3, "D": 6930.0, "pcj": 21e3, "A": 371.2e3, "B": 3.23e3, "R1": 4.15, "R2": 0.95, "w": 0.30, "E0": 7.0e3}


def explosive(name="TNT", beta=2, more=""):
    strength = 'type="HighExpBurn" D="{D}" beta="{0}" PCJ="{pcj}" {1}'.format(beta, more, **TNT)
    eos = '<EquationOfState type="JWL" A="{A}" B="{B}" R1="{R1}" R2="{R2}" w="{w}" E0="{E0}"/>'.format(**TNT)
    return _mpm.material(name, TNT["density"], strength, eos)


def lit_at(x, time=0.0):
    """A plane across the column."""
    return (f'<Detonation><Item type="plane" time="{time}" normal="0" location="{x!r}" left="-1e6" right="1e6" '
            'bottom="-1e6" top="1e6"/></Detonation>')


def layers(name, lower, upper, size, cell, of, density, velocity=0.0):
    """A body of layers `size` thick from `lower` to `upper`, in a column of one cell."""
    count = round((upper - lower) / size)
    mass = density * cell * cell * (upper - lower) / count
    points = "".join(f'<Point mass="{mass!r}" x="{lower + (i + 0.5) * (upper - lower) / count!r}" y="{cell / 2!r}" '
                     f'z="{cell / 2!r}"/>' for i in range(count))
    return (f'<Body name="{name}" material="{of}" type="Point"><Geometry>{points}</Geometry>'
            f'<InitialVelocity vx="{velocity!r}" vy="0" vz="0"/></Body>')


def column(lower, upper, cell, faces):
    """The grid around the column; `faces`: the boundary types at its ends."""
    return _mpm.grid((lower, 0, 0), (upper, cell, cell), faces + "2222", cell)


# The products' isentrope -------------------------------------------------------------------------------------------


class Products:
    """TNT's products on the isentrope through the CJ state of its JWL, where the Rayleigh line touches the adiabat."""

    def __init__(self):
        v = np.linspace(0.6, 0.9, 300001)
        cold, w = self.cold(v), TNT["w"]
        adiabat = (cold + w / v * TNT["E0"]) / (1 - w / v * (1 - v) / 2)
        at = np.argmin(adiabat / (1 - v))
        self.v_cj, self.p_cj = v[at], adiabat[at]
        self.d = np.sqrt(self.p_cj / (1 - self.v_cj) / TNT["density"])
        self.u_cj = (1 - self.v_cj) * self.d
        exponents = sum(TNT[f] * np.exp(-TNT[r] * self.v_cj) for f, r in (("A", "R1"), ("B", "R2")))
        self.c = (self.p_cj - exponents) * self.v_cj ** (1 + w)

    @staticmethod
    def cold(v):
        """a of p = a + w E/V."""
        return sum(TNT[f] * (1 - TNT["w"] / (TNT[r] * v)) * np.exp(-TNT[r] * v) for f, r in (("A", "R1"), ("B", "R2")))

    def pressure(self, v):
        return TNT["A"] * np.exp(-TNT["R1"] * v) + TNT["B"] * np.exp(-TNT["R2"] * v) + self.c * v ** (-1 - TNT["w"])

    def sound(self, v):
        slope = (TNT["A"] * TNT["R1"] * np.exp(-TNT["R1"] * v) + TNT["B"] * TNT["R2"] * np.exp(-TNT["R2"] * v)
                 + (1 + TNT["w"]) * self.c * v ** (-2 - TNT["w"]))
        return v * np.sqrt(slope / TNT["density"])

    def taylor_wave(self):
        """x/t, pressure and velocity behind a front from a wall, from the wall's state up to the CJ state.

        A simple wave: x/t = u + c, du = -c dV/V, down to u = 0, and matter at rest from there to the wall."""
        v = np.linspace(self.v_cj, 2, 20001)
        c = self.sound(v)
        u = self.u_cj - np.concatenate([[0], np.cumsum(0.5 * (c[1:] / v[1:] + c[:-1] / v[:-1]) * np.diff(v))])
        moving = u > 0
        way, p, u = (u + c)[moving][::-1], self.pressure(v)[moving][::-1], u[moving][::-1]
        return np.concatenate([[0], way]), np.concatenate([[p[0]], p]), np.concatenate([[0], u])


@dataclasses.dataclass
class Detonation:
    """TNT lit along a wall, x = 0, until the front has run through 0.9 of it. The `booster`, a part of the length, has
    programmed burn, the rest burns by `beta`."""

    cells: int = 200
    split: int = 8
    length: float = 100.0
    beta: int = 2
    booster: float = 0.0
    algorithm: str = "MUSL"
    factor: float = 0.2
    bq1: float = 1.5
    bq2: float = 0.06
    pictures: int = 18

    @property
    def cell(self):
        return self.length / self.cells

    @property
    def end(self):
        return 0.9 * self.length / TNT["D"]

    def text(self):
        h = self.cell
        def bar(name, lower, upper):
            return layers(name, lower, upper, h / self.split, h, name, TNT["density"])

        booster = self.booster * self.length
        bodies, materials = [], []
        for name, lower, upper, beta in (("booster", 0, booster, 2), ("charge", booster, self.length, self.beta)):
            if upper > lower:
                bodies.append(bar(name, lower, upper))
                materials.append(explosive(name, beta, f'bq1="{self.bq1}" bq2="{self.bq2}"'))
        return _mpm.scene(bodies, column(0, self.length + 4 * h, h, "20"), _mpm.solution(self.end, self.algorithm, self.factor),
                          materials,
                          f'<PostProcessing time_interval="{self.end / self.pictures!r}" h5part="1" var="pres|density|engi|SigmaX"/>',
                          lit_at(0.0))

    def profile(self, states, which=-1):
        x = states.column("x", which)
        order = np.argsort(x)
        return {"X": states.column("x", 0)[order], "x": x[order], "p": states.column("pres", which)[order],
                "stress": -states.column("SigmaX", which)[order], "rho": states.column("density", which)[order],
                "v": states.column("velocity_0", which)[order]}

    def means(self, profile):
        """Over the particles of each cell's worth of matter: the noise of particles that cross cells is finer."""
        n = self.split
        count = len(profile["X"]) // n * n
        return {name: values[:count].reshape(-1, n).mean(axis=1) for name, values in profile.items()}

    def measure(self, folder):
        """Relative errors: speed of the front; highest pressure and velocity, as means over cells, against the CJ state;
        pressure and velocity of the whole wave against the exact one, in the mean (L1)."""
        states, exact = _cases.States(folder), Products()
        late = range(round(len(states.times) * max(0.25, self.booster + 0.1)), len(states.times))
        fronts = []
        for which in late:
            mean = self.means(self.profile(states, which))
            # The first rise through half of the CJ pressure, at its place in the unmoved explosive.
            fronts.append(_cases.crossing(mean["X"], mean["p"], 0.5 * exact.p_cj))
        speed = np.polyfit(states.times[late], fronts, 1)[0]
        peaks = [self.means(self.profile(states, which)) for which in range(3 * len(states.times) // 4, len(states.times))]

        end = self.means(self.profile(states))
        way, p, u = exact.taylor_wave()
        front = TNT["D"] * states.times[-1]
        inside = end["x"] < front
        exact_p = np.where(inside, np.interp(end["x"] / states.times[-1], way, p), 0)
        exact_u = np.where(inside, np.interp(end["x"] / states.times[-1], way, u), 0)
        return {"D": speed / TNT["D"] - 1, "peak": np.mean([m["p"].max() for m in peaks]) / exact.p_cj - 1,
                "speed": np.mean([m["v"].max() for m in peaks]) / exact.u_cj - 1,
                "L1 p": np.abs(end["p"] - exact_p).mean() / np.abs(exact_p).mean(),
                "L1 u": np.abs(end["v"] - exact_u).mean() / np.abs(exact_u).mean(),
                "energy": _mpm.summary(folder)["energy"]["relative_drift"]}


# Open-faced sandwich -----------------------------------------------------------------------------------------------


@dataclasses.dataclass
class Sandwich:
    """A copper plate that TNT drives from one side, the explosive's other face free; lit there, or at the plate.

    Gurney: the gas has constant density and a velocity linear in the mass, all of the energy E per mass is kinetic:
    v/sqrt(2 E) = (((1 + 2 M/C)^3 + 1)/(6 (1 + M/C)) + M/C)^(-1/2) (J. E. Kennedy, Gurney energy of explosives, Sandia
    Laboratories SC-RR-70-790, 1970, eq. 4). sqrt(2 E) of TNT: 2.37 and 2.44 mm/us (his table 2, from cylinder tests and
    from I. G. Henry, 1967)."""

    ratio: float  # C/M: mass of explosive over that of the plate
    cells: int = 100  # along the explosive
    split: int = 12
    thickness: float = 50.0  # of the explosive
    lit: str = "free"  # face: free or plate
    expansion: float = 12.0  # the run ends when a wave at D could have passed the explosive so many times
    algorithm: str = "MUSL"
    factor: float = 0.2

    @property
    def cell(self):
        return self.thickness / self.cells

    @property
    def plate(self):
        return self.thickness * TNT["density"] / _cases.COPPER["density"] / self.ratio

    @property
    def end(self):
        return self.expansion * self.thickness / TNT["D"]

    def gurney(self, velocity):
        m = 1 / self.ratio
        return velocity / (((1 + 2 * m) ** 3 + 1) / (6 * (1 + m)) + m) ** 0.5

    def text(self):
        h, length = self.cell, self.thickness
        bodies = [layers("TNT", 0, length, h / self.split, h, "TNT", TNT["density"]),
                  layers("plate", length, length + self.plate, h / self.split, h, "copper", _cases.COPPER["density"])]
        left = -h * np.ceil(2 * TNT["D"] * self.end / h)
        right = length + self.plate + h * np.ceil(0.5 * TNT["D"] * self.end / h)
        right = left + h * np.ceil((right - left) / h)
        return _mpm.scene(bodies, column(float(left), float(right), h, "00"), _mpm.solution(self.end, self.algorithm, self.factor),
                          [explosive(), _cases.copper('type="Null"')],
                          f'<Console print_time="{self.end / 40!r}"/>',
                          lit_at(0.0 if self.lit == "free" else length))

    def measure(self, folder):
        """Velocity of the plate's mass centre at the end, its growth over the last quarter of the run, and the largest
        loss of momentum, over what the plate has."""
        rows, last = _cases.status(folder), 0.75 * self.end
        v = rows["vx[body:plate]"]
        return {"v": v[-1], "growth": 1 - np.interp(last, rows["time"], v) / v[-1],
                "momentum": np.abs(rows["px"]).max() / rows["px[body:plate]"][-1],
                "kinetic": (2 * rows["kinetic"][-1] / (TNT["density"] * self.thickness * self.cell**2)) ** 0.5,
                "energy": rows["relative_drift"][-1]}

    def lagrange(self, zones=400, factor=0.3):
        """The plate's velocity by another method: zones that move with the matter (J. von Neumann and R. D. Richtmyer,
        J. Appl. Phys. 21, 1950), with the same laws, artificial viscosity and lighting."""
        length, size = self.thickness, self.thickness / zones
        plate = round(self.plate / size) or 1
        x = np.concatenate([np.arange(zones + 1) * size, length + (np.arange(plate) + 1) * self.plate / plate])
        burns = np.arange(zones + plate) < zones
        copper = _cases.COPPER
        rho0 = np.where(burns, TNT["density"], copper["density"])
        first = np.diff(x)
        middle = 0.5 * (x[1:] + x[:-1])
        lit = (middle if self.lit == "free" else length - middle) / TNT["D"]
        mass = np.convolve(rho0 * first, [0.5, 0.5])
        u, energy = np.zeros(len(x)), np.where(burns, TNT["E0"], 0.0)
        p, q, time = np.zeros(len(first)), np.zeros(len(first)), 0.0
        stiffness, v = copper["density"] * copper["c0"] ** 2, np.ones(len(first))
        while time < self.end:
            def line(v):
                """p = a + b E and da/dV, db/dV of what all is burnt."""
                ends = [(TNT[f] * np.exp(-TNT[r] * v), TNT[r]) for f, r in (("A", "R1"), ("B", "R2"))]
                w = TNT["w"]
                gas = sum(e * (1 - w / (r * v)) for e, r in ends), w / v
                gas_slope = sum(e * (w / (r * v * v) - r + w / v) for e, r in ends), -w / v**2
                mu, s1, g = np.maximum(1 / v - 1, 0), copper["s1"], copper["gamma0"]
                top, pole = mu * (1 + (1 - g / 2) * mu), 1 - (s1 - 1) * mu
                solid = stiffness * (top / pole**2 + np.minimum(1 / v - 1, 0))
                rise = (1 + (2 - g) * mu + 2 * (s1 - 1) * top / pole) / pole**2
                return (np.where(burns, gas[0], solid), np.where(burns, gas[1], g),
                        np.where(burns, gas_slope[0], -stiffness / v**2 * np.where(v < 1, rise, 1)),
                        np.where(burns, gas_slope[1], 0.0))

            a, b, da, db = line(v)
            c = v * np.sqrt(np.maximum(p * b - da - db * energy, 0) / rho0)
            gap = np.diff(x)
            rate = np.maximum(-np.diff(u) / gap, 0)
            dt = min(factor * (gap / (c + 3 * gap * rate)).min(), factor * first[0] / TNT["D"], self.end - time + 1e-15)
            u = u - dt * np.diff(np.concatenate([[0], p + q, [0]])) / mass
            x = x + dt * u
            time += dt
            new = np.diff(x) / first
            rate, gap = np.maximum(-np.diff(u) / np.diff(x), 0), np.diff(x)
            q_old, q = q, rho0 / new * gap * rate * (1.5 * gap * rate + 0.06 * c)
            share = np.where(burns, np.clip((time - lit) * TNT["D"] / (1.5 * first), 0, 1), 1.0)
            a, b, _, _ = line(new)
            h = 0.5 * (new - v)
            star = energy - h * (p + q_old + q)
            p = share * (a + b * star) / (1 + share * b * h)
            energy, v = star - h * p, new
        moving = ~burns
        weight = (rho0 * first)[moving]
        return (weight * 0.5 * (u[1:] + u[:-1])[moving]).sum() / weight.sum()


# Shock tube --------------------------------------------------------------------------------------------------------


def riemann(left, right, gamma):
    """G. A. Sod's problem (J. Comput. Phys. 27, 1978) and its like: rho, u, p over x/t, for two gases of one gamma at
    states (rho, u, p), by the exact solution with a rarefaction on the left and a shock on the right."""
    (r1, u1, p1), (r4, u4, p4) = left, right
    a1, g = np.sqrt(gamma * p1 / r1), gamma

    def behind_shock(p):
        return u4 + (p - p4) * np.sqrt(2 / r4 / ((g + 1) * p + (g - 1) * p4))

    def behind_fan(p):
        return u1 + 2 * a1 / (g - 1) * (1 - (p / p1) ** ((g - 1) / (2 * g)))

    low, high = p4, p1
    for _ in range(200):
        p = 0.5 * (low + high)
        low, high = (p, high) if behind_shock(p) < behind_fan(p) else (low, p)
    u = behind_shock(p)
    r2, jump = r1 * (p / p1) ** (1 / g), p / p4
    r3 = r4 * ((g + 1) * jump + g - 1) / ((g - 1) * jump + g + 1)
    shock = u4 + (u - u4) * r3 / (r3 - r4)
    a2 = np.sqrt(g * p / r2)

    def at(way):
        fan_u = 2 / (g + 1) * (a1 + (g - 1) / 2 * u1 + way)
        fan_a = fan_u - way
        fan_r = r1 * (np.maximum(fan_a, 1e-12) / a1) ** (2 / (g - 1))
        where = [way < u1 - a1, way < u - a2, way < u, way < shock]
        return {"rho": np.select(where, [r1, fan_r, r2, r3], r4), "v": np.select(where, [u1, fan_u, u, u], u4),
                "p": np.select(where, [p1, p1 * (fan_r / r1) ** g, p, p], p4)}

    return at


@dataclasses.dataclass
class ShockTube:
    """Sod's tube: (rho, u, p) = (1, 0, 1) and (0.125, 0, 0.1), gamma 1.4, to t = 0.2. Each gas is Null with Polynomial,
    c4 = c5 = gamma - 1, and E0 = p/(gamma - 1). Units are nobody's."""

    cells: int = 200
    split: int = 16
    algorithm: str = "MUSL"
    factor: float = 0.2
    bq1: float = 1.5
    bq2: float = 0.06
    gamma: float = 1.4
    end: float = 0.2
    left: tuple = (1.0, 0.0, 1.0)
    right: tuple = (0.125, 0.0, 0.1)

    def gas(self, name, state):
        g = self.gamma - 1
        eos = ('<EquationOfState type="Polynomial" c0="0" c1="0" c2="0" c3="0" '
               f'c4="{g!r}" c5="{g!r}" c6="0" E0="{state[2] / g!r}"/>')
        return _mpm.material(name, state[0], f'type="Null" bq1="{self.bq1}" bq2="{self.bq2}"', eos)

    def text(self):
        h = 1 / self.cells
        bodies = [layers("left", 0, 0.5, h / self.split, h, "dense", self.left[0]),
                  layers("right", 0.5, 1, h / self.split, h, "thin", self.right[0])]
        return _mpm.scene(bodies, column(0, 1, h, "22"), _mpm.solution(self.end, self.algorithm, self.factor),
                          [self.gas("dense", self.left), self.gas("thin", self.right)],
                          f'<PostProcessing time_interval="{self.end}" h5part="1" var="pres|density|engi"/>')

    def profile(self, states, which=-1):
        """Means over the particles of each first cell, and the exact solution at the same places."""
        names = {"x": "x", "rho": "density", "v": "velocity_0", "p": "pres"}
        found = {name: states.column(column, which).reshape(-1, self.split).mean(axis=1) for name, column in names.items()}
        return found, riemann(self.left, self.right, self.gamma)((found["x"] - 0.5) / states.times[which])

    def measure(self, folder):
        """Mean absolute errors over the tube, each over its largest exact value."""
        states = _cases.States(folder)
        found, exact = self.profile(states)
        length = np.gradient(found["x"])
        error = {name: (np.abs(found[name] - exact[name]) * length).sum() / length.sum() / np.abs(exact[name]).max()
                 for name in ("rho", "p", "v")}
        return {**error, "energy": _mpm.summary(folder)["energy"]["relative_drift"]}
