#include "core/discretise/inside.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>
#include <utility>
#include <variant>

#include "core/discretise/line.hpp"
#include "core/discretise/make_source.hpp"
#include "core/discretise/profile.hpp"
#include "core/discretise/sweep.hpp"

namespace mpm::core {

namespace {

InsideTest inside_block(const BlockGeometry& block, const Frame& frame) {
  return [block, frame](const Position& position, double) {
    const Position p = frame.to_local(position);
    for (std::size_t d = 0; d < 3; ++d) {
      const double slack = on_boundary * block.size[d];
      const double from_corner = p[d] - block.origin[d];
      if (!(from_corner >= -slack && from_corner <= block.size[d] + slack)) return false;
    }
    return true;
  };
}

InsideTest inside_ball(const SphereGeometry& ball, const Frame& frame) {
  return [ball, frame, sweep = Sweep(ball.angle)](const Position& position, double) {
    Position p = frame.to_local(position);
    for (std::size_t d = 0; d < 3; ++d) p[d] -= ball.centre[d];
    const double r = std::hypot(p[0], p[1], p[2]);
    const double slack = on_boundary * ball.outer_radius;
    return r <= ball.outer_radius + slack && r >= ball.inner_radius - slack &&
           (!ball.upper_half || p[2] >= -slack) && sweep.contains(p[0], p[1]);
  };
}

InsideTest inside_revolved(const Revolved& solid, const Frame& frame) {
  return [solid, frame, sweep = Sweep(solid.angle)](const Position& position, double) {
    Position p = frame.to_local(position);
    for (std::size_t d = 0; d < 3; ++d) p[d] -= solid.base[d];
    const Profile& profile = *solid.profile;
    const double slack = on_boundary * profile.height();
    if (!(p[2] >= -slack && p[2] <= profile.height() + slack)) return false;
    const double z = std::fmin(std::fmax(p[2], 0), profile.height());
    const double r = std::hypot(p[0], p[1]);
    return r <= profile.outer(z) * (1 + on_boundary) && r >= profile.inner(z) * (1 - on_boundary) &&
           sweep.contains(p[0], p[1]);
  };
}

/// Points hashed into cubes, for neighbour searches within a distance.
class PointCloud {
 public:
  PointCloud(const std::vector<Seed>& seeds, double cube) : cube_(cube) {
    for (const Seed& seed : seeds) points_.emplace(key(cell(seed.position)), seed.position);
  }

  bool any_within(const Position& position, double distance) const {
    // More cubes than points: the points are far denser than the querying particles.
    if (std::pow(2 * distance / cube_ + 1, 3) > static_cast<double>(points_.size()))
      return std::ranges::any_of(points_, [&](const auto& p) { return near(p.second, position, distance); });
    const auto reach = static_cast<std::int64_t>(std::ceil(distance / cube_));
    const std::array<std::int64_t, 3> middle = cell(position);
    for (std::int64_t i = middle[0] - reach; i <= middle[0] + reach; ++i)
      for (std::int64_t j = middle[1] - reach; j <= middle[1] + reach; ++j)
        for (std::int64_t k = middle[2] - reach; k <= middle[2] + reach; ++k)
          if (any_in({i, j, k}, position, distance)) return true;
    return false;
  }

 private:
  std::array<std::int64_t, 3> cell(const Position& p) const {
    std::array<std::int64_t, 3> c;
    for (std::size_t d = 0; d < 3; ++d) c[d] = std::llround(p[d] / cube_);
    return c;
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& c) {
    std::uint64_t hash = 0;
    for (const std::int64_t i : c) hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15U;
    return hash;
  }
  static bool near(const Position& q, const Position& p, double distance) {
    return std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]) <= distance * (1 + on_boundary);
  }
  bool any_in(const std::array<std::int64_t, 3>& c, const Position& p, double distance) const {
    const auto [first, last] = points_.equal_range(key(c));
    return std::any_of(first, last, [&](const auto& q) { return near(q.second, p, distance); });
  }

  double cube_;
  std::unordered_multimap<std::uint64_t, Position> points_;
};

InsideTest near_points(const Scene& scene, const BodyInput& body) {
  const auto source = make_unchecked_source(scene, body);
  std::vector<Seed> seeds;
  source->generate(0, source->units(), seeds);
  const double cube = std::cbrt(source->solid_volume() / static_cast<double>(seeds.size()));
  auto cloud = std::make_shared<const PointCloud>(seeds, cube);
  return
      [cloud](const Position& position, double spacing) { return cloud->any_within(position, spacing / 2); };
}

InsideTest inside_difference(const Scene& scene, const BodyInput& body, const BoolGeometry& difference) {
  InsideTest kept = make_inside_test(scene, body_at(scene, difference.minuend));
  InsideTest removed = make_inside_test(scene, body_at(scene, difference.subtrahend));
  return [kept, removed, frame = Frame(scene, body)](const Position& position, double spacing) {
    const Position p = frame.to_local(position);
    return kept(p, spacing) && !removed(p, spacing);
  };
}

}  // namespace

InsideTest make_inside_test(const Scene& scene, const BodyInput& body) {
  const Frame frame(scene, body);
  if (const auto* g = std::get_if<BlockGeometry>(&body.geometry)) return inside_block(*g, frame);
  if (const auto* g = std::get_if<SphereGeometry>(&body.geometry)) return inside_ball(*g, frame);
  if (const auto* g = std::get_if<CylinderGeometry>(&body.geometry))
    return inside_revolved(revolved(*g), frame);
  if (const auto* g = std::get_if<OgiveGeometry>(&body.geometry)) return inside_revolved(revolved(*g), frame);
  if (std::holds_alternative<PointGeometry>(body.geometry)) return near_points(scene, body);
  if (const auto* g = std::get_if<BoolGeometry>(&body.geometry)) return inside_difference(scene, body, *g);
  throw InputErrors(
      body.source, "Body",
      "only bodies of particles can be subtracted, not the finite elements of `" + body.name + "`");
}

}  // namespace mpm::core
