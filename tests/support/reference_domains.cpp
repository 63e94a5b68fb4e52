// What the oracle's shape functions need beyond a particle's position: its domain, whose corners may move
// with the grid, and the cells in use.
#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "tests/support/reference_stepper.hpp"

namespace mpm::tests {

void ReferenceStepper::find_cells_in_use() {
  const auto& cells = case_.cells;
  geometry_.weight.assign(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]), 0);
  for (const auto& particle : case_.particles) {
    const std::array<int, 3> c = cell_at(geometry_, particle.x);
    double& weight = geometry_.weight[static_cast<std::size_t>(c[0] + cells[0] * (c[1] + cells[1] * c[2]))];
    const double density =
        std::min({case_.material.density / 10, density_of(particle), 4 * particle.m / particle.V});
    weight = case_.weigh_cells || has_light() ? std::max(weight, density) : 1;
  }
  average_gradients(geometry_);
}

/// Of reference.
double ReferenceStepper::density_of(const ReferenceParticle& particle) const {
  return case_.material.density * (index_of(particle) < case_.light_from ? 1 : 1e-3);
}

/// Which particles act from inside their cells. With USL cells without particles count as cells of the light
/// material, but for those beyond walls, which are images.
void ReferenceStepper::find_inset() {
  using Cell = std::array<int, 3>;
  struct Densities {
    double thinnest = std::numeric_limits<double>::infinity(), densest = 0;
  };
  const double light = 1e-3 * case_.material.density;
  std::map<Cell, Densities> cells;
  for (const ReferenceParticle& p : case_.particles) {
    Densities& of = cells[cell_at(geometry_, p.x)];
    of.thinnest = std::min(of.thinnest, density_of(p));
    of.densest = std::max(of.densest, density_of(p));
  }
  inset_.clear();
  for (const ReferenceParticle& p : case_.particles) {
    const Cell own = cell_at(geometry_, p.x);
    double thinnest = std::numeric_limits<double>::infinity();
    for (int d = 0; d < 27; ++d) {
      Cell cell = {own[0] + d % 3 - 1, own[1] + d / 3 % 3 - 1, own[2] + d / 9 - 1};
      for (std::size_t a = 0; a < 3; ++a) {
        if (cell[a] < 0 && case_.boundary[2 * a] != 0) cell[a] = 0;
        if (cell[a] >= case_.cells[a] && case_.boundary[2 * a + 1] != 0) cell[a] = case_.cells[a] - 1;
      }
      const auto found = cells.find(cell);
      if (found != cells.end())
        thinnest = std::min(thinnest, found->second.thinnest);
      else if (case_.scheme == ReferenceScheme::usl)
        thinnest = std::min(thinnest, light);
    }
    inset_.push_back(cells[own].densest > 10 * thinnest);
  }
}

Vector ReferenceStepper::acting_point(const ReferenceParticle& particle) const {
  Vector x = particle.x;
  if (inset_.empty() || !inset_[index_of(particle)]) return x;
  const std::array<int, 3> cell = cell_at(geometry_, x);
  for (std::size_t a = 0; a < 3; ++a) {
    const double lowest = case_.origin[a] + case_.cell[a] * cell[a], margin = case_.inset * case_.cell[a];
    x[a] = std::clamp(x[a], lowest + margin, lowest + case_.cell[a] - margin);
  }
  return x;
}

/// With the particle's domain.
ReferenceGrid ReferenceStepper::grid_of(const ReferenceParticle& particle) const {
  ReferenceGrid grid = geometry_;
  for (std::size_t a = 0; a < 3; ++a)  // a wider domain counts as one cell wide
    grid.half_size[a] = std::min(particle.half_size[a], 0.5 * case_.cell[a]);
  grid.corner = scaled_back(particle.corner, case_.cell);
  return grid;
}

std::size_t ReferenceStepper::number(const std::array<int, 3>& node) const {
  std::size_t at = 0;
  for (std::size_t a = 3; a-- > 0;) at = at * nodes_[a] + static_cast<std::size_t>(node[a] + 1);
  return at;
}

/// Each corner with the grid's velocity there; the particle to the centroid.
void ReferenceStepper::move_corners(std::size_t index, double dt) {
  const ReferenceParticle& particle = case_.particles[index];
  ReferenceGrid grid = grid_of(particle);
  grid.shape = ReferenceShape::linear;
  DomainCorners moved = particle.corner;
  for (std::size_t c = 0; c < 8; ++c) {
    Vector at = particle.x;
    for (std::size_t a = 0; a < 3; ++a) at[a] += grid.corner[c][a];
    const WideSupport support = wide_support(grid, at);
    for (std::size_t n = 0; n < support.count; ++n) {
      const Node& node = grid_[number(support.entry[n].node)];
      for (std::size_t a = 0; a < 3; ++a)
        if (node.active) moved[c][a] += dt * support.entry[n].value[a] * moving(node)[a];
    }
  }
  if (!(smallest_corner(moved) > 0)) throw std::runtime_error("a particle's domain is tangled");
  const Vector centroid = means_over(moved).centroid;
  for (std::size_t a = 0; a < 3; ++a) {
    next_x_[index][a] = particle.x[a] + centroid[a];
    for (Vector& corner : moved) corner[a] -= centroid[a];
  }
  next_corner_[index] = moved;
}

}  // namespace mpm::tests
