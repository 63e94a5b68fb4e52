// The oracle's means of volume changes and pressures over the particles of a site.
#include <algorithm>
#include <cmath>
#include <map>

#include "tests/support/reference_stepper.hpp"

namespace mpm::tests {

/// A site is a cell, or for shapes of three nodes per axis what is nearer to a node than to the others.
void ReferenceStepper::average(std::vector<double>& values) const {
  using enum ReferenceShape;
  const bool of_nodes = case_.shape == sgmp || case_.shape == quadratic_bspline || case_.shape == ugimp ||
                        case_.shape == cpgimp;
  const auto site = [&](const ReferenceParticle& particle) {
    std::array<double, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double scaled = (particle.x[a] - case_.origin[a]) * inverse_cell_[a];
      at[a] = of_nodes ? std::floor(scaled + 0.5) : std::min(std::floor(scaled), case_.cells[a] - 1.0);
    }
    return at;
  };
  std::map<std::array<double, 3>, std::array<double, 2>> sums;
  for (std::size_t p = 0; p < values.size(); ++p) {
    auto& [volume, sum] = sums[site(case_.particles[p])];
    volume += case_.particles[p].V;
    sum += case_.particles[p].V * values[p];
  }
  for (std::size_t p = 0; p < values.size(); ++p) {
    const auto& [volume, sum] = sums[site(case_.particles[p])];
    values[p] = sum / volume;
  }
}

void ReferenceStepper::relax_pressures(double dt, std::vector<double>& changes) const {
  const double modulus = case_.material.bulk();
  const double sound = std::sqrt(modulus / case_.material.density);
  const double rate = std::min(case_.relaxation * sound / *std::ranges::min_element(case_.cell), 1 / dt);
  std::vector<double> means;
  for (const auto& particle : case_.particles) means.push_back(particle.p);
  average(means);
  for (std::size_t p = 0; p < means.size(); ++p)
    changes[p] += rate * (case_.particles[p].p - means[p]) / (modulus + 8 * std::abs(means[p]));
}

std::vector<double> ReferenceStepper::acting_pressures() const {
  std::vector<double> pressures;
  for (const auto& particle : case_.particles) pressures.push_back(particle.p + particle.q);
  if (case_.average) average(pressures);
  return pressures;
}

}  // namespace mpm::tests
