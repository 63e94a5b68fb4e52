// Common part of the checks of the laws: the sample's material, its paths, and the failures.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "physics/checks/law_checks.hpp"
#include "physics/checks/random_path.hpp"
#include "physics/material/material.hpp"
#include "physics/point/point_driver.hpp"

namespace mpm::physics::checks {

inline double norm(const core::Sym3<double>& a) { return std::sqrt(contract(a, a)); }

class Checker {
 public:
  Checker(const LawSample& of, const Registry& laws)
      : sample(of), registry(laws), material(make()), traits(material->laws().strength->traits()) {}

  const LawSample& sample;
  const Registry& registry;
  std::unique_ptr<Material> material;
  StrengthTraits traits;
  std::vector<std::string> failures;

  std::unique_ptr<Material> make() const { return make_material(sample.input, sample.detonations, registry); }
  RandomPath path(unsigned seed) const { return {seed, sample.strain, sample.duration}; }
  PointDriver::Options with_viscosity() const { return {.cell_size = sample.cell_size}; }
  /// rho0 c0^2, the scale of round-off.
  double stiffness() const {
    return sample.input.reference_density * std::pow(material->initial_sound_speed(), 2);
  }
  /// False for bars, whose axis is x, and rigid bodies: for checks on tensors.
  bool solid() const { return !traits.rigid && !traits.uniaxial; }

  /// Fails unless `found` is at most `allowed`; NaN always fails.
  void at_most(double found, double allowed, const std::string& what) {
    if (found <= allowed) return;
    std::ostringstream text;
    text.precision(6);
    text << what << ": " << found << ", allowed is " << allowed;
    failures.push_back(text.str());
  }
  void require(bool holds, const std::string& what) {
    if (!holds) failures.push_back(what);
  }
  /// |a - b| within `relative` of the larger, and `margin`.
  void near(double a, double b, double relative, double margin, const std::string& what) {
    at_most(std::abs(a - b), relative * std::max(std::abs(a), std::abs(b)) + margin, what);
  }
};

/// Follows the path; calls `visit()` after every step. Returns the largest stress, the scale of negligible
/// values.
template <class Visit>
double walk(PointDriver& point, const RandomPath& path, int steps, Visit visit) {
  double largest = 0;
  const double dt = path.duration() / steps;
  for (int i = 0; i < steps; ++i) {
    point.step(path.gradient((i + 0.5) * dt), dt);
    largest = std::max(largest, norm(point.stress()));
    visit();
  }
  return largest;
}
inline double walk(PointDriver& point, const RandomPath& path, int steps) {
  return walk(point, path, steps, [] {});
}

using Failures = std::vector<std::string>;
// checks/state.cpp
Failures instances_agree(const LawSample& sample, const Registry& registry);
Failures rest_stays(const LawSample& sample, const Registry& registry);
Failures restarts(const LawSample& sample, const Registry& registry);
Failures units_agree(const LawSample& sample, const Registry& registry);
Failures neighbours_do_not_matter(const LawSample& sample, const Registry& registry);
Failures columns_suffice(const LawSample& sample, const Registry& registry);
Failures columns_are_used(const LawSample& sample, const Registry& registry);
// checks/mechanics.cpp
Failures ends_on_yield_surface(const LawSample& sample, const Registry& registry);
Failures dissipates(const LawSample& sample, const Registry& registry);
Failures converges(const LawSample& sample, const Registry& registry);
Failures objective(const LawSample& sample, const Registry& registry);
Failures energy_balances(const LawSample& sample, const Registry& registry);
Failures wave_speed_bounds_tangent(const LawSample& sample, const Registry& registry);
// checks/tangent.cpp
Failures tangent_is_derivative(const LawSample& sample, const Registry& registry);
Failures tangent_is_pure(const LawSample& sample, const Registry& registry);

}  // namespace mpm::physics::checks
