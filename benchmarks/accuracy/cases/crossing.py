"""Noise of particles that cross cells, alone: uniformly stressed blocks, at rest, carried and stretched."""

import random

import numpy as np

import derive
import methods
from case import Case, Error, Study
from cases import support

SOLID = derive.Solid(1.0, 0.3, 1.0)
COMPRESSION = 1.05  # density over the reference density, of the blocks that start compressed
STRETCHES = {"2 %": 0.02, "10 %": 0.10, "30 %": 0.30}
CARRY = (1.0, 0.618, 0.382)  # velocity over that of waves
OFFSETS, SMALL, CORE = 16, 13, 4  # blocks at rest: number, cells along an edge, cells along the measured core's
LARGE, WAY, FAR = 36, 5.0, 14.0  # moving block: cells along an edge, cells that a wave runs, cells between core and surface


def pressure(compression):
    """Of the solid when it is compressed equally in all directions."""
    stretch = compression ** (-1 / 3)
    return -float(support.neo_hookean(stretch * np.eye(3)[None], SOLID)[0, 0, 0])


class Crossing(Case):
    name = "crossing"
    title = "Cell crossing"
    about = """What is left of the error when there is nothing to resolve: a block under uniform stress, whose lattice of
particles does not fit the cells (neo-Hookean, E = 1, Poisson's ratio 0.3, density 1; cells of 1). Only the core of the block
is measured, which no wave from the surface has reached, so the exact stress is uniform and nothing accelerates. The input
language has no stress at the start; the blocks of *force* and *carried* start with `density` 5 % above the reference density
and thus under a pressure, those of *stretched* are stretched by their velocities, v = w + a x, which all particles keep.
Noise: root mean square of the particles' velocity error, over sigma/(rho c); for *force*, after a single short step, as an
acceleration over sigma/(rho h). Particles of *force* and *carried* are 0.51, 0.55 and 0.65 cells apart; the boxes of uGIMP
and cpGIMP are cubes of the particle's volume and fit there without a gap. In *stretched* the particles start 0.5 cells apart
and are 2, 10 and 30 % further apart at the end: there the boxes of uGIMP do not follow. *free*: carried without stress,
exact but for the files' single precision."""
    errors = {"noise": Error("noise", ".1e", order=False), "stress": Error("stress noise", ".1e", order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {f"force {name}": Study(f"16 blocks at random places, spacing 0.5 (1 + {s:g}), one step.", (1,), 0.5, quick=(1,),
                                      methods=methods.flip) for name, s in STRETCHES.items()}
    studies |= {f"carried {name}": Study(f"compressed, spacing 0.5 (1 + {s:g}), carried over five cells at an angle.", (1,), 0.5,
                                         methods=None if name == "10 %" else methods.flip) for name, s in STRETCHES.items()}
    studies |= {f"stretched {name}": Study(f"stretched by {name} while it is carried.", (1,), 0.5,
                                           methods=None if name == "10 %" else methods.flip) for name in STRETCHES}
    studies["free"] = Study("without stress, carried.", (1,), 0.5, methods=methods.flip)
    plotted = ("carried 10 %", "stretched 10 %", "stretched 30 %")

    def methods(self):
        return list(dict.fromkeys([*methods.every_scheme(), *methods.every_transfer(("cpGIMP", "QuadraticBSpline", "CubicBSpline"))]))

    def scene(self, point):
        return self.at_rest(point) if point.study.startswith("force") else self.moving(point)

    def at_rest(self, point):
        """Blocks in a row, each at its own place in the cells; the step is short, so that nothing moves."""
        spacing = (1 + stretch_of(point)) / point.split
        size = spacing * round(SMALL / spacing)
        places, gap = random.Random(2), SMALL + 6
        blocks = [support.block(f"block{i}", [i * gap + 3 + places.random(), 3 + places.random(), 3 + places.random()],
                                (size,) * 3, spacing, "solid", attributes=f'density="{COMPRESSION * SOLID.density!r}"')
                  for i in range(OFFSETS)]
        step = 1e-3 / SOLID.wave_speed
        solution = support.solution(step, point.factor).replace(f'<TimeStep factor="{point.factor!r}"/>',
                                                                f'<TimeStep specified="{step!r}"/>')
        return support.scene(blocks, support.grid((0, 0, 0), (OFFSETS * gap, gap, gap), "000000", 1), solution,
                             [support.material("solid", SOLID.density, SOLID.law)], support.pictures(step, support.STRESSES))

    def moving(self, point):
        kind, stretch = point.study.split()[0], stretch_of(point)
        spacing = (1 + stretch if kind == "carried" else 1.0) / point.split
        end = WAY / SOLID.wave_speed
        rate = stretch / end if kind == "stretched" else 0.0
        edge = spacing * round(LARGE / spacing)
        room = (LARGE * (1 + stretch) - LARGE) / 2 + 4
        lower = room + 0.37  # no particle on a cell's face
        middle = lower + edge / 2
        speeds = [f"{c * SOLID.wave_speed!r}+{rate!r}*({a}-{middle!r})" for a, c in zip("xyz", CARRY)]
        density = f'density="{COMPRESSION * SOLID.density!r}"' if kind == "carried" else ""
        body = support.block("block", (lower,) * 3, (edge,) * 3, spacing, "solid",
                             '<InitialVelocity vx="{}" vy="{}" vz="{}"/>'.format(*speeds), density)
        wide = int(edge + 2 * room + WAY + 4)
        return support.scene([body], support.grid((0, 0, 0), (wide,) * 3, "000000", 1), support.solution(end, point.factor),
                             [support.material("solid", SOLID.density, SOLID.law)], support.pictures(end, support.STRESSES))

    def measure(self, point, folder):
        states = support.States(folder)
        first, v, kind = support.places(states, 0), support.velocities(states), point.study.split()[0]
        stretch = 1 + stretch_of(point) if kind == "stretched" else 1.0
        wanted = pressure(COMPRESSION if kind != "stretched" else stretch**-3)
        scale = abs(wanted) if kind != "free" else SOLID.young
        if kind == "force":
            gap = SMALL + 6
            local = first - np.floor(first / gap) * gap * np.array([1, 0, 0]) - 3.5 - 0.5 * SMALL
            core = np.abs(local).max(axis=1) < 0.5 * CORE
            noise = v[core] / states.times[-1] / (scale / SOLID.density)
        else:
            middle = 0.5 * (first.min(axis=0) + first.max(axis=0))
            core = np.abs(first - middle).max(axis=1) < 0.5 * LARGE - FAR
            rate = (stretch - 1) / states.times[-1]
            exact = SOLID.wave_speed * np.array(CARRY) + rate * (first - middle)
            noise = (v - exact)[core] / (scale / SOLID.density / SOLID.wave_speed)
        off = support.stresses(states)[core] - (0 if kind == "free" else -wanted) * np.eye(3)
        return {"noise": support.rms(noise), "stress": support.rms(off) / scale, "drift": support.drift(folder)}


def stretch_of(point):
    return STRETCHES.get(" ".join(point.study.split()[1:]), 0.1)


CASE = Crossing()
