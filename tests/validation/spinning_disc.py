"""An elastic disc that spins freely: what a lumped mass at the rim costs, over resolution and scheme.

The exact answer is a rigid turn but for strains of the size (rim speed/c)^2 = 1e-4; the angular momentum stays. On the
grid the nodes around the rim stand outside of the particles that move them, so their velocities are those of places
further in: the rim is strained and the disc loses angular momentum until rim and interior agree. This is the method's
own error with linear functions and lumped mass; it must fall with the cell size. Each column of particles is a body, for
the language gives velocities to bodies."""

import _common  # first: it says where the next ones are
import _cases
import _mpm
import numpy as np

MODULUS, POISSON, DENSITY = 117e3, 0.3, _cases.COPPER["density"]
RIM = 0.01  # speed of the rim over that of waves
COLUMNS = {"scheme": ("scheme", ""), "radius": ("radius, cells", "d"), "steps": ("steps", "d"),
           "momentum": ("angular momentum %", "+.2f"), "lag": ("lag of the rim %", "+.2f"), "energy": ("energy %", "+.2f")}


def measure(out, radius, scheme):
    """A quarter of a turn, in cells of 1 mm."""
    wave = (MODULUS * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON)) / DENSITY) ** 0.5
    omega = RIM * wave / radius
    end = np.pi / 2 / omega
    places = np.arange(-radius + 0.25, radius, 0.5)
    columns = [(x, y) for x in places for y in places if x * x + y * y < radius * radius]
    bodies = [_mpm.block(f"column{i}", (x - 0.25, y - 0.25, 0), (0.5, 0.5, 1), (-omega * y, omega * x, 0), 0.5, "elastic")
              for i, (x, y) in enumerate(columns)]
    elastic = _mpm.material("elastic", DENSITY, f'type="IsoElastic" Young="{MODULUS}" Poisson="{POISSON}"')
    box = radius + 3
    text = _mpm.scene(bodies, _mpm.grid((-box, -box, 0), (box, box, 1), "000022"), _mpm.solution(end, scheme, 0.4), [elastic],
                      f'<Console print_time="{end}"/><PostProcessing time_interval="{end}" h5part="1" var="pres"/>')
    folder = out / f"{scheme}-{radius}"
    _common.run(folder, text)
    summary, states = _mpm.summary(folder), _cases.States(folder)
    first, last = (np.column_stack([states.column(a, w) for a in "xy"]) for w in (0, -1))
    rim = np.hypot(*first.T) > radius - 1
    turned = np.arctan2(*(first[rim, 0] * last[rim, 1] - first[rim, 1] * last[rim, 0],
                          first[rim, 0] * last[rim, 0] + first[rim, 1] * last[rim, 1]))
    exact = omega * DENSITY * 0.25 * sum(x * x + y * y for x, y in columns)
    return {"scheme": scheme, "radius": radius, "steps": summary["steps"],
            "momentum": 100 * (summary["angular_momentum"][2] / exact - 1), "lag": 100 * float(1 - turned.mean() / (np.pi / 2)),
            "energy": 100 * summary["energy"]["relative_drift"]}


def main():
    options = _common.arguments(__doc__, "spinning_disc").parse_args()
    verdict = _common.Verdict()
    print(_common.machine(), "\n", flush=True)
    rows = []
    for scheme in ("MUSL", "USF", "USL"):
        coarse, fine = (measure(options.out, radius, scheme) for radius in (5, 10))
        rows += [coarse, fine]
        verdict.expect(abs(fine["momentum"]) < abs(coarse["momentum"]) / 2, f"{scheme}: the loss of angular momentum does not fall")
    _common.write(options.out, "spinning_disc", rows, COLUMNS)
    verdict.finish()


main()
