#include "core/setup/start_velocity.hpp"

#include <cmath>

namespace mpm::core {

StartVelocity::StartVelocity(const BodyInput& input, double time)
    : expressions_(expressions_of(input)),
      number_(input.prescribed_velocity.value_or(input.initial_velocity)),
      time_(time) {
  for (const Expression& e : expressions_) formulas_.emplace_back(e.text);
}

Vec3<double> StartVelocity::at(const Vec3<double>& place) {
  Vec3<double> v = number_;
  for (std::size_t i = 0; i < formulas_.size(); ++i)
    v[expressions_[i].component] = formulas_[i]({place, place, time_});
  return v;
}

std::optional<StartVelocity::Fault> StartVelocity::first_not_finite(const Vec3<double>& place) {
  for (std::size_t i = 0; i < formulas_.size(); ++i) {
    const double value = formulas_[i]({place, place, time_});
    if (!std::isfinite(value)) return Fault{i, value};
  }
  return std::nullopt;
}

}  // namespace mpm::core
