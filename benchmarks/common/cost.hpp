// Memory traffic and operations of each phase of a step per particle, counted by hand from the passes
// (core/step/passes.cpp). A change of a pass must change the count.
//
// Bytes: a block's column is one cache line and is moved as a whole, even if the block is not full. A column
// counts once as read and once as written per pass, because a brick's particles stay in the cache while a
// pass works on it, and the passes together are larger than any cache. Node arrays count the same way per
// brick: a neighbour's records are still in the cache when they are summed. A line that is written before it
// is read is fetched all the same; neither that fetch nor useless prefetches are counted, so the resulting
// floor is a lower bound.
//
// Operations: + - * / and square root are one each, a fused multiply-add two; comparisons, conversions,
// minima and selections none. One distinct cell per block is assumed, and a law is IsoHarden with Gruneisen.
#pragma once

#include <string>
#include <vector>

#include "core/model.hpp"
#include "core/particle_range.hpp"
#include "core/scene/solution.hpp"
#include "core/step/node_update.hpp"
#include "core/step/stepper.hpp"

namespace mpm::benchmarks {

struct PhaseCost {
  std::string phase;  ///< as Stepper::phases() names it
  double read = 0;    ///< bytes per particle
  double written = 0;
  double node_read = 0;
  double node_written = 0;
  double operations = 0;  ///< per particle
  double bytes() const { return read + written + node_read + node_written; }
};

/// How full the model's containers are.
struct Filling {
  double line = 8;   ///< bytes of a column per particle
  double first = 0;  ///< bytes of a brick's first node array per particle
  double second = 0;
  double motion = 0;       ///< bytes of a brick's nodes' motion per particle
  double node_visits = 0;  ///< records added up per particle by one sum of contributions

  explicit Filling(const core::Model& model) {
    double particles = 0, blocks = 0;
    for (const core::ConstParticleBlock& block : core::blocks_of(model)) {
      particles += block.used;
      blocks += 1;
    }
    const double bricks = model.grid->owned(), nodes = model.grid->shape().nodes();
    line = sizeof(double) * core::block_lanes * blocks / particles;
    first = sizeof(double) * core::record_doubles(core::NodeArray::first) * nodes * bricks / particles;
    second = sizeof(double) * core::record_doubles(core::NodeArray::second) * nodes * bricks / particles;
    motion = sizeof(double) * core::motion_width * nodes * bricks / particles;
    // Along an axis each of the inner nodes has one owner, each of the two outer ones two. The sums of the
    // lowest plane along x come from the brick before, where that is the lower neighbour.
    const double along = core::brick_cells + 3;
    double known = 0;
    for (core::Slot s = 0; s < model.grid->owned(); ++s) {
      const core::Slot lower = model.grid->brick(s).neighbour[core::lower_x_index];
      known += lower != core::no_slot && lower + 1 == s ? 2 : 0;
    }
    node_visits = along * along * (along * bricks - known) / particles;
  }
};

namespace detail {

// Columns.
constexpr double position = 3, velocity = 3, mass = 1, volume = 1, deviator = 6, pressures = 2, energy = 1;

// Operations per particle of what the passes are made of.
constexpr double locating = 16;  // 3 scaled coordinates, their fractions, the node's number
constexpr double weights = 64;   // of 8 nodes: 3 factors (2 each), their products (2)
constexpr double momentum_to_nodes = 3 + 8 * 6;
constexpr double mass_to_nodes = 8 * 2;
constexpr double force_to_nodes = 10 + 8 * (12 + 27.0 / 8);  // V sigma, its sums; once per cell their forces
constexpr double vector_from_nodes = 15 + 3 * 15;            // 8 weights, 8 products for each component
constexpr double gradient_from_nodes = 3 * 31 + 9;
constexpr double kinematics = 15, deviatoric = 203,
                 pressure_and_energy = 95;  // physics/material, stage by stage
constexpr double law = kinematics + deviatoric + pressure_and_energy;
constexpr double critical_speed = 9, bounds = 9;
constexpr double node_operations = 8;  // per record added up; four for the second array

struct Pass {
  double columns_read = 0, columns_written = 0, operations = 0;
  Pass& operator+=(const Pass& o) {
    columns_read += o.columns_read;
    columns_written += o.columns_written;
    operations += o.operations;
    return *this;
  }
};

/// Momentum and mass, and the stress for forces: all mechanical columns but energy and identity.
inline Pass to_grid(bool with_momentum, bool with_mass, bool with_force) {
  Pass p{position, 0, locating + weights};
  if (with_momentum) p += {velocity + mass, 0, momentum_to_nodes};
  if (with_mass) p += {0, 0, mass_to_nodes};
  if (with_force) p += {volume + deviator + pressures, 0, force_to_nodes};
  return p;
}

/// v += dv; a pass that maps or moves afterwards finds position and velocity in the cache.
inline Pass kick() { return {position + velocity, velocity, locating + vector_from_nodes + 3}; }

/// x += dt v; positions are there from the pass before.
inline Pass drift() { return {0, position, locating + vector_from_nodes + 6 + bounds}; }

/// Strain and stress: reads everything but the identity, the law's own columns (epef) included; velocities
/// for the critical step. Writes volume, stress, energy and the law's own columns.
inline Pass stress(double own_columns) {
  const double written = volume + deviator + pressures + energy + own_columns;
  return {position + velocity + mass + written, written,
          locating + gradient_from_nodes + law + critical_speed};
}

inline Pass stress_and_forces(double own_columns) {
  Pass p = stress(own_columns);
  p += {0, 0, to_grid(false, false, true).operations};
  return p;
}
inline Pass stress_and_motion(double own_columns) {
  Pass p = stress(own_columns);
  p += drift();
  return p;
}

/// The velocities, and their momentum back to the grid: mass joins the columns of the kick.
inline Pass kick_and_map_back() {
  Pass p = kick();
  p += {mass, 0, to_grid(true, false, false).operations};
  return p;
}

}  // namespace detail

/// The phases that touch particles or nodes, in the order of the step. `own_columns`: beyond the mechanics.
inline std::vector<PhaseCost> phase_costs(core::Scheme scheme, const Filling& fill, double own_columns) {
  using namespace detail;
  std::vector<PhaseCost> costs;
  const auto add = [&](const char* name, const Pass& p, double node_read, double node_written,
                       double node_ops) {
    costs.push_back({name, p.columns_read * fill.line, p.columns_written * fill.line, node_read, node_written,
                     p.operations + node_ops * fill.node_visits});
  };
  using core::Scheme;
  switch (scheme) {
    case Scheme::musl: {
      add("particles to grid", to_grid(true, true, true), 0, fill.first, 0);
      // The first array is summed, and the nodes' motion kept, half a record each.
      add("velocities, and back to grid", kick_and_map_back(), fill.first, fill.second + fill.motion,
          node_operations);
      add("stress and motion", stress_and_motion(own_columns), fill.motion + fill.second, 0,
          0.5 * node_operations);
      break;
    }
    case Scheme::usf: {
      add("particles to grid", to_grid(true, true, false), 0, fill.second, 0);
      add("stress, and forces to grid", stress_and_forces(own_columns), fill.second, fill.first,
          0.5 * node_operations);
      Pass last = kick();
      last += drift();
      add("velocities and motion", last, fill.first + fill.second, 0, 1.5 * node_operations);
      break;
    }
    case Scheme::usavg: {
      add("particles to grid", to_grid(true, true, false), 0, fill.second, 0);
      add("stress, second half, and forces to grid", stress_and_forces(own_columns), fill.second, fill.first,
          0.5 * node_operations);
      add("velocities, and back to grid", kick_and_map_back(), fill.first + fill.second,
          fill.second + fill.motion, 1.5 * node_operations);
      add("stress, first half, and motion", stress_and_motion(own_columns), fill.motion + fill.second, 0,
          0.5 * node_operations);
      break;
    }
    case Scheme::usl: {
      add("particles to grid", to_grid(true, true, true), 0, fill.first, 0);
      Pass all = stress(own_columns);
      all += {0, velocity, kick().operations};
      all += drift();
      add("stress, velocities and motion", all, fill.first, 0, node_operations);
      break;
    }
  }
  // Every so many steps positions are read and, since hardly a brick stays in order, everything is moved.
  const double all_columns =
      position + velocity + mass + volume + deviator + pressures + energy + 1 + own_columns;
  const double often = 1.0 / static_cast<double>(core::Stepper::sorting_interval);
  costs.push_back(
      {"sort and prune", all_columns * fill.line * often, all_columns * fill.line * often, 0, 0, 0});
  return costs;
}

}  // namespace mpm::benchmarks
