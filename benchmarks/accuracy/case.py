"""What a case of the accuracy benchmark states: its studies, its methods, its scene and its errors."""

import dataclasses
import math
import sys

from common import results

sys.path.append(str(results.ROOT / "tests/system"))

import methods  # noqa: E402: found from here


@dataclasses.dataclass(frozen=True)
class Point:
    """One run. `factor` is of the critical time step, `split` the particles along a cell."""

    case: str
    study: str
    method: methods.Method
    cells: int
    split: int
    factor: float

    @property
    def key(self):
        m = self.method
        return f"{self.case}/{self.study}/{m.shape}/{m.transfer}/{m.scheme}/{self.cells}/{self.split}/{self.factor:g}"


@dataclasses.dataclass(frozen=True)
class Study:
    """A series of runs: over the cells (axis "cells"), or over the time step with the same cells (axis "factor").

    `steps` is a function of the cells that gives the factors; with a single factor for all the time step is
    proportional to the cell size."""

    about: str
    cells: tuple
    factors: object = 0.5
    splits: tuple = (2,)
    axis: str = "cells"
    quick: tuple = ()  # the cells that are part of --quick, with few methods
    methods: object = None  # a function that gives the study's methods; those of the case where None
    fine: tuple = ()  # cells for `fine_methods` alone
    fine_methods: tuple = ()

    def factors_at(self, cells):
        given = self.factors(cells) if callable(self.factors) else self.factors
        return given if isinstance(given, tuple) else (given,)


@dataclasses.dataclass(frozen=True)
class Error:
    """A measured error: its heading, its format, and a factor for tables (100 for per cent)."""

    heading: str
    how: str = ".2e"
    factor: float = 1.0
    order: bool = True  # falls with refinement by a power of the cell size


class Unmeasurable(Exception):
    """A run that ended well, but left nothing that the error can be taken from; the row then says why."""


class Case:
    """A case: `name`, `title`, `about` (text for the page), `errors` ({column: Error}, the first is the one plotted),
    `studies` ({name: Study}). Scenes leave shape, transfer and scheme out: the driver puts them in."""

    name = title = about = ""
    errors = {}
    studies = {}
    plotted = ()  # studies with a plot of error against run time; all with axis "cells" where empty

    def methods(self):
        return methods.every_scheme()

    def excluded(self, method):
        """Why the case leaves a method out; None where it does not."""
        return None

    def scene(self, point):
        """Text of the input file."""
        raise NotImplementedError

    def files(self, point):
        """{name: text} of the files beside it that it names."""
        return {}

    def measure(self, point, folder):
        """{error: value} of the run in `folder`."""
        raise NotImplementedError

    def methods_of(self, study, every=False):
        """Those that the study names, or `every` one; without those that the case leaves out."""
        chosen = methods.every if every else self.studies[study].methods or self.methods
        return [m for m in chosen() if self.excluded(m) is None]

    def points(self, quick=False, every=False):
        """Those of the studies; `quick`: of the coarse grids, with few methods; `every`: with every method."""
        return [point for study in self.studies for method in self.methods_of(study, every)
                if not quick or method in methods.quick() for point in self.points_of(study, method, quick)]

    def points_of(self, name, method, quick=False):
        study = self.studies[name]
        cells = study.quick if quick else study.cells + (study.fine if method in study.fine_methods else ())
        return [Point(self.name, name, method, n, split, factor)
                for split in study.splits for n in cells for factor in study.factors_at(n)]

    def all_points(self):
        """The same, those of the studies first."""
        return list(dict.fromkeys([*self.points(), *self.points(quick=True), *self.points(every=True)]))


def order(coarse, fine, ratio):
    """Observed order between two errors whose cell or step sizes have this ratio; None where there is none."""
    if not (coarse and fine and coarse > 0 and fine > 0 and math.isfinite(coarse) and math.isfinite(fine)):
        return None
    return math.log(coarse / fine) / math.log(ratio)
