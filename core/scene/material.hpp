#pragma once
// Materials from the input: the names and values of each law's parameters, checked, with defaults filled in.
// Units are the user's own and consistent throughout.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/errors.hpp"

namespace mpm::core {

/// Values by attribute name. Contains every attribute that was given or has a default.
using ParameterValues = std::map<std::string, double, std::less<>>;

/// A strength model, equation of state or failure model: its type and its parameters.
struct LawInput {
  std::string type;  ///< as in the input: "JohnsonCook", "Gruneisen", "PlaStrain" ...
  ParameterValues values;
  SourceLocation source;

  bool has(std::string_view name) const { return values.find(name) != values.end(); }
  /// The value, which must exist: the reader ensures required values and defaults.
  double at(std::string_view name) const;
  double value_or(std::string_view name, double otherwise) const;
};

struct FailureInput : LawInput {
  bool erosion = false;  ///< failed particles are deleted
};

/// Scatter of the failure thresholds over particles or cells.
struct RandomFailureInput {
  enum class Spread { particle = 1, cell = 2 };
  enum class Distribution { constant = 0, gauss = 1, weibull = 2 };

  bool enable = false;
  Spread spread = Spread::particle;
  Distribution distribution = Distribution::constant;
  double gauss_mean = 1;
  double gauss_deviation = 0.2;
  double weibull_median = 1.2549;
  double weibull_modulus = 20.270;
  double weibull_reference_volume = 1;
  double weibull_particle_volume = 1000;
  bool random_damage = false;  ///< the damage threshold scatters too
};

/// Where the artificial viscosity acts: in all compression, or in shocks only.
enum class ViscosityLimiter { none, shock };

struct MaterialInput {
  std::string name;
  double reference_density = 0;  ///< mass/length^3, > 0
  ViscosityLimiter limiter = ViscosityLimiter::none;
  LawInput strength;
  std::optional<LawInput> eos;
  std::vector<FailureInput> failures;  ///< at most ten; `none` adds no entry
  RandomFailureInput random_failure;
  SourceLocation source;
};

/// Between the surfaces of two materials.
struct Friction {
  double coefficient = 0;  ///< Coulomb's, >= 0
  /// What is pressed together does not slide: the weaker material shears instead.
  bool rough = false;

  /// Of rough surfaces: more shear for its pressure than any material bears.
  static constexpr double of_rough = 1e3;
  bool operator==(const Friction&) const = default;
};

/// Friction of two materials; indices into Scene::materials.
struct FrictionPair {
  std::size_t first_material = 0;
  std::size_t second_material = 0;
  Friction friction;
};

}  // namespace mpm::core
