#include "core/step/strain_limit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/step/speeds.hpp"

namespace mpm::core {

namespace {
constexpr double largest_strain = 0.15;  // difference of velocities over a cell's edge, times the step
}  // namespace

bool strain_may_jump(const Model& model) {
  const Scene& scene = *model.scene;
  const TimeStepInput& step = scene.solution.time_step;
  if (step.specified > 0 || step.constant) return false;
  std::vector<Vec3<double>> velocities;
  double fastest = 0;  // as of the critical step at the start
  for (const ComponentInput& component : scene.components) {
    for (const BodyInput& body : component.bodies) {
      if (body.for_bool || body.deactivated) continue;
      const Vec3<double> v = body.prescribed_velocity.value_or(body.initial_velocity);
      const double c = model.materials[body.material]->initial_sound_speed();
      fastest = std::max(fastest, c / wave_limit(scene) + std::sqrt(dot(v, v)));
      velocities.push_back(v);
    }
  }
  const std::array<Boundary, 6>& faces = model.grid->geometry().boundary;
  if (std::ranges::any_of(faces, is_constrained)) velocities.push_back({});
  double difference = 0;  // squared
  for (const Vec3<double>& a : velocities) {
    for (const Vec3<double>& b : velocities) difference = std::max(difference, dot(a - b, a - b));
  }
  return step.factor * std::sqrt(difference) > largest_strain * fastest;
}

double limited_step(double dt, double rate) {
  return rate * dt > largest_strain ? largest_strain / rate : dt;
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

}  // namespace mpm::core
