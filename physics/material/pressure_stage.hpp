// Third stage: artificial viscosity, and energy and pressure solved together (thesis 2-69, 2-82 to 2-92). Per
// unit initial volume, with h = (V^{n+1} - V^n)/(2 V0) and the stress work w = V^{n+1/2} s^{n+1/2} : de / V0:
//   E* = E^n - h p^n - h (q^n + q^{n+1}) + w,   p = (a + b E*)/(1 + b h),   E = E* - h p
// h replaces V^{n+1/2} tr(de)/2 (2-88), so that -p dV is the work of the actual volume change. The sound
// speed in q is that of the new volume with the old energy and pressure. The stage then computes the wave
// speed of the new state (2-57) and the speed of the critical step (2-74). Shown by
// tests/physics/energy_test.cpp and laws_test.cpp.
#pragma once

#include "physics/eos/burning.hpp"
#include "physics/eos/point.hpp"
#include "physics/eos/strength_pressure.hpp"
#include "physics/history.hpp"
#include "physics/material/failed_state.hpp"
#include "physics/material/vectors.hpp"
#include "physics/material/viscosity_limiter.hpp"
#include "physics/strength/tension.hpp"

namespace mpm::physics {

struct PressureRules {
  double reference_density = 0;
  double bq1 = 0;              ///< quadratic term of the artificial viscosity
  double bq2 = 0;              ///< linear term
  bool limited = false;        ///< both act in shocks only (viscosity_limiter.hpp)
  double tension_weight = 1;   ///< of the critical speed of a fluid in tension
  double initial_modulus = 0;  ///< rho0 c0^2 at rest, the scale of negligible stresses
  double initial_sound_speed = 0;
  bool constant_sound_speed = false;  ///< for the critical step
  bool viscosity_in_wave_speed = true;
  double expansion = 0;       ///< volumetric, per degree; 0: no effect of temperature
  double expansion_from = 0;  ///< temperature without thermal strain
  bool viscous = false;       ///< the batch's shear_viscosity is not zero throughout
  FailedRules failed;
  TensionRules tension;
};

/// Derived quantities of a particle's mass and volume, with one division.
template <class T>
struct Density {
  T inverse_mass, density, relative_volume, compression;

  Density(const T& mass, const T& volume, double reference_density) {
    const T r = 1.0 / (mass * volume);
    inverse_mass = volume * r;
    density = mass * (mass * r);
    relative_volume = reference_density * (volume * inverse_mass);
    compression = density * (1 / reference_density) - 1.0;
  }
};

/// rho dp/drho along an isentrope (2-57).
template <class T>
T isentropic_modulus(const LinearisedPressure<T>& line, const T& compression, const T& relative_volume,
                     const T& pressure, const T& energy) {
  return (1.0 + compression) * (line.da + line.db * energy) + relative_volume * pressure * line.b;
}

/// The linearised equation at the point, with the compression limited where the equation has a limit.
template <class T, class Eos>
LinearisedPressure<T> limited_line(const Eos& eos, EosPoint<T>& point, core::MaskOf<T>& outside) {
  if constexpr (requires { eos.compression_limit; }) {
    outside = point.compression > eos.compression_limit;
    point.compression = core::min(point.compression, eos.compression_limit);
  }
  return eos.linearise(point);
}

/// Q of all viscosity that counts in the critical step: the artificial viscosity (2-73), from the rate of
/// compression and its sound speed, and the shear viscosity, 4/3 mu D = rho l Q D.
template <class T>
T damping_speed(const core::Batch& batch, const PressureRules& rules, const T& rate, const T& c,
                const T& specific_volume, int row) {
  T damping = 0.0;
  if (rules.viscosity_in_wave_speed) {
    const T sound = rules.constant_sound_speed ? T(rules.initial_sound_speed) : c;
    damping = core::select(rate > 0.0, rules.bq2 * sound + (rules.bq1 * batch.cell_size) * rate, 0.0);
  }
  if (rules.viscous) {
    damping += (4 / (3 * batch.cell_size)) * specific_volume * core::load<T>(batch.shear_viscosity + row);
  }
  return damping;
}

/// The pressure of a failed particle between whose fragments there is a void (kinematics.hpp): none.
/// Fragments that would press, since they were heated, expand into the void instead, against no resistance.
template <class T>
T fill_void(double* gap_column, double* volume_column, const T& volume, const LinearisedPressure<T>& line,
            const Density<T>& now, const T& pressure, const T& energy) {
  const T gap = core::load<T>(gap_column);
  const core::MaskOf<T> open = gap > 0.0;
  if (!core::any(open)) return pressure;
  const T modulus = isentropic_modulus(line, now.compression, now.relative_volume, pressure, energy);
  const core::MaskOf<T> expands = open & (pressure > 0.0);
  const T step = core::min(gap, core::select(modulus > 0.0, volume * (pressure / modulus), gap));
  const T growth = core::select(expands, step, 0.0);
  core::store(gap_column, gap - growth);
  core::store(volume_column, volume + growth);
  return core::select(open, 0.0, pressure);
}

/// A fluid in tension counts faster for the time step, where the shape functions ask for that
/// (core/step/speeds.hpp). `shear`: 4/3 of the shear modulus.
template <class T>
void weigh_tension(core::Batch& batch, int row, const PressureRules& rules, const T& shear, const T& p) {
  if (rules.tension_weight == 1) return;
  const T speed = core::load<T>(batch.critical_speed + row);
  const core::MaskOf<T> torn = (p < -1e-6 * rules.initial_modulus) & (shear <= 0.0);
  core::store(batch.critical_speed + row, core::select(torn, rules.tension_weight * speed, speed));
}

/// Speeds for the time step (2-74) and, where the layout has that column, for output. `damping` is Q of all
/// viscosity that counts.
template <class T>
void store_speeds(core::Batch& batch, double* block, int row, const PressureRules& rules, const T& c2,
                  const T& damping) {
  const double c0 = rules.initial_sound_speed;
  const T speed2 = rules.constant_sound_speed ? T(c0 * c0) : c2;
  core::store(batch.critical_speed + row, damping + sqrt(damping * damping + speed2));
  const int sound_at = batch.layout->offset(core::Column::sound_speed);
  if (sound_at < 0) return;
  const T c = sqrt(c2);
  core::store(batch.sound_speed + row, c);
  core::store(block + sound_at, c);
}

/// Every stress contributes to the energy, so checking the energy finds all NaN.
template <class T>
void count_events(core::Batch& batch, core::MaskOf<T> undefined, const T& energy, double negligible,
                  int row) {
  const core::MaskOf<T> negative = energy < negligible;
  const core::MaskOf<T> not_finite = !(energy - energy == 0.0);
  if (!core::any(undefined | negative | not_finite)) return;
  core::MaterialEvents& events = batch.events;
  events.undefined_root += count<T>(undefined, row, batch.particles);
  events.negative_energy += count<T>(negative, row, batch.particles);
  events.not_finite += count<T>(not_finite, row, batch.particles);
  batch.negative |= lanes_of<T>(negative, row, batch.particles);
}

/// Thermal expansion: the pressure depends only on the volume change beyond it. With e = expansion (T - T0)
/// the volume at rest is V0 exp(e), and `now` becomes V relative to it. Returns the increase of e since the
/// column was last written, whatever changed the temperature. There is no feedback on the temperature (no
/// cooling in tension); only for equations whose pressure does not depend on heat through E.
template <class T>
T expand(Density<T>& now, const PressureRules& rules, const core::ColumnLayout& layout, double* block) {
  using core::exp;
  double* const column = block + layout.offset(core::Column::thermal_strain);
  const T temperature = core::load<T>(block + layout.offset(core::Column::temperature));
  const T e = rules.expansion * (temperature - rules.expansion_from), before = core::load<T>(column);
  core::store(column, e);
  now.relative_volume = now.relative_volume * exp(-e);
  now.compression = 1.0 / now.relative_volume - 1.0;
  return e - before;
}

/// Updates pressure, viscous_pressure, internal_energy and the equation's state; computes sound_speed and
/// critical_speed. `verdict` (null where the material cannot fail) becomes 1 where the result is undefined,
/// else 0.
template <class T, class Eos>
[[gnu::noinline, gnu::flatten]] void update_pressure(core::Batch& batch, const Eos& eos,
                                                     const PressureRules& rules, double* verdict) {
  using core::Column;
  using core::max;
  constexpr bool can_fail = core::derivatives_of<T> == 0;  // what can fail has no tangent
  const core::ColumnLayout& layout = *batch.layout;
  const History<Eos, EosPoint<T>> history(eos, layout);
  const int mass_at = layout.offset(Column::mass), volume_at = layout.offset(Column::volume);
  const int pressure_at = layout.offset(Column::pressure), q_at = layout.offset(Column::viscous_pressure);
  const int energy_at = layout.offset(Column::internal_energy), failed_at = layout.offset(Column::failed);
  const int void_at = layout.offset(Column::void_volume);
  const int factor_at = layout.offset(Column::viscosity_factor);
  const int divergence_at = layout.offset(Column::velocity_divergence);
  const bool limited = rules.limited && batch.cell_size > 0;
  const double length = batch.cell_size, inverse_dt = 1 / batch.dt, rho0 = rules.reference_density;
  const double new_q = batch.new_viscosity(), old_q = 2 - new_q;  // in the mean that does work, twice
  const double negligible = -1e-12 * rules.initial_modulus;

  for_each_vector<T, parts_of_pressure>(batch, [&](double* block, int row) {
    const T volume = core::load<T>(block + volume_at), old_volume = core::load<T>(batch.old_volume + row);
    Density<T> now(core::load<T>(block + mass_at), volume, rho0);
    const T tr = core::load<T>(batch.volumetric_strain + row);
    const T mechanical = rules.expansion != 0 ? tr - expand(now, rules, layout, block) : tr;
    const T old_p = core::load<T>(block + pressure_at), old_energy = core::load<T>(block + energy_at);
    const T shear = (4.0 / 3.0) * core::load<T>(batch.shear_modulus + row);
    const T specific_volume = volume * now.inverse_mass;

    EosPoint<T> point{now.compression, now.relative_volume, mechanical, old_p, old_energy};
    history.load(block, point);
    core::MaskOf<T> outside{};
    const LinearisedPressure<T> line = [&] {
      if constexpr (std::is_same_v<Eos, StrengthPressure>)
        return eos.linearise(batch, row, now.relative_volume);
      else
        return limited_line(eos, point, outside);
    }();

    const LinearisedPressure<T> acting = acting_line(eos, point, line);

    const T per_v0 = rho0 * now.inverse_mass;
    const T h = 0.5 * (volume - old_volume) * per_v0;
    const T response = 1.0 / (1.0 + acting.b * h);

    // Artificial viscosity: none in expansion, and none for failed particles.
    core::MaskOf<T> failed{};
    if (can_fail && failed_at >= 0) failed = core::load<T>(block + failed_at) > 0.5;
    const T rate = core::select(failed, 0.0, max(-inverse_dt * tr, 0.0));
    const T modulus_before =
        shear + isentropic_modulus(line, now.compression, now.relative_volume, old_p, old_energy);
    const T c_before = sqrt(max(modulus_before, 0.0) * specific_volume);
    T acting_rate = rate;
    if (limited) {
      acting_rate =
          rate * limit_viscosity<T>(batch, row, block + factor_at, block + divergence_at, tr, c_before);
    }
    const T q = (length * now.density * acting_rate) * (rules.bq1 * length * rate + rules.bq2 * c_before);

    const T work = 0.5 * (volume + old_volume) * per_v0 * core::load<T>(batch.deviatoric_work + row);
    const T energy_star = old_energy - h * (old_p + old_q * core::load<T>(block + q_at) + new_q * q) + work;
    const T stated = (acting.a + acting.b * energy_star) * response;
    T p = stated, sentence = 0.0;
    if (can_fail && rules.tension.limited) {
      p = limit_tension(rules.tension, stated, core::load<T>(batch.lowest_pressure + row), sentence);
    }
    if (can_fail && failed_at >= 0)
      p = core::select(failed, broken_pressure(eos, rules.failed, point, stated), p);
    if (can_fail && void_at >= 0)
      p = fill_void(block + void_at, block + volume_at, volume, line, now, p, energy_star);
    const T energy = energy_star - h * p;

    history.store(block, point);
    core::store(block + pressure_at, p);
    core::store(block + q_at, q);
    core::store(block + energy_at, energy);
    if constexpr (core::derivatives_of < T >> 0) return;  // of the stress alone

    const T modulus = shear + isentropic_modulus(line, now.compression, now.relative_volume, p, energy);
    const core::MaskOf<T> undefined = outside | (modulus < negligible);
    const T c2 = core::select(undefined, rules.initial_sound_speed * rules.initial_sound_speed,
                              max(modulus, 0.0) * specific_volume);
    store_speeds(batch, block, row, rules, c2,
                 damping_speed(batch, rules, rate, c_before, specific_volume, row));
    weigh_tension<T>(batch, row, rules, shear, p);
    if (verdict != nullptr) core::store(verdict + row, core::select(undefined, max(sentence, 1.0), sentence));

    count_events<T>(batch, undefined, energy, negligible, row);
  });
}

}  // namespace mpm::physics
