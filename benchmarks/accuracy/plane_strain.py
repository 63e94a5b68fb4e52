"""Small deformations in plane strain by finite elements: converged references for nearly incompressible solids.

Quadrilaterals of nine nodes with the volume change projected onto a linear function in each (Q2/P1 in mixed form, inf-sup
stable; see T. J. R. Hughes, The Finite Element Method, 4.5): they do not lock as Poisson's ratio approaches 1/2.
tests/system/benchmarks_accuracy.py shows that they reproduce uniform strains and converge."""

import numpy as np

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)


def quadratic(t):
    """Values and slopes of the three functions of the nodes -1, 0, 1."""
    return np.array([t * (t - 1) / 2, 1 - t * t, t * (t + 1) / 2]), np.array([t - 0.5, -2 * t, t + 0.5])


class Mesh:
    """n x m elements on the image of the unit square under `place`(s, t) -> (x, y), arrays alike."""

    def __init__(self, place, n, m):
        s, t = np.meshgrid(np.linspace(0, 1, 2 * n + 1), np.linspace(0, 1, 2 * m + 1), indexing="ij")
        self.nodes = np.column_stack([np.ravel(v) for v in place(s, t)])
        self.s, self.t = s.ravel(), t.ravel()
        number = np.arange(len(self.nodes)).reshape(s.shape)
        self.elements = [number[2 * i:2 * i + 3, 2 * j:2 * j + 3].ravel() for i in range(n) for j in range(m)]

    def quadrature(self, element):
        """Values, gradients (9, 2), place and weight at the points of an element."""
        nodes = self.nodes[element]
        for a, wa in zip(POINTS, WEIGHTS):
            for b, wb in zip(POINTS, WEIGHTS):
                (fa, da), (fb, db) = quadratic(a), quadratic(b)
                slopes = np.column_stack([np.outer(da, fb).ravel(), np.outer(fa, db).ravel()])
                jacobian = nodes.T @ slopes
                value = np.outer(fa, fb).ravel()
                yield value, slopes @ np.linalg.inv(jacobian), value @ nodes, wa * wb * np.linalg.det(jacobian), (1, a, b)

    def stiffness(self, shear, bulk):
        size = 2 * len(self.nodes)
        whole = np.zeros((size, size))
        # Components xx, yy, zz and the shear strain of engineers.
        deviator = 2 * shear * np.array([[2 / 3, -1 / 3, -1 / 3, 0], [-1 / 3, 2 / 3, -1 / 3, 0], [-1 / 3, -1 / 3, 2 / 3, 0], [0, 0, 0, 0.5]])
        for element in self.elements:
            own, moments, masses = np.zeros((18, 18)), np.zeros((3, 18)), np.zeros((3, 3))
            for _, g, _, weight, linear in self.quadrature(element):
                strain = np.zeros((4, 18))
                strain[0, 0::2] = strain[3, 1::2] = g[:, 0]
                strain[1, 1::2] = strain[3, 0::2] = g[:, 1]
                own += weight * strain.T @ deviator @ strain
                moments += weight * np.outer(linear, g.ravel())
                masses += weight * np.outer(linear, linear)
            own += bulk * moments.T @ np.linalg.solve(masses, moments)
            rows = np.column_stack([2 * element, 2 * element + 1]).ravel()
            whole[np.ix_(rows, rows)] += own
        return whole

    def mean_over(self, where):
        """Weights of the nodes: integral over the part in which `where`(x, y) is 1, over its area. Elements lie inside or
        outside."""
        weights = np.zeros(len(self.nodes))
        for element in self.elements:
            for value, _, (x, y), weight, _ in self.quadrature(element):
                weights[element] += weight * where(x, y) * value
        return weights / weights.sum()

    def solve(self, shear, bulk, force, held, values=0.0):
        """Displacements (nodes, 2) under nodal forces (nodes, 2), with the components `held` (nodes, 2) given."""
        matrix, given = self.stiffness(shear, bulk), np.where(held, values, 0.0).ravel()
        free = ~held.ravel()
        found = given.copy()
        found[free] = np.linalg.solve(matrix[np.ix_(free, free)], (force.ravel() - matrix @ given)[free])
        return found.reshape(-1, 2)
