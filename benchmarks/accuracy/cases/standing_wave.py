"""The first mode of an elastic bar over a hundred periods: phase, amplitude, energy."""

import numpy as np

import methods
from case import Case, Error, Study
from cases import support

PERIODS, ROWS = 100, 40
LENGTH = YOUNG = DENSITY = 1.0
PERIOD = 4 * LENGTH  # waves of speed 1
SPEED = 1e-4


class StandingWave(Case):
    name = "standing_wave"
    title = "Standing wave in a bar"
    about = """The first mode of a bar, held at one end and free at the other, v = 1e-4 c sin(pi x/(2 L)), over a hundred
periods: linear elastic, Poisson's ratio 0, a column of one cell between symmetry planes, no artificial viscosity. Nothing
crosses a cell: this shows dispersion and dissipation alone. Error: by how many periods the wave is off after a hundred, from
the last passage of the momentum through zero. *Amplitude lost* and *energy drift* over the hundred periods, each from means
over a period."""
    errors = {"phase": Error("phase error, periods", ".2e"), "amplitude": Error("amplitude lost, %", ".2f", 100, order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"cells": Study("cells along the bar, factor 0.4.", (4, 8, 12, 16), 0.4, quick=(4, 8, 16),
                              fine=(32,), fine_methods=tuple(methods.product(("linear", "QuadraticBSpline")))),
               "time": Study("16 cells, time step falling.", (16,), (0.8, 0.4, 0.2, 0.1), axis="factor",
                             methods=lambda: [*methods.product(("linear", "QuadraticBSpline"), some_schemes=methods.schemes()),
                                              methods.Method("QuadraticBSpline", "APIC")])}

    def methods(self):
        return methods.short()

    def excluded(self, method):
        return "nothing is left of the wave after a few periods" if method.transfer == "PIC" else None

    def scene(self, point):
        h = LENGTH / point.cells
        bar = support.block("bar", (0, 0, 0), (LENGTH, h, h), h / point.split, "elastic",
                            f'<InitialVelocity vx="{SPEED}*sin(pi*x/{2 * LENGTH})" vy="0" vz="0"/>')
        law = f'type="IsoElastic" Young="{YOUNG}" Poisson="0" bq1="0" bq2="0"'
        return support.scene([bar], support.grid((0, 0, 0), (LENGTH + 3 * h, h, h), "202222", h),
                             support.solution(PERIODS * PERIOD, point.factor), [support.material("elastic", DENSITY, law)],
                             f'<Console print_time="{PERIOD / ROWS}"/>')

    def measure(self, point, folder):
        rows = support.status(folder)
        t, p = rows["time"], rows["px"]
        change = np.flatnonzero(p[:-1] * p[1:] < 0)
        zeros = t[change] - p[change] * (t[change + 1] - t[change]) / (p[change + 1] - p[change])
        count = len(zeros)  # the n-th stands at (n - 1/2)/2 periods
        phase = zeros[-1] / PERIOD - (count - 0.5) / 2

        def mean(name, which):
            inside = (t >= which * PERIOD) & (t < (which + 1) * PERIOD)
            return rows[name][inside].mean()

        size = [np.sqrt(mean_square(t, p, which)) for which in (0, PERIODS - 1)]
        energy = [mean("total", which) for which in (0, PERIODS - 1)]
        return {"phase": abs(phase), "amplitude": 1 - size[1] / size[0], "drift": energy[1] / energy[0] - 1}


def mean_square(t, p, which):
    inside = (t >= which * PERIOD) & (t < (which + 1) * PERIOD)
    return (p[inside] ** 2).mean()


CASE = StandingWave()
