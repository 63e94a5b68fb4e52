#include "core/step/strain_limit.hpp"

#include <algorithm>
#include <cmath>

#include "core/simd/math.hpp"
#include "core/step/speeds.hpp"

namespace mpm::core {

namespace {
constexpr double largest_strain = 0.15;  // difference of velocities over a cell's edge, times the step

/// Of the grid, length.
double diagonal(const GridGeometry& g) {
  double square = 0;
  for (int a = 0; a < 3; ++a) {
    const double length = g.cell[a] * static_cast<double>(g.cells[static_cast<std::size_t>(a)]);
    square += length * length;
  }
  return std::sqrt(square);
}
}  // namespace

bool strain_may_jump(const Model& model) {
  const Scene& scene = *model.scene;
  const TimeStepInput& step = scene.solution.time_step;
  if (step.specified > 0 || step.constant) return false;
  if (!scene.detonations.empty()) return true;
  std::vector<Vec3<double>> velocities;
  double fastest = 0;  // as of the critical step at the start
  const Vec3<double>& gravity = scene.solution.gravity;
  double weight = std::sqrt(dot(gravity, gravity));  // the largest force per mass
  for (const ComponentInput& component : scene.components) {
    for (const BodyInput& body : component.bodies) {
      if (body.for_bool || body.deactivated) continue;
      if (!body.initial_velocity_expressions.empty() || !body.prescribed_velocity_expressions.empty())
        return true;
      if (body.prescribed_acceleration || body.harmonic_excitation) return true;
      if (body.body_force) {
        if (!body.body_force->expressions.empty()) return true;
        const Vec3<double> force = gravity + body.body_force->number;
        weight = std::max(weight, std::sqrt(dot(force, force)));
      }
      const Vec3<double> v = body.prescribed_velocity.value_or(body.initial_velocity);
      const double c = model.materials[body.material]->initial_sound_speed();
      fastest = std::max(fastest, c / wave_limit(model) + std::sqrt(dot(v, v)));
      velocities.push_back(v);
    }
  }
  const std::array<Boundary, 6>& faces = model.grid->geometry().boundary;
  if (std::ranges::any_of(faces, is_constrained)) velocities.push_back({});
  double difference = 0;  // squared
  for (const Vec3<double>& a : velocities) {
    for (const Vec3<double>& b : velocities) difference = std::max(difference, dot(a - b, a - b));
  }
  const double fall = std::sqrt(2 * weight * diagonal(model.grid->geometry()));
  return step.factor * (std::sqrt(difference) + fall) > largest_strain * fastest;
}

double strain_rate_limit(double dt) { return largest_strain / dt; }

double limited_step(double dt, double rate) {
  return rate > strain_rate_limit(dt) ? largest_strain / rate : dt;
}

double largest_strain_rate(const NodeBlockShape& shape, const Vec3<double>& inverse_cell, double mass_cutoff,
                           const double* record) {
  const int side = shape.side();
  const int strides[3] = {1, side, side * side};
  // Squared, over an edge along an axis from a node of mass on.
  const auto square = [&](const double* node, int a) {
    const double* next = node + node_doubles * strides[a];
    if (!(next[Motion::mass_at] > mass_cutoff)) return 0.0;
    const double *u = node + Motion::strain_velocity_at, *v = next + Motion::strain_velocity_at;
    const double x = v[0] - u[0], y = v[1] - u[1], z = v[2] - u[2];
    return inverse_cell[a] * inverse_cell[a] * (x * x + y * y + z * z);
  };
  double largest = 0;
  const double* node = record;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i, node += node_doubles) {
        if (!(node[Motion::mass_at] > mass_cutoff)) continue;
        if (i + 1 < side) largest = std::max(largest, square(node, 0));
        if (j + 1 < side) largest = std::max(largest, square(node, 1));
        if (k + 1 < side) largest = std::max(largest, square(node, 2));
      }
    }
  }
  return std::sqrt(largest);
}

void VelocityRange::include(const VelocityRange& other) {
  for (int a = 0; a < 3; ++a) {
    lowest[a] = std::min(lowest[a], other.lowest[a]);
    highest[a] = std::max(highest[a], other.highest[a]);
  }
}

VelocityRange velocity_range(const Model& model, Slot s) {
  using Block = Lanes<block_lanes>;
  const Block number(Block::vector{0, 1, 2, 3, 4, 5, 6, 7});
  VelocityRange found;
  Block lowest[3], highest[3];
  for (int a = 0; a < 3; ++a) lowest[a] = Block(found.lowest[a]), highest[a] = Block(found.highest[a]);
  for (const ParticleTile& tile : model.grid->brick(s).tiles) {
    const BlockPool& pool = *model.bodies[static_cast<std::size_t>(tile.body)].pool;
    const int at = pool.layout().offset(Column::velocity_x);
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      const double* v = pool.block(tile.blocks[b]) + at;
      const int used = tile.used_lanes(b);
      for (int a = 0; a < 3; ++a, v += block_lanes) {
        const Block each = select(number < Block(used), load<Block>(v), Block(v[0]));
        lowest[a] = min(lowest[a], each);
        highest[a] = max(highest[a], each);
      }
    }
  }
  for (int a = 0; a < 3; ++a) {
    for (int l = 0; l < block_lanes; ++l) {
      found.lowest[a] = std::min(found.lowest[a], lowest[a][l]);
      found.highest[a] = std::max(found.highest[a], highest[a][l]);
    }
  }
  return found;
}

namespace {

/// Whether a brick's nodes, or those next to them, lie on a wall.
bool near_wall(const BrickGrid& grid, Slot s) {
  const GridGeometry& g = grid.geometry();
  const int first[3] = {grid.brick(s).coord.x, grid.brick(s).coord.y, grid.brick(s).coord.z};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t lower = -std::int64_t{brick_cells} * first[a], upper = lower + g.cells[a];
    if (is_constrained(g.boundary[2 * a]) && lower >= grid.shape().lowest() - 1) return true;
    if (is_constrained(g.boundary[2 * a + 1]) && upper <= grid.shape().highest() + 1) return true;
  }
  return false;
}

}  // namespace

bool may_strain_faster(const BrickGrid& grid, const std::vector<VelocityRange>& ranges, Slot s, double rate) {
  constexpr double room_for_round_off = 1 - 1e-6;
  VelocityRange around;
  for (const Slot n : grid.brick(s).neighbour) {
    if (n == no_slot) continue;
    if (n >= grid.owned()) return true;
    around.include(ranges[static_cast<std::size_t>(n)]);
  }
  const Vec3<double> width = around.highest - around.lowest;
  const bool differ =
      std::sqrt(dot(width, width)) > room_for_round_off * rate * grid.geometry().smallest_cell();
  return differ || near_wall(grid, s);
}

}  // namespace mpm::core
