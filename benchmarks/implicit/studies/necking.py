"""A circular bar that is pulled until it necks."""

import numpy as np

import necked_bar
import scenes
import study
from run_one import Run

RADIUS, HALF, NECK = 6.413, 26.667, 0.982  # mm; of the first radius, in the middle
PULLED = 7.0  # each end, mm
BULK, SHEAR = 164.21e3, 80.1938e3  # MPa
YOUNG, POISSON = 9 * BULK * SHEAR / (3 * BULK + SHEAR), (3 * BULK - 2 * SHEAR) / (6 * BULK + 2 * SHEAR)
YIELD, SATURATION, EXPONENT, LINEAR = 450.0, 265.0, 16.93, 129.24  # MPa
DENSITY = 7.85e-3  # g/mm3; the unit of time is ms
WAVE = (YOUNG / DENSITY) ** 0.5
STEPS, PICTURES = 70, 28
FINE, FLAT = 5.0, 4  # mm from the middle: layers this much thinner, as they are stretched to seven times their thickness
AREA = np.pi / 4 * RADIUS**2  # of the quarter


def particles(lower, upper, h, fine=False):
    """Lines of a point file of a quarter between two heights: particles in rings of h/2, in layers of h/2."""
    lines, dr = [], RADIUS / round(2 * RADIUS / h)
    edges = np.linspace(lower, upper, round(2 * (upper - lower) / h) + 1)
    if fine:
        layers = round(2 * FINE / h)
        edges = np.concatenate([np.linspace(0, edges[layers], FLAT * layers + 1), edges[layers + 1:]])
    for z, dz in zip((edges[1:] + edges[:-1]) / 2, np.diff(edges)):
        scale = NECK + (1 - NECK) * min(z / HALF, 1)
        for ring in range(round(RADIUS / dr)):
            count = max(round(np.pi / 4 * (2 * ring + 1)), 1)
            mass = DENSITY * np.pi / 4 * (2 * ring + 1) * (scale * dr) ** 2 * dz / count
            for angle in (np.arange(count) + 0.5) * np.pi / 2 / count:
                r = scale * dr * (ring + 0.5)
                lines.append(f"{mass:.12g} {r * np.cos(angle):.12g} {r * np.sin(angle):.12g} {z:.12g}")
    return "\n".join(lines) + "\n"


def flow(plastic):
    left = SATURATION * np.exp(-EXPONENT * plastic)
    return YIELD + SATURATION + LINEAR * plastic - left, LINEAR + EXPONENT * left


def bar(radial, axial, held=True):
    """The reference, by finite elements."""
    return necked_bar.Bar(necked_bar.Metal(BULK, SHEAR, flow), lambda z: RADIUS * (NECK + (1 - NECK) * z / HALF), HALF, radial, axial,
                          held=held)


class Necking(study.Study):
    name = "necking"
    title = "Necking of a bar"
    about = f"""to come"""
    labels = ("steps by", "shape", "averaging", "cells")
    measured = ("radius", "force", "peak", "at")

    def runs(self):
        return []

    @staticmethod
    def one(by, shape, averaging, cells, quick=False, steps=STEPS):
        """`cells`: over half the length."""
        h, is_implicit = HALF / cells, by == "implicit"
        speed = PULLED if is_implicit else float(by.split()[1]) * WAVE
        end = PULLED / speed
        bodies = [f'<Body name="{name}" material="{of}" type="Point"><Geometry file="{name}.txt"/>{more}</Body>'
                  for name, of, more in (("bar", "metal", ""), ("head", "elastic", ""), ("grip", "rigid", scenes.moved(vz=speed)))]
        width = (np.ceil(RADIUS / h) + 1) * h
        top = (cells + 5 + np.ceil(PULLED / h) + 2) * h
        law = (f'type="Voce" Young="{YOUNG!r}" Poisson="{POISSON!r}" Yield0="{YIELD}" Q="{SATURATION}" b="{EXPONENT}" '
               f'H="{LINEAR}" bq1="0" bq2="0"')
        metals = [scenes.material("metal", DENSITY, law), scenes.rigid(DENSITY),
                  scenes.material("elastic", DENSITY, f'type="IsoElastic" Young="{YOUNG!r}" Poisson="{POISSON!r}" bq1="0" bq2="0"')]
        averages = f'<Volumetric averaging="{averaging}"/>'
        solution = (scenes.implicit(end, end / steps, children=averages) if is_implicit
                    else scenes.explicit(end, more=averages))
        text = scenes.scene(bodies, scenes.grid(shape, (0, 0, 0), (width, width, top), "202020", h), solution, metals,
                            scenes.pictures(end / PICTURES, ("SigmaZ", "density")))
        files = {"bar.txt": particles(0, HALF, h, True), "head.txt": particles(HALF, HALF + 3 * h, h),
                 "grip.txt": particles(HALF + 3 * h, HALF + 5 * h, h)}

        def measure(result):
            z0 = result.column("z", 0)
            bar, head, low = z0 < HALF, (z0 > HALF) & (z0 < HALF + h / 2), z0 < z0.min() * 1.5
            count, first = len(result.states.steps), result.column("density", 0)
            mass = np.array([float(line.split()[0]) for name in ("bar", "head", "grip") for line in files[f"{name}.txt"].splitlines()])
            pulled, radius, force = np.zeros((3, count))
            for i in range(count):
                z, density = result.column("z", i), result.column("density", i)
                pulled[i] = (z - z0)[head].mean()
                growth = (first / density)[low].mean() / (z / z0)[low].mean()
                radius[i] = NECK * growth**0.5
                force[i] = 4e-3 * (mass / density * result.column("SigmaZ", i))[bar].sum() / (HALF + pulled[i])
            print(np.c_[2 * pulled, radius, force])
            return {"radius": radius[-1], "force": force[-1], "peak": force.max(), "at": 2 * pulled[force.argmax()]}

        return Run({"steps by": by, "shape": shape, "averaging": averaging, "cells": cells}, text, measure, quick, files=files)


STUDY = Necking()
