#include "core/contact/overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

std::size_t pair_number(std::int32_t a, std::int32_t b) {
  return number_of(static_cast<std::size_t>(std::min(a, b)), static_cast<std::size_t>(std::max(a, b)));
}

/// Adds the particles of a brick that overlap other components.
void add_overlaps(const Model& model, Slot s, const PointsByCell& others, std::vector<Overlap>& found) {
  const BrickGrid& grid = *model.grid;
  const GridGeometry& g = grid.geometry();
  const BrickCoord coord = grid.brick(s).coord;
  const std::int64_t brick[3] = {coord.x, coord.y, coord.z};
  std::vector<std::int32_t> met;  // components, by one particle
  for (const ParticleTile& tile : grid.brick(s).tiles) {
    for (const ConstParticleBlock& block : blocks_of(model, grid.brick(s), tile)) {
      for (const ConstParticle p : block) {
        const Vec3<double> x = p.vector(Column::position_x);
        const double half = 0.5 * std::cbrt(p[Column::volume]);
        const double reach = (1 + 1e-6) * half;  // lattices may be shifted by just half a spacing
        int lowest[3], highest[3];
        for (int a = 0; a < 3; ++a) {
          const auto cell = static_cast<int>(g.cell_index(x[a], a) - brick_cells * brick[a]);
          lowest[a] = std::max(cell - 1, -PointsByCell::layers);
          highest[a] = std::min(cell + 1, brick_cells + PointsByCell::layers - 1);
        }
        met.clear();
        others.for_each(lowest, highest, [&](const Vec3<double>& y, std::int32_t component) {
          const Vec3<double> d = x - y;
          const double apart = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
          if (component == tile.component || apart > reach) return;
          Overlap& overlap = found[pair_number(component, tile.component)];
          overlap.add(x, y, half);
          if (std::ranges::find(met, component) != met.end()) return;
          met.push_back(component);
          ++overlap.particles;
        });
      }
    }
  }
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
  std::vector<std::int64_t> counts;
  std::vector<double> bounds;
  for (const Overlap& o : found) {
    counts.push_back(o.particles);
    for (int a = 0; a < 3; ++a) bounds.push_back(o.lower[a]), bounds.push_back(-o.upper[a]);
  }
  communication.reductions.sum(std::span<std::int64_t>(counts));
  communication.reductions.minimum(bounds);
  std::vector<std::string> words;
  for (std::size_t b = 1; b < components; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const std::size_t n = number_of(a, b);
      if (counts[n] == 0) continue;
      const double* box = bounds.data() + 6 * n;
      words.push_back(fmt::format(
          "components '{}' and '{}' overlap at the start by {:.3g} x {:.3g} x {:.3g}, from ({:.6g}, {:.6g}, "
          "{:.6g}) to ({:.6g}, {:.6g}, {:.6g}): {} of their particles are within half a spacing of the "
          "other's; "
          "contact will push them apart. Move the bodies, or give them one component",
          scene.components[a].name, scene.components[b].name, -box[1] - box[0], -box[3] - box[2],
          -box[5] - box[4], box[0], box[2], box[4], 0 - box[1], 0 - box[3], 0 - box[5], counts[n]));
    }
  }
  return words;
}

}  // namespace mpm::core
