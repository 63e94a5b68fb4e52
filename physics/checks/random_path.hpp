// A smooth path of the velocity gradient through a bounded strain, with simultaneous stretch, shear and spin:
// the same for every material, in any unit of time.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "core/tensor/tensor.hpp"

namespace mpm::physics {

class RandomPath {
 public:
  /// The integral of each component is `strain` times a number within -1 and 1; the whole path takes
  /// `duration`.
  RandomPath(unsigned seed, double strain, double duration) : strain_(strain), duration_(duration) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> amplitude(-1, 1), frequency(1, 2.5);
    for (auto& c : components_) c = {amplitude(random), frequency(random)};
  }

  /// Velocity gradient at the time t: each component the rate of strain a sin^2(w t/T), and a spin.
  core::Mat3<double> gradient(double t) const {
    std::array<double, 9> l{};
    for (std::size_t i = 0; i < 9; ++i) {
      const auto [a, w] = components_[i];
      // The spin has a larger share: the tests are mainly about rotation.
      l[i] = strain_ * a * w * std::sin(2 * w * t / duration_) / duration_;
    }
    const double spin = 10 * strain_ * std::cos(3 * t / duration_) / duration_;
    return {l[0], l[1] - spin, l[2], l[3] + spin, l[4], l[5] - 0.5 * spin, l[6], l[7] + 0.5 * spin, l[8]};
  }
  double duration() const { return duration_; }

 private:
  struct Component {
    double amplitude, frequency;
  };
  std::array<Component, 9> components_{};
  double strain_, duration_;
};

}  // namespace mpm::physics
