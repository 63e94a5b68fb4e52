// Checks of a law's tangent.

#include <cstring>
#include <numeric>
#include <random>

#include "core/scene/solution.hpp"
#include "physics/checks/checker.hpp"

namespace mpm::physics::checks {

using core::Column;
using core::Row;

namespace {

constexpr int particles = core::batch_particles;

/// A batch of particles, each with a history of its own: some hardly strained, some far beyond yield.
class Deformed {
 public:
  Deformed(const Checker& c, const core::UpdateOptions& options) : options_(options), material_(*c.material) {
    core::ColumnSet set = core::ColumnSet::mechanics();
    set.add(material_.columns(options));
    layout_ = core::ColumnLayout(set);
    memory_.assign(static_cast<std::size_t>(core::batch_blocks * layout_.block_doubles()), 0.0);
    batch_.layout = &layout_;
    batch_.blocks = core::batch_blocks, batch_.particles = particles;
    batch_.cell_size = c.sample.cell_size;
    for (int b = 0; b < core::batch_blocks; ++b) {
      batch_.block[b] = memory_.data() + b * layout_.block_doubles();
      std::fill_n(batch_.column(Column::mass, b), core::block_lanes, c.sample.input.reference_density);
      std::fill_n(batch_.column(Column::volume, b), core::block_lanes, 1.0);
    }
    material_.initialise(batch_, options);
    constexpr int steps = 20;
    std::mt19937 random(11);
    for (int step = 0; step < steps; ++step) {
      for (int i = 0; i < particles; ++i) {
        const double strain = c.sample.strain * std::pow(10.0, -3.0 * (i % 7) / 6);
        set_increment(i, increment(random, strain / std::sqrt(steps)));
      }
      advance(c.sample.duration / steps);
    }
    batch_.dt = c.sample.duration / steps;
  }
  Deformed(const Deformed&) = delete;  // the batch points into this object
  Deformed& operator=(const Deformed&) = delete;

  using Increment = std::array<double, 9>;
  /// In a random direction, of that norm.
  static Increment increment(std::mt19937& random, double size) {
    std::normal_distribution<double> normal;
    Increment h;
    double square = 0;
    for (double& x : h) x = normal(random), square += x * x;
    for (double& x : h) x *= size / std::sqrt(square);
    return h;
  }
  void set_increment(int particle, const Increment& h) { h_[static_cast<std::size_t>(particle)] = h; }
  const Increment& increment_of(int particle) const { return h_[static_cast<std::size_t>(particle)]; }

  /// Stress of all particles, in the order of StressTangent, after the step with h, its component `k` changed
  /// by `by`; the state remains.
  struct Stress {
    Row row[6];
  };
  Stress stress_after(int k, double by) {
    const std::vector<double> before = memory_;
    set_gradient(k, by);
    material_.update(batch_, options_);
    Stress stress;
    for (int i = 0; i < particles; ++i) {
      for (int n = 0; n < 6; ++n) stress.row[n][i] = at(core::next(Column::s_xx, n), i);
      const double p = at(Column::pressure, i) + at(Column::viscous_pressure, i);
      for (int n = 0; n < 3; ++n) stress.row[n][i] -= p;
    }
    std::copy(before.begin(), before.end(), memory_.begin());
    return stress;
  }
  void tangent(core::StressTangent& result) {
    set_gradient(0, 0);
    material_.tangent(batch_, options_, result);
  }
  /// Whether tangent() leaves all that the batch holds and points at.
  bool tangent_changes_nothing() {
    set_gradient(0, 0);
    const std::vector<double> before = memory_;
    std::vector<unsigned char> batch(sizeof batch_);
    std::memcpy(batch.data(), &batch_, sizeof batch_);
    const auto result = std::make_unique<core::StressTangent>();
    material_.tangent(batch_, options_, *result);
    return std::memcmp(batch.data(), &batch_, sizeof batch_) == 0 &&
           std::memcmp(before.data(), memory_.data(), sizeof(double) * before.size()) == 0;
  }
  /// The particles in reverse order.
  void reverse() {
    std::vector<double> reversed(memory_.size());
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      const auto size = static_cast<std::size_t>(layout_.block_doubles());
      const std::size_t lane = i % core::block_lanes, column = i % size - lane, block = i / size;
      reversed[(core::batch_blocks - 1 - block) * size + column + (core::block_lanes - 1 - lane)] =
          memory_[i];
    }
    std::copy(reversed.begin(), reversed.end(), memory_.begin());
    std::reverse(h_.begin(), h_.end());
  }

 private:
  double& at(Column c, int i) { return batch_.column(c, i / core::block_lanes)[i % core::block_lanes]; }
  void set_gradient(int changed, double by) {
    for (int i = 0; i < particles; ++i) {
      const Increment& h = h_[static_cast<std::size_t>(i)];
      for (int k = 0; k < 9; ++k)
        batch_.gradient[k][i] = (h[static_cast<std::size_t>(k)] + (k == changed ? by : 0.0)) / batch_.dt;
      batch_.cell_volumetric_strain[i] = h[0] + h[4] + h[8];
    }
  }
  void advance(double dt) {
    batch_.dt = dt;
    batch_.time += dt;
    set_gradient(0, 0);
    material_.update(batch_, options_);
  }

  core::UpdateOptions options_;
  const Material& material_;
  core::ColumnLayout layout_;
  std::vector<double> memory_;
  core::Batch batch_{};
  std::array<Increment, particles> h_{};
};

const core::UpdateOptions implicit_options{.volume_update = static_cast<int>(core::VolumeUpdate::mid_point),
                                           .artificial_viscosity = false};

/// Steps from far below yield to a third, in all directions, rotation included.
void take_steps_of_all_sizes(Deformed& batch) {
  std::mt19937 random(12);
  for (int i = 0; i < particles; ++i) {
    const double size = 0.3 * std::pow(10.0, -3.5 * i / (particles - 1));
    batch.set_increment(i, Deformed::increment(random, size));
  }
}

/// Mean stress and deviator of a column of the tangent.
struct Parts {
  double mean;
  std::array<double, 6> deviator;
  double size() const {
    return std::sqrt(std::inner_product(deviator.begin(), deviator.end(), deviator.begin(), 0.0));
  }
};
template <class Component>
Parts parts_of(Component component) {
  Parts parts{(component(0) + component(1) + component(2)) / 3, {}};
  for (int n = 0; n < 6; ++n)
    parts.deviator[static_cast<std::size_t>(n)] = component(n) - (n < 3 ? parts.mean : 0.0);
  return parts;
}
Parts difference(const Parts& a, const Parts& b) {
  Parts d{a.mean - b.mean, {}};
  for (std::size_t n = 0; n < 6; ++n) d.deviator[n] = a.deviator[n] - b.deviator[n];
  return d;
}

struct Comparison {
  double worst_mean = 0, worst_deviator = 0;
  int compared = 0, excluded = 0;
};

/// Central differences over 2 e and e, extrapolated. Excluded are those that disagree by more than a
/// kink-free law's could: a kink is within the step. Mean stress and deviator are compared apart, each with
/// its largest derivative: in flow that of the deviator is a small part of the stiffness.
Comparison compare(Deformed& batch, const core::StressTangent& tangent, double stiffness) {
  constexpr double e = 2e-6, kink = 1e-4;
  // Round-off of the stress, some 1e-16 of the stiffness (1e-15 where a law iterates), over e.
  const double margin = 2e-9 * stiffness;
  const auto central = [&](int k, double by) {
    const auto plus = std::make_unique<Deformed::Stress>(batch.stress_after(k, by)),
               minus = std::make_unique<Deformed::Stress>(batch.stress_after(k, -by));
    auto d = std::make_unique<Deformed::Stress>();
    for (int n = 0; n < 6; ++n) {
      for (int i = 0; i < particles; ++i) d->row[n][i] = (plus->row[n][i] - minus->row[n][i]) / (2 * by);
    }
    return d;
  };
  std::array<Parts, particles> largest{};
  std::vector<std::array<Parts, 9>> exact(particles);
  for (int i = 0; i < particles; ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (int k = 0; k < 9; ++k) {
      const Parts column = parts_of([&](int n) { return tangent.d[n][k][i]; });
      exact[at][static_cast<std::size_t>(k)] = column;
      largest[at].mean = std::max(largest[at].mean, std::abs(column.mean));
      largest[at].deviator[0] = std::max(largest[at].deviator[0], column.size());
    }
  }
  Comparison result;
  for (int k = 0; k < 9; ++k) {
    const auto wide = central(k, e), narrow = central(k, 0.5 * e);
    for (int i = 0; i < particles; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double mean = largest[at].mean, deviator = largest[at].deviator[0];
      const Parts w = parts_of([&](int n) { return wide->row[n][i]; });
      const Parts half = parts_of([&](int n) { return narrow->row[n][i]; });
      const Parts change = difference(w, half);
      if (std::abs(change.mean) > kink * mean + margin || change.size() > kink * deviator + margin) {
        ++result.excluded;
        continue;
      }
      ++result.compared;
      const Parts best = parts_of([&](int n) { return (4 * narrow->row[n][i] - wide->row[n][i]) / 3; });
      const Parts error = difference(exact[at][static_cast<std::size_t>(k)], best);
      const auto ratio = [](double a, double b) { return std::isfinite(a) ? a / b : HUGE_VAL; };
      result.worst_mean = std::max(result.worst_mean, ratio(std::abs(error.mean), mean + margin / 1e-6));
      result.worst_deviator = std::max(result.worst_deviator, ratio(error.size(), deviator + margin / 1e-6));
    }
  }
  return result;
}

}  // namespace

Failures tangent_is_derivative(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  if (!c.material->tangent_fault().empty()) return {};
  for (const core::UpdateOptions& options : {implicit_options, core::UpdateOptions{}}) {
    const std::string with = options.artificial_viscosity ? ", as in explicit steps" : ", without viscosity";
    Deformed batch(c, options);
    take_steps_of_all_sizes(batch);
    const auto tangent = std::make_unique<core::StressTangent>();
    batch.tangent(*tangent);
    const Comparison found = compare(batch, *tangent, c.stiffness());
    c.at_most(found.worst_mean, 1e-6, "error of the mean stress's tangent" + with);
    c.at_most(found.worst_deviator, 1e-6, "error of the deviator's tangent" + with);
    c.at_most(found.excluded, 0.05 * (found.excluded + found.compared), "differences across a kink" + with);
  }
  return c.failures;
}

Failures tangent_is_pure(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  if (!c.material->tangent_fault().empty()) return {};
  Deformed batch(c, implicit_options);
  take_steps_of_all_sizes(batch);
  const auto tangent = std::make_unique<core::StressTangent>(),
             reversed = std::make_unique<core::StressTangent>();
  batch.tangent(*tangent);
  c.require(batch.tangent_changes_nothing(), "the tangent changes the batch or the columns");
  batch.reverse();
  batch.tangent(*reversed);
  int different = 0;
  for (int n = 0; n < 6; ++n) {
    for (int k = 0; k < 9; ++k) {
      for (int i = 0; i < particles; ++i)
        different +=
            std::memcmp(&tangent->d[n][k][i], &reversed->d[n][k][particles - 1 - i], sizeof(double)) != 0;
    }
  }
  c.at_most(different, 0, "components that depend on a particle's lane or its neighbours");
  return c.failures;
}

}  // namespace mpm::physics::checks
