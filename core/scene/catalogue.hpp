#pragma once
// The parameter tables of the material laws. `physics` fills a Catalogue; `io` uses it to check the input and
// print the keyword reference. Neither includes the other: the applications pass the catalogue.

#include <limits>
#include <string_view>
#include <vector>

namespace mpm::core {

inline constexpr double unbounded = std::numeric_limits<double>::infinity();
inline constexpr double no_default = std::numeric_limits<double>::quiet_NaN();

/// One attribute of a material law. Ranges are closed unless `min_open` or `max_open` says otherwise.
struct ParameterInfo {
  std::string_view name;  ///< the attribute's spelling in the input
  /// Value when the attribute is absent; `no_default` omits it from the law's values (the law can then detect
  /// that it was not given). Ignored when `required`.
  double default_value = no_default;
  bool required = false;
  double min = -unbounded;
  double max = unbounded;
  bool min_open = false;
  bool max_open = false;
  bool integer = false;  ///< only integers are accepted
  std::string_view dimension =
      "1";                   ///< "stress", "1", "density", "time", "1/time", "energy/(mass temperature)" ...
  std::string_view meaning;  ///< one line for the keyword reference
  /// Attributes of one law with the same non-empty group are given all together or not at all (D1 .. D5).
  std::string_view group = {};
  /// Every finite number is valid: set by an external law's parameter without a range.
  bool any_number = false;
};

/// One type of strength model, equation of state or failure model.
struct TypeInfo {
  std::string_view name;  ///< the value of `type=` in the input
  std::string_view summary;
  std::vector<ParameterInfo> parameters;
};

/// All laws. The common tables apply to every type of their family; a type's own entry of the same name takes
/// precedence (so a type can make a common parameter required, or narrow its range).
struct Catalogue {
  std::vector<ParameterInfo> common_strength;  ///< bq1, bq2, FailedType, ..., Young, Poisson, SpecHeat
  std::vector<ParameterInfo> common_eos;       ///< C0, E0
  std::vector<TypeInfo> strength;
  std::vector<TypeInfo> eos;
  std::vector<TypeInfo> failure;
};

}  // namespace mpm::core
