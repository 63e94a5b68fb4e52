"""An elastic-plastic rod that strikes a smooth rigid wall end on, by axisymmetric finite elements: what the law alone, without particles, grid
and contact, makes of the rods of apps/scenes/symmetric_taylor_impact, which meet at a plane of symmetry.

Explicit steps. Elements of four nodes that move with the material, 2 x 2 Gauss points, with the mean divergence of the element at each of them, so
that plastic flow does not lock. Hypoelastic with Jaumann's rate and radial return, von Mises' yield stress Yield0 + B ep; artificial viscosity as that of
the scene, with the element's smallest width for the cell. Nodes of the foot do not pass the wall, and may leave it."""

import _common  # noqa: F401: says where the next one is
import _symmetric_impact
import numpy as np

DENSITY, YOUNG, POISSON, HARDENING = 2.7e-3, 69e3, 0.3, 105.0  # g/mm3, MPa: the scene's
BULK, SHEAR = YOUNG / (3 * (1 - 2 * POISSON)), YOUNG / (2 * (1 + POISSON))
WAVES = ((BULK + 4 / 3 * SHEAR) / DENSITY) ** 0.5  # m/s
QUADRATIC, LINEAR = 1.5, 0.06  # bq1, bq2
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
POINTS = CORNERS / np.sqrt(3)


class Rod:
    """r, z of the nodes; the foot at z = 0, which moves down at first."""

    def __init__(self, across, speed, yields):
        along = round(across * _symmetric_impact.LENGTH / _symmetric_impact.RADIUS)
        self.number = np.arange((across + 1) * (along + 1)).reshape(across + 1, along + 1)
        r, z = np.meshgrid(np.linspace(0, _symmetric_impact.RADIUS, across + 1), np.linspace(0, _symmetric_impact.LENGTH, along + 1), indexing="ij")
        self.x = np.stack([r.ravel(), z.ravel()], 1)
        n = self.number
        self.nodes = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], 2).reshape(-1, 4)
        self.v = np.tile([0.0, -speed], (len(self.x), 1))
        self.yields = yields
        count = len(self.nodes)
        self.s = np.zeros((count, 4, 4))  # deviator: rr, zz, tt, rz
        self.p, self.strain = np.zeros(count), np.zeros((count, 4))  # pressure; plastic strain
        shape = 0.25 * (1 + POINTS[:, :1] * CORNERS[:, 0]) * (1 + POINTS[:, 1:] * CORNERS[:, 1])
        self.shape = shape  # point, node
        self.slope = 0.25 * np.stack([CORNERS[:, 0] * (1 + POINTS[:, 1:] * CORNERS[:, 1]), CORNERS[:, 1] * (1 + POINTS[:, :1] * CORNERS[:, 0])], 1)
        mass = DENSITY * np.einsum("eq,qa->ea", self.gradients()[2], shape)
        self.mass = np.bincount(self.nodes.ravel(), mass.ravel())

    def gradients(self):
        """Per element and point: gradients of the functions (r, z), functions over the radius, volumes per radian."""
        x = self.x[self.nodes]
        jacobian = np.einsum("qia,eaj->eqij", self.slope, x)
        determinant = jacobian[..., 0, 0] * jacobian[..., 1, 1] - jacobian[..., 0, 1] * jacobian[..., 1, 0]
        inverse = np.stack([np.stack([jacobian[..., 1, 1], -jacobian[..., 0, 1]], -1), np.stack([-jacobian[..., 1, 0], jacobian[..., 0, 0]], -1)], -2)
        gradient = np.einsum("eqij,qja->eqia", inverse, self.slope) / determinant[..., None, None]
        radius = np.einsum("qa,ea->eq", self.shape, x[..., 0])
        return gradient, self.shape / radius[..., None], determinant * radius

    def widths(self):
        """The smallest distance between opposite edges of each element."""
        x = self.x[self.nodes]
        across, along = (x[:, 1] + x[:, 2] - x[:, 0] - x[:, 3]) / 2, (x[:, 2] + x[:, 3] - x[:, 0] - x[:, 1]) / 2
        area = np.abs(across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0])
        return area / np.maximum(np.hypot(*across.T), np.hypot(*along.T))

    def step(self, dt):
        gradient, ring, volume = self.gradients()
        whole = volume.sum(1)
        swell = gradient.copy()  # of the divergence: node, component
        swell[:, :, 0] += ring
        swell = np.einsum("eq,eqia->eia", volume, swell) / whole[:, None, None]
        v = self.v[self.nodes]
        rate = np.einsum("eqia,eaj->eqij", gradient, v)
        divergence = np.einsum("eia,eai->e", swell, v)
        d = np.stack([rate[..., 0, 0], rate[..., 1, 1], np.einsum("eqa,ea->eq", ring, v[..., 0]), (rate[..., 0, 1] + rate[..., 1, 0]) / 2], -1)
        d[..., :3] -= d[..., :3].mean(-1, keepdims=True)
        spin = (rate[..., 1, 0] - rate[..., 0, 1]) / 2 * dt  # W_rz = (dv_r/dz - dv_z/dr)/2
        rr, zz, tt, rz = (self.s[..., i] for i in range(4))
        self.s = np.stack([rr + 2 * spin * rz, zz - 2 * spin * rz, tt, rz + spin * (zz - rr)], -1) + 2 * SHEAR * dt * d
        trial = np.sqrt(1.5 * ((self.s[..., :3] ** 2).sum(-1) + 2 * self.s[..., 3] ** 2))
        more = np.maximum(trial - self.yields - HARDENING * self.strain, 0) / (3 * SHEAR + HARDENING)
        self.s *= (1 - 3 * SHEAR * more / np.maximum(trial, 1e-30))[..., None]
        self.strain += more
        self.p -= BULK * divergence * dt
        width, closing = self.widths(), np.minimum(divergence, 0)
        q = DENSITY * width * (QUADRATIC * width * closing**2 - LINEAR * WAVES * closing)
        rr, zz, tt, rz = (self.s[..., i] * volume for i in range(4))
        tensor = np.stack([np.stack([rr, rz], -1), np.stack([rz, zz], -1)], -1)
        force = np.einsum("eqij,eqja->eai", tensor, gradient) - ((self.p + q) * whole)[:, None, None] * swell.transpose(0, 2, 1)
        force[..., 0] += np.einsum("eq,eqa->ea", tt, ring)
        for axis in range(2):
            self.v[:, axis] -= dt * np.bincount(self.nodes.ravel(), force[..., axis].ravel()) / self.mass
        self.v[self.number[0], 0] = 0
        foot = self.number[:, 0]
        free = self.v[foot, 1].copy()
        self.v[foot, 1] = np.maximum(free, -self.x[foot, 1] / dt)  # not below the wall
        self.wall = (self.mass[foot] * (self.v[foot, 1] - free)).sum() / dt
        self.x += dt * self.v

    def sizes(self):
        """Length between the means over the two faces, and the widest diameter of the side near the foot."""
        ring = np.arange(len(self.number)) / (len(self.number) - 1)
        weight = np.gradient(ring**2)
        foot, end = (np.average(self.x[self.number[:, at], 1], weights=weight) for at in (0, -1))
        side = self.x[self.number[-1, :int(0.3 * self.number.shape[1])], 0]
        return {"L": float(end - foot), "D": float(2 * side.max()), "foot": float(foot)}


def strike(across=12, speed=225.5, yields=311.0, end=0.14):
    """`across`: elements over the radius; sizes in mm after `end` ms, the velocity of the rod, its largest plastic strain; when the wall's
    force fell below a hundredth of its largest, and when the last one acted, in us."""
    rod, time, steps = Rod(across, speed, yields), 0.0, 0
    start = 0.5 * (rod.mass * (rod.v**2).sum(1)).sum()
    forces = []
    while time < end:
        dt = min(0.4 * rod.widths().min() / WAVES, end - time)
        rod.step(dt)
        time += dt
        steps += 1
        forces.append((1e3 * time, rod.wall))
    when, force = np.array(forces).T
    released, parted = (float(when[np.flatnonzero(force > share * force.max())[-1]]) for share in (0.01, 0))
    velocity = (rod.mass @ rod.v[:, 1]) / rod.mass.sum()
    return {"across": across, "yields": yields, "steps": steps, **rod.sizes(), "released": released, "parted": parted,
            "speed": float(velocity), "strain": float(rod.strain.max()),
            "kinetic": float(0.5 * (rod.mass * (rod.v**2).sum(1)).sum() / start)}
