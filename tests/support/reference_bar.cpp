// The Taylor bar as a case of the oracle, its shape, and the baseline of the benchmarks.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <time.h>

#include "tests/support/reference_stepper.hpp"

namespace mpm::tests {
namespace {

constexpr double bar_length = 25.4, bar_diameter = 7.6;

}  // namespace

ReferenceCase taylor_bar(double dp) {
  constexpr double impact_speed = 190;
  ReferenceCase setup;
  setup.material = {.density = 8.93e-3,
                    .young = 117e3,
                    .poisson = 0.35,
                    .yield = 157,
                    .plastic_modulus = 425,
                    .gruneisen = true,
                    .c0 = 3940,
                    .s = 1.49,
                    .gamma0 = 1.96,
                    .bq1 = 1.5,
                    .bq2 = 0.06};
  const double cell = 2 * dp;
  const int half = static_cast<int>(std::ceil(1.1 * bar_diameter / cell));  // the foot grows to 0.9 diameters
  setup.cell = {cell, cell, cell};
  setup.origin = {-half * cell, -half * cell, 0};
  setup.cells = {2 * half, 2 * half, static_cast<int>(std::ceil(bar_length / cell)) + 1};
  setup.boundary = {0, 0, 0, 0, 2, 0};

  const int layers = static_cast<int>(std::lround(bar_length / dp));
  const double dz = bar_length / layers;
  setup.gimp_half_size = {dp / 2, dp / 2, dz / 2};
  const int side = static_cast<int>(std::ceil(bar_diameter / 2 / dp));
  for (int k = 0; k < layers; ++k)
    for (int j = -side; j < side; ++j)
      for (int i = -side; i < side; ++i) {
        const double x = (i + 0.5) * dp, y = (j + 0.5) * dp;
        if (4 * (x * x + y * y) > bar_diameter * bar_diameter) continue;
        ReferenceParticle particle;
        particle.x = {x, y, (k + 0.5) * dz};
        particle.v = {0, 0, -impact_speed};
        particle.V = dp * dp * dz;
        particle.m = setup.material.density * particle.V;
        setup.particles.push_back(particle);
      }
  return setup;
}

BarShape bar_shape(const ReferenceCase& initial, std::span<const ReferenceParticle> particles) {
  struct Reach {
    double z = 0, r = 0;
  };
  const auto reach = [](std::span<const ReferenceParticle> bar) {
    Reach most;
    for (const auto& particle : bar) {
      most.z = std::max(most.z, particle.x[2]);
      most.r = std::max(most.r, std::hypot(particle.x[0], particle.x[1]));
    }
    return most;
  };
  const Reach before = reach(initial.particles), now = reach(particles);
  const double height = 0.2 * bar_length, width = initial.cell[2];
  double area = 0;
  for (const auto& particle : particles)
    area += particle.V * std::max(0.0, 1 - std::abs(particle.x[2] - height) / width) / width;
  return {.length = now.z + bar_length - before.z,
          .foot_diameter = now.r / before.r * bar_diameter,
          .diameter = std::sqrt(4 * area / std::numbers::pi)};
}

double run_reference(int particles_target, int steps) {
  const double bar_volume = std::numbers::pi / 4 * bar_diameter * bar_diameter * bar_length;
  ReferenceStepper stepper(taylor_bar(std::cbrt(bar_volume / particles_target)));
  stepper.step();  // the first one touches the memory
  const auto cpu_ns = [] {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
  };
  const double start = cpu_ns();
  for (int n = 0; n < steps; ++n) stepper.step();
  return (cpu_ns() - start) / (static_cast<double>(stepper.particles().size()) * steps);
}

}  // namespace mpm::tests
