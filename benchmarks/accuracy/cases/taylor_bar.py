"""The copper Taylor bar against the experiment."""

import sys
import xml.etree.ElementTree as ElementTree

from common import results

import methods
from case import Case, Error, Study
from cases import support

FOLDER = results.ROOT / "benchmarks/taylor_bar"
sys.path.append(str(FOLDER))

import bar as measured_bar  # noqa: E402: found by the line above


class TaylorBar(Case):
    name = "taylor_bar"
    title = "Taylor bar"
    about = """The bar of [taylor_bar.xmp](../benchmarks/taylor_bar/taylor_bar.xmp) at 190 m/s, against the experiment (L
16.2, D 13.5, W 10.1 mm; [validation.md](validation.md)). Error: mean of the three relative errors. The experiment's own
error is not known; differences below half a per cent mean little."""
    errors = {"mean": Error("mean error of L, D and W, %", ".2f", 100, order=False), "L": Error("L mm", ".2f", order=False),
              "D": Error("D mm", ".2f", order=False), "W": Error("W mm", ".2f", order=False),
              "drift": Error("energy drift, %", "+.2f", 100, order=False)}
    studies = {"cells": Study("cells along the bar, factor 0.4.", (12, 17, 23, 33), 0.4,
                              fine=(46,), fine_methods=tuple(methods.product(("linear", "SGMP", "cpGIMP", "QuadraticBSpline")))),
               "particles": Study("four particles along a cell.", (8, 12, 17), 0.4, splits=(4,), methods=methods.leading),
               "averaged": Study('with `Volumetric averaging="cell"`.', (12, 17, 23, 33), 0.4, methods=methods.leading),
               "time": Study("17 cells, time step falling.", (17,), (0.9, 0.4, 0.2), axis="factor", methods=methods.leading)}
    plotted = ("cells",)

    def methods(self):
        return methods.short()

    def scene(self, point):
        root = ElementTree.parse(FOLDER / "taylor_bar.xmp").getroot()
        cell = measured_bar.LENGTH / point.cells
        spacing, half = cell / point.split, round(7.6 / cell)
        root.find(".//Geometry").attrib.update(dp_bottom=repr(spacing), dp_top=repr(spacing))
        for axis in "XYZ":
            root.find(f".//{axis}Min").set("value", "0" if axis == "Z" else repr(-half * cell))
            root.find(f".//{axis}Max").set("value", repr((point.cells + 2 if axis == "Z" else half) * cell))
            root.find(".//DCell").set(f"d{axis.lower()}", repr(cell))
        root.find(".//Name").set("value", "case")
        root.find(".//TimeStep").set("factor", repr(point.factor))
        if point.study == "averaged":
            ElementTree.SubElement(root.find("Solution"), "Volumetric", averaging="cell")
        output = root.find("Output")
        output.remove(output.find("Restart"))
        output.find("PostProcessing").attrib.update(vtk_data="0", time_interval=root.find(".//EndTime").get("value"))
        return ElementTree.tostring(root, encoding="unicode")

    def measure(self, point, folder):
        support.States(folder)  # refuses a bar that has lost particles
        sizes = measured_bar.Bar(folder).sizes
        _, mean = measured_bar.errors(sizes)
        return {"mean": mean, **sizes, "drift": support.drift(folder)}


CASE = TaylorBar()
