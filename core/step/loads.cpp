#include "core/step/loads.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::core {

namespace {

/// Linear interpolation between the points, zero outside them. `value` is that of a point.
template <class Point, class F>
double between(const std::vector<Point>& points, double time, F value) {
  if (points.empty() || time < points.front().time || time > points.back().time) return 0;
  const auto next = std::upper_bound(points.begin(), points.end(), time,
                                     [](double t, const Point& p) { return t < p.time; });
  if (next == points.end()) return value(points.back());
  const Point &a = *(next - 1), &b = *next;
  return value(a) + (value(b) - value(a)) * (time - a.time) / (b.time - a.time);
}

/// Integral of the same function to `time`, from its first point or from 0, whichever is later.
template <class Point, class F>
double integral(const std::vector<Point>& points, double time, F value) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double from = std::max(points[i].time, 0.0), to = std::min(points[i + 1].time, time);
    if (to > from) sum += 0.5 * (to - from) * (between(points, from, value) + between(points, to, value));
  }
  return sum;
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

Loads::Loads(const Model& model) : motions_(model.bodies.size()) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.prescribed_velocity) {
      motions_[b] = {BodyMotion::Kind::prescribed, *body.prescribed_velocity};
    } else if (body.rigid) {
      motions_[b].kind = BodyMotion::Kind::rigid;
    }
  }
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

void Loads::begin_step(double time, double dt) {
  dt_ = dt;
  const double middle = time + 0.5 * dt;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    OfBody& mine = bodies_[b];
    if (mine.input == nullptr) continue;
    const BodyInput& input = *mine.input;
    if (input.constrain_rigid_position) {
      const Vec3<double> start = input.prescribed_velocity.value_or(input.initial_velocity);
      motions_[b] = {BodyMotion::Kind::prescribed, start + velocity_gained(input, time + dt)};
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
        if (j == load.normal) s.column[j] = s.column[j] + factor * load.traction;
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

}  // namespace mpm::core
