#include "physics/material/material.hpp"

#include "core/grid/brick.hpp"
#include "physics/failure/full_damage.hpp"
#include "physics/material/deformation.hpp"
#include "physics/material/failure_stage.hpp"
#include "physics/material/kinematics.hpp"

namespace mpm::physics {

using core::Column;

namespace {

StrengthPoint<double> point_at_rest(const Material::Laws& laws) {
  StrengthPoint<double> point{};
  point.density = laws.reference_density;
  point.temperature = laws.common.room_temperature;
  return laws.strength->at_rest(point);
}

/// rho0 c0^2 of the undeformed material.
double modulus_at_rest(const Material::Laws& laws, const StrengthPoint<double>& at_rest) {
  if (laws.common_eos.c0 > 0)
    return 4.0 / 3.0 * at_rest.shear_modulus +
           laws.reference_density * laws.common_eos.c0 * laws.common_eos.c0;
  return laws.eos->modulus_at_rest(laws.common_eos.e0, at_rest);
}

}  // namespace

Material::Material(Laws laws) : laws_(std::move(laws)), strength_traits_(laws_.strength->traits()) {
  laws_.eos->burn(strength_traits_.compression_burn);
  add_failures_of_damage();
  heats_ = strength_traits_.heats && laws_.common.specific_heat > 0;
  fails_ = !laws_.failures.empty() || strength_traits_.tension.fails();
  expands_ = laws_.common.temperature_coefficient != 0;
  const core::RandomFailureInput& random = laws_.random_failure;
  if (random.enable && random.distribution != core::RandomFailureInput::Distribution::constant)
    scatters_ = fails_ || (random.random_damage && columns({}).has(Column::damage));
  follows_deformation_ = columns({}).has(Column::f_xx);
  viscous_ = strength_traits_.viscous || (fails_ && laws_.common.fail_viscosity > 0);
  const StrengthPoint<double> at_rest = point_at_rest(laws_);
  initial_modulus_ = modulus_at_rest(laws_, at_rest);
  initial_shear_speed_ = std::sqrt(std::max(at_rest.shear_modulus, 0.0) / laws_.reference_density);
  initial_sound_speed_ = std::sqrt(std::max(initial_modulus_, 0.0) / laws_.reference_density);
}

/// Erosion by damage requires full damage (manual 3.2.1.10); the threshold of failure may scatter.
void Material::add_failures_of_damage() {
  if (strength_traits_.failing_damage) {
    const core::RandomFailureInput& random = laws_.random_failure;
    const bool scatters = random.enable && random.random_damage &&
                          random.distribution != core::RandomFailureInput::Distribution::constant;
    const FullDamage damage{*strength_traits_.failing_damage, scatters};
    laws_.failures.push_back({std::make_unique<FailureOf<FullDamage>>(damage), false});
  }
  if (strength_traits_.erodes_by_damage)
    laws_.failures.push_back({std::make_unique<FailureOf<FullDamage>>(FullDamage{}), true});
}

core::ColumnSet Material::columns(const core::UpdateOptions& options) const {
  core::ColumnSet set = laws_.strength->columns();
  set.add(laws_.eos->traits().columns);
  for (const Failure& failure : laws_.failures) set.add(failure.model->columns());
  if (fails_) set.add(Column::failed);
  if (fails_ && pressure_rules(options).failed.no_tension()) set.add(Column::void_volume);
  if (heats_) set.add(Column::temperature);
  if (expands_) set.add({Column::temperature, Column::thermal_strain});
  if (laws_.common.conductivity > 0) set.add(Column::temperature);
  if (scatters_) set.add(Column::threshold_factor);
  if (limits_viscosity(options)) set.add({Column::viscosity_factor, Column::velocity_divergence});
  if (options.keep_strain || options.volume_update == 4) set.add_range(Column::strain_xx, 6);
  return set;
}

bool Material::limits_viscosity(const core::UpdateOptions& options) const {
  const bool viscosity = options.artificial_viscosity && (laws_.common.bq1 > 0 || laws_.common.bq2 > 0);
  return viscosity && laws_.limiter == core::ViscosityLimiter::shock && !strength_traits_.rigid;
}

StrengthRules Material::strength_rules() const {
  return {.fail_viscosity = laws_.common.fail_viscosity,
          .specific_heat = laws_.common.specific_heat,
          .viscous = viscous_};
}

PressureRules Material::pressure_rules(const core::UpdateOptions& options) const {
  const CommonParameters& common = laws_.common;
  return {.reference_density = laws_.reference_density,
          .bq1 = options.artificial_viscosity ? common.bq1 : 0,
          .bq2 = options.artificial_viscosity ? common.bq2 : 0,
          .limited = limits_viscosity(options),
          .tension_weight = options.tension_weight,
          .initial_modulus = initial_modulus_,
          .initial_sound_speed = initial_sound_speed_,
          .constant_sound_speed = common.constant_sound_speed != 0,
          .viscosity_in_wave_speed = options.viscosity_in_wave_speed,
          .expansion = 3 * common.temperature_coefficient,
          .expansion_from = common.room_temperature,
          .viscous = viscous_,
          .failed = {.type = static_cast<int>(common.failed_type), .tensile_cutoff = common.tensile_cutoff},
          .tension = strength_traits_.tension};
}

template <class T>
void Material::update_as(core::Batch& batch, const core::UpdateOptions& options, Instance instance) const {
  if (strength_traits_.rigid) {
    std::fill_n(batch.critical_speed, core::batch_particles, 0.0);
    std::fill_n(batch.sound_speed, core::batch_particles, 0.0);
    std::fill_n(batch.old_volume, core::batch_particles, 0.0);  // its stresses do no work
    return;
  }
  alignas(64) core::Row verdict;
  const PressureRules rules = pressure_rules(options);
  update_kinematics<T>(batch, options,
                       {.reference_density = laws_.reference_density,
                        .parts = fails_ && rules.failed.no_tension(),
                        .largest_volume = strength_traits_.largest_volume});
  if (follows_deformation_) update_deformation_gradient<T>(batch);
  laws_.strength->update(batch, strength_rules(), instance);
  laws_.eos->update(batch, rules, fails_ ? verdict : nullptr, instance);
  if constexpr (core::derivatives_of<T> == 0) {  // what can fail has no tangent
    if (!fails_) return;
    for (const Failure& failure : laws_.failures)
      failure.model->judge(batch, failure.erodes, scatters_, verdict, instance);
    apply_failure<T>(batch, rules.failed, laws_.reference_density, verdict);
  }
}

/// Scalar loop: this happens once per particle.
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
  if (scatters_) draw_thresholds(batch);
  if (follows_deformation_) {
    for (int b = 0; b < batch.blocks; ++b) {
      for (const Column c : {Column::f_xx, Column::f_yy, Column::f_zz})
        std::fill_n(batch.column(c, b), core::block_lanes, 1.0);
    }
  }
  if (limits_viscosity(options)) {
    for (int b = 0; b < batch.blocks; ++b)
      std::fill_n(batch.column(Column::viscosity_factor, b), core::block_lanes, factor_unknown);
  }
  const StartRules rules{pressure_rules(options), laws_.common.room_temperature, laws_.common.specific_heat,
                         laws_.common_eos.e0};
  laws_.strength->initialise(batch, rules);
  laws_.eos->initialise(batch, rules);
}

void Material::update(core::Batch& batch, const core::UpdateOptions& options) const {
  update_as<core::Real>(batch, options, Instance::vectors);
}

void Material::update_scalars(core::Batch& batch, const core::UpdateOptions& options) const {
  update_as<double>(batch, options, Instance::scalars);
}

void Material::differentiate_update(core::Batch& batch, const core::UpdateOptions& options) const {
  update_as<DualReal>(batch, options, Instance::derivatives);
}

}  // namespace mpm::physics
