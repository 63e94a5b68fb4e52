#include "core/contact/overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/contact/contact_points.hpp"
#include "core/particle_range.hpp"

namespace mpm::core {

namespace {

/// Of a pair of components.
struct Overlap {
  std::int64_t particles = 0;  ///< of both
  Vec3<double> lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};

  /// What the cubes around x and y, with edges of twice `half`, have in common.
  void add(const Vec3<double>& x, const Vec3<double>& y, double half) {
    for (int a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], std::max(x[a], y[a]) - half);
      upper[a] = std::max(upper[a], std::min(x[a], y[a]) + half);
    }
  }
};

/// Pairs a < b of components, numbered (0, 1), (0, 2), (1, 2), (0, 3) ...
std::size_t number_of(std::size_t a, std::size_t b) { return b * (b - 1) / 2 + a; }

/// Whether y is within `half` of x along every axis. Lattices may be shifted by just half a spacing.
bool is_near(const Vec3<double>& x, const Vec3<double>& y, double half) {
  const Vec3<double> d = x - y;
  return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= (1 + 1e-6) * half;
}

/// The overlaps of one particle after another; each is counted once for each body or component that it meets.
class OverlapsOfParticles {
 public:
  explicit OverlapsOfParticles(std::vector<Overlap>& found) : found_(found) {}
  void begin_particle() { met_.clear(); }
  /// Of the particle at x, of `own`, with one of `other` at y.
  void add(std::size_t own, const Vec3<double>& x, std::size_t other, const Vec3<double>& y, double half) {
    Overlap& overlap = found_[number_of(std::min(own, other), std::max(own, other))];
    overlap.add(x, y, half);
    if (std::ranges::find(met_, other) != met_.end()) return;
    met_.push_back(other);
    ++overlap.particles;
  }

 private:
  std::vector<Overlap>& found_;
  std::vector<std::size_t> met_;
};

/// Adds the particles of a brick that overlap other components.
void add_overlaps(const Model& model, Slot s, const PointsByCell& others, std::vector<Overlap>& found) {
  const BrickGrid& grid = *model.grid;
  const GridGeometry& g = grid.geometry();
  const BrickCoord coord = grid.brick(s).coord;
  const std::int64_t brick[3] = {coord.x, coord.y, coord.z};
  OverlapsOfParticles overlaps(found);
  for (const ParticleTile& tile : grid.brick(s).tiles) {
    const auto own = static_cast<std::size_t>(tile.component);
    for (const ConstParticleBlock& block : blocks_of(model, grid.brick(s), tile)) {
      for (const ConstParticle p : block) {
        const Vec3<double> x = p.vector(Column::position_x);
        const double half = 0.5 * std::cbrt(p[Column::volume]);
        int lowest[3], highest[3];
        for (int a = 0; a < 3; ++a) {
          const auto cell = static_cast<int>(g.cell_index(x[a], a) - brick_cells * brick[a]);
          lowest[a] = std::max(cell - 1, -PointsByCell::layers);
          highest[a] = std::min(cell + 1, brick_cells + PointsByCell::layers - 1);
        }
        overlaps.begin_particle();
        others.for_each(lowest, highest, [&](const Vec3<double>& y, std::int32_t component) {
          if (component != tile.component && is_near(x, y, half))
            overlaps.add(own, x, static_cast<std::size_t>(component), y, half);
        });
      }
    }
  }
}

/// Whether contact parts the components of two bodies, whose overlaps are those of the components.
bool contact_parts(const Model& model, std::size_t a, std::size_t b) {
  return model.scene->contact.enable && model.bodies[a].component != model.bodies[b].component;
}

/// The places of a brick's particles, by cell.
class PlacesInBrick {
 public:
  PlacesInBrick(const Model& model, const Brick& brick) : geometry_(model.grid->geometry()) {
    first_[0] = brick_cells * std::int64_t{brick.coord.x} - below;
    first_[1] = brick_cells * std::int64_t{brick.coord.y} - below;
    first_[2] = brick_cells * std::int64_t{brick.coord.z} - below;
    for (const ConstParticleBlock& block : blocks_of(model, brick))
      for (const ConstParticle p : block) {
        const Vec3<double> x = p.vector(Column::position_x);
        at(cell_of(x, 0), cell_of(x, 1), cell_of(x, 2)).push_back({x, static_cast<std::size_t>(block.body)});
      }
  }
  /// f(place, body) of those in the cells around x.
  template <class F>
  void for_each_around(const Vec3<double>& x, F f) {
    const int c[3] = {cell_of(x, 0), cell_of(x, 1), cell_of(x, 2)};
    for (int k = std::max(c[2] - 1, 0); k <= std::min(c[2] + 1, side - 1); ++k)
      for (int j = std::max(c[1] - 1, 0); j <= std::min(c[1] + 1, side - 1); ++j)
        for (int i = std::max(c[0] - 1, 0); i <= std::min(c[0] + 1, side - 1); ++i)
          for (const auto& [place, body] : at(i, j, k)) f(place, body);
  }

 private:
  // A brick that takes particles by node has some in the half cells below.
  static constexpr int below = 1, side = brick_cells + 2 * below;
  int cell_of(const Vec3<double>& x, int a) const {
    return static_cast<int>(std::clamp<std::int64_t>(geometry_.cell_index(x[a], a) - first_[a], 0, side - 1));
  }
  std::vector<std::pair<Vec3<double>, std::size_t>>& at(int i, int j, int k) {
    return cells_[static_cast<std::size_t>(i + side * (j + side * k))];
  }

  const GridGeometry& geometry_;
  std::int64_t first_[3];
  std::vector<std::vector<std::pair<Vec3<double>, std::size_t>>> cells_{side * side * side};
};

/// Adds the particles of a brick that are in the place of another body's in that brick.
void add_shared_places(const Model& model, Slot s, std::vector<Overlap>& found) {
  const Brick& brick = model.grid->brick(s);
  const auto other_body = [&](const ParticleTile& tile) { return tile.body != brick.tiles.front().body; };
  if (brick.tiles.empty() || std::ranges::none_of(brick.tiles, other_body)) return;
  PlacesInBrick places(model, brick);
  OverlapsOfParticles overlaps(found);
  for (const ConstParticleBlock& block : blocks_of(model, brick)) {
    const auto own = static_cast<std::size_t>(block.body);
    for (const ConstParticle p : block) {
      const Vec3<double> x = p.vector(Column::position_x);
      const double half = 0.5 * std::cbrt(p[Column::volume]);
      overlaps.begin_particle();
      places.for_each_around(x, [&](const Vec3<double>& y, std::size_t body) {
        if (body != own && !contact_parts(model, own, body) && is_near(x, y, half))
          overlaps.add(own, x, body, y, half);
      });
    }
  }
}

/// Of pairs among `many`: one sentence each.
template <class Name>
std::vector<std::string> in_words(const std::vector<Overlap>& found, std::size_t many, Reductions& ranks,
                                  std::string_view kind, Name name, std::string_view advice) {
  std::vector<std::int64_t> counts;
  std::vector<double> bounds;
  for (const Overlap& o : found) {
    counts.push_back(o.particles);
    for (int a = 0; a < 3; ++a) bounds.push_back(o.lower[a]), bounds.push_back(-o.upper[a]);
  }
  ranks.sum(std::span<std::int64_t>(counts));
  ranks.minimum(bounds);
  std::vector<std::string> words;
  for (std::size_t b = 1; b < many; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const std::size_t n = number_of(a, b);
      if (counts[n] == 0) continue;
      const double* box = bounds.data() + 6 * n;
      words.push_back(fmt::format(
          "{} '{}' and '{}' overlap at the start by {:.3g} x {:.3g} x {:.3g}, from ({:.6g}, {:.6g}, {:.6g}) "
          "to "
          "({:.6g}, {:.6g}, {:.6g}): {} of their particles are within half a spacing of the other's; {}",
          kind, name(a), name(b), -box[1] - box[0], -box[3] - box[2], -box[5] - box[4], box[0], box[2],
          box[4], 0 - box[1], 0 - box[3], 0 - box[5], counts[n], advice));
    }
  }
  return words;
}

}  // namespace

std::vector<std::string> overlaps_in_words(const Model& model, Communication& communication) {
  const Scene& scene = *model.scene;
  const BrickGrid& grid = *model.grid;
  const std::size_t components = scene.components.size();
  constexpr std::size_t most_components = 64;
  if (components < 2) return {};
  if (components > most_components)
    return {fmt::format("{} components: whether any overlap at the start is found for {} at most", components,
                        most_components)};
  const auto of_slot = components_by_slot(grid, communication.halo);
  const auto meets = [&](Slot s) {
    const std::int32_t* first = nullptr;
    for (const Slot n : grid.brick(s).neighbour) {
      if (n == no_slot) continue;
      for (const std::int32_t& c : of_slot[static_cast<std::size_t>(n)]) {
        if (first == nullptr) first = &c;
        if (c != *first) return true;
      }
    }
    return false;
  };
  ContactPoints points;
  const Vec3<double> far{INFINITY, INFINITY, INFINITY};
  points.collect(model, communication.halo, meets, [&](Slot, std::int32_t) {
    return AxisBox{-1.0 * far, far};
  });
  std::vector<Overlap> found(number_of(0, components));
  PointsByCell others;
  for (Slot s = 0; s < grid.owned(); ++s) {
    if (!meets(s)) continue;
    others.take(grid, points, s, {{0, 0, 0}, {brick_cells, brick_cells, brick_cells}});
    add_overlaps(model, s, others, found);
  }
  return in_words(
      found, components, communication.reductions, "components",
      [&](std::size_t c) -> const std::string& { return scene.components[c].name; },
      "contact will push them apart. Move the bodies, or give them one component");
}

std::vector<std::string> shared_places_in_words(const Model& model, Reductions& ranks) {
  const std::size_t bodies = model.bodies.size();
  constexpr std::size_t most_bodies = 256;
  if (bodies < 2) return {};
  if (bodies > most_bodies)
    return {fmt::format("{} bodies: whether any are in the same place at the start is found for {} at most",
                        bodies, most_bodies)};
  std::vector<Overlap> found(number_of(0, bodies));
  for (Slot s = 0; s < model.grid->owned(); ++s) add_shared_places(model, s, found);
  return in_words(
      found, bodies, ranks, "bodies",
      [&](std::size_t b) -> const std::string& { return model.bodies[b].name; },
      "their masses add up there. Move one of them, or cut it out of the other (BoolType)");
}

}  // namespace mpm::core
