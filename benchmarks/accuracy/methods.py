"""Shapes, transfers and schemes, as the program's own specification of its input lists them: a new one is measured without
a change here. What is listed there and not implemented yet is refused by the program, and recorded as refused."""

import dataclasses
import functools
import xml.etree.ElementTree as ElementTree

from common import results


@functools.cache
def choices(element, attribute):
    """Values that Specification.xml allows for an attribute of an element of the root."""
    root = ElementTree.parse(results.ROOT / "io/input/Specification.xml").getroot()
    for key, text in root.find(f".//{element}").attrib.items():
        words = [word.strip() for word in text.split(",")]
        if key.startswith("attribute") and words[0] == attribute:
            return tuple(words[3].split("|"))
    raise SystemExit(f"Specification.xml: no attribute {attribute} of {element}")


def shapes():
    return choices("Grid", "shape")


CONSISTENT = "consistent"  # FLIP with the consistent mass matrix
# What the tables show as transfers of their own: {name: attributes of Solution}.
VARIANTS = {"FMPM(5)": {"transfer": "FMPM", "xpic_order": "5"}, CONSISTENT: {"mass": "consistent"},
            "FMPM(16)": {"transfer": "FMPM", "xpic_order": "16"}}
FEW = ("FMPM(16)",)  # those that only the cases that name them measure


def transfers():
    return (*choices("Solution", "transfer"), *VARIANTS)


def schemes():
    """The schemes; auto is MUSL, then USAVG where the energy asks for it."""
    return [word for word in choices("Solution", "algorithm") if word != "auto"]


@dataclasses.dataclass(frozen=True, order=True)
class Method:
    shape: str
    transfer: str = "FLIP"
    scheme: str = "MUSL"

    def __str__(self):
        return f"{self.shape} {self.transfer} {self.scheme}"


def product(some_shapes=None, some_transfers=("FLIP",), some_schemes=("MUSL",)):
    return [Method(s, t, a) for s in some_shapes or shapes() for t in some_transfers for a in some_schemes]


def flip():
    """Every shape with FLIP and MUSL."""
    return product()


def every_scheme():
    return product(some_schemes=schemes())


def usual_transfers():
    return tuple(t for t in transfers() if t not in FEW)


def every_transfer(some_shapes=None, some_schemes=("MUSL",)):
    return product(some_shapes, usual_transfers(), some_schemes)


def every():
    """Every shape with every transfer and scheme: also those that the program refuses."""
    return product(None, transfers(), schemes())


def quick():
    """Every shape with FLIP, and one affine transfer."""
    return [*flip(), Method("QuadraticBSpline", "APIC")]


def short():
    """Every shape with FLIP and MUSL; the other schemes and transfers with few shapes."""
    return list(dict.fromkeys([*flip(), *product(("linear", "QuadraticBSpline"), some_schemes=schemes()),
                               *product(("QuadraticBSpline",), usual_transfers()), *product(("cpGIMP",), ("APIC", "AFLIP"))]))


def leading():
    """Those that lead the tables of docs/choosing.md, and linear functions: what more particles, averages and steps do to them."""
    return product(("linear", "cpGIMP", "QuadraticBSpline", "CubicBSpline", "SGMP"))


def choose(root, method):
    """Puts the method into a scene, the root of an input file."""
    root.find("Grid").set("shape", method.shape)
    for name, value in VARIANTS.get(method.transfer, {"transfer": method.transfer}).items():
        root.find("Solution").set(name, value)
    root.find("Solution").set("algorithm", method.scheme)
