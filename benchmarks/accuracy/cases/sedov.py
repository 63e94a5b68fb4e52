"""Sedov's blast in three dimensions."""

import functools

import numpy as np

import methods
from case import Case, Error, Study
from cases import support

GAMMA, ROOM, RADIUS, COLD = 1.4, 1.2, 1.0, 1e-6
JUMP = (GAMMA + 1) / (GAMMA - 1)  # density behind a strong shock over that before it
SOURCE = 0.2  # edge of the cube, in the octant, in which the energy is set free


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


@functools.cache
def of_source(edge, cells=1200):
    """Radius, mass over 4 pi and density of shells of the gas at t = 1, when the energy is set free in a sphere with the volume
    of eight cubes of this edge, and the total energy over that at the start: in one dimension, Lagrangian, with artificial viscosity
    (J. von Neumann and R. D. Richtmyer, J. Appl. Phys. 21 (1950) 232)."""
    node = np.linspace(0, 1.1 * ROOM, cells + 1)
    mass, density = np.diff(node**3) / 3, np.ones(cells)  # of shells, over 4 pi
    energy, viscous = np.full(cells, COLD / (GAMMA - 1)), np.zeros(cells)
    hot = 0.5 * (node[1:] + node[:-1]) < edge * (6 / np.pi) ** (1 / 3)
    energy[hot] = energy_factor() / (4 * np.pi) / mass[hot].sum()
    first = (mass * energy).sum()
    carried = np.append(0.5 * (mass[1:] + mass[:-1]), 0.5 * mass[-1])  # by the outer node of each shell
    speed, time, last = np.zeros(cells + 1), 0.0, 0.0
    while time < 1:
        pressure = (GAMMA - 1) * density * energy
        sound = np.sqrt(GAMMA * pressure / density)
        dt = min(0.3 * (np.diff(node) / (sound + 4 * np.abs(np.diff(speed)))).min(), 1 - time)
        speed[1:-1] -= 0.5 * (dt + last) * node[1:-1] ** 2 * np.diff(pressure + viscous) / carried[:-1]
        before, volume = viscous, np.diff(node**3) / 3
        node, closing = node + dt * speed, np.diff(speed)
        more = np.diff(node**3) / 3 - volume
        density = mass / (volume + more)
        viscous = np.where(closing < 0, density * (2 * closing**2 - 0.3 * sound * closing), 0)
        # Work of the means over the step of the viscosity and of the pressure, which depends on the new energy.
        work = more / mass
        energy = (energy - work * 0.5 * (pressure + before + viscous)) / (1 + 0.5 * (GAMMA - 1) * density * work)
        time, last = time + dt, dt
    total = (mass * energy).sum() + 0.5 * (carried * speed[1:] ** 2).sum()
    return 0.5 * (node[1:] + node[:-1]), mass, density, total / first


class Sedov(Case):
    name = "sedov"
    title = "Sedov's blast"
    about = """An ideal gas (gamma 1.4, density 1) at rest, almost without pressure, in whose corner, between symmetry planes,
the energy is set free that drives the exact shock of a source without extent to R = 1 at t = 1: in a cube of edge 0.2, or in
one cell. Reference: of the cube, a sphere of the same volume computed in one dimension with 1,200 cells; of one cell, the
exact solution. Error: mean over the mass within 1.2 of the error of the density, over that behind the shock; densities are
means by mass over shells a cell thick. *Radius*: mean radius of the shell with the highest density, *peak*: that density, both over
those of the reference."""
    errors = {"density": Error("L1 error of density, %", ".2f", 100), "radius": Error("radius of the peak, %", "+.1f", 100, order=False),
              "peak": Error("peak density, %", "+.1f", 100, order=False), "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"cells": Study("cells along the edge of the octant, 1.2; source of 0.2; factor 0.4.", (6, 12, 24, 36), 0.4),
               "one cell": Study("the same with a source of one cell.", (6, 12, 18, 24), 0.4)}
    plotted = ("cells",)

    def methods(self):
        return methods.short()

    def scene(self, point):
        h, g = ROOM / point.cells, GAMMA - 1
        s = h if point.study == "one cell" else SOURCE
        dp, rest = h / point.split, ROOM - s
        materials, bodies = [], [support.block("spark", (0, 0, 0), (s, s, s), dp, "hot")]
        for name, energy in (("hot", energy_factor() / 8 / s**3), ("cold", COLD / g)):
            equation = f'<EquationOfState type="Polynomial" c0="0" c1="0" c2="0" c3="0" c4="{g!r}" c5="{g!r}" c6="0" E0="{energy!r}"/>'
            materials.append(support.material(name, 1.0, 'type="Null"', equation))
        for name, lower, size in (("x", (s, 0, 0), (rest, s, s)), ("y", (0, s, 0), (ROOM, rest, s)), ("z", (0, 0, s), (ROOM, ROOM, rest))):
            bodies.append(support.block(name, lower, size, dp, "cold"))
        return support.scene(bodies, support.grid((0, 0, 0), (ROOM,) * 3, "222222", h), support.solution(1.0, point.factor),
                             materials, support.pictures(1.0, ["density"]))

    def reference(self, point):
        """Radius, mass and density of thin shells."""
        if point.study == "cells":
            return of_source(SOURCE)[:3]
        r, exact, _, _ = similarity()
        edge = np.linspace(0, ROOM, 12001)
        middle = 0.5 * (edge[1:] + edge[:-1])
        density = np.where(middle < RADIUS, JUMP * np.interp(middle, r, exact), 1.0)
        return middle, density * np.diff(edge**3) / 3, density

    def measure(self, point, folder):
        states, shells = support.States(folder), point.cells
        radius = np.linalg.norm(support.places(states), axis=1)

        def means(radius, mass, density):
            """Mass of each shell, its mean radius and density."""
            inside = radius < ROOM
            shell = np.floor(radius[inside] * shells / ROOM).astype(int)
            total = np.bincount(shell, mass[inside], shells)
            return total, *(np.bincount(shell, (mass * of)[inside], shells) / np.maximum(total, 1e-300) for of in (radius, density))

        _, middle, found = means(radius, np.ones(len(radius)), states.column("density"))
        weight, exact, wanted = means(*self.reference(point))
        top, highest = np.argmax(found), np.argmax(wanted)
        return {"density": float((np.abs(found - wanted) * weight).sum() / weight.sum() / JUMP),
                "radius": middle[top] / exact[highest] - 1, "peak": found[top] / wanted[highest] - 1, "drift": support.drift(folder)}


CASE = Sedov()
