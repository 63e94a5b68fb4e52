"""An elastic ball that its own inertia presses on a rigid plane: linear elasticity, static, by axisymmetric finite elements.

The approach is that of the ball's centre of mass under a uniform acceleration; Hertz's law is that of half spaces, and too
soft for it: F/F_Hertz(x) = 1 + 0.93 s + s^2 with s = sqrt(x/R) fits these elements to 0.5 % (Poisson's ratio 0.4, x/R from
0.003 to 0.08). Four-node elements in polar coordinates, finer towards the pole of contact; nodes on the plane stay there
while they press on it."""

import _common  # noqa: F401: says where the next one is
import _gallery
import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as solvers

R, E, NU = _gallery.RADIUS, _gallery.YOUNG, _gallery.POISSON
ELASTICITY = E / ((1 + NU) * (1 - 2 * NU)) * np.array(
    [[1 - NU, NU, NU, 0], [NU, 1 - NU, NU, 0], [NU, NU, 1 - NU, 0], [0, 0, 0, (1 - 2 * NU) / 2]])  # rr, zz, tt, rz


class Ball:
    """The ball on z = 0, its lowest point at the origin."""

    def __init__(self, radial=40, around=110):
        s = R * (1 - (1 - np.arange(1, radial + 1) / radial) ** 2)
        angle = np.pi * (np.arange(around + 1) / around) ** 1.7
        self.number = np.zeros((radial + 1, around + 1), int)  # the centre is node 0
        self.number[1:] = 1 + np.arange(radial * (around + 1)).reshape(radial, -1)
        r, z = (np.concatenate([[0], np.outer(s, f).ravel()]) for f in (np.sin(angle), -np.cos(angle)))
        r[np.abs(r) < 1e-12] = 0
        self.places = np.column_stack([r, z + R])
        self.bottom = self.number[-1, :around // 2]
        self.mass = np.zeros(len(r))
        parts = [self.element(self.number[[i, i + 1, i + 1, i], [j, j, j + 1, j + 1]])
                 for i in range(radial) for j in range(around)]
        rows, columns, values = (np.concatenate(part) for part in zip(*parts))
        self.stiffness = sparse.csr_matrix((values, (rows, columns)), shape=(2 * len(r),) * 2)

    def element(self, nodes):
        """Rows, columns and values of its stiffness; its mass goes to the nodes."""
        places, stiffness = self.places[nodes], np.zeros((8, 8))
        for a, b in np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / np.sqrt(3):
            n = 0.25 * np.array([(1 - a) * (1 - b), (1 + a) * (1 - b), (1 + a) * (1 + b), (1 - a) * (1 + b)])
            slopes = 0.25 * np.array([[b - 1, 1 - b, 1 + b, -1 - b], [a - 1, -1 - a, 1 + a, 1 - a]])
            jacobian = slopes @ places
            gradient, radius = np.linalg.solve(jacobian, slopes), n @ places[:, 0]
            weight = 2 * np.pi * radius * abs(np.linalg.det(jacobian))
            strain = np.zeros((4, 8))
            strain[0, 0::2], strain[1, 1::2], strain[2, 0::2] = gradient[0], gradient[1], n / radius
            strain[3, 0::2], strain[3, 1::2] = gradient[1], gradient[0]
            stiffness += weight * strain.T @ ELASTICITY @ strain
            np.add.at(self.mass, nodes, weight * n)
        unknowns = np.column_stack([2 * nodes, 2 * nodes + 1]).ravel()
        return np.repeat(unknowns, 8), np.tile(unknowns, 8), stiffness.ravel()

    def press(self, force):
        """The approach of the centre of mass."""
        load, u = np.zeros(2 * len(self.mass)), np.zeros(2 * len(self.mass))
        load[1::2] = -force * self.mass / self.mass.sum()
        axis = 2 * np.flatnonzero(self.places[:, 0] == 0)
        height = self.places[self.bottom, 1]
        touches = np.arange(len(height)) < 2
        for _ in range(100):
            held = 2 * self.bottom[touches] + 1
            u[:] = 0
            u[held] = -height[touches]
            free = np.setdiff1d(np.arange(len(u)), np.concatenate([axis, held]))
            u[free] = solvers.spsolve(self.stiffness[free][:, free].tocsc(), (load - self.stiffness @ u)[free])
            reaction = (self.stiffness @ u - load)[2 * self.bottom + 1]
            found = np.where(touches, reaction > 0, height + u[2 * self.bottom + 1] < 0)
            if (found == touches).all():
                return -(self.mass @ u[1::2]) / self.mass.sum()
            touches = found
        raise SystemExit("the nodes in contact do not settle")


def check_fit():
    """The largest deviation of _gallery.finite_ball from the elements."""
    ball, worst = Ball(), 0.0
    for guess in (0.003, 0.01, 0.03, 0.06, 0.09):
        force = _gallery.stiffness() * (guess * R) ** 1.5
        approach = ball.press(force)
        found = force / (_gallery.stiffness() * approach**1.5)
        fitted = _gallery.finite_ball(approach)
        print(f"elements: approach {approach / R:.4f} R, force/Hertz {found:.4f}, fitted {fitted:.4f}", flush=True)
        worst = max(worst, abs(fitted / found - 1))
    return worst
