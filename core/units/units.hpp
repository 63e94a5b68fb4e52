// Dimensions and units. A law's table uses "energy/(mass temperature)", a data sheet "J/(kg K)", a case "mm g
// ms": all three are parsed here, and quantities are converted between them.
//
// A product is written with blanks, a quotient with one slash and brackets around a longer denominator, a
// power as ^2, ^-1, ^0.5 or ^name where name is another parameter of the law (stress time^nn).
// Temperatures are absolute. Shown by tests/core/units/units_test.cpp.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace mpm::core {

/// An invalid dimension, unit or system of units; what() names the part and suggests the nearest.
class UnitError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Exponents of the base quantities: stress is length -1, mass 1, time -2.
struct Dimension {
  double length = 0, mass = 0, time = 0, temperature = 0;

  friend bool operator==(const Dimension&, const Dimension&) = default;
};
Dimension operator*(const Dimension& a, const Dimension& b);
Dimension operator/(const Dimension& a, const Dimension& b);
Dimension power(const Dimension& a, double exponent);
/// As in the laws' tables where possible: "stress", "1/time"; otherwise in length, mass, time.
std::string to_text(const Dimension& dimension);

/// The value of another parameter, for exponents by name; nothing where it is not known.
using ExponentOf = std::function<std::optional<double>(std::string_view name)>;

/// "stress time", "1/temperature", "stress time^nn"; throws UnitError.
Dimension parse_dimension(std::string_view text, const ExponentOf& exponent_of = {});

/// A unit: its dimension, and its size in SI units.
struct Unit {
  Dimension dimension;
  double in_si = 1;
};
/// "MPa", "kg/m^3", "J/(kg K)", "cm/us", "1"; throws UnitError.
Unit parse_unit(std::string_view text);

/// A number with its unit: "90 MPa", "0.31"; a number alone is dimensionless. Throws UnitError.
struct Quantity {
  double value = 0;
  Unit unit;
};
Quantity parse_quantity(std::string_view text);

/// The units of a case: one of length, one of mass, one of time; temperatures are in kelvin.
class UnitSystem {
 public:
  UnitSystem() = default;  ///< m kg s
  /// "mm g ms", "kg m s", "cm g us", "SI", "cgs", in any order; throws UnitError.
  static UnitSystem parse(std::string_view text);

  /// Size of one unit of this system in SI units.
  double in_si(const Dimension& dimension) const;
  /// The quantity's value in this system.
  double value_of(const Quantity& quantity) const;
  /// "mm g ms"
  std::string name() const;
  /// Unit of a value of this dimension: "MPa", "mm/ms", "g/mm^3", "K", "1".
  std::string unit_name(const Dimension& dimension) const;

  friend bool operator==(const UnitSystem&, const UnitSystem&) = default;

 private:
  struct Base {
    std::string_view symbol;
    double in_si = 1;
    friend bool operator==(const Base&, const Base&) = default;
  };
  std::array<Base, 3> bases_{{{"m", 1}, {"kg", 1}, {"s", 1}}};  ///< length, mass, time
};

/// Converts `value` from the units of `from` to those of `to`.
double convert(double value, const UnitSystem& from, const UnitSystem& to, const Dimension& dimension);

}  // namespace mpm::core
