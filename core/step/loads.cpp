#include "core/step/loads.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::core {

namespace {

/// Linear between the points, zero outside them. `value` of a point.
template <class Point, class F>
double between(const std::vector<Point>& points, double time, F value) {
  if (points.empty() || time < points.front().time || time > points.back().time) return 0;
  const auto next = std::upper_bound(points.begin(), points.end(), time,
                                     [](double t, const Point& p) { return t < p.time; });
  if (next == points.end()) return value(points.back());
  const Point &a = *(next - 1), &b = *next;
  return value(a) + (value(b) - value(a)) * (time - a.time) / (b.time - a.time);
}

/// Integral of the same from its beginning, or from 0 where that is later, to `time`.
template <class Point, class F>
double integral(const std::vector<Point>& points, double time, F value) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double from = std::max(points[i].time, 0.0), to = std::min(points[i + 1].time, time);
    if (to > from) sum += 0.5 * (to - from) * (between(points, from, value) + between(points, to, value));
  }
  return sum;
}

/// 1 inside, 0 outside, with slopes of width `ramp` about the box's faces; with its gradient.
double box_weight(const SurfaceLoad& load, double ramp, const Vec3<double>& x, Vec3<double>& gradient) {
  double w[3], slope[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double y = x[static_cast<int>(a)];
    const double up = (y - load.lower[a]) / ramp + 0.5, down = (load.upper[a] - y) / ramp + 0.5;
    w[a] = std::clamp(std::min(up, down), 0.0, 1.0);
    slope[a] = w[a] == 0 || w[a] == 1 ? 0 : (up < down ? 1 : -1) / ramp;
  }
  gradient = {slope[0] * w[1] * w[2], w[0] * slope[1] * w[2], w[0] * w[1] * slope[2]};
  return w[0] * w[1] * w[2];
}

}  // namespace

Vec3<double> acceleration_of(const BodyInput& input, double time) {
  Vec3<double> a{};
  for (std::size_t i = 0; i < 3; ++i) {
    double& component = a[static_cast<int>(i)];
    if (const auto& load = input.prescribed_acceleration) {
      component = load->linear_amplitude[i] *
                  between(load->points, time, [&](const auto& p) { return p.linear_factor[i]; });
    } else if (const auto& h = input.harmonic_excitation) {
      if (time <= h->end_time[i])
        component = h->amplitude[i] * std::sin(h->angular_frequency[i] * time + h->phase[i]);
    }
  }
  return a;
}

Vec3<double> velocity_gained(const BodyInput& input, double time) {
  Vec3<double> v{};
  for (std::size_t i = 0; i < 3; ++i) {
    double& component = v[static_cast<int>(i)];
    if (const auto& load = input.prescribed_acceleration) {
      component = load->linear_amplitude[i] *
                  integral(load->points, time, [&](const auto& p) { return p.linear_factor[i]; });
    } else if (const auto& h = input.harmonic_excitation) {
      const double t = std::min(time, h->end_time[i]), w = h->angular_frequency[i];
      component = h->amplitude[i] * (w == 0 ? t * std::sin(h->phase[i])
                                            : (std::cos(h->phase[i]) - std::cos(w * t + h->phase[i])) / w);
    }
  }
  return v;
}

Loads::Loads(const Model& model) {
  const GridGeometry& geometry = model.grid->geometry();
  for (const Boundary b : geometry.boundary) nonreflecting_ |= b == Boundary::nonreflecting;
  bool acts = nonreflecting_;
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    OfBody& mine = bodies_.emplace_back();
    mine.shear_speed = model.bodies[b].model->initial_shear_speed();
    if (b >= inputs.size()) continue;
    const BodyInput& input = *inputs[b];
    mine.input = &input;
    const bool held = input.constrain_rigid_position || input.prescribed_velocity;
    mine.loaded =
        !held && (input.prescribed_acceleration || input.harmonic_excitation || !input.surface_loads.empty());
    for (const SurfaceLoad& load : input.surface_loads)
      mine.surfaces.push_back({{}, &load, load.ramp.value_or(geometry.smallest_cell())});
    acts = acts || mine.loaded || input.constrain_rigid_position;
  }
  if (!acts) bodies_.clear();
}

void Loads::begin_step(Model& model, double time, double dt) {
  dt_ = dt;
  const double middle = time + 0.5 * dt;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    OfBody& mine = bodies_[b];
    if (mine.input == nullptr) continue;
    const BodyInput& input = *mine.input;
    if (input.constrain_rigid_position) {
      const std::array<double, 3> start = input.prescribed_velocity.value_or(input.initial_velocity);
      model.bodies[b].prescribed_velocity = to_vec(start) + velocity_gained(input, time + dt);
    }
    if (!mine.loaded) continue;
    mine.acceleration = acceleration_of(input, middle);
    for (Surface& s : mine.surfaces) {
      const SurfaceLoad& load = *s.input;
      const double factor =
          load.points.empty() ? 1 : between(load.points, middle, [](const auto& p) { return p.factor; });
      for (int j = 0; j < 3; ++j) {
        s.column[j] = {};
        s.column[j][j] = -factor * load.pressure;
        if (j == load.normal) s.column[j] = s.column[j] + factor * to_vec(load.traction);
      }
    }
  }
}

bool Loads::touches_nonreflecting(const BrickGrid& grid, Slot slot) const {
  const GridGeometry& g = grid.geometry();
  const BrickCoord b = grid.brick(slot).coord;
  const int coord[3] = {b.x, b.y, b.z};
  for (std::size_t a = 0; a < 3; ++a) {
    if (g.boundary[2 * a] == Boundary::nonreflecting && coord[a] == 0) return true;
    if (g.boundary[2 * a + 1] == Boundary::nonreflecting &&
        std::int64_t{brick_cells} * (coord[a] + 1) >= g.cells[a])
      return true;
  }
  return false;
}

/// f(node, force) for every particle and every node of its cell, in that order.
template <class F>
void Loads::for_each_force(const Model& model, Slot slot, int body, const BlockPlace& place,
                           const double* block, int used, F f) const {
  const OfBody& mine = bodies_[static_cast<std::size_t>(body)];
  const GridGeometry& g = model.grid->geometry();
  const NodeBlockShape& shape = model.grid->shape();
  const BrickCoord brick = model.grid->brick(slot).coord;
  const std::int64_t first[3] = {std::int64_t{brick_cells} * brick.x, std::int64_t{brick_cells} * brick.y,
                                 std::int64_t{brick_cells} * brick.z};
  const ColumnLayout& layout = model.bodies[static_cast<std::size_t>(body)].pool->layout();
  const bool dashpots = nonreflecting_ && touches_nonreflecting(*model.grid, slot);

  for (int l = 0; l < used; ++l) {
    const auto get = [&](Column c) { return block[layout.offset(c) + l]; };
    const double m = get(Column::mass), volume = get(Column::volume);
    const Vec3<double> x{get(Column::position_x), get(Column::position_y), get(Column::position_z)};
    Vec3<double> per_shape{};
    Vec3<double> per_gradient[3]{};  // columns
    if (mine.loaded) {
      per_shape = m * mine.acceleration;
      for (const Surface& s : mine.surfaces) {
        Vec3<double> slope{};
        const double weight = box_weight(*s.input, s.ramp, x, slope);
        for (int j = 0; j < 3; ++j) {
          per_shape = per_shape + (volume * slope[j]) * s.column[j];
          per_gradient[j] = per_gradient[j] + (volume * weight) * s.column[j];
        }
      }
    }
    // Dashpots: one for each face of the grid at which the particle's cell lies.
    Vec3<double> dashpot[3]{};
    int side[3] = {-1, -1, -1};
    if (dashpots) {
      const int cell[3] = {place.node[l] % shape.side(), place.node[l] / shape.side() % shape.side(),
                           place.node[l] / (shape.side() * shape.side())};
      const double c_p = get(Column::sound_speed), c_s = mine.shear_speed;
      for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<int>(a);
        const std::int64_t global = first[a] + cell[a];
        if (g.boundary[2 * a] == Boundary::nonreflecting && global == 0) side[a] = 0;
        if (g.boundary[2 * a + 1] == Boundary::nonreflecting && global == g.cells[a] - 1) side[a] = 1;
        if (side[a] < 0) continue;
        for (int i = 0; i < 3; ++i) {
          const double rate = (i == axis ? c_p : c_s) * g.inverse_cell[axis];
          dashpot[a][i] = -2 * m * rate * get(next(Column::velocity_x, i));
        }
      }
    }
    for_each_corner(place, l, g.inverse_cell,
                    [&](int corner, int node, double shape_value, const Vec3<double>& slope) {
                      Vec3<double> force = shape_value * per_shape + slope.x * per_gradient[0] +
                                           slope.y * per_gradient[1] + slope.z * per_gradient[2];
                      for (int a = 0; a < 3; ++a) {
                        if (side[a] == ((corner >> a) & 1)) force = force + shape_value * dashpot[a];
                      }
                      f(node, force);
                    });
  }
}

void Loads::add_forces(const Model& model, Slot slot, int body, const BlockPlace& place, const double* block,
                       int used, double* contributions) const {
  for_each_force(model, slot, body, place, block, used, [&](int node, const Vec3<double>& force) {
    for (int a = 0; a < 3; ++a) contributions[node_doubles * node + 4 + a] += force[a];
  });
}

double Loads::work(const Model& model, Slot slot, int body, const BlockPlace& place, const double* block,
                   int used, const double* nodes) const {
  double power = 0;
  for_each_force(model, slot, body, place, block, used, [&](int node, const Vec3<double>& force) {
    const double* at = nodes + node_doubles * node;
    for (int a = 0; a < 3; ++a) power += force[a] * (at[a] - 0.5 * at[4 + a]);
  });
  return power * dt_;
}

}  // namespace mpm::core
