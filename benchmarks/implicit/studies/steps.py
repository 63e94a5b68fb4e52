"""Long time steps: what is left of the energy of a wave and of a ring-down."""

import numpy as np

import scenes
import study
from run_one import Run

LENGTH, YOUNG, DENSITY = 32.0, 1000.0, 1.0
CELLS, OTHER_CELLS = 32, (16, 64)
WAVE = (YOUNG / DENSITY) ** 0.5
SPEED = 1e-3 * WAVE  # amplitude
PERIODS = 50
PERIOD = 2 * LENGTH / WAVE
# Beta and gamma, or the spectral radius.
RULES = {"trapezoidal": (0.25, 0.5), "damped Newmark": (0.3025, 0.6), "generalised alpha": 0.8, "backward Euler": None}
EXPLICIT, RATIOS = 0.5, (1, 10, 100, 1000)  # steps over the explicit limit


def left_by_alpha(radius, w2, step, end):
    """The same by Chung and Hulbert's rule. What it carries is, over the step, the acceleration less -w2 u."""
    am, af = (2 * radius - 1) / (radius + 1), radius / (radius + 1)
    gamma, beta = 0.5 - am + af, 0.25 * (1 - am + af) ** 2
    u, v, carried, time = 0.0, 1.0, 0.0, 0.0
    while time < end * (1 - 1e-9):
        dt = min(step, end - time)
        a = dt * carried - w2 * u
        ahead = u + dt * v + dt * dt * (0.5 - beta) * a
        now = -(am * a + w2 * ((1 - af) * ahead + af * u)) / (1 - am + w2 * (1 - af) * beta * dt * dt)
        u, v, time = ahead + dt * dt * beta * now, v + dt * ((1 - gamma) * a + gamma * now), time + dt
        carried = (now + w2 * u) / dt
    return w2 * u**2 + v**2


def left(rule, frequency, step, end):
    """Part of an oscillator's energy that the rule leaves after steps to the end, the last one shortened; begun at its
    largest velocity. a = -w2 u at both ends of a step."""
    numbers = RULES.get(rule, (0, 0.5))  # explicit steps: central differences
    if isinstance(numbers, float):
        return left_by_alpha(numbers, frequency**2, step, end)
    state, time, w2 = np.array([0.0, 1.0]), 0.0, frequency**2
    while time < end * (1 - 1e-9):
        dt = min(step, end - time)
        if numbers is None:
            after, before = np.array([[1, -dt], [dt * w2, 1]]), np.eye(2)
        else:
            beta, gamma = numbers
            after = np.array([[1 + beta * dt * dt * w2, 0], [gamma * dt * w2, 1]])
            before = np.array([[1 - (0.5 - beta) * dt * dt * w2, dt], [-(1 - gamma) * dt * w2, 1]])
        state, time = np.linalg.solve(after, before @ state), time + dt
    return w2 * state[0] ** 2 + state[1] ** 2


class Steps(study.Study):
    name = "steps"
    title = "Time steps of 1, 10, 100 and 1000 explicit ones"
    about = f"""A neo-Hookean bar of {CELLS} cells between symmetry planes (E = {YOUNG:g}, Poisson's ratio 0),
particles' speeds of a thousandth of that of waves. *wave*: the first mode, a standing wave; *ring-down*: the halves move
against each other, and all modes ring. Steps in cells over the speed of waves, the explicit limit; {PERIODS} periods of the
first mode, so that the longest step is {1000 / (2 * CELLS):.0f} periods. *energy*: kinetic and internal, at the end over
that of the start; *oscillator*: what the rule leaves of the first mode. *trapezoidal*: the default; *damped Newmark*: gamma
0.6, beta 0.3025; *generalised alpha*: spectral radius {RULES['generalised alpha']}. The trapezoidal rule conserves the energy of the grid; what it loses here is lost between grid and
particles: FLIP adds the nodes' velocity increments dv to the particles, whose kinetic energy then misses 1/2 (sum m_i
dv_i^2 - sum m_p (sum S_ip dv_i)^2), of second order in the cell size and in the velocity change of a step, which is small
in explicit steps only. Of a ring-down, backward Euler leaves what the grid does not see: the two velocities within the cell
in the middle, one of {CELLS}."""
    labels = ("motion", "rule", "shape", "cells", "ratio")
    measured = ("energy", "kinetic", "oscillator")

    def runs(self):
        found = []
        for motion in ("wave", "ring-down"):
            for shape in ("linear", "uGIMP", "QuadraticBSpline", "SGMP", "CPDI2"):
                found.append(self.one(motion, "explicit", shape, CELLS, EXPLICIT, False))
                for rule in RULES:
                    for ratio in RATIOS:
                        found.append(self.one(motion, rule, shape, CELLS, ratio, shape == "QuadraticBSpline" and ratio >= 100))
                found += [self.one(motion, "trapezoidal", shape, n, 10 * n / CELLS, False) for n in OTHER_CELLS]
        return found

    @staticmethod
    def one(motion, rule, shape, cells, ratio, quick):
        h = LENGTH / cells
        end = PERIODS * PERIOD
        if rule == "explicit":
            solution = scenes.explicit(end, ratio)
        else:
            numbers = RULES[rule]
            if isinstance(numbers, float):
                more = f'rule="generalised_alpha" spectral_radius="{numbers}"'
            else:
                more = f'newmark_beta="{numbers[0]}" newmark_gamma="{numbers[1]}"' if numbers else 'rule="backward_euler"'
            solution = scenes.implicit(end, ratio * h / WAVE, "dynamic", more)
        speed = f"{SPEED!r}*sin({np.pi / LENGTH!r}*X)" if motion == "wave" else f"if(X&lt;{LENGTH / 2!r},{SPEED!r},-{SPEED!r})"
        bar = scenes.block("bar", (0, 0, 0), (LENGTH, h, h), h / 2, more=f'<InitialVelocity vx="{speed}" vy="0" vz="0"/>')
        text = scenes.scene([bar], scenes.grid(shape, (0, 0, 0), (LENGTH, h, h), "222222", h), solution,
                            [scenes.neo_hookean(YOUNG, 0.0, DENSITY)])

        def measure(result):
            energy = result.summary["energy"]
            row = {"energy": energy["total"] / energy["initial_total"], "kinetic": energy["kinetic"] / energy["initial_total"]}
            if motion == "wave":
                row["oscillator"] = left(rule, 2 * np.pi / PERIOD, ratio * LENGTH / CELLS / WAVE, end)
            return row

        return Run({"motion": motion, "rule": rule, "shape": shape, "cells": cells, "ratio": ratio}, text, measure, quick)

    def block(self, rows):
        text = []
        for motion in study.values(rows, "motion"):
            mine, lines = study.where(rows, motion=motion, cells=CELLS), []
            for rule in study.values(mine, "rule"):
                if rule == "explicit":
                    continue
                for shape in study.values(mine, "shape"):
                    at = {r["ratio"]: r for how in ("explicit", rule) for r in study.where(mine, rule=how, shape=shape)}
                    lines.append([rule, shape, *(f"{study.shown(at[p], 'energy', '.4g')} ({study.shown(at[p], 'seconds', '.2g')})"
                                                 if p in at else "–" for p in (EXPLICIT, *RATIOS))])
                if motion == "wave":
                    at = {r["ratio"]: r for how in ("explicit", rule) for r in study.where(mine, rule=how)}
                    lines.append([rule, "*oscillator*",
                                  *(study.shown(at[p], "oscillator", ".4g") if p in at else "–" for p in (EXPLICIT, *RATIOS))])
            text.append(f"**{motion}**: energy left (seconds), of explicit steps and at steps of so many explicit limits\n\n"
                        + study.table(["rule", "shape", f"explicit, factor {EXPLICIT}", *(f"{p}" for p in RATIOS)], lines))
            finer = [r for r in study.where(rows, motion=motion, rule="trapezoidal") if r["ratio"] * CELLS == 10 * r["cells"]]
            text.append(f"The same step, {10 * LENGTH / CELLS / WAVE / PERIOD:.2g} periods, over the cells of the bar: part of the "
                        "energy that the trapezoidal rule loses\n\n" + self.losses(finer))
        failed = study.failures(rows)
        return "\n\n".join(text) + (f"\n\nNot done:\n\n{failed}" if failed else "")

    @staticmethod
    def losses(rows):
        places = sorted(set(study.values(rows, "cells")))
        lines = []
        for shape in study.values(rows, "shape"):
            at = {r["cells"]: r for r in study.where(rows, shape=shape)}
            lines.append([shape, *(f"{1 - at[p]['energy']:.3f}" if p in at and study.done(at[p]) else "–" for p in places)])
        return study.table(["shape", *(f"{p:g}" for p in places)], lines)


STUDY = Steps()
