"""A circular bar that necks, by axisymmetric finite elements: the reference of studies/necking.py.

Quadrilaterals of four nodes with the determinant of F from the element's middle (F-bar), so that they do not lock; von Mises
plasticity in the logarithms of the principal elastic stretches, in which the radial return is that of small strains and
plastic flow keeps the volume; the yield stress is Kirchhoff's. Newton's method; the elements' matrices by differences.
tests/system/benchmarks_implicit.py compares uniform tension with the closed form.

  necked_bar.py [RADIAL AXIAL [HELD [GRADING]]]     the table of studies/necking.py: elongation, ratio of radii, force;
                                                    HELD 0: ends free to narrow; GRADING 0: elements of one length
  necked_bar.py notched|strip RADIAL AXIAL GRADING  studies/notched.py: displacement of an end, radius or half width of the
                                                    neck, force, and its error against each published curve"""

import dataclasses
import pathlib
import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as solvers

CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
POINTS = np.vstack([CORNERS / 3**0.5, [(0, 0)]])  # the middle last


@dataclasses.dataclass(frozen=True)
class Metal:
    bulk: float
    shear: float
    flow: object  # of the plastic strain: yield stress and slope


def at_points():
    """Values (5, 4) and slopes (5, 4, 2) of the functions."""
    s = 1 + CORNERS[None] * POINTS[:, None]
    return s.prod(axis=2) / 4, np.stack([CORNERS[:, 0] * s[..., 1], CORNERS[:, 1] * s[..., 0]], 2) / 4


class Bar:
    """Half of a bar between its middle, z = 0, and its end. `radius`(z); `grading` above 1: finer towards the middle; `held`:
    the end keeps its width. `plane`: a strip in plane strain instead, of this half width and unit thickness, and the force on
    half of it."""

    def __init__(self, metal, radius, half, radial, axial, grading=3.0, held=True, plane=False):
        self.metal = metal
        t = np.linspace(0, 1, axial + 1)
        z = half * np.expm1(grading * t) / np.expm1(grading) if grading else half * t
        s, z = np.meshgrid(np.linspace(0, 1, radial + 1), z, indexing="ij")
        self.first = np.stack([s * radius(z), z], 2).reshape(-1, 2)
        number = np.arange(len(self.first)).reshape(s.shape)
        self.nodes = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], -1).reshape(-1, 4)
        self.rows = (2 * self.nodes[..., None] + np.arange(2)).reshape(-1, 8)
        self.end, self.neck = number[:, -1], number[-1, 0]
        fixed = np.zeros((len(self.first), 2), bool)
        fixed[number[0], 0] = fixed[number[:, 0], 1] = fixed[self.end, 1] = True
        fixed[self.end, 0] |= held
        self.free = np.flatnonzero(~fixed.ravel())
        value, slope = at_points()
        jacobian = np.einsum("pai,eaj->epij", slope, self.first[self.nodes])
        self.slope = np.einsum("epij,paj->epai", np.linalg.inv(jacobian), slope)  # with respect to the first place
        self.value, self.r0 = value, np.einsum("pa,ea->ep", value, self.first[self.nodes][..., 0])
        self.volume = 2 * np.pi * self.r0[:, :4] * np.linalg.det(jacobian)[:, :4]
        if plane:  # no strain around the axis
            self.value, self.r0, self.volume = 0 * value, np.ones_like(self.r0), np.linalg.det(jacobian)[:, :4]
        self.u, self.last = np.zeros_like(self.first), self.first * (0, 1)  # the last step was uniform
        eye = np.broadcast_to(np.eye(2), (*self.volume.shape, 2, 2))
        self.state = (eye, np.ones_like(self.volume), eye, np.ones_like(self.volume), np.zeros_like(self.volume))

    def forces(self, u):
        """Of the elements' nodes (e, 8), and the state after the step. u: (e, 8)."""
        u = u.reshape(-1, 4, 2)
        f = np.eye(2) + np.einsum("eaj,epai->epji", u, self.slope)
        hoop = 1 + np.einsum("pa,ea->ep", self.value, u[..., 0]) / self.r0
        whole = np.linalg.det(f) * hoop
        share = np.cbrt(whole[:, 4:] / whole[:, :4])
        mean, mean_hoop = share[..., None, None] * f[:, :4], share * hoop[:, :4]
        stress, stress_hoop, state = self.stress(mean, mean_hoop)  # Kirchhoff's
        ratio = self.volume / share**3  # of the true volume to that of the mean
        inverse = np.linalg.inv(f[:, :4])
        spatial = np.einsum("epai,epij->epaj", self.slope[:, :4], inverse)
        force = np.einsum("ep,epij,epaj->eai", ratio, stress, spatial)
        force[..., 0] += np.einsum("ep,ep,pa->ea", ratio, stress_hoop / (self.r0[:, :4] * hoop[:, :4]), self.value[:4])
        return force.reshape(-1, 8), state

    def stress(self, f, hoop):
        old_f, old_hoop, old_b, old_b_hoop, plastic = self.state
        step = f @ np.linalg.inv(old_f)
        b = step @ old_b @ np.swapaxes(step, -1, -2)
        b_hoop = (hoop / old_hoop) ** 2 * old_b_hoop
        values, axes = np.linalg.eigh(b)
        strain = 0.5 * np.log(np.concatenate([values, b_hoop[..., None]], -1))
        volume = strain.sum(-1, keepdims=True)
        trial = 2 * self.metal.shear * (strain - volume / 3)
        size = np.sqrt(1.5 * (trial**2).sum(-1))
        more = np.zeros_like(size)
        for _ in range(50):
            flow, slope = self.metal.flow(plastic + more)
            off = np.where(size > self.metal.flow(plastic)[0], size - 3 * self.metal.shear * more - flow, 0)
            if np.abs(off).max() < 1e-12 * flow.max():
                break
            more = np.maximum(more + off / (3 * self.metal.shear + slope), 0)
        left = 1 - 3 * self.metal.shear * more / np.where(size > 0, size, 1)
        s = left[..., None] * trial
        elastic = np.exp(2 * (s / (2 * self.metal.shear) + volume / 3))
        tau = s + self.metal.bulk * volume

        def turned(d):
            return np.einsum("...ik,...k,...jk->...ij", axes, d[..., :2], axes)
        return turned(tau), tau[..., 2], (f, hoop, turned(elastic), elastic[..., 2], plastic + more)

    def pull(self, by):
        """A step that moves the end; returns the force on it."""
        # The first guess goes on as the last step did.
        u = self.u + self.last * (by / self.last[self.end[0], 1])
        for iteration in range(40):
            own = u.ravel()[self.rows]
            force, state = self.forces(own)
            whole = np.bincount(self.rows.ravel(), force.ravel(), u.size)
            if iteration and np.abs(whole[self.free]).max() < 1e-9 * np.abs(whole).max():
                break
            matrix = np.empty((len(own), 8, 8))
            for k in range(8):
                change = np.zeros(8)
                change[k] = 1e-7 * self.first[:, 0].max()
                matrix[:, :, k] = (self.forces(own + change)[0] - self.forces(own - change)[0]) / (2 * change[k])
            rows, columns = np.repeat(self.rows, 8, axis=1), np.tile(self.rows, (1, 8))
            sparse_matrix = sparse.csr_matrix((matrix.ravel(), (rows.ravel(), columns.ravel())), (u.size, u.size))
            u = u.copy()
            u.ravel()[self.free] -= solvers.spsolve(sparse_matrix[self.free][:, self.free].tocsc(), whole[self.free])
        else:
            raise ArithmeticError(f"no equilibrium at an elongation of {2 * u[self.end[0], 1]:g}")
        self.u, self.last, self.state = u, u - self.u, state
        return whole.reshape(-1, 2)[self.end, 1].sum()

    def neck_radius(self):
        return self.first[self.neck, 0] + self.u[self.neck, 0]


def curve(bar, pulled, steps):
    """Rows of elongation, radius of the neck and force; both ends move by `pulled`."""
    rows = [(0.0, bar.neck_radius(), 0.0)]
    for step in range(1, steps + 1):
        force = bar.pull(pulled / steps)
        rows.append((2 * pulled * step / steps, bar.neck_radius(), force))
    return np.array(rows)


def against_published(name, radial, axial, grading):
    from studies import notched
    pulled, bar, curves = notched.CASES[name]
    found = curve(bar(int(radial), int(axial), float(grading)), pulled, 80)
    for elongation, radius, force in found[1:]:
        moved, force = elongation / 2, force / 1e3
        wanted = [published[np.isclose(published[:, 0], moved), 1] for published in curves.values()]
        if wanted[0].size:
            print(f"{moved:.4g} {radius:.4f} {force:.4f}", *(f"{force / w[0] - 1:+.2%}" for w in wanted if w.size))


def main(radial=12, axial=40, held=1, grading=3):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
    if radial in ("notched", "strip"):
        return against_published(radial, axial, held, grading)
    from studies import necking
    found = curve(necking.bar(int(radial), int(axial), bool(int(held)), float(grading)), necking.PULLED, 140)
    found[:, 1] /= necking.RADIUS
    for elongation, ratio, force in found[::5]:
        print(f"({elongation:.4g}, {ratio:.5f}, {force / 1e3:.4f}),")
    print("peak", found[found[:, 2].argmax()])


if __name__ == "__main__":
    main(*sys.argv[1:])
