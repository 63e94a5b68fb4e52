// What the step knows of a material: which columns it needs, how to start a particle and how to update a
// batch. The laws themselves live in `physics`; `mpm_point` drives them through this same door.
#pragma once

#include <string>
#include <vector>

#include "core/material/batch.hpp"
#include "core/material/failed_component.hpp"

namespace mpm::core {

/// Settings of the run that reach into the update of a material point.
struct UpdateOptions {
  int volume_update = 0;                ///< Volume@update_type, 0..4
  double volume_min = 0;                ///< times the volume at reference density; 0: off
  double volume_max = 0;                ///< as volume_min
  bool viscosity_in_wave_speed = true;  ///< false for TimeStep@NotConsiderVisForCp
  bool keep_strain = false;             ///< accumulate the strain columns (volume update 4, outputs exx..)
};

class ConstitutiveModel {
 public:
  virtual ~ConstitutiveModel() = default;

  virtual const std::string& name() const = 0;
  /// Columns beyond ColumnSet::mechanics() that this material's particles carry under these options.
  virtual ColumnSet columns(const UpdateOptions& options) const = 0;
  /// The bulk stiffness wave speed at rest, for messages and the first step; 0 for a rigid body.
  virtual double initial_sound_speed() const = 0;
  /// Shear wave speed at rest; 0 for a fluid.
  virtual double initial_shear_speed() const { return 0; }
  virtual double reference_density() const = 0;
  /// A rigid body takes no velocity from the grid and is never deformed.
  virtual bool rigid() const { return false; }
  /// A bar's stress: along x, which the owner of bars turns into the bar's axis.
  virtual bool uniaxial() const { return false; }

  /// First state of new particles whose position, velocity, mass, volume and identity are set, the
  /// temperature too where it is not the material's own; all else is zero: energy, temperature, the pressure
  /// of a body placed at another density, history. Also fills sound_speed and critical_speed.
  virtual void initialise(Batch& batch, const UpdateOptions& options) const = 0;

  /// One step: from `gradient` and `dt` to stress, volume, energy, state, sound_speed and critical_speed.
  virtual void update(Batch& batch, const UpdateOptions& options) const = 0;

  /// Derived quantities for output and for the thermal summary; 0 where the law has none.
  virtual double specific_heat() const { return 0; }
  /// Heat conductivity; 0: adiabatic.
  virtual double conductivity() const { return 0; }

  /// For contact between components.
  virtual FailedComponentRule failed_component_rule() const { return {}; }
};

}  // namespace mpm::core
