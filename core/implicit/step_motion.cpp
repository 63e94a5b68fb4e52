#include "core/implicit/step_motion.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace mpm::core {

namespace {

/// Distance of two boxes of Travel along the axis on which they are farthest apart; negative where they
/// overlap.
double gap(const double (&a)[6], const double (&b)[6]) {
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) most = std::max({most, a[i] + b[3 + i], b[i] + a[3 + i]});
  return most;
}

void extend(double (&box)[6], const Vec3<double>& by) {
  for (int i = 0; i < 3; ++i) {
    box[i] = std::min(box[i], by[i]);
    box[3 + i] = std::min(box[3 + i], -by[i]);
  }
}

}  // namespace

void StepMotion::add_particle(int body, const Vec3<double>& at, const Vec3<double>& moved) {
  Travel& travel = bodies_[static_cast<std::size_t>(body)];
  extend(travel.start, at);
  extend(travel.path, at);
  extend(travel.path, at + moved);
  extend(travel.moved, moved);
}

void StepMotion::merge(const StepMotion& other) {
  add_strain(other.strain_);
  add_beyond_wall(other.beyond_wall_);
  bodies_.resize(std::max(bodies_.size(), other.bodies_.size()));
  for (std::size_t b = 0; b < other.bodies_.size(); ++b) {
    for (int i = 0; i < 6; ++i) {
      bodies_[b].start[i] = std::min(bodies_[b].start[i], other.bodies_[b].start[i]);
      bodies_[b].path[i] = std::min(bodies_[b].path[i], other.bodies_[b].path[i]);
      bodies_[b].moved[i] = std::min(bodies_[b].moved[i], other.bodies_[b].moved[i]);
    }
  }
}

void StepMotion::combine(Reductions& ranks) {
  std::vector<double> all{-strain_, -beyond_wall_};
  for (const Travel& t : bodies_)
    for (const auto& box : {t.start, t.path, t.moved}) all.insert(all.end(), box, box + 6);
  ranks.minimum(all);
  strain_ = -all[0];
  beyond_wall_ = -all[1];
  const double* from = all.data() + 2;
  for (Travel& t : bodies_)
    for (double* box : {t.start, t.path, t.moved}) {
      std::copy_n(from, 6, box);
      from += 6;
    }
}

double StepMotion::approach(const Travel& a, const Travel& b) {
  constexpr double contact = 1;  // bodies closer than a cell share nodes
  if (a.empty() || b.empty() || gap(a.start, b.start) <= contact || gap(a.path, b.path) > contact) return 0;
  double most = 0;
  for (int i = 0; i < 3; ++i)
    most = std::max({most, -a.moved[3 + i] - b.moved[i], -b.moved[3 + i] - a.moved[i]});
  return most;
}

std::string StepMotion::objection(const std::vector<std::string>& names) const {
  if (strain_ > largest_strain) return fmt::format("a particle is strained by {:.3g}", strain_);
  if (beyond_wall_ > rounding) return fmt::format("a particle passes a wall by {:.3g} cells", beyond_wall_);
  for (std::size_t a = 0; a < bodies_.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies_.size(); ++b) {
      const double cells = approach(bodies_[a], bodies_[b]);
      if (cells > 1)
        return fmt::format("bodies \"{}\" and \"{}\" meet, {:.3g} cells against each other", names[a],
                           names[b], cells);
    }
  }
  return {};
}

}  // namespace mpm::core
