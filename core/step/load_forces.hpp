// The forces of loads (loads.hpp) on the particles of a block, mapped with any shape functions.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/shape/shape.hpp"
#include "core/step/loads.hpp"

namespace mpm::core {

namespace detail {

/// Rises from 0 to 1 over a width `ramp` about 0: the mean over z - size/2 .. z + size/2, and its derivative.
inline void mean_of_ramp(double z, double ramp, double size, double& mean, double& slope) {
  const double upper = z + 0.5 * size, lower = z - 0.5 * size, end = 0.5 * ramp;
  mean = lower >= end ? 1 : 0;
  slope = 0;
  if (lower >= end || upper <= -end) return;
  const auto height = [&](double y) { return std::clamp(y / ramp + 0.5, 0.0, 1.0); };
  const auto integral = [&](double y) { return y > end ? y : 0.5 * ramp * height(y) * height(y); };
  mean = (integral(upper) - integral(lower)) / size;
  slope = (height(upper) - height(lower)) / size;
}

/// The edge of a particle over which the weight of a box is taken: a brick knows the loads in its reach.
inline double size_for_loads(double volume, double cell) { return std::min(std::cbrt(volume), cell); }

/// 1 inside, 0 outside, with ramps of width `ramp` about the box's faces: the mean over a cube of edge `size`
/// about x, and its gradient. The gradients of a lattice of particles add up to the ramp's height, wherever
/// its ends are.
inline double box_weight(const SurfaceLoad& load, double ramp, const Vec3<double>& x, double size,
                         Vec3<double>& gradient) {
  double w[3], slope[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double y = x[static_cast<int>(a)];
    double up, down, rise, fall;
    mean_of_ramp(y - load.lower[a], ramp, size, up, rise);
    mean_of_ramp(load.upper[a] - y, ramp, size, down, fall);
    w[a] = up + down - 1;
    slope[a] = rise - fall;
  }
  gradient = {slope[0] * w[1] * w[2], w[0] * slope[1] * w[2], w[0] * w[1] * slope[2]};
  return w[0] * w[1] * w[2];
}

/// Acceleration in the absorbing layers of the grid's non-reflecting faces.
inline Vec3<double> absorption(const GridGeometry& g, const Vec3<double>& x, const Vec3<double>& v,
                               double pressure_speed, double shear_speed) {
  Vec3<double> a{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto face = static_cast<std::size_t>(2 * axis);
    const double lower = GridGeometry::scaled(x[axis], g.origin[axis], g.inverse_cell[axis]),
                 upper = static_cast<double>(g.cells[face / 2]) - lower;
    double weight = 0;
    if (g.boundary[face] == Boundary::nonreflecting) weight += std::max(1 - lower, 0.0);
    if (g.boundary[face + 1] == Boundary::nonreflecting) weight += std::max(1 - upper, 0.0);
    for (int i = 0; weight > 0 && i < 3; ++i)
      a[i] -= 2 * weight * g.inverse_cell[axis] * (i == axis ? pressure_speed : shear_speed) * v[i];
  }
  return a;
}

/// f(node, force) for every particle on which loads act and every node of its support, in that order.
/// `acceleration`: Loads::acceleration() where the particles map it, else zero.
template <ShapePolicy S, class F>
void for_each_load_force(const Loads& loads, const Model& model, Slot slot, int body,
                         const Vec3<double>& acceleration, const typename S::Place& place,
                         const double* block, int used, F f) {
  const Loads::OfBody& mine = loads.of(body);
  const GridGeometry& g = model.grid->geometry();
  const Body& of_body = model.bodies[static_cast<std::size_t>(body)];
  const ColumnLayout& layout = of_body.pool->layout();
  const bool absorbs = loads.nonreflecting() && loads.touches_nonreflecting(*model.grid, slot);

  for (int l = 0; l < used; ++l) {
    const auto get = [&](Column c) { return block[layout.offset(c) + l]; };
    const double m = get(Column::mass), volume = get(Column::volume);
    const Vec3<double> x{get(Column::position_x), get(Column::position_y), get(Column::position_z)};
    Vec3<double> per_shape = m * acceleration;
    Vec3<double> per_gradient[3]{};  // columns
    bool acts = acceleration != Vec3<double>{};
    if (mine.loaded) {
      acts = acts || !mine.force.of_place.empty();
      if (!mine.force.of_place.empty())
        per_shape = per_shape + m * loads.varying_acceleration(mine, of_body, block + l);
      for (const Loads::Surface& s : mine.surfaces) {
        Vec3<double> slope{};
        const double size = size_for_loads(volume, g.smallest_cell());
        const double weight = box_weight(*s.input, s.ramp, x, size, slope);
        if (weight == 0 && slope == Vec3<double>{}) continue;
        acts = true;
        const Vec3<double>* column = s.column;
        Loads::Stress varying;
        if (!s.terms.of_place.empty()) {
          varying = loads.varying_stress(s, of_body, block + l);
          column = varying.column;
          per_shape = per_shape + (volume * weight) * varying.divergence;
        }
        for (int j = 0; j < 3; ++j) {
          per_shape = per_shape + (volume * slope[j]) * column[j];
          per_gradient[j] = per_gradient[j] + (volume * weight) * column[j];
        }
      }
    }
    if (absorbs) {
      const Vec3<double> v{get(Column::velocity_x), get(Column::velocity_y), get(Column::velocity_z)};
      const Vec3<double> a = absorption(g, x, v, get(Column::sound_speed), mine.shear_speed);
      acts = acts || a != Vec3<double>{};
      per_shape = per_shape + m * a;
    }
    if (!acts) continue;
    if (mine.surfaces.empty()) {
      // Without the gradients; the zero rounds the product as the sum with them does, to the same bits.
      for_each_weight<S>(place, l, g.inverse_cell, [&](int node, double shape_value) {
        f(node, shape_value * per_shape + Vec3<double>{});
      });
      continue;
    }
    S::for_each_node(place, l, g.inverse_cell, [&](int node, double shape_value, const Vec3<double>& slope) {
      f(node, shape_value * per_shape + slope.x * per_gradient[0] + slope.y * per_gradient[1] +
                  slope.z * per_gradient[2]);
    });
  }
}

}  // namespace detail

/// Adds the forces on a block's first `used` particles to the forces of the brick's contributions.
template <ShapePolicy S>
[[gnu::noinline]] void add_load_forces(const Loads& loads, const Model& model, Slot slot, int body,
                                       const Vec3<double>& acceleration, const typename S::Place& place,
                                       const double* block, int used, double* contributions) {
  detail::for_each_load_force<S>(
      loads, model, slot, body, acceleration, place, block, used, [&](int node, const Vec3<double>& force) {
        for (int a = 0; a < 3; ++a)
          contributions[node_doubles * node + node_field::force.first + a] += force[a];
      });
}

/// Work of these forces, without the acceleration, over the step, whose velocities advance by `dt`. It uses
/// the nodes' velocity at midstep, since the nodes gain the kinetic energy f (v + v')/2 dt.
template <ShapePolicy S>
[[gnu::noinline]] double work_of_loads(const Loads& loads, const Model& model, Slot slot, int body,
                                       const typename S::Place& place, const double* block, int used,
                                       const double* nodes, double dt) {
  double power = 0;
  detail::for_each_load_force<S>(loads, model, slot, body, {}, place, block, used,
                                 [&](int node, const Vec3<double>& force) {
                                   const MotionRecord<const double> at{nodes + node_doubles * node};
                                   for (int a = 0; a < 3; ++a)
                                     power += force[a] * (at.velocity()[a] - 0.5 * at.increment()[a]);
                                 });
  return power * dt;
}

}  // namespace mpm::core
