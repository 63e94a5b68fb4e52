"""A thick cylinder of elastic, perfectly plastic material (von Mises) in plane strain under an inner pressure, by finite
elements over the radius: the exact solution for a compressible material, which has no closed form.

Linear elements, one point in each, small strains, radial return, Newton's method with the consistent tangent (J. C. Simo
and T. J. R. Hughes, Computational Inelasticity, 3.3). tests/system/benchmarks_implicit.py compares it with Lame's
solution."""

import numpy as np


def solve(inner, outer, young, poisson, yielded, pressures, elements=800):
    """Radii of the elements' middles, stresses (elements, 3) radial, hoop and axial at the last pressure, the
    displacement of the inner surface at each pressure, and radii and displacements of the nodes at the last."""
    shear, bulk = young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))
    r = np.linspace(inner, outer, elements + 1)
    middle, length = 0.5 * (r[1:] + r[:-1]), np.diff(r)
    slope = np.stack([np.stack([-1 / length, 1 / length], 1), np.stack([0.5 / middle, 0.5 / middle], 1)], 1)  # (e, 2, 2)
    weight = (middle * length)[:, None]
    plastic, u, moved = np.zeros((elements, 3)), np.zeros(elements + 1), []
    deviator = np.eye(3) - 1 / 3
    for pressure in pressures:
        for _ in range(40):
            strain = np.zeros((elements, 3))
            strain[:, :2] = slope[:, :, 0] * u[:-1, None] + slope[:, :, 1] * u[1:, None]
            trial = 2 * shear * (strain - plastic) @ deviator
            size = np.sqrt(1.5 * (trial**2).sum(axis=1))
            part = yielded / np.maximum(size, yielded)  # of the trial deviator that is left
            s = part[:, None] * trial
            stress = s + bulk * strain.sum(axis=1)[:, None]
            tangent = bulk * np.ones((elements, 3, 3)) + 2 * shear * part[:, None, None] * deviator
            normal = trial / np.maximum(size, 1e-300)[:, None]
            tangent -= np.where(part < 1, 3 * shear * part, 0)[:, None, None] * normal[:, :, None] * normal[:, None, :]
            forces = weight * np.einsum("eia,ei->ea", slope, stress[:, :2])
            residual = np.zeros(elements + 1)
            residual[0] = inner * pressure
            np.subtract.at(residual, np.arange(elements), forces[:, 0])
            np.subtract.at(residual, np.arange(elements) + 1, forces[:, 1])
            if np.abs(residual).max() < 1e-8 * inner * pressure:
                break
            blocks = weight[:, :, None] * np.einsum("eia,eij,ejb->eab", slope, tangent[:, :2, :2], slope)
            u = u + tridiagonal(blocks, residual)
        else:
            raise ArithmeticError(f"the reference of the cylinder does not converge at a pressure of {pressure:g}")
        plastic += (trial - s) / (2 * shear)
        moved.append(u[0])
    return middle, stress, np.array(moved), (r, u)


def tridiagonal(blocks, right):
    """Solves the system of elements' 2 x 2 matrices."""
    main, off, right = np.zeros(len(right)), blocks[:, 0, 1], right.copy()
    main[:-1] += blocks[:, 0, 0]
    main[1:] += blocks[:, 1, 1]
    for i in range(1, len(right)):
        factor = off[i - 1] / main[i - 1]
        main[i] -= factor * off[i - 1]
        right[i] -= factor * right[i - 1]
    for i in range(len(right) - 1, -1, -1):
        right[i] = (right[i] - (off[i] * right[i + 1] if i < len(off) else 0)) / main[i]
    return right
