"""Slopes of clay and sand in plane strain, one cell thick (apps/scenes/slopes), with other soils and cells, and what is
measured of them."""

import math

import _cases
import _gallery
import _granular
import _mpm
import numpy as np

JOB = "slopes"
TOE, CREST = 15.0, 35.0  # heights, m
TOE_X = 50.0
DENSITY = 2100.0
# Thesis, tables 6.1 to 6.3 and the text of 6.3: law, seconds until the slide has stopped, repose in degrees, largest displacement in m.
SOILS = {"clay": {"phi": 20, "c": 10e3}, "sand": {"phi": 20, "c": 100}, "dry 20": {"phi": 20, "c": 0}, "dry 30": {"phi": 30, "c": 0},
         "dry 40": {"phi": 40, "c": 0}}
TIMES = {"clay": 5.8, "sand": 8.0, "dry 20": 8.0, "dry 30": 7.6, "dry 40": 8.5}
REPOSE = {"sand": 15.5, "dry 20": 15.2, "dry 30": 22.0, "dry 40": 29.0}
DISPLACEMENT = 7.5  # clay
PLAIN_LAW = {"closes": 0, "VarSoundspeed": 0}
# The method of the thesis.
THESIS = {".//Grid": {"shape": "linear"}, ".//Solution": {"transfer": "FLIP"}, ".//StrengthModel": PLAIN_LAW}


def text(soil, cell=1.0, changes=None):
    """`cell`: the slope's lengths are multiples of it (2.5, 1 or 0.5 m)."""
    law = SOILS[soil] | (changes or {}).get(".//StrengthModel", {})
    # No tension beyond the cone's tip, c/tan phi: in the thesis, too, whose 27.48 kPa for clay are just that.
    tip = math.floor(law["c"] / math.tan(math.radians(law["phi"])))
    every = {".//DCell": dict.fromkeys(("dx", "dy", "dz"), cell), ".//YMax": {"value": cell}, ".//ZMax": {"value": math.ceil(38 / cell) * cell},
             **{f".//Body[@name='{name}']/Geometry": {"ly": cell, "dp": cell / _granular.SPACINGS} for name in ("ground", "bank")},
             ".//PostProcessing": {"vtk_data": 0}}
    return _gallery.text(_gallery.scene(JOB), {**every, **(changes or {}), ".//StrengthModel": {"ten_f": tip, **law}})


def stopped(times, moved):
    """When 99 % of the last value of `moved` is reached for good."""
    return times[np.flatnonzero(moved < 0.99 * moved[-1])[-1] + 1]


def measure(folder):
    """The largest displacement along x, and how far the foremost soil of the slope is in front of the toe; when the displacement
    that one particle in a hundred exceeds has come to 99 % of its last value; repose between a tenth and nine tenths of the height;
    kinetic energy at the end over what gravity has released; the least density under pressure."""
    heap, states, summary = _granular.Heap(folder, JOB, DENSITY), _cases.States(folder, JOB), _mpm.summary(folder, JOB)
    first, bank = states.column("x", 0), states.column("z", 0) > TOE
    moved = [states.column("x", which) - first for which in range(len(states.times))]
    tenth = 0.1 * (CREST - TOE)
    pressed = heap.pressure > 1e-3 * DENSITY * 9.8 * (CREST - TOE)
    return {"particles": summary["particles"], "steps": summary["steps"], "largest": moved[-1].max(),
            "toe": states.column("x")[bank].max() + heap.spacing / 2 - TOE_X,
            "time": stopped(states.times, np.array([np.quantile(along, 0.99) for along in moved])),
            "repose": heap.repose(TOE + tenth, CREST - tenth)[0],
            "kinetic": summary["energy"]["kinetic"] / summary["energy"]["external_work"],
            "pressed": heap.density[pressed].min(), "drift": 100 * summary["energy"]["relative_drift"]}
