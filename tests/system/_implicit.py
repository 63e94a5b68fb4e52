"""Scenes of implicit steps for several tests."""

import re

import _mpm

YOUNG, POISSON = 1000.0, 0.3
SOFT = _mpm.material("soft", 1.0, f'type="NeoHookean" Young="{YOUNG}" Poisson="{POISSON}"')
RAM = _mpm.material("ram", 1.0, 'type="Rigid"')


def implicit(end, kind="quasistatic", step=None, more="", extra=""):
    step = f'time_step="{step}"' if step else ""
    return _mpm.solution(end, attributes='Integration="impl"',
                         more=f'<Implicit type="{kind}" {step} {more}/>{extra}').replace('<TimeStep factor="0.5"/>', "")


def column(shape="linear", travel=1.0, steps=10, material=SOFT, more="", output=""):
    """A column of 2 x 2 x 8 cells between smooth walls, pressed from above by a rigid body."""
    bodies = [_mpm.block("column", (0, 0, 0), (2, 2, 8)),
              _mpm.block("ram", (0, 0, 8), (2, 2, 1), of="ram",
                         more=f'<PrescribedVelocity vx="0" vy="0" vz="{-travel}"/>')]
    return _mpm.scene(bodies, _mpm.grid((0, 0, 0), (2, 2, 10), "222210").replace("<Grid>", f'<Grid shape="{shape}">'),
                      implicit(1.0, step=1 / steps, more=more), [material, RAM], output)


def residuals(outcome_folder):
    """The residuals of every step's first solution, from the log."""
    text = (outcome_folder / "case.out").read_text()
    return [[float(word) for word in found.split()] for found in re.findall(r"implicit +step .*residual ([^;|]*)", text)]
