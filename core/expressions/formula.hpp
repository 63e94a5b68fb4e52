// A compiled expression of position and time: + - * / ^, comparisons, && ||, ?: and if(condition, a, b), pi,
// sqrt, ln, exp, sin and the other functions of muParser, which parses and evaluates it. Its variables are
// the current position x, y, z, the initial position X, Y, Z and the time t. Tested by
// tests/core/expressions/formula_test.cpp.
#pragma once

#include <bitset>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// Values of the variables.
struct PlaceAndTime {
  Vec3<double> place{};
  Vec3<double> first_place{};
  double time = 0;
};

/// The variables in an expression: x, y, z are 0 to 2, X, Y, Z are 3 to 5, t is 6.
using VariableSet = std::bitset<7>;
inline constexpr std::string_view variable_names = "xyzXYZt";
/// Those named in a text, such as "x y z t".
VariableSet variables_named(std::string_view text);
/// `x, y, z, t`
std::string in_words(const VariableSet& variables);

/// `infinite` or `not a number`, for a value that is one of these.
std::string_view not_finite_in_words(double value);

class Formula {
 public:
  /// The error in the text of a formula, or the variables that it uses and, if it uses none, its value.
  struct Check {
    std::string error;         ///< empty if it is well formed
    std::string unknown_name;  ///< the name in the text, if that is the error
    VariableSet uses;
    std::optional<double> constant;
  };
  static Check check(std::string_view text);
  /// The names of the functions and constants.
  static std::vector<std::string> known_names();

  /// `text` has passed the check.
  explicit Formula(const std::string& text);
  ~Formula();
  Formula(Formula&&) noexcept;
  Formula& operator=(Formula&&) noexcept;

  /// May be infinite or not a number. Not thread-safe.
  double operator()(const PlaceAndTime& at);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace mpm::core
