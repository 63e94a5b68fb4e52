#include "core/step/loads.hpp"

#include <algorithm>
#include <cmath>
#include <span>

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

double fall_time(const Model& model) {
  double largest = 0;  // squared
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  for (std::size_t b = 0; b < inputs.size(); ++b) {
    if (model.bodies[b].rigid) continue;
    Vec3<double> a = model.scene->solution.gravity + acceleration_of(*inputs[b], model.clock.time);
    if (inputs[b]->body_force) a = a + inputs[b]->body_force->number;
    largest = std::max(largest, dot(a, a));
  }
  return std::sqrt(model.grid->geometry().smallest_cell() / std::sqrt(largest));
}

Vec3<double> velocity_gained(const BodyInput& input, double time) {
  Vec3<double> v{};
  for (std::size_t i = 0; i < 3; ++i) {
    double& component = v[static_cast<int>(i)];
    if (const auto& load = input.prescribed_acceleration) {
      component = load->linear_amplitude[i] *
                  integral(load->points, time, [&](const auto& p) { return p.linear_factor[i]; });
    } else if (const auto& h = input.harmonic_excitation) {
      const double t = std::clamp(h->end_time[i], 0.0, time), w = h->angular_frequency[i];
      component = h->amplitude[i] * (w == 0 ? t * std::sin(h->phase[i])
                                            : (std::cos(h->phase[i]) - std::cos(w * t + h->phase[i])) / w);
    }
  }
  return v;
}

Loads::Loads(const Model& model) : model_(&model), motions_(model.bodies.size()) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.prescribed_velocity) {
      motions_[b].kind = BodyMotion::Kind::prescribed;
      motions_[b].velocity.common = *body.prescribed_velocity;
    } else if (body.rigid) {
      motions_[b].kind = BodyMotion::Kind::rigid;
    }
  }
  for (std::size_t r = 0; r < model.reactions.size(); ++r)
    motions_[static_cast<std::size_t>(model.reactions[r].body)].reaction = r;
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
    mine.loaded = !held && (input.prescribed_acceleration || input.harmonic_excitation || input.body_force ||
                            !input.surface_loads.empty());
    for (const SurfaceLoad& load : input.surface_loads)
      mine.surfaces.push_back({{}, &load, load.ramp.value_or(geometry.smallest_cell())});
    const bool turned =
        input.prescribed_acceleration && input.prescribed_acceleration->angular_amplitude != Vec3<double>{};
    acts = acts || mine.loaded || input.constrain_rigid_position || turned;
  }
  if (!acts) bodies_.clear();
  add_functions(model, inputs);
}

LoadFunctions& Loads::functions() {
  if (!functions_) functions_ = std::make_unique<LoadFunctions>();
  return *functions_;
}

void Loads::add_functions(const Model& model, const std::vector<const BodyInput*>& inputs) {
  // The derivative's error, of second order in this step, is far below that of the integration over
  // particles; round-off stays below 1e-9 of the load.
  constexpr double part_of_cell = 1.0 / 1024;
  difference_ = part_of_cell * model.grid->geometry().smallest_cell();
  for (std::size_t b = 0; b < std::min(model.bodies.size(), inputs.size()); ++b) {
    const BodyInput& input = *inputs[b];
    if (!input.prescribed_velocity_expressions.empty()) {
      LoadFunctions::Terms terms = functions().add(input.prescribed_velocity_expressions);
      motions_[b].velocity.terms = std::move(terms.of_place);
      motions_[b].velocity.functions = functions_.get();
      motions_[b].velocity.body = &model.bodies[b];
      held_.push_back({b, &input, std::move(terms.of_time)});
    }
    if (bodies_.empty() || !bodies_[b].loaded) continue;
    if (input.body_force && !input.body_force->expressions.empty())
      bodies_[b].force = functions().add(input.body_force->expressions);
    for (Surface& s : bodies_[b].surfaces)
      if (!s.input->expressions.empty()) s.terms = functions().add(s.input->expressions);
  }
}

void Loads::begin_step(double time, double dt, double part, VelocityOfStep velocity) {
  middle_ = time + part * dt;
  struct Sample {
    double time, weight;
  };
  const double apart = 0.5 / std::sqrt(3.0);
  const Sample gauss[] = {{time + (0.5 - apart) * dt, 0.5}, {time + (0.5 + apart) * dt, 0.5}};
  const Sample end[] = {{time + dt, 1.0}};
  const bool mean = velocity == VelocityOfStep::mean;
  const std::span<const Sample> samples = mean ? std::span<const Sample>(gauss) : end;
  for (const Held& h : held_) {
    Vec3<double> sum{};
    for (const Sample& sample : samples) {
      double v[3];
      for (int a = 0; a < 3; ++a) v[a] = (*h.input->prescribed_velocity)[a];
      functions_->add_values(h.of_time, model_->bodies[h.body], sample.time, v);
      sum = sum + sample.weight * Vec3<double>{v[0], v[1], v[2]};
    }
    motions_[h.body].velocity.common = sum;
    motions_[h.body].velocity.time = mean ? time + 0.5 * dt : time + dt;
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    OfBody& mine = bodies_[b];
    if (mine.input == nullptr) continue;
    const BodyInput& input = *mine.input;
    if (input.constrain_rigid_position) {
      BodyMotion& motion = motions_[b];
      const Vec3<double> start = motion.velocity.functions
                                     ? motion.velocity.common
                                     : input.prescribed_velocity.value_or(input.initial_velocity);
      motion.kind = BodyMotion::Kind::prescribed;
      motion.velocity.common = start;
      for (const Sample& sample : samples)
        motion.velocity.common = motion.velocity.common + sample.weight * velocity_gained(input, sample.time);
    }
    if (!mine.loaded) continue;
    mine.acceleration = acceleration_of(input, middle_);
    if (input.body_force) {
      double b_of_time[3] = {input.body_force->number.x, input.body_force->number.y,
                             input.body_force->number.z};
      if (!mine.force.of_time.empty())
        functions_->add_values(mine.force.of_time, model_->bodies[b], middle_, b_of_time);
      mine.acceleration = mine.acceleration + Vec3<double>{b_of_time[0], b_of_time[1], b_of_time[2]};
    }
    for (Surface& s : mine.surfaces) set_stress(s, model_->bodies[b]);
  }
}

Vec3<double> Loads::angular_acceleration(int body) const {
  Vec3<double> a{};
  if (!any()) return a;
  const BodyInput* input = bodies_[static_cast<std::size_t>(body)].input;
  if (input == nullptr || !input->prescribed_acceleration) return a;
  const PrescribedAcceleration& load = *input->prescribed_acceleration;
  for (int i = 0; i < 3; ++i)
    a[i] = load.angular_amplitude[i] *
           between(load.points, middle_, [i](const auto& p) { return p.angular_factor[i]; });
  return a;
}

/// T of a surface load in this step, or the part of it that is the same in all places.
void Loads::set_stress(Surface& s, const Body& body) {
  const SurfaceLoad& load = *s.input;
  s.factor = load.points.empty() ? 1 : between(load.points, middle_, [](const auto& p) { return p.factor; });
  double values[4] = {load.traction.x, load.traction.y, load.traction.z, load.pressure};
  if (!s.terms.of_time.empty()) functions_->add_values(s.terms.of_time, body, middle_, values);
  for (int j = 0; j < 3; ++j) {
    s.column[j] = {};
    s.column[j][j] = -s.factor * values[SurfaceLoad::pressure_component];
    if (j == load.normal)
      s.column[j] = s.column[j] + s.factor * Vec3<double>{values[0], values[1], values[2]};
  }
}

Vec3<double> Loads::varying_acceleration(const OfBody& of, const Body& body, const double* lane) const {
  double a[3]{};
  functions_->add_values(of.force.of_place, body, lane, middle_, a);
  return {a[0], a[1], a[2]};
}

Loads::Stress Loads::varying_stress(const Surface& surface, const Body& body, const double* lane) const {
  constexpr int pressure = SurfaceLoad::pressure_component;
  const int normal = surface.input->normal;
  double values[4]{};
  functions_->add_values(surface.terms.of_place, body, lane, middle_, values);
  Stress t;
  for (int j = 0; j < 3; ++j) {
    t.column[j] = surface.column[j];
    t.column[j][j] -= surface.factor * values[pressure];
    if (j == normal)
      t.column[j] = t.column[j] + surface.factor * Vec3<double>{values[0], values[1], values[2]};
  }
  const auto slope = [&](const LoadFunctions::Term& term, int axis) {
    return surface.factor * functions_->slope(term, body, lane, middle_, axis, difference_);
  };
  for (const LoadFunctions::Term& term : surface.terms.of_place) {
    const int component = term.input->component;
    if (component != pressure) t.divergence[component] += slope(term, normal);
    for (int j = 0; component == pressure && j < 3; ++j) t.divergence[j] -= slope(term, j);
  }
  return t;
}

bool Loads::reach(const OfBody& of, const BrickGrid& grid, Slot slot) {
  if (!of.loaded) return false;
  if (!of.force.of_place.empty()) return true;
  // A brick's particles are less than a cell beyond its cells, and half a cell wide to each side.
  constexpr int low = -2, high = brick_cells + 2;
  const BrickCoord brick = grid.brick(slot).coord;
  const Vec3<double> lower = grid.geometry().node_place(brick, {low, low, low}),
                     upper = grid.geometry().node_place(brick, {high, high, high});
  return std::ranges::any_of(of.surfaces, [&](const Surface& s) {
    const double beyond = 0.5 * s.ramp;
    for (int a = 0; a < 3; ++a)
      if (upper[a] < s.input->lower[a] - beyond || lower[a] > s.input->upper[a] + beyond) return false;
    return true;
  });
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
