// Initial state of new particles whose position, velocity, mass, volume and identity are set and all other
// columns zero. The strength model comes first and stores its moduli in the rows of the batch; the equation
// of state follows. Shown by tests/physics/energy_test.cpp and laws_test.cpp.
#pragma once

#include "physics/material/pressure_stage.hpp"
#include "physics/material/scatter.hpp"
#include "physics/material/strength_stage.hpp"

namespace mpm::physics {

struct StartRules {
  PressureRules pressure;
  double room_temperature = 293;
  double specific_heat = 0;
  double e0 = 0;  ///< initial internal energy per initial volume
};

/// The particle's temperature where its body sets one (the column is then positive), else the material's.
template <class T>
T initial_temperature(const core::ColumnLayout& layout, const double* block, const StartRules& rules) {
  if (!layout.has(core::Column::temperature)) return rules.room_temperature;
  const T given = core::load<T>(block + layout.offset(core::Column::temperature));
  return core::select(given > 0.0, given, T(rules.room_temperature));
}

/// The law at rest: no strain, no stress. Its stiffness and strength are those at the start.
template <class T, class Law>
StrengthPoint<T> rest(const Law& law, StrengthPoint<T> point) {
  point.dt = 1;
  point.strain = point.s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  point.volumetric_strain = 0.0;
  law.update(point);
  return point;
}

/// Energy and pressure of a particle placed at the point's volume. The energy is E0 at any volume: how the
/// body reached its density is up to the user. Only the elastic bulk, which has no E0, starts with the work
/// of reaching that density, so that a body released to the reference density ends with none. `heat` is the
/// additional energy of a body that starts at another temperature than the material's, as if heated in place.
template <class T, class Eos>
LinearisedPressure<T> start(const Eos& eos, EosPoint<T>& point, double e0, const T& heat) {
  point.energy = e0;
  if constexpr (requires { eos.initialise(point); }) eos.initialise(point);
  point.energy += heat;
  core::MaskOf<T> outside{};
  const LinearisedPressure<T> line = limited_line(eos, point, outside);
  const LinearisedPressure<T> acting = acting_line(eos, point, line);
  point.pressure = acting.a + acting.b * point.energy;
  return line;
}

/// Initialises the law's state, the temperature and the yield stress where the layout has them, and the rows
/// of the shear modulus and of a law's own pressure.
template <class T, class Law>
void initialise_strength(core::Batch& batch, const Law& law, const StartRules& rules) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const History<Law, StrengthPoint<T>> history(law, layout);
  for_each_vector<T>(batch, [&](double* block, int row) {
    const auto put = [&](Column c, const T& value) {
      if (layout.has(c)) core::store(block + layout.offset(c), value);
    };
    const auto get = [&](Column c) { return core::load<T>(block + layout.offset(c)); };
    Density<T> now(get(Column::mass), get(Column::volume), rules.pressure.reference_density);
    const T temperature = initial_temperature<T>(layout, block, rules);
    StrengthPoint<T> point{};
    history.load(block, point);
    point.density = now.density;
    point.temperature = temperature;
    point.time = batch.time;
    point.cell_size = batch.cell_size;
    if constexpr (requires(core::Vec3<T> x) { law.initialise(point, x); }) {
      law.initialise(
          point, core::Vec3<T>{get(Column::position_x), get(Column::position_y), get(Column::position_z)});
    }
    if constexpr (requires { law.scatters(); }) {
      if (law.scatters()) point.deviate = normal_deviate(get(Column::identity));
    }
    put(Column::temperature, temperature);
    if (rules.pressure.expansion != 0) expand(now, rules.pressure, layout, block);
    if constexpr (SetsPressure<Law>) { put(Column::internal_energy, law.place(point, now.relative_volume)); }
    point = rest(law, point);
    history.store(block, point);
    put(Column::yield_stress, point.yield_stress);
    core::store(batch.shear_modulus + row, point.shear_modulus);
    if constexpr (SetsPressure<Law>) {
      core::store(batch.law_pressure + row, point.pressure);
      core::store(batch.bulk_modulus + row, point.bulk_modulus);
    }
  });
}

/// Initialises the equation's state, pressure, energy, sound_speed and critical_speed.
template <class T, class Eos>
void initialise_eos(core::Batch& batch, const Eos& eos, const StartRules& rules) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const History<Eos, EosPoint<T>> history(eos, layout);
  for_each_vector<T>(batch, [&](double* block, int row) {
    const auto put = [&](Column c, const T& value) { core::store(block + layout.offset(c), value); };
    const auto get = [&](Column c) { return core::load<T>(block + layout.offset(c)); };
    const T volume = get(Column::volume);
    Density<T> now(get(Column::mass), volume, rules.pressure.reference_density);
    if (rules.pressure.expansion != 0) expand(now, rules.pressure, layout, block);
    const T heat = (rules.pressure.reference_density * rules.specific_heat) *
                   (initial_temperature<T>(layout, block, rules) - rules.room_temperature);
    EosPoint<T> point{now.compression, now.relative_volume, T(0.0), T(0.0), T(0.0)};
    history.load(block, point);
    const LinearisedPressure<T> line = [&] {
      if constexpr (std::is_same_v<Eos, StrengthPressure>) {
        point.energy = get(Column::internal_energy) + heat;
        point.pressure = core::load<T>(batch.law_pressure + row);
        return eos.linearise(batch, row, now.relative_volume);
      } else {
        return start(eos, point, rules.e0, heat);
      }
    }();
    history.store(block, point);
    put(Column::pressure, point.pressure);
    put(Column::internal_energy, point.energy);

    const T modulus =
        (4.0 / 3.0) * core::load<T>(batch.shear_modulus + row) +
        isentropic_modulus(line, now.compression, now.relative_volume, point.pressure, point.energy);
    const T c2 = core::max(modulus, 0.0) * volume * now.inverse_mass;
    store_speeds(batch, block, row, rules.pressure, c2, T(0.0));
  });
}

}  // namespace mpm::physics
