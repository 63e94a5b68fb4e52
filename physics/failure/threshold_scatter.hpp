// Scatter of the failure thresholds (manual 3.2.4): every threshold of a particle is multiplied by the
// particle's factor x, drawn once at the start, per particle or per cell of the background grid.
//   Gauss    density exp(-(x - GaussMean)^2 / (2 GaussStd^2)) / (sqrt(2 pi) GaussStd)             (3.60)
//   Weibull  P(x) = 1 - exp(-(WeibPartVol/WeibRefVol) (x/WeibMed)^WeibMod)                        (3.62)
// The manual calls GaussStd a variance; as its name says, it is taken as the standard deviation: with the
// default 0.2 as a variance one particle in eighty would have a negative threshold. A negative draw counts as
// 0: a particle without strength, whose criterion is met by any value above zero. Tested by
// tests/physics/threshold_scatter_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/random/normal.hpp"
#include "core/scene/material.hpp"

namespace mpm::physics {

class ThresholdScatter {
 public:
  using Input = core::RandomFailureInput;

  explicit ThresholdScatter(const Input& input) : input_(input) {}

  bool per_cell() const { return input_.spread == Input::Spread::cell; }

  /// `item`: identity of the particle, or number of the cell.
  double factor(std::uint64_t item) const {
    constexpr std::uint64_t seed = 0x4661696c75726531;  // arbitrary; fixed, so that a case is reproducible
    const auto kind = static_cast<std::uint32_t>(input_.spread);
    switch (input_.distribution) {
      case Input::Distribution::gauss:
        return std::max(input_.gauss_mean + input_.gauss_deviation * core::standard_normal(item, kind, seed),
                        0.0);
      case Input::Distribution::weibull: {
        const double u = core::uniform_pair(item, kind, seed)[0];
        const double volumes = input_.weibull_reference_volume / input_.weibull_particle_volume;
        return input_.weibull_median * std::pow(-std::log(u) * volumes, 1 / input_.weibull_modulus);
      }
      default: return 1;
    }
  }

 private:
  Input input_;
};

}  // namespace mpm::physics
