"""Largest stable steps by a linear analysis in one dimension, in units of h/c.

With positions, volumes and domains held, a step of a free elastic bar is a linear map of its particles' velocities and stresses
(and affine velocities). It is stable if no eigenvalue of the map exceeds one. The particles, two in a cell, are up to h/4 from
their places in a row, at random, and the row lies anywhere in the grid; the limit is the least of 200 such packings. MUSL and
USF have the same one: their maps are those of the same two half steps, begun with either. What the analysis leaves out:
particles that cross cells from step to step, three dimensions, large strains, artificial viscosity."""

import functools

import numpy as np

CELLS, PER_CELL = 8, 2  # of the body
GROWTH = 1e-6  # of the largest eigenvalue in a step: round-off of defective ones is below
PACKINGS = 200
USL_MASS_FLOOR = 0.2  # of a full node, as in core/step/passes_with.hpp
AFLIP_DAMPING = 0.01  # core/transfer/affine.hpp


def bspline(x, degree):
    """Value and slope of the centred B-spline."""
    if degree == 0:
        return np.where((x >= -0.5) & (x < 0.5), 1.0, 0.0), np.zeros_like(x)
    half = (degree + 1) / 2
    left, right = bspline(x + 0.5, degree - 1)[0], bspline(x - 0.5, degree - 1)[0]
    return ((half + x) * left + (half - x) * right) / degree, left - right


def box_mean(x, half):
    """The linear function's mean over a box of half size `half`, and its slope."""
    def integral(t):  # of max(0, 1 - |t|) from -1
        t = np.clip(t, -1, 1)
        return np.where(t < 0, 0.5 * (1 + t) ** 2, 1 - 0.5 * (1 - t) ** 2)

    def value(t):
        return np.maximum(0, 1 - np.abs(t))
    return (integral(x + half) - integral(x - half)) / (2 * half), (value(x + half) - value(x - half)) / (2 * half)


def functions(shape, x, nodes):
    """Values and gradients of the nodes' functions at the particles, each nodes x particles; h = 1."""
    distance = x[None, :] - nodes[:, None]
    linear = bspline(distance, 1)
    if shape in ("QuadraticBSpline", "CubicBSpline"):
        return bspline(distance, 2 if shape == "QuadraticBSpline" else 3)
    if shape in ("uGIMP", "cpGIMP", "CPDI", "CPDI2"):  # the same as long as the domains are those of the start
        return box_mean(distance, 0.5 / PER_CELL)
    centres = nodes[:-1] + 0.5
    from_nodes = 0.5 * (np.eye(len(centres), len(nodes)) + np.eye(len(centres), len(nodes), 1))
    differences = np.eye(len(centres), len(nodes), 1) - np.eye(len(centres), len(nodes))
    if shape == "SGMP":
        weights = bspline(x[None, :] - centres[:, None], 1)[0]
        return from_nodes.T @ weights, differences.T @ weights
    if shape == "DDMP":
        f = x - np.floor(x)
        alpha = 4 * f * (1 - f)
        used = np.isin(np.floor(nodes[:-1]), np.floor(x)).astype(float)
        around = np.eye(len(nodes), len(centres)) + np.eye(len(nodes), len(centres), -1)
        count = around @ used
        mean = np.divide(around @ (used[:, None] * differences), count[:, None], out=np.zeros((len(nodes), len(nodes))),
                         where=count[:, None] > 0)
        return linear[0], alpha * linear[1] + (1 - alpha) * (mean.T @ linear[0])
    return linear


def packing(seed):
    """Places of a bar's particles."""
    random = np.random.default_rng(seed)
    count = CELLS * PER_CELL
    return (np.arange(count) + 0.5 + random.uniform(-0.5, 0.5, count)) / PER_CELL + random.uniform(0, 1)


class Bar:
    """The matrices of one shape for particles at x, each of the volume 1/2."""

    def __init__(self, shape, x):
        self.x = np.asarray(x)
        self.nodes = np.arange(np.floor(self.x.min()) - 3, np.floor(self.x.max()) + 5)
        self.volume = 1 / PER_CELL
        values, gradients = functions(shape, self.x, self.nodes)
        mass = values.sum(axis=1) * self.volume
        kept = mass > 1e-10
        self.nodes, self.values, self.gradients, self.mass = self.nodes[kept], values[kept], gradients[kept], mass[kept]
        self.stress_to_acceleration = -self.volume * self.gradients / self.mass[:, None]
        self.inertia = {"QuadraticBSpline": 0.25, "CubicBSpline": 1 / 3}.get(shape)

    def map_velocity(self):
        return self.volume * self.values / self.mass[:, None]

    def arms(self):
        return self.nodes[:, None] - self.x[None, :]

    def affine_gradient(self, transfer):
        """Nodal velocities to the particles' affine velocities."""
        if transfer == "TPIC":
            return self.gradients.T
        moments = self.values * self.arms() ** 2
        inertia = self.inertia or np.maximum(moments.sum(axis=0), 1e-12)
        return (self.values * self.arms()).T / (inertia if self.inertia else inertia[:, None])

    def step(self, scheme, transfer, dt):
        """The map of a step."""
        n = len(self.x)
        affine = transfer in ("APIC", "TPIC", "AFLIP")
        size = (3 if affine else 2) * n
        v, s = np.eye(n, size), np.eye(n, size, n)
        c = np.eye(n, size, 2 * n)
        to_grid, to_particles, gradient = self.map_velocity(), self.values.T, self.gradients.T
        part = 0.5 if scheme == "USAVG" else 1.0  # of the step, in an update of the stresses
        momentum = to_grid @ v
        if affine:
            momentum = momentum + (to_grid * self.arms()) @ c
        if scheme in ("USF", "USAVG"):
            s = s + part * dt * gradient @ momentum
        increment = dt * self.stress_to_acceleration @ s
        end = momentum + increment
        if transfer == "FLIP":
            v = v + to_particles @ increment
        elif transfer == "AFLIP":
            share = AFLIP_DAMPING * dt
            v = (1 - share) * (v + to_particles @ increment) + share * to_particles @ end
        elif transfer in ("XPIC", "FMPM"):  # of order 2
            first = momentum if transfer == "XPIC" else end
            v = to_particles @ (end + first - to_grid @ to_particles @ first)
        else:
            v = to_particles @ end
        if affine:
            c = self.affine_gradient("TPIC" if transfer == "TPIC" else "APIC") @ end
        if scheme in ("MUSL", "USAVG"):
            again = to_grid @ v
            if affine:
                again = again + (to_grid * self.arms()) @ c
            s = s + part * dt * gradient @ again
        elif scheme == "USL":
            omitted = np.maximum(0, 1 - self.mass / USL_MASS_FLOOR)
            s = s + dt * gradient @ (end - omitted[:, None] * increment)
        return np.vstack([v, s, c] if affine else [v, s])

    def stable(self, scheme, transfer, dt):
        return np.abs(np.linalg.eigvals(self.step(scheme, transfer, dt))).max() <= 1 + GROWTH


@functools.cache
def limit(shape, scheme, transfer="FLIP", packings=PACKINGS, within=0.01, high=4.0, low=0.02):
    """Least over the packings of the largest stable step; 0 if there is none above `low`."""
    for seed in range(packings):
        bar = Bar(shape, packing(seed))
        if bar.stable(scheme, transfer, high):
            continue
        if not bar.stable(scheme, transfer, low):
            return 0.0
        below = low
        while high > (1 + within) * below:
            middle = (below * high) ** 0.5
            if bar.stable(scheme, transfer, middle):
                below = middle
            else:
                high = middle
        high = below
    return high
