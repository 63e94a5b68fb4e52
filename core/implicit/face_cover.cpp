#include "core/implicit/face_cover.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/grid/brick_grid.hpp"
#include "core/particle_range.hpp"

namespace mpm::core {

namespace {

/// Of its size, to a point that a particle covers: more than to its edge, as lattices stretch; rounding would
/// decide on points of half its spacing at 0.75.
constexpr double reach = 0.7;

double size_of(const ConstParticle& p, double density) {
  return std::cbrt(std::max(p[Column::volume], p[Column::mass] / density));
}

}  // namespace

FaceCover::FaceCover(const Model& model, Reductions& ranks, std::span<const FacePoint> points)
    : model_(model), ranks_(ranks), points_(points), across_(0.5 * model.grid->geometry().smallest_cell()) {
  double size = 0;
  for (const ConstParticleBlock& block : blocks_of(model)) {
    const ConstitutiveModel& law = *model.bodies[static_cast<std::size_t>(block.body)].model;
    if (law.rigid()) continue;
    for (const ConstParticle p : block) size = std::max(size, size_of(p, law.reference_density()));
  }
  // Particles grow little more than by half.
  const double largest = across_ + 1.5 * ranks_.largest(size);
  const Vec3<double> reach_of_all{largest, largest, largest};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3<double> x = points[i].place;
    if (i == 0 || points[i].body != points[i - 1].body)
      bodies_.push_back({points[i].body, {}, PlaceBoxes(std::max(largest, std::sqrt(points[i].area)))});
    bodies_.back().within.add({x - reach_of_all, x + reach_of_all});
    bodies_.back().boxes.add(x, i);
  }
}

std::vector<bool> FaceCover::find(std::span<const Vec3<double>> moved) const {
  std::vector<std::int64_t> covered(points_.size());
  for (const ConstParticleBlock& block : blocks_of(model_)) {
    const ConstitutiveModel& law = *model_.bodies[static_cast<std::size_t>(block.body)].model;
    if (law.rigid()) continue;
    for (const ConstParticle p : block) {
      const double size = size_of(p, law.reference_density());
      for (const OfBody& of : bodies_) {
        const Vec3<double> x = p.vector(Column::position_x) - moved[static_cast<std::size_t>(of.body)];
        if (!of.within.contains(x)) continue;
        of.boxes.for_each_around(x, [&](std::size_t i) {
          const FacePoint& point = points_[i];
          const double along = std::max(reach * size, 0.5 * std::sqrt(point.area));
          const Vec3<double> to = x - point.place;
          const double outward = dot(to, point.normal);
          const Vec3<double> beside = to - outward * point.normal;
          if (outward < -size || outward > 0.5 * size + across_) return;
          if (std::max({std::abs(beside.x), std::abs(beside.y), std::abs(beside.z)}) <= along) covered[i] = 1;
        });
      }
    }
  }
  ranks_.sum(std::span(covered));
  std::vector<bool> found;
  for (const std::int64_t count : covered) found.push_back(count > 0);
  return found;
}

}  // namespace mpm::core
