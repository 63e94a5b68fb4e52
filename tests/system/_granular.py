"""Heaps of soil in plane strain, one cell thick (apps/scenes/sand_column, aluminium_rods), with other cells and
proportions, and what is measured of them."""

import xml.etree.ElementTree as ElementTree

import _cases
import _gallery
import _mpm
import numpy as np

SPACINGS = 2  # particles along a cell's edge


def lube_run_out(a):
    """(d - d0)/d0 of a column of height a d0 in plane strain. G. Lube, H. E. Huppert, R. S. J. Sparks and A. Freundt, Physical
    Review E 72 (2005) 041301: 1.2 a below 1.8, 1.9 a^(2/3) above 2.8; quoted after S. Dunatunga and K. Kamrin,
    arXiv 1411.5447."""
    if 1.8 < a < 2.8:
        raise ValueError("no law between 1.8 and 2.8")
    return 1.2 * a if a <= 1.8 else 1.9 * a ** (2 / 3)


def lajeunesse(a):
    """Run-out and height at the end over the foot of a column in a rectangular channel. E. Lajeunesse, J. B. Monnier and G. M. Homsy, Physics of
    Fluids 17 (2005) 103302: 1.2 a below 2.3 and 1.9 a^(2/3) above; a below 0.7 and a^(1/3) above. Quoted after K. Kumar's thesis (Cambridge,
    chapter 2; github.com/kks32/phd-thesis), which has Lube's constants for the run-out."""
    return 1.2 * a if a <= 2.3 else 1.9 * a ** (2 / 3), a if a <= 0.7 else a ** (1 / 3)


FRICTION = 0.6009  # of the sand, tan 31 degrees


def rigid_floor(root, cell, length, friction):
    """The sand's fixed wall at z = 0 becomes the surface of a rigid body with this coefficient of friction."""
    root.find(".//ZMin").attrib.update(boundary="0", value=repr(-2 * cell))
    body = f"""<Floor>
      <Material name="rigid"> <ReferenceDensity value="1600"/> <StrengthModel type="Rigid"/> </Material>
      <Friction> <Coefficient value="{friction}" mat1="sand" mat2="rigid"/> </Friction>
      <Component name="floor" normal_vector_weight="1"> <Body name="floor" material="rigid" type="Block">
        <Geometry x0="0" y0="0" z0="{-2 * cell}" lx="{length}" ly="{cell}" lz="{2 * cell}" dp="{cell / SPACINGS}"/>
        <PrescribedVelocity vx="0" vy="0" vz="0"/> </Body> </Component>
      <Contact enable="1" contact_type="1" distance_type="2" min_distance="0.05" contact_normal="regression"/> </Floor>"""
    material, rubs, floor, contact = ElementTree.fromstring(body)
    for what, before in ((material, "Component"), (rubs, "Component"), (floor, "Grid"), (contact, "Solution")):
        root.insert(list(root).index(root.find(before)), what)


def sand_column(a, cells, changes=None, d0=0.1, friction=None):
    """`cells`: along the column's foot; `friction`: on a rigid floor, or None: the sand sticks to the grid's fixed wall. To 10 times
    sqrt(height/g): then it has long stopped, and the few lone grains, which nothing slows down, have left the grid."""
    cell, height = d0 / cells, a * d0
    end = 10 * (height / 9.81) ** 0.5
    length, above = d0 * (1 + 2.5 * lube_run_out(a)), height + 3 * cell
    grid = {".//XMax": length, ".//YMax": cell, ".//ZMax": above}
    every = {path: {"value": max(1, round(value / cell)) * cell} for path, value in grid.items()}
    root = _gallery.scene("sand_column")
    text = _gallery.text(root, {
        **every, ".//Geometry": {"dp": cell / SPACINGS, "lx": d0, "ly": cell, "lz": height},
        ".//DCell": dict.fromkeys(("dx", "dy", "dz"), cell), ".//EndTime": {"value": end},
        ".//Console": {"print_time": end / 200}, ".//PostProcessing": {"time_interval": end, "vtk_data": 0}, **(changes or {})})
    if friction is None:
        return text
    rigid_floor(root, cell, every[".//XMax"]["value"], friction)
    return ElementTree.tostring(root, encoding="unicode")


def sand_sheet(layers, cells=20, speed=0.5, friction=None, d0=0.1):
    """A sheet of so many layers of particles that slides on the floor, far from the walls."""
    cell = d0 / cells
    root = ElementTree.fromstring(sand_column(1, cells, {".//Geometry": {"x0": 0.2 * d0, "dp": cell / SPACINGS, "lx": d0, "ly": cell, "lz": layers * cell / SPACINGS},
                                                         ".//EndTime": {"value": 0.4}, ".//PostProcessing": {"time_interval": 0.4, "vtk_data": 0}}, d0, friction))
    root.find(".//Body[@name='sand']").append(ElementTree.Element("InitialVelocity", {"vx": repr(speed), "vy": "0", "vz": "0"}))
    return ElementTree.tostring(root, encoding="unicode")


def measure_sand_sheet(folder, speed=0.5):
    """The mean way of the sand over that of Coulomb's friction, v^2/(2 mu g), and of its top layer; its velocity at the end over the first."""
    states, summary = _cases.States(folder, "sand_column"), _mpm.summary(folder, "sand_column")
    height = states.column("z", 0)
    way = (states.column("x") - states.column("x", 0)) / (speed**2 / (2 * FRICTION * 9.81))
    top = height > height.max() - 1e-6
    return {"steps": summary["steps"], "way": float(way[height > 0].mean()), "top": float(way[top].mean()),
            "left": float(states.column("velocity_0")[height > 0].mean() / speed)}


class Heap:
    """The last state: thickness over x, of the soil at its first density, in strips one cell wide."""

    def __init__(self, folder, job, density):
        states = _cases.States(folder, job)
        soil = states.column("z", 0) > 0  # not the base
        mine = np.isin(states.column("id"), states.column("id", 0)[soil])  # some grains may have left the grid
        first = np.unique(np.round(states.column("x", 0)[soil], 9))
        self.spacing = first[1] - first[0]
        self.width = SPACINGS * self.spacing
        self.x, self.z, self.density, self.pressure = (states.column(name)[mine] for name in ("x", "z", "density", "pres"))
        self.speed = np.sqrt(sum(states.column(f"velocity_{axis}")[mine] ** 2 for axis in range(3)))
        self.mass = density * self.spacing**3
        self.density /= density
        count = np.histogram(self.x, np.arange(0, self.x.max() + 2 * self.width, self.width))[0]
        self.thickness = count * self.spacing**2 / (SPACINGS * self.width)
        self.middle = self.width * (np.arange(len(count)) + 0.5)

    def repose(self, low, high, foot=0.0):
        """Slope of the surface between the heights `low` and `high`, in degrees, and where it would reach the height `foot`."""
        strips = [self.z[(self.x >= x) & (self.x < x + self.width)] for x in self.middle - self.width / 2]
        top = np.array([strip.max(initial=0.0) for strip in strips])
        slope = (top > low) & (top < high)
        fall, start = np.polyfit(self.middle[slope], top[slope], 1)
        return float(np.degrees(np.arctan(-fall))), float((foot - start) / fall)

    def kinetic(self, front):
        """Of the soil up to `front`."""
        return 0.5 * (self.mass * self.speed**2)[self.x < front].sum()

    def front(self, thin):
        """Where the thickness first falls to `thin`."""
        below = np.flatnonzero(self.thickness < thin)[0]
        left, right = self.thickness[below - 1], self.thickness[below]
        return self.middle[below - 1] + self.width * (left - thin) / (left - right)


def measure_sand_column(folder, a, d0=0.1):
    """Run-out over d0, to where the heap is thinner than 1 % of d0 (a grain of the experiments), 2 or 5 %, the errors of the first
    by Lube's and Lajeunesse's laws; the place within which 98 % of the sand is, the height over d0, its error by Lajeunesse's law, the kinetic energy over what gravity released, of all and of the heap alone, and the density."""
    heap, summary = Heap(folder, "sand_column", 1600), _mpm.summary(folder, "sand_column")
    run_out, two, thick = ((heap.front(thin * d0) - d0) / d0 for thin in (0.01, 0.02, 0.05))
    released, height = summary["energy"]["external_work"], (heap.z.max() + heap.spacing / 2) / d0
    pressed = heap.pressure > 1e-3 * 1600 * 9.81 * a * d0
    return {"particles": summary["particles"], "steps": summary["steps"], "run_out": run_out, "two": two, "thick": thick,
            "most": (np.quantile(heap.x, 0.98) - d0) / d0,
            "error": 100 * (run_out / lube_run_out(a) - 1), "height": height, "lajeunesse": 100 * (run_out / lajeunesse(a)[0] - 1),
            "height_error": 100 * (height / lajeunesse(a)[1] - 1),
            "farthest": (heap.x.max() - d0) / d0, "kinetic": summary["energy"]["kinetic"] / released,
            "heap": heap.kinetic(d0 * (1 + run_out)) / released, "density": heap.density.mean(),
            "pressed": heap.density[pressed].min(), "loose": 100 * (heap.density < 0.8).mean(),
            "drift": 100 * summary["energy"]["relative_drift"]}


def aluminium_rods(cells, base="contact", changes=None):
    """`cells`: over the height of 0.1 m; `base`: contact with a rigid body, or the grid's fixed wall."""
    cell = 0.1 / cells
    root = _gallery.scene("aluminium_rods")
    if base == "wall":
        root.remove(root.find("Component[@name='base']"))
        for name in ("Material[@name='rigid']", "Friction", "Contact"):
            root.remove(root.find(name))
        root.find(".//ZMin").set("boundary", "1")
    bottom, length = (-2 * cell if base == "contact" else 0), round(0.8 / cell) * cell
    every = {".//Geometry": {"dp": cell / SPACINGS, "ly": cell}, ".//DCell": dict.fromkeys(("dx", "dy", "dz"), cell),
             ".//XMax": {"value": length}, ".//YMax": {"value": cell}, ".//ZMin": {"value": bottom},
             ".//ZMax": {"value": 0.1 + 3 * cell}, ".//PostProcessing": {"time_interval": 1, "vtk_data": 0}}
    if base == "contact":
        every[".//Body[@name='base']/Geometry"] = {"lx": length, "z0": bottom, "lz": -bottom}
    return _gallery.text(root, every | (changes or {}))


def measure_aluminium_rods(folder):
    """Angle of repose: the slope of the surface between a tenth and nine tenths of the first height; its foot; when the
    kinetic energy has fallen to a twentieth of its largest; how much of what gravity released is left of it."""
    heap, summary = Heap(folder, "aluminium_rods", 2650), _mpm.summary(folder, "aluminium_rods")
    repose, foot = heap.repose(0.01, 0.09)
    status = _cases.status(folder, "aluminium_rods")
    kinetic = status["kinetic"]
    moving = np.flatnonzero(kinetic > kinetic.max() / 20)[-1]
    return {"particles": summary["particles"], "steps": summary["steps"], "repose": repose, "foot": foot,
            "flow": float(status["time"][moving]), "kinetic": kinetic[-1] / summary["energy"]["external_work"],
            "density": heap.density.mean(), "drift": 100 * summary["energy"]["relative_drift"]}
