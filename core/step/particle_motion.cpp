#include "core/step/particle_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/step/grid_to_particles.hpp"
#include "core/step/migration.hpp"

namespace mpm::core {

void prescribe_velocities(const ColumnLayout& layout, const BodyMotion& motion, double* block, int used,
                          ThreadScratch& at) {
  const double* x = block + layout.offset(Column::position_x);
  double mass = 0;
  Vec3<double> impulse{}, moment{}, place{};
  for (int i = 0; i < used; ++i) {
    const Vec3<double> p = motion.velocity.velocity(block + i);
    double* v[3];
    for (int a = 0; a < 3; ++a) v[a] = block + i + layout.offset(next(Column::velocity_x, a));
    const double m = block[layout.offset(Column::mass) + i];
    const Vec3<double> at_x{x[i], x[block_lanes + i], x[2 * block_lanes + i]},
        given = m * (p - Vec3<double>{*v[0], *v[1], *v[2]});
    for (int a = 0; a < 3; ++a) at.work += 0.5 * given[a] * (at.old[block_lanes * a + i] + p[a]);
    mass += m;
    place = place + m * at_x;
    impulse = impulse + given;
    moment = moment + cross(at_x, given);
    for (int a = 0; a < 3; ++a) *v[a] = p[a];
  }
  std::vector<ReactionSums>& reactions = at.statistics.reactions;
  if (reactions.size() <= motion.reaction) reactions.resize(motion.reaction + 1);
  ReactionSums& sums = reactions[motion.reaction];
  sums.sums[ReactionSums::mass].add(mass);
  sums.add(ReactionSums::place, place);
  sums.add(ReactionSums::impulse, impulse);
  sums.add(ReactionSums::moment, moment);
}

void scale_velocities(double factor, const ColumnLayout& layout, double* block) {
  double* v = block + layout.offset(Column::velocity_x);
  for (int i = 0; i < 3 * block_lanes; ++i) v[i] *= factor;
}

void limit_velocities(const ColumnLayout& layout, double limit, double* block, int used, ThreadScratch& at) {
  for (int i = 0; i < used; ++i) {
    double* v[3];
    for (int a = 0; a < 3; ++a) v[a] = block + i + layout.offset(next(Column::velocity_x, a));
    const double speed = std::sqrt(*v[0] * *v[0] + *v[1] * *v[1] + *v[2] * *v[2]);
    if (!(speed > limit)) continue;
    at.work += 0.5 * block[layout.offset(Column::mass) + i] * (limit * limit - speed * speed);
    for (int a = 0; a < 3; ++a) *v[a] *= limit / speed;
    ++at.statistics.limited;
  }
}

void integrate_rigid_velocities(const ColumnLayout& layout, const Vec3<double>& acceleration, double dt,
                                double* block, int used, ThreadScratch& at) {
  double* velocity = block + layout.offset(Column::velocity_x);
  for (int i = 0; i < used; ++i) {
    const double m = block[layout.offset(Column::mass) + i];
    for (int a = 0; a < 3; ++a) {
      double& v = velocity[block_lanes * a + i];
      const double free = at.old[block_lanes * a + i] + dt * acceleration[a];
      at.work += 0.5 * m * (free - v) * (at.old[block_lanes * a + i] + free);
      v = free;
    }
  }
}

void move_at_own_velocity(const ColumnLayout& layout, double dt, double* block) {
  double* x = block + layout.offset(Column::position_x);
  const double* v = block + layout.offset(Column::velocity_x);
  for (int i = 0; i < 3 * block_lanes; ++i) x[i] += dt * v[i];
}

void correct_work_of_weight(const Vec3<double>& weight, double dt, double velocity_dt,
                            const ColumnLayout& layout, const double* block, int used, ThreadScratch& at) {
  const double* m = block + layout.offset(Column::mass);
  const double* v = block + layout.offset(Column::velocity_x);
  for (int i = 0; i < used; ++i) {
    for (int a = 0; a < 3; ++a) {
      const double now = v[block_lanes * a + i], old = at.old[block_lanes * a + i];
      at.work += m[i] * weight[a] * (0.5 * velocity_dt * (old + now) - dt * now);
    }
  }
}

void add_work_of_damping(double damped, const ColumnLayout& layout, const double* block, int used,
                         ThreadScratch& at) {
  const double* m = block + layout.offset(Column::mass);
  const double* v = block + layout.offset(Column::velocity_x);
  for (int i = 0; i < used; ++i) {
    for (int a = 0; a < 3; ++a) {
      const double now = v[block_lanes * a + i], old = at.old[block_lanes * a + i];
      at.work -= 0.5 * m[i] * damped * old * (old + now);
    }
  }
}

void add_work_of_motion(const Vec3<double>& weight, const ColumnLayout& layout, const double* block, int used,
                        ThreadScratch& at) {
  const double* m = block + layout.offset(Column::mass);
  const double* x = block + layout.offset(Column::position_x);
  for (int i = 0; i < used; ++i)
    for (int a = 0; a < 3; ++a)
      at.work += m[i] * weight[a] * (x[block_lanes * a + i] - at.old[block_lanes * a + i]);
}

void refer_gradient_to_old_positions(Batch& batch, int at, double dt, ReferredTrace trace_of,
                                     bool cell_strain) {
  using R = Lanes<block_lanes>;
  constexpr double least = 0.1;
  const auto row = [&](int i) { return load<R>(batch.gradient[i] + at); };
  const Mat3<R> l{row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7), row(8)};
  const R one(1.0), k(-dt);
  const Mat3<R> back{one + k * l.xx, k * l.xy, k * l.xz, k * l.yx,      one + k * l.yy,
                     k * l.yz,       k * l.zx, k * l.zy, one + k * l.zz};
  const R determinant_back = determinant(back);
  const auto invertible = determinant_back > R(least);
  Mat3<R> referred = (one / select(invertible, determinant_back, one)) * (adjugate(back) * l);
  if (trace_of != ReferredTrace::of_gradient) {
    const R rate = l.xx + l.yy + l.zz, left = one + k * rate;
    const R wanted = trace_of == ReferredTrace::unchanged ? rate : rate / max(left, R(least));
    const R more = (wanted - (referred.xx + referred.yy + referred.zz)) * R(1.0 / 3);
    referred.xx += more, referred.yy += more, referred.zz += more;
  }
  const R values[9] = {referred.xx, referred.xy, referred.xz, referred.yx, referred.yy,
                       referred.yz, referred.zx, referred.zy, referred.zz};
  for (int i = 0; i < 9; ++i) store(batch.gradient[i] + at, select(invertible, values[i], row(i)));
  if (!cell_strain) return;
  const R e = load<R>(batch.cell_volumetric_strain + at), left = one - e;
  store(batch.cell_volumetric_strain + at, select(left > R(least), e / max(left, R(least)), e));
}

namespace {

/// s : L of lane `i` of a block whose deviator is at `s`.
double deviatoric_power(const Batch& batch, const double* s, int b, int i) {
  constexpr int y = block_lanes, z = 2 * block_lanes;
  const auto l = [&](int k) { return batch.gradient[k][block_lanes * b + i]; };
  return s[i] * l(0) + s[i + y] * l(4) + s[i + z] * l(8) + s[i + 3 * y] * (l(1) + l(3)) +
         s[i + 4 * y] * (l(5) + l(7)) + s[i + 5 * y] * (l(2) + l(6));
}

/// Sum over the particles of a batch of work(block, lane), which the compiler evaluates in lanes.
template <class F>
double sum_of_lanes(const Batch& batch, F work_of) {
  double sum = 0;
  for (int b = 0; b < batch.blocks; ++b) {
    alignas(64) double work[block_lanes];
    for (int i = 0; i < block_lanes; ++i) work[i] = work_of(b, i);
    const int used = std::min(block_lanes, batch.particles - block_lanes * b);
    for (int i = 0; i < used; ++i) sum += work[i];
  }
  return sum;
}

}  // namespace

double work_of_stress(const Batch& batch) {
  const ColumnLayout& layout = *batch.layout;
  const int volume = layout.offset(Column::volume), deviator = layout.offset(Column::s_xx),
            pressure = layout.offset(Column::pressure), viscous = layout.offset(Column::viscous_pressure);
  return sum_of_lanes(batch, [&](int b, int i) {
    const double *block = batch.block[b], *old = batch.old_volume + block_lanes * b;
    const double v = block[volume + i];
    return 0.5 * batch.dt * (v + old[i]) * deviatoric_power(batch, block + deviator, b, i) -
           (v - old[i]) * (block[pressure + i] + block[viscous + i]);
  });
}

double work_of_present_stress(const Batch& batch, bool updated) {
  const ColumnLayout& layout = *batch.layout;
  const int volume = layout.offset(Column::volume), deviator = layout.offset(Column::s_xx),
            pressure = layout.offset(Column::pressure);
  return sum_of_lanes(batch, [&](int b, int i) {
    const double* block = batch.block[b];
    const auto l = [&](int k) { return batch.gradient[k][block_lanes * b + i]; };
    const double v = updated ? batch.old_volume[block_lanes * b + i] : block[volume + i];
    return batch.dt * v *
           (deviatoric_power(batch, block + deviator, b, i) - block[pressure + i] * (l(0) + l(4) + l(8)));
  });
}

void name_unphysical(const WarnInput& warn, const Body& body, const Batch& batch,
                     StepStatistics& statistics) {
  const ColumnLayout& layout = *batch.layout;
  const auto name = [&](std::uint64_t lanes, OffendingParticles& among) {
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
  if (warn.negative_volume) name(batch.vanishing, statistics.vanishing);
  if (warn.negative_internal_energy) name(batch.negative, statistics.negative);
}

unsigned find_departing(int tile, std::size_t b, const BrickFrame& frame, double erosion_volume,
                        const FailedComponent::Membership& membership, const ColumnLayout& layout,
                        const double* block, int used, std::vector<DepartingParticle>& departing) {
  const auto add = [&](int lane, bool eroded) {
    departing.push_back(
        {tile, static_cast<std::uint32_t>(block_lanes * b) + static_cast<std::uint32_t>(lane), eroded});
  };
  unsigned gone = 0;
  if (layout.has(Column::failed) || erosion_volume > 0) {
    const double* volume = block + layout.offset(Column::volume);
    for (int i = 0; i < used; ++i) {
      const bool eroded = volume[i] < erosion_volume ||
                          (layout.has(Column::failed) && block[layout.offset(Column::failed) + i] >= 2);
      if (!eroded) continue;
      gone |= 1u << i;
      add(i, true);
    }
  }
  unsigned outside = lanes_outside(frame, layout, block, used);
  if (membership.rule != nullptr) outside |= membership.misplaced(layout, block, used);
  outside &= ~gone;
  for (unsigned left = outside; left != 0; left &= left - 1) add(__builtin_ctz(left), false);
  return ((1u << used) - 1) & ~(gone | outside);
}

}  // namespace mpm::core
