"""The block of studies/platen.py: steps without inertia beside dynamic relaxation, in turns."""

from studies import platen

SHAPE = "QuadraticBSpline"


class Relaxation(platen.Platen):
    name = "relaxation"
    title = "A platen, beside dynamic relaxation"
    about = f"""The block of the study above with `{SHAPE}`, and its errors. *implicit n*: n steps. *explicit relaxed*: the platen comes to
rest in the first half of {platen.RELAXED["relaxed short"]:g} (*short*) or {platen.RELAXED["relaxed long"]:g} periods of the slowest wave
(*long*), which `DynamicRelax` damps critically; it is in contact; in the implicit steps the block sticks to it. By
`implicit.py run --study relaxation --repeat 3`: the list of runs three times over, of each run the median time."""

    def runs(self):
        return [self.one(by, SHAPE, cells, cells == 8) for cells in (8, 16, 32, 64)
                for by in ("implicit 1", "explicit relaxed short", "implicit 3", "explicit relaxed long")]


STUDY = Relaxation()
