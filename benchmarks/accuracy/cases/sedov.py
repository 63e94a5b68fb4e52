"""Sedov's blast in three dimensions."""

import numpy as np

import methods
from case import Case, Error, Study
from cases import support

GAMMA, ROOM, RADIUS, COLD = 1.4, 1.2, 1.0, 1e-6


def similarity():
    """r/R, density, pressure and velocity over the values just behind the shock, from the centre outwards: the
    self-similar solution in closed form (L. D. Landau and E. M. Lifshitz, Fluid Mechanics, section 106)."""
    g = GAMMA
    v = np.concatenate([1 / g + np.geomspace(1e-12, 1e-3, 4000), np.linspace(1 / g + 1e-3, 2 / (g + 1), 8001)[1:]])
    n1, n2 = -(13 * g * g - 7 * g + 12) / ((3 * g - 1) * (2 * g + 1)), 5 * (g - 1) / (2 * g + 1)
    n3, n4, n5 = 3 / (2 * g + 1), -n1 / (2 - g), -2 / (2 - g)
    near = (g + 1) / (7 - g) * (5 - (3 * g - 1) * v)
    inner = (g + 1) / (g - 1) * (g * v - 1)
    outer = (g + 1) / (g - 1) * (1 - v)
    r = ((0.5 * (g + 1) * v) ** -2 * near**n1 * inner**n2) ** 0.2
    density = inner**n3 * near**n4 * outer**n5
    velocity = 0.5 * (g + 1) * v * r
    sound = g * (g - 1) * (1 - v) * v * v / (2 * (g * v - 1)) * r * r
    return r, density, density * sound / (density * sound)[-1], velocity


def energy_factor():
    """E t^2/(rho R^5) of the whole space."""
    r, density, pressure, velocity = similarity()
    g, speed = GAMMA, 0.4  # of the shock at R = t = 1
    u, p, rho = 2 / (g + 1) * speed, 2 / (g + 1) * speed**2, (g + 1) / (g - 1)
    per_volume = 0.5 * rho * density * (u * velocity) ** 2 + p * pressure / (g - 1)
    shells = 4 * np.pi * r * r * per_volume
    return float((0.5 * (shells[1:] + shells[:-1]) * np.diff(r)).sum() + shells[0] * r[0] / 3)


class Sedov(Case):
    name = "sedov"
    title = "Sedov's blast"
    about = """An ideal gas (gamma 1.4, density 1) at rest, almost without pressure, in whose corner, one cell of an octant
between symmetry planes, the energy is set free that drives the exact shock to R = 1 at t = 1. Error: mean over the mass
within 1.2 of the density's error over shells, over the density behind the shock. *Radius*: where the density, averaged over
shells a cell thick, is highest."""
    errors = {"density": Error("L1 error of density, %", ".2f", 100), "radius": Error("radius of the peak, %", "+.1f", 100, order=False),
              "peak": Error("peak density, %", "+.1f", 100, order=False), "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"cells": Study("cells along the edge of the octant, 1.2, factor 0.4.", (6, 12, 18, 24), 0.4)}

    def methods(self):
        return methods.short()

    def scene(self, point):
        h, g = ROOM / point.cells, GAMMA - 1
        dp, rest = h / point.split, ROOM - h
        materials, bodies = [], [support.block("spark", (0, 0, 0), (h, h, h), dp, "hot")]
        for name, energy in (("hot", energy_factor() / 8 / h**3), ("cold", COLD / g)):
            equation = f'<EquationOfState type="Polynomial" c0="0" c1="0" c2="0" c3="0" c4="{g!r}" c5="{g!r}" c6="0" E0="{energy!r}"/>'
            materials.append(support.material(name, 1.0, 'type="Null"', equation))
        for name, lower, size in (("x", (h, 0, 0), (rest, h, h)), ("y", (0, h, 0), (ROOM, rest, h)), ("z", (0, 0, h), (ROOM, ROOM, rest))):
            bodies.append(support.block(name, lower, size, dp, "cold"))
        return support.scene(bodies, support.grid((0, 0, 0), (ROOM,) * 3, "222222", h), support.solution(1.0, point.factor),
                             materials, support.pictures(1.0, ["density"]))

    def measure(self, point, folder):
        states, h = support.States(folder), ROOM / point.cells
        radius = np.linalg.norm(support.places(states), axis=1)
        density = states.column("density")
        inside = radius < ROOM
        shell = np.floor(radius[inside] / h).astype(int)
        count = np.maximum(np.bincount(shell), 1)
        found, middle = np.bincount(shell, density[inside]) / count, np.bincount(shell, radius[inside]) / count
        r, exact, _, _ = similarity()
        jump = (GAMMA + 1) / (GAMMA - 1)
        wanted = np.where(middle < RADIUS, jump * np.interp(middle, r, exact), 1.0)
        top = np.argmax(found)
        return {"density": float((np.abs(found - wanted) * count).sum() / count.sum() / jump),
                "radius": middle[top] / RADIUS - 1, "peak": found[top] / jump - 1, "drift": support.drift(folder)}


CASE = Sedov()
