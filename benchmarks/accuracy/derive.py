"""Body forces of manufactured motions of a neo-Hookean solid, derived with SymPy and written in the input language.

With the law of physics/strength/neo_hookean.hpp the first Piola-Kirchhoff stress is
  P = mu (F - F^-T) + lambda ln J F^-T,   and   b = d2x/dt2 - Div P / rho0.
tests/system/benchmarks_accuracy.py compares the written expressions with differences of the motion."""

import dataclasses
import re

import sympy as sp
from sympy.printing.str import StrPrinter

X, Y, Z, T = sp.symbols("X Y Z t", real=True)


@dataclasses.dataclass(frozen=True)
class Solid:
    """Neo-Hookean: Young's modulus, Poisson's ratio, density."""

    young: float
    poisson: float
    density: float

    @property
    def shear(self):
        return self.young / (2 * (1 + self.poisson))

    @property
    def lame(self):
        return self.young * self.poisson / ((1 + self.poisson) * (1 - 2 * self.poisson))

    @property
    def wave_speed(self):
        return ((self.lame + 2 * self.shear) / self.density) ** 0.5

    @property
    def law(self):
        """StrengthModel without artificial viscosity, whose effect is an error of first order in smooth flow."""
        return f'type="NeoHookean" Young="{self.young!r}" Poisson="{self.poisson!r}" bq1="0" bq2="0"'


class InputPrinter(StrPrinter):
    """Expressions as muParser reads them."""

    def _print_Pow(self, power, rational=False):
        base, exponent = power.as_base_exp()
        if exponent == sp.Rational(1, 2):
            return f"sqrt({self._print(base)})"
        if exponent == sp.Rational(-1, 2):
            return f"1/sqrt({self._print(base)})"
        whole = self._print(base) if base.is_Symbol else f"({self._print(base)})"
        if exponent.is_Integer and abs(exponent) < 4:  # products: the program calls pow for all other powers
            return ("1/" if exponent < 0 else "") + "*".join([whole] * abs(int(exponent))).join("()")
        return f"{whole}^({self._print(exponent)})"

    def _print_Mul(self, product):
        plain = [a for a in product.args if a != 1]
        return "*".join(self._print(a) if a.is_Symbol or a.is_Function else f"({self._print(a)})" for a in plain) or "1"

    def _print_log(self, function):
        return f"ln({self._print(function.args[0])})"

    def _print_Float(self, number):
        return repr(float(number))

    def _print_Rational(self, number):
        return repr(float(number))


def written(expression, **names):
    """In the input language; numbers in full precision. `names`: texts that stand for symbols."""
    text = InputPrinter().doprint(sp.sympify(expression)).replace(" ", "")
    for name, meaning in names.items():
        text = re.sub(rf"\b{name}\b", lambda _, meaning=meaning: f"({meaning})", text)
    return text


def piola(gradient, solid):
    inverse = gradient.inv().T
    return solid.shear * (gradient - inverse) + solid.lame * sp.log(gradient.det()) * inverse


def along_axes(displacements, solid):
    """Body force of x_i = X_i + u_i(X_i, t): the gradient is diagonal, and each component needs one derivative.

    Written with one logarithm and as a product, since the program evaluates it for every particle in every step."""
    places = (X, Y, Z)
    stretch = [1 + sp.diff(u, at) for u, at in zip(displacements, places)]
    log_j = sp.Symbol("log_j")
    force = []
    for u, at, s in zip(displacements, places, stretch):
        f = sp.Function("f")(at)  # the stretch along this axis; the others do not depend on its place
        others = sp.Symbol("others")
        stress = solid.shear * (f - 1 / f) + solid.lame * (sp.log(f) + others) / f
        slope = sp.Symbol("slope")
        divergence = sp.diff(stress, at).subs(sp.diff(f, at), slope).subs(sp.log(f), log_j - others)
        divergence = sp.factor(sp.simplify(divergence)).subs({f: s, slope: sp.diff(s, at)})
        force.append((sp.diff(u, T, 2) - divergence / solid.density).subs(log_j, sp.log(sp.Mul(*stretch, evaluate=False))))
    return force


RADIUS, SPIN, GAIN, SLOPE, BEND = sp.symbols("R spin gain slope bend", real=True)


def turning_rings(solid):
    """Radial and circumferential body force, in axes that turn with the point, of a motion in which each ring R turns by
    an angle alpha(R, t); a function of RADIUS and of alpha's derivatives SPIN, GAIN (in t) and SLOPE, BEND (in R).

    Derived at the point (R, 0) from the terms of alpha's Taylor series that second derivatives see; there is no change
    of volume, so that F^-T is the cofactor matrix."""
    away = sp.sqrt(X**2 + Y**2) - RADIUS
    alpha = SPIN * T + GAIN * T**2 / 2 + SLOPE * away + BEND * away**2 / 2
    place = sp.Matrix([sp.cos(alpha) * X - sp.sin(alpha) * Y, sp.sin(alpha) * X + sp.cos(alpha) * Y])
    gradient = place.jacobian([X, Y])
    cofactor = sp.Matrix([[gradient[1, 1], -gradient[1, 0]], [-gradient[0, 1], gradient[0, 0]]])
    stress = solid.shear * (gradient - cofactor)
    at_point = {T: 0, Y: 0}
    force = []
    for i in range(2):
        divergence = sum(sp.diff(stress[i, j], at) for j, at in enumerate((X, Y)))
        total = (sp.diff(place[i], T, 2) - divergence / solid.density).subs(at_point)
        force.append(sp.expand(total.subs(X, sp.Symbol("r", positive=True)).subs(RADIUS, sp.Symbol("r", positive=True))
                               .subs(sp.Symbol("r", positive=True), RADIUS)))
    return force
