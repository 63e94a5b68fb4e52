#pragma once
// Scenes of one body, and what the tests ask of its seeds.

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "core/discretise/frame.hpp"
#include "core/discretise/seeds.hpp"

namespace mpm::core::testing {

using Seeds = std::vector<Seed>;

inline constexpr double pi = std::numbers::pi;
inline constexpr double density = 8930;

inline BodyInput body(Geometry geometry) {
  BodyInput made;
  made.name = "bar";
  made.geometry = std::move(geometry);
  made.density = density;
  made.source = {"case.xmp", 7};
  return made;
}

inline std::unique_ptr<SeedSource> source(Geometry geometry) {
  return make_seed_source({}, body(std::move(geometry)));
}

inline std::unique_ptr<SeedSource> source(Geometry geometry, const WorkPlane& plane) {
  Scene scene;
  scene.work_planes = {plane};
  BodyInput placed = body(std::move(geometry));
  placed.work_plane = 0;
  return make_seed_source(scene, placed);
}

inline Seeds all(const SeedSource& from) {
  Seeds seeds;
  from.generate(0, from.units(), seeds);
  return seeds;
}

inline Seeds all(Geometry geometry) { return all(*source(std::move(geometry))); }

inline double volume(const Seeds& seeds) {
  double sum = 0;
  for (const Seed& seed : seeds) sum += seed.volume;
  return sum;
}

/// (volume of all seeds - that of the shape) / that of the shape
inline double volume_error(const SeedSource& from) { return volume(all(from)) / from.solid_volume() - 1; }

inline double mass(const Seeds& seeds) {
  double sum = 0;
  for (const Seed& seed : seeds) sum += seed.mass;
  return sum;
}

/// Positions in an order of their own, after `map`; zeros without a sign.
template <class Map>
std::vector<Position> sorted(const Seeds& seeds, Map&& map) {
  std::vector<Position> positions;
  positions.reserve(seeds.size());
  for (const Seed& seed : seeds) {
    Position p = map(seed.position);
    positions.push_back(p + Position{0, 0, 0});
  }
  std::sort(positions.begin(), positions.end(), [](const Position& a, const Position& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  return positions;
}

inline std::vector<Position> sorted(const Seeds& seeds) {
  return sorted(seeds, [](const Position& p) { return p; });
}

inline Position mirror_x(const Position& p) { return {-p[0], p[1], p[2]}; }
inline Position mirror_y(const Position& p) { return {p[0], -p[1], p[2]}; }
inline Position mirror_z(const Position& p) { return {p[0], p[1], -p[2]}; }
inline Position swap_xy(const Position& p) { return {p[1], p[0], p[2]}; }

/// Whether `part` is, bit for bit, the seeds of `whole` that `keep` keeps.
template <class Keep>
bool is_part(const Seeds& part, const Seeds& whole, Keep&& keep) {
  Seeds kept;
  for (const Seed& seed : whole)
    if (keep(seed.position)) kept.push_back(seed);
  return sorted(part) == sorted(kept);
}

// Shapes that several tests use.
inline BlockGeometry block(double spacing, Position origin, Position size) { return {spacing, origin, size}; }

inline SphereGeometry ball(double spacing, double outer, double inner = 0) {
  SphereGeometry made;
  made.spacing = spacing;
  made.outer_radius = outer;
  made.inner_radius = inner;
  return made;
}

inline CylinderGeometry cylinder(double spacing, double radius, double height) {
  CylinderGeometry made;
  made.bottom_spacing = made.top_spacing = spacing;
  made.bottom_outer_radius = made.top_outer_radius = radius;
  made.height = height;
  return made;
}

inline OgiveGeometry ogive(double bottom, double top) {
  OgiveGeometry made;
  made.bottom_spacing = bottom;
  made.top_spacing = top;
  made.ogive_radius = 6;
  made.end_radius = 2;
  return made;
}

}  // namespace mpm::core::testing
