"""The limit load of a ball that moves through rigid, perfectly plastic clay without walls: force over pi R^2 k, k the strength in shear.

The power of the plastic flow, k times the integral of sqrt(2 e:e), is minimised over the velocities without divergence that the ball's
motion allows, plus a share of k times the slip over its surface: 0 for a smooth ball, 1 for a rough one. So the load is approached
from above (the kinematic theorem), but for the divergence that the elements leave. Axisymmetric elements of nine nodes in the
spherical coordinates of the upper half, which the lower one mirrors: the velocity has an even component along the motion. The viscosity
k/sqrt(rate^2 + eps^2) follows the rates from one linear problem to the next while eps falls; an augmented Lagrangian removes the divergence.

Known for the rough ball: A. N. Beris, J. A. Tsamopoulos, R. C. Armstrong and R. A. Brown (J. Fluid Mech. 158 (1985) 219) find that a sphere
moves through a Bingham plastic where the yield stress is below 0.143. With their number read as 2 pi R^2 k over the force
(only the abstract was read) the factor is 13.99, between 13.94 and 14.04 by its three digits."""

import math

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as solvers

BERIS = 2 / 0.143
GAUSS = list(zip(*np.polynomial.legendre.leggauss(3)))


def quadratic(a):
    """The three functions of an edge at -1 < a < 1, and their slopes."""
    return np.array([a * (a - 1) / 2, 1 - a * a, a * (a + 1) / 2]), np.array([a - 0.5, -2 * a, a + 0.5])


class Flow:
    """Velocities (radial and polar) around a ball of radius 1 that moves with velocity 1 along the axis."""

    def __init__(self, elements=24, outer=4.0):
        part = np.linspace(0, 1, elements + 1)
        radii = 1 + (outer - 1) * np.expm1(2.5 * part) / math.expm1(2.5)  # finer towards the ball
        angles = np.pi / 2 * part
        size = 2 * elements + 1
        self.number = np.arange(size * size).reshape(size, size)
        i, j = (axis.ravel() for axis in np.meshgrid(range(elements), range(elements), indexing="ij"))
        nodes = np.stack([self.number[2 * i + a, 2 * j + b] for a in range(3) for b in range(3)], 1)
        self.unknowns = np.stack([2 * nodes, 2 * nodes + 1], 2).reshape(len(i), 18)
        self.points(radii[i], np.diff(radii)[i], angles[j], angles[1])
        self.surface(angles, elements)
        self.bounds(size)

    def points(self, radius, height, angle, width):
        """At the Gauss points: rates by unknown (three direct ones and the shear rate), volumes, functions of the pressure."""
        count = len(radius)
        self.rate, self.volume = np.zeros((count, 9, 4, 18)), np.zeros((count, 9))
        functions = np.zeros((9, 3))
        for q, ((a, w_a), (b, w_b)) in enumerate((p, r) for p in GAUSS for r in GAUSS):
            (n_a, d_a), (n_b, d_b) = quadratic(a), quadratic(b)
            s, t = radius + height * (1 + a) / 2, angle + width * (1 + b) / 2
            value = np.outer(n_a, n_b).ravel() / s[:, None]
            d_s, d_t = np.outer(d_a, n_b).ravel() * 2 / height[:, None], np.outer(n_a, d_b).ravel() * 2 / width / s[:, None]
            self.volume[:, q] = w_a * w_b * height * width / 4 * 2 * np.pi * s * s * np.sin(t)
            functions[q] = 1, a, b
            at = self.rate[:, q]
            at[:, 0, 0::2] = d_s
            at[:, 1, 0::2], at[:, 1, 1::2] = value, d_t
            at[:, 2, 0::2], at[:, 2, 1::2] = value, value / np.tan(t)[:, None]
            at[:, 3, 0::2], at[:, 3, 1::2] = d_t, d_s - value
        self.divergence = np.einsum("eq,qi,eqk->eik", self.volume, functions, self.rate[:, :, :3].sum(2))
        self.inverse = np.linalg.inv(np.einsum("eq,qi,qj->eij", self.volume, functions, functions))

    def surface(self, angles, elements):
        """At the Gauss points of the ball's surface: unknowns of the slip, their functions, angles, areas."""
        places = [(j, a, w) for j in range(elements) for a, w in GAUSS]
        self.slip = np.array([2 * self.number[0, 2 * j:2 * j + 3] + 1 for j, _, _ in places])
        self.function = np.array([quadratic(a)[0] for _, a, _ in places])
        self.angle = np.array([angles[j] + angles[1] * (1 + a) / 2 for j, a, _ in places])
        self.area = np.array([w for _, _, w in places]) * angles[1] / 2 * 2 * np.pi * np.sin(self.angle)

    def bounds(self, size):
        """The ball's normal velocity, rest far away, symmetry on the axis and on the equator's plane."""
        self.known = np.full(2 * size * size, np.nan)
        radial, polar = self.known[0::2].reshape(size, size), self.known[1::2].reshape(size, size)
        radial[:, -1] = polar[:, 0] = 0
        radial[0] = np.cos(np.pi / 2 * np.linspace(0, 1, size))
        radial[-1] = polar[-1] = 0
        self.free = np.flatnonzero(np.isnan(self.known))
        self.known = np.nan_to_num(self.known)

    def load(self, share, rounds=100, smallest=1e-4, penalty=1e5):
        """Force over pi R^2 k; and with this flow in Tresca's clay of the same k, an upper bound there."""
        pressure, eps = np.zeros((len(self.unknowns), 3)), 1.0
        viscosity, drag = np.ones_like(self.volume), np.ones_like(self.area)
        closed = penalty * np.einsum("eik,eij,ejl->ekl", self.divergence, self.inverse, self.divergence)
        square = lambda unknowns, k: (np.repeat(unknowns, k, 1).ravel(), np.tile(unknowns, (1, k)).ravel())
        for _ in range(rounds):
            block = closed + np.einsum("eq,eqik,i,eqil->ekl", self.volume * viscosity, self.rate, [2, 2, 2, 1], self.rate, optimize=True)
            stuck = np.einsum("e,ei,ej->eij", share * self.area * drag, self.function, self.function)
            shape = (len(self.known),) * 2
            matrix = sparse.csr_matrix((block.ravel(), square(self.unknowns, 18)), shape) + sparse.csr_matrix((stuck.ravel(), square(self.slip, 3)), shape)
            load = np.zeros(len(self.known))
            np.add.at(load, self.unknowns, -np.einsum("eik,ei->ek", self.divergence, pressure))
            np.add.at(load, self.slip, -(share * self.area * drag * np.sin(self.angle))[:, None] * self.function)
            velocity = self.known.copy()
            velocity[self.free] = solvers.spsolve(matrix[self.free][:, self.free].tocsc(), (load - matrix @ self.known)[self.free])
            pressure += penalty * np.einsum("eij,ejk,ek->ei", self.inverse, self.divergence, velocity[self.unknowns])
            rates = np.einsum("eqik,ek->eqi", self.rate, velocity[self.unknowns])
            slip = np.einsum("ei,ei->e", self.function, velocity[self.slip]) + np.sin(self.angle)
            shear = np.sqrt(2 * (rates[..., :3] ** 2).sum(-1) + rates[..., 3] ** 2)
            eps = max(0.75 * eps, smallest)
            viscosity, drag = 1 / np.hypot(shear, eps), 1 / np.hypot(slip, eps)
        middle, half = (rates[..., 0] + rates[..., 1]) / 2, np.hypot(rates[..., 0] - rates[..., 1], rates[..., 3]) / 2
        tresca = 2 * np.abs([middle + half, middle - half, rates[..., 2]]).max(0)
        rubbed = share * (self.area * np.abs(slip)).sum()
        return tuple(2 * ((self.volume * part).sum() + rubbed) / np.pi for part in (shear, tresca))


def check(factors):
    """The largest relative difference between the factors, {"smooth": .., "rough": ..}, and the elements."""
    worst = 0.0
    for elements in (12, 24):
        for ball, share in (("smooth", 0), ("rough", 1)):
            mises, tresca = Flow(elements).load(share)
            print(f"elements: {elements} x {elements}, {ball}: {mises:.2f}; the same flow with Tresca's law {tresca:.2f}", flush=True)
            if elements == 24:
                worst = max(worst, abs(factors[ball] / mises - 1))
    return worst
