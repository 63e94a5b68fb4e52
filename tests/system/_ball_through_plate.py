"""The ball and the plate of apps/scenes/ball_through_a_plate with other cells, plates and contact, and what is left of them."""

import _cases
import _gallery
import _mpm
import numpy as np

JOB = "ball_through_a_plate"
BALL = 5.0  # mm, radius


def text(cell, radius=40, shape="linear", normal="regression", kind=1, distance=2, gap=0.05, contact=True, end=0.2):
    """`radius`: of the plate; `distance`: type of the criterion of contact, and `gap` of it in cells."""
    changes = _gallery.resolution(cell, shape, normal, kind)
    del changes[".//Geometry"]
    across = (-(-radius // cell) + 2) * cell
    changes |= {".//Body[@name='ball']/Geometry": {"dp": cell / 2},
                ".//Body[@name='plate']/Geometry": {"dp_bottom": cell / 2, "dp_top": cell / 2, "Bottom_Outer_Radius": radius,
                                                    "Top_Outer_Radius": radius},
                ".//XMax": {"value": across}, ".//YMax": {"value": across},
                ".//EndTime": {"value": end}, ".//PostProcessing": {"time_interval": end / 4, "vtk_data": 0}}
    changes[".//Contact"] |= {"distance_type": distance, "min_distance": gap}
    root = _gallery.scene(JOB)
    if not contact:
        root.remove(root.find("Contact"))
        del changes[".//Contact"]
    return _gallery.text(root, changes)


def measure(folder, cell, radius=40):
    """The ball's velocity at the end in m/s; height h of the plate's lip, from the plate's rim to the lowest particles that have not
    failed, and diameter D of the hole between them, means over sectors of ten degrees; `torn`: h/D with the failed particles whose
    neighbours reach up to the lip; `through`: the ball's top is below the lip; the failed fraction of the ball."""
    states, status, summary = _cases.States(folder, JOB), _cases.status(folder, JOB), _mpm.summary(folder, JOB)
    first, now = (np.column_stack([states.column(axis, which) for axis in "xyz"]) for which in (0, -1))
    failed, plate = states.column("fail") > 0, first[:, 2] < 0
    far = np.hypot(first[:, 0], first[:, 1])
    rim = now[plate & (far > 0.9 * radius), 2].mean()
    around, place = np.degrees(np.arctan2(now[:, 1], now[:, 0])), np.hypot(now[:, 0], now[:, 1])
    lip = plate & ~failed & (place > 0.75 * BALL) & (place < 2 * BALL)  # without the plug
    sectors = [lip & (around >= low) & (around < low + 10) for low in range(0, 90, 10)]
    h = rim - np.mean([now[s, 2].min() for s in sectors])
    hole = 2 * np.mean([place[s].min() for s in sectors])
    edge = plate & (place > 0.75 * BALL) & (place < 1.5 * BALL)
    torn = rim - np.mean([hanging(now[edge & (around >= low) & (around < low + 10), 2], rim - h, cell) for low in range(0, 90, 10)])
    return {"particles": summary["particles"], "steps": summary["steps"], "speed": -float(status["vz[body:ball]"][-1]),
            "h": float(h), "D": float(hole), "ratio": float(h / hole), "torn": float(torn / hole), "through": bool(now[~plate, 2].max() < rim - h + cell),
            "failed": 100 * float(failed[~plate].mean()), "drift": 100 * summary["energy"]["relative_drift"]}


def hanging(heights, lip, cell):
    """The lowest of the heights that are reached from the lip downwards without a gap of a cell."""
    below = np.sort(heights[heights < lip])[::-1]
    gaps = np.flatnonzero(np.diff(np.append(lip, below)) < -cell)
    reached = below[: gaps[0]] if len(gaps) else below
    return reached[-1] if len(reached) else lip
