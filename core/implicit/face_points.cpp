#include "core/implicit/face_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "core/communication/gather_records.hpp"
#include "core/grid/brick_grid.hpp"
#include "core/implicit/place_boxes.hpp"
#include "core/particle_range.hpp"

namespace mpm::core {

namespace {

/// What a particle tells all ranks.
struct Sample {
  double body, identity, x[3], volume;
};

std::vector<Sample> samples_of_all(const Model& model, std::span<const int> bodies, Reductions& ranks) {
  std::vector<Sample> mine;
  for (const ConstParticleBlock& block : blocks_of(model)) {
    if (std::ranges::find(bodies, block.body) == bodies.end()) continue;
    for (const ConstParticle p : block) {
      const Vec3<double> x = p.vector(Column::position_x);
      mine.push_back(
          {static_cast<double>(block.body), p[Column::identity], {x.x, x.y, x.z}, p[Column::volume]});
    }
  }
  std::vector<Sample> all = gather_records(std::span<const Sample>(mine), ranks);
  std::ranges::sort(all, [](const Sample& a, const Sample& b) {
    return a.body != b.body ? a.body < b.body : a.identity < b.identity;
  });
  return all;
}

/// The axes of the lattice of a body.
std::array<Vec3<double>, 3> axes_of(const Scene& scene, const BodyInput& input) {
  if (!input.work_plane) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const WorkPlane& plane = scene.work_planes[*input.work_plane];
  return {plane.x_axis, plane.y_axis, plane.z_axis};
}

/// The ends of a body's lattice. `of_body`: its particles.
std::vector<FacePoint> ends_of_lattice(std::span<const Sample> of_body,
                                       const std::array<Vec3<double>, 3>& axes) {
  const double spacing = std::cbrt(of_body.front().volume);
  constexpr double least = 0.3, most = 1.5,
                   aside = 0.4;  // of the spacing, to the next particle along an axis
  PlaceBoxes boxes(most * spacing);
  const auto place = [&](std::size_t i) {
    return Vec3<double>{of_body[i].x[0], of_body[i].x[1], of_body[i].x[2]};
  };
  for (std::size_t i = 0; i < of_body.size(); ++i) boxes.add(place(i), i);
  std::vector<FacePoint> points;
  for (std::size_t i = 0; i < of_body.size(); ++i) {
    const Vec3<double> x = place(i);
    double next[3][2] = {};  // distance of the next particle backward and forward; 0: none
    boxes.for_each_around(x, [&](std::size_t j) {
      const Vec3<double> to = place(j) - x;
      for (std::size_t a = 0; a < 3; ++a) {
        const double along = dot(to, axes[a]);
        const Vec3<double> rest = to - along * axes[a];
        if (std::abs(along) < least * spacing || std::abs(along) > most * spacing) continue;
        if (dot(rest, rest) > aside * aside * spacing * spacing) continue;
        double& of = next[a][along > 0];
        of = of > 0 ? std::min(of, std::abs(along)) : std::abs(along);
      }
    });
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t side = 0; side < 2; ++side) {
        if (next[a][side] > 0) continue;
        const double size = next[a][1 - side] > 0 ? next[a][1 - side] : spacing;
        const Vec3<double> outward = (side == 0 ? -1.0 : 1.0) * axes[a];
        points.push_back(
            {static_cast<int>(of_body[i].body), x + 0.5 * size * outward, outward, of_body[i].volume / size});
      }
  }
  return points;
}

/// Whether the sides enclose the volume of the particles, as those of a lattice do (Gauss).
bool enclose(std::span<const FacePoint> sides, std::span<const Sample> of_body) {
  const Vec3<double> from{of_body.front().x[0], of_body.front().x[1], of_body.front().x[2]};
  double within = 0, volume = 0;
  for (const FacePoint& side : sides) within += side.area * dot(side.normal, side.place - from) / 3;
  for (const Sample& particle : of_body) volume += particle.volume;
  constexpr double rounding = 1e-6;
  return std::abs(within - volume) <= rounding * volume;
}

/// Of a body with curved faces.
std::vector<FacePoint> with_smooth_normals(std::span<const FacePoint> sides) {
  // No two sides of a lattice have this distance, which rounding would decide.
  const double reach = 2.5 * std::sqrt(sides.front().area);
  PlaceBoxes boxes(reach);
  for (std::size_t i = 0; i < sides.size(); ++i) boxes.add(sides[i].place, i);
  std::vector<FacePoint> points;
  for (const FacePoint& side : sides) {
    Vec3<double> sum{};
    boxes.for_each_around(side.place, [&](std::size_t j) {
      const Vec3<double> to = sides[j].place - side.place;
      const bool is_opposite = dot(sides[j].normal, side.normal) < -0.5;  // of a thin shell
      if (dot(to, to) <= reach * reach && !is_opposite) sum = sum + sides[j].area * sides[j].normal;
    });
    const Vec3<double> normal = (1 / std::sqrt(dot(sum, sum))) * sum;
    constexpr double least_cosine = 0.5;  // some side of each place has 0.58
    if (dot(normal, side.normal) < least_cosine) continue;
    points.push_back(side);
    points.back().normal = normal;
  }
  return points;
}

}  // namespace

std::vector<FacePoint> find_face_points(const Model& model, std::span<const int> bodies, Reductions& ranks) {
  const std::vector<Sample> all = samples_of_all(model, bodies, ranks);
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  std::vector<FacePoint> points;
  for (auto from = all.begin(); from != all.end();) {
    const auto to = std::find_if(from, all.end(), [&](const Sample& s) { return s.body != from->body; });
    const BodyInput& input = *inputs[static_cast<std::size_t>(from->body)];
    std::vector<FacePoint> of_body = ends_of_lattice({from, to}, axes_of(*model.scene, input));
    if (enclose(of_body, {from, to})) {
      if (!std::holds_alternative<BlockGeometry>(input.geometry)) of_body = with_smooth_normals(of_body);
      points.insert(points.end(), of_body.begin(), of_body.end());
    }
    from = to;
  }
  return points;
}

}  // namespace mpm::core
