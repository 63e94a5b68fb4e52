#include "physics/material/material.hpp"

#include "core/grid/brick.hpp"
#include "core/simd/math.hpp"
#include "physics/laws.hpp"
#include "physics/material/deformation.hpp"
#include "physics/material/failure_stage.hpp"
#include "physics/material/kinematics.hpp"
#include "physics/material/scatter.hpp"

namespace mpm::physics {

using core::Column;

namespace {

/// Whether make_material puts the two together: no other pair is compiled.
template <class Law, class Eos>
constexpr bool pair =
    SetsPressure<std::remove_cvref_t<Law>> == std::is_same_v<std::remove_cvref_t<Eos>, StrengthPressure>;

/// The law at rest: no strain, no stress. What it says then of stiffness and strength holds at the start.
template <class T, class Law>
StrengthPoint<T> rest(const Law& law, StrengthPoint<T> point) {
  point.dt = 1;
  point.strain = point.s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  point.volumetric_strain = 0.0;
  law.update(point);
  return point;
}

/// Energy and pressure of a particle placed at the point's volume. The energy is E0 at that volume, whatever
/// the volume: how the body came to its density is the user's matter. Only the elastic bulk, which has no E0,
/// starts with the work of the way there, so that a body released to the reference density ends with none.
/// `heat` is what a body that starts at another temperature than the material's has more, as if heated in
/// place.
template <class T, class Eos>
EosLine<T> start(const Eos& eos, EosPoint<T>& point, double e0, const T& heat) {
  point.energy = e0;
  if constexpr (requires { eos.initialise(point); }) eos.initialise(point);
  point.energy += heat;
  core::MaskOf<T> outside{};
  const EosLine<T> line = limited_line(eos, point, outside);
  const EosLine<T> acting = acting_line(eos, point, line);
  point.pressure = acting.a + acting.b * point.energy;
  return line;
}

/// What the particle starts with: the same, or of the law's point, where that has placed the particle.
template <class T, class Law, class Eos>
EosLine<T> start(const Law&, const Eos& eos, const StrengthPoint<T>& point, EosPoint<T>& bulk, double e0,
                 const T& heat) {
  if constexpr (SetsPressure<Law>) {
    bulk.energy += heat;
    bulk.pressure = point.pressure;
    return StrengthPressure::line(point.pressure, point.bulk_modulus, bulk.relative_volume);
  } else {
    return start(eos, bulk, e0, heat);
  }
}

StrengthPoint<double> point_at_rest(const Material::Laws& laws) {
  StrengthPoint<double> at_rest{};
  at_rest.density = laws.reference_density;
  at_rest.temperature = laws.common.room_temperature;
  std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (SetsPressure<Law>) law.place(at_rest, 1.0);
        at_rest = rest(law, at_rest);
      },
      laws.strength);
  return at_rest;
}

/// rho0 c0^2 of the undeformed material.
double modulus_at_rest(const Material::Laws& laws, const StrengthPoint<double>& at_rest) {
  const double shear = at_rest.shear_modulus;
  if (laws.common_eos.c0 > 0)
    return 4.0 / 3.0 * shear + laws.reference_density * laws.common_eos.c0 * laws.common_eos.c0;
  return std::visit(
      [&]<class Eos>(const Eos& eos) {
        if constexpr (std::is_same_v<Eos, StrengthPressure>) {
          return 4.0 / 3.0 * shear + at_rest.bulk_modulus;
        } else {
          EosPoint<double> point{};
          point.relative_volume = 1;
          const EosLine<double> line = start(eos, point, laws.common_eos.e0, 0.0);
          return 4.0 / 3.0 * shear + isentropic_modulus(line, 0.0, 1.0, point.pressure, point.energy);
        }
      },
      laws.eos);
}

}  // namespace

Material::Material(Laws laws) : laws_(std::move(laws)) {
  std::visit(
      [&](const auto& law) {
        if constexpr (requires { law.fails_by_damage(); }) {
          if (law.fails_by_damage()) {
            FullDamage damage;
            if constexpr (requires { law.failing_damage(); }) damage.threshold = law.failing_damage();
            laws_.failures.push_back({damage, false});
          }
        }
        if constexpr (requires { law.erodes_by_damage(); }) {
          if (law.erodes_by_damage()) laws_.failures.push_back({FullDamage{}, true});
        }
        if constexpr (requires { law.tension_rules(); }) tension_ = law.tension_rules();
        if constexpr (requires { law.plastic_work_coefficient; }) heats_ = laws_.common.specific_heat > 0;
        if constexpr (requires { law.is_viscous(); }) viscous_ = law.is_viscous();
        if constexpr (requires { requires std::decay_t<decltype(law)>::rigid; }) rigid_ = true;
        if constexpr (requires { requires std::decay_t<decltype(law)>::uniaxial; }) uniaxial_ = true;
      },
      laws_.strength);
  fails_ = !laws_.failures.empty() || tension_.fails();
  expands_ = laws_.common.temperature_coefficient != 0;
  scatter_thresholds();
  follows_deformation_ = columns({}).has(Column::f_xx);
  viscous_ = viscous_ || (fails_ && laws_.common.fail_viscosity > 0);
  const StrengthPoint<double> at_rest = point_at_rest(laws_);
  initial_modulus_ = modulus_at_rest(laws_, at_rest);
  initial_shear_speed_ = std::sqrt(std::max(at_rest.shear_modulus, 0.0) / laws_.reference_density);
  initial_sound_speed_ = std::sqrt(std::max(initial_modulus_, 0.0) / laws_.reference_density);
}

void Material::scatter_thresholds() {
  const core::RandomFailureInput& random = laws_.random_failure;
  if (!random.enable || random.distribution == core::RandomFailureInput::Distribution::constant) return;
  for (FailureEntry& entry : laws_.failures) {
    // Erosion by damage waits for all of it (manual 3.2.1.10).
    auto* const damage = std::get_if<FullDamage>(&entry.model);
    if (damage != nullptr && !entry.erodes) damage->scatters = random.random_damage;
  }
  scatters_ = fails_ || (random.random_damage && columns({}).has(Column::damage));
}

core::ColumnSet Material::columns(const core::UpdateOptions& options) const {
  core::ColumnSet set = std::visit([](const auto& law) { return columns_of(law); }, laws_.strength);
  set.add(std::visit([](const auto& eos) { return columns_of(eos); }, laws_.eos));
  for (const FailureEntry& entry : laws_.failures) {
    set.add(std::visit([](const auto& law) { return columns_of(law); }, entry.model));
  }
  if (fails_) set.add(Column::failed);
  if (heats_) set.add(Column::temperature);
  if (expands_) set.add({Column::temperature, Column::thermal_strain});
  if (laws_.common.conductivity > 0) set.add(Column::temperature);
  if (scatters_) set.add(Column::threshold_factor);
  if (options.keep_strain || options.volume_update == 4) set.add_range(Column::strain_xx, 6);
  return set;
}

StrengthRules Material::strength_rules() const {
  return {.fail_viscosity = laws_.common.fail_viscosity,
          .specific_heat = laws_.common.specific_heat,
          .viscous = viscous_};
}

PressureRules Material::pressure_rules(const core::UpdateOptions& options) const {
  const CommonParameters& common = laws_.common;
  return {.reference_density = laws_.reference_density,
          .bq1 = common.bq1,
          .bq2 = common.bq2,
          .initial_modulus = initial_modulus_,
          .initial_sound_speed = initial_sound_speed_,
          .constant_sound_speed = common.constant_sound_speed != 0,
          .viscosity_in_wave_speed = options.viscosity_in_wave_speed,
          .expansion = 3 * common.temperature_coefficient,
          .expansion_from = common.room_temperature,
          .viscous = viscous_,
          .failed = {.type = static_cast<int>(common.failed_type), .tensile_cutoff = common.tensile_cutoff},
          .tension = tension_};
}

template <class T>
void Material::update_as(core::Batch& batch, const core::UpdateOptions& options) const {
  if (rigid_) {
    std::fill_n(batch.critical_speed, core::batch_particles, 0.0);
    std::fill_n(batch.sound_speed, core::batch_particles, 0.0);
    return;
  }
  alignas(64) core::Row verdict;
  const PressureRules rules = pressure_rules(options);
  update_kinematics<T>(batch, options, laws_.reference_density);
  if (follows_deformation_) update_deformation_gradient<T>(batch);
  std::visit([&](const auto& law) { update_strength<T>(batch, law, strength_rules()); }, laws_.strength);
  std::visit(
      [&](const auto& law, const auto& eos) {
        if constexpr (pair<decltype(law), decltype(eos)>)
          update_pressure<T>(batch, beside(eos, law), rules, fails_ ? verdict : nullptr);
      },
      laws_.strength, laws_.eos);
  if (!fails_) return;
  for (const FailureEntry& entry : laws_.failures) {
    std::visit([&](const auto& model) { judge<T>(batch, model, entry.erodes, scatters_, verdict); },
               entry.model);
  }
  apply_failure<T>(batch, rules.failed, verdict);
}

template <class T, class Law, class PlainEos>
void Material::initialise_pair(core::Batch& batch, const PressureRules& rules, const Law& law,
                               const PlainEos& plain_eos) const {
  const core::ColumnLayout& layout = *batch.layout;
  const auto& eos = beside(plain_eos, law);
  const History<Law, StrengthPoint<T>> law_history(law, layout);
  const History<std::decay_t<decltype(eos)>, EosPoint<T>> eos_history(eos, layout);
  for_each_vector<T>(batch, [&](double* block, int row) {
    const auto put = [&](Column c, const T& value) {
      if (layout.has(c)) core::store(block + layout.offset(c), value);
    };
    const auto get = [&](Column c) { return core::load<T>(block + layout.offset(c)); };
    const T volume = get(Column::volume);
    Density<T> now(get(Column::mass), volume, rules.reference_density);
    T temperature = laws_.common.room_temperature;
    if (layout.has(Column::temperature)) {
      const T given = get(Column::temperature);
      temperature = core::select(given > 0.0, given, temperature);
    }
    const T heat = (laws_.reference_density * laws_.common.specific_heat) *
                   (temperature - laws_.common.room_temperature);

    if (follows_deformation_) {
      for (const Column c : {Column::f_xx, Column::f_yy, Column::f_zz}) put(c, 1.0);
    }
    StrengthPoint<T> point{};
    law_history.load(block, point);
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
    if (expands_) {
      core::store(block + layout.offset(Column::temperature), temperature);
      expand(now, rules, layout, block);
    }
    EosPoint<T> bulk{now.compression, now.relative_volume, T(0.0), T(0.0), T(0.0)};
    if constexpr (SetsPressure<Law>) { bulk.energy = law.place(point, now.relative_volume); }
    point = rest(law, point);
    law_history.store(block, point);
    put(Column::temperature, temperature);
    put(Column::yield_stress, point.yield_stress);

    eos_history.load(block, bulk);
    const EosLine<T> line = start(law, eos, point, bulk, laws_.common_eos.e0, heat);
    eos_history.store(block, bulk);
    put(Column::pressure, bulk.pressure);
    put(Column::internal_energy, bulk.energy);

    const T modulus =
        (4.0 / 3.0) * point.shear_modulus +
        isentropic_modulus(line, now.compression, now.relative_volume, bulk.pressure, bulk.energy);
    const T c2 = core::max(modulus, 0.0) * volume * now.inverse_mass;
    store_speeds(batch, block, row, rules, c2, T(0.0));
  });
}

template <class T>
void Material::initialise_as(core::Batch& batch, const core::UpdateOptions& options) const {
  const PressureRules rules = pressure_rules(options);
  if (scatters_) draw_thresholds(batch);
  std::visit(
      [&](const auto& law, const auto& eos) {
        if constexpr (pair<decltype(law), decltype(eos)>) initialise_pair<T>(batch, rules, law, eos);
      },
      laws_.strength, laws_.eos);
}

/// One draw after the other: this happens once in a particle's life.
void Material::draw_thresholds(core::Batch& batch) const {
  const ThresholdScatter scatter(laws_.random_failure);
  const auto cell_of = [&](const double* lane) -> std::int64_t {
    if (batch.grid == nullptr) return 0;
    const core::GridGeometry& grid = *batch.grid;
    std::int64_t cell = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const double x = lane[batch.layout->offset(core::next(Column::position_x, axis))];
      cell = cell * grid.cells[static_cast<std::size_t>(axis)] + grid.cell_index(x, axis);
    }
    return cell;
  };
  for_each_vector<double>(batch, [&](double* lane, int) {
    const std::uint64_t item = scatter.per_cell()
                                   ? static_cast<std::uint64_t>(cell_of(lane))
                                   : static_cast<std::uint64_t>(lane[batch.layout->offset(Column::identity)]);
    lane[batch.layout->offset(Column::threshold_factor)] = scatter.factor(item);
  });
}

void Material::initialise(core::Batch& batch, const core::UpdateOptions& options) const {
  initialise_as<core::Real>(batch, options);
}

void Material::update(core::Batch& batch, const core::UpdateOptions& options) const {
  update_as<core::Real>(batch, options);
}

template void Material::update_as<core::Real>(core::Batch&, const core::UpdateOptions&) const;
template void Material::initialise_as<core::Real>(core::Batch&, const core::UpdateOptions&) const;
#if MPM_SIMD_LANES != 1
template void Material::update_as<double>(core::Batch&, const core::UpdateOptions&) const;
template void Material::initialise_as<double>(core::Batch&, const core::UpdateOptions&) const;
#endif

}  // namespace mpm::physics
