// The rarer parts of the passes: velocities that something else than the grid decides, and the work that
// these, gravity and damping do.
#include <algorithm>
#include <cmath>

#include "core/step/migration.hpp"
#include "core/step/passes.hpp"

namespace mpm::core {

void Passes::hold_velocities(const Body& body, double* block, int used, Workplace& at) {
  const ColumnLayout& layout = body.pool->layout();
  for (int i = 0; i < used; ++i) {
    double* lane = block + i;
    double* v[3];
    for (int a = 0; a < 3; ++a) v[a] = lane + layout.offset(next(Column::velocity_x, a));
    if (body.prescribed_velocity) {
      // What holds the velocity gives momentum m (v_p - v) at velocity v_p.
      const Vec3<double>& p = *body.prescribed_velocity;
      const double m = lane[layout.offset(Column::mass)];
      at.work += m * ((p.x - *v[0]) * p.x + (p.y - *v[1]) * p.y + (p.z - *v[2]) * p.z);
      for (int a = 0; a < 3; ++a) *v[a] = p[a];
    } else {
      const double speed = std::sqrt(*v[0] * *v[0] + *v[1] * *v[1] + *v[2] * *v[2]);
      if (speed > velocity_limit_) {
        at.work +=
            0.5 * lane[layout.offset(Column::mass)] * (velocity_limit_ * velocity_limit_ - speed * speed);
        for (int a = 0; a < 3; ++a) *v[a] *= velocity_limit_ / speed;
        ++at.found.limited;
      }
    }
  }
}

void Passes::fly_on(const Body& body, const BlockPlace& place, double* block, int used, Workplace& at) {
  const ColumnLayout& layout = body.pool->layout();
  const Vec3<double> pull = forces_.gravity + loads_.acceleration(number_of(body));
  double* velocity = block + layout.offset(Column::velocity_x);
  std::copy_n(velocity, 3 * block_lanes, at.before);
  add_velocity_increment(place, layout, at.nodes.data(), block);
  for (int i = 0; i < used; ++i) {
    // As with a prescribed velocity: what turns the grid's answer into free flight does work on it.
    const double m = block[layout.offset(Column::mass) + i];
    for (int a = 0; a < 3; ++a) {
      double& v = velocity[block_lanes * a + i];
      const double free = at.before[block_lanes * a + i] + dt * pull[a];
      at.work += m * (free - v) * free;
      v = free;
    }
  }
}

void Passes::note_unphysical(const Body& body, const Batch& batch, StepFindings& found) const {
  const ColumnLayout& layout = *batch.layout;
  const auto note = [&](std::uint64_t lanes, Witnesses& among) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctzll(lanes);
      const double* values = batch.block[lane / block_lanes] + lane % block_lanes;
      among.offer(values[layout.offset(Column::identity)], [&] {
        double columns[column_count];
        for (int c = 0; c < layout.columns(); ++c) columns[c] = values[block_lanes * c];
        return describe_particle(body, columns);
      });
    }
  };
  const WarnInput& warn = model_.scene->solution.warn;
  if (warn.negative_volume) note(batch.vanishing, found.vanishing);
  if (warn.negative_internal_energy) note(batch.negative, found.negative);
}

/// The work of gravity and damping in the motion that a block has just made from at.before.
void Passes::book_motion(const ColumnLayout& layout, const double* block, int used, Workplace& at) const {
  const Vec3<double> g = forces_.gravity;
  const double* m = block + layout.offset(Column::mass);
  const double* x = block + layout.offset(Column::position_x);
  const double* v = block + layout.offset(Column::velocity_x);
  for (int i = 0; i < used; ++i) {
    for (int a = 0; a < 3; ++a) {
      const int at_a = block_lanes * a + i;
      at.work += m[i] * (g[a] - forces_.damping * v[at_a]) * (x[at_a] - at.before[at_a]);
    }
  }
}

}  // namespace mpm::core
