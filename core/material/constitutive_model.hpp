// Interface of a material to the step: the columns it needs, the initialisation of particles and the update
// of a batch. The laws themselves are in `physics`; `mpm_point` uses the same interface.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "core/material/batch.hpp"
#include "core/material/failed_component.hpp"
#include "core/material/stress_tangent.hpp"

namespace mpm::core {

/// Settings of the run that affect the update of a material point.
struct UpdateOptions {
  int volume_update = 0;                ///< VolumeUpdate as a number
  double volume_min = 0;                ///< times the volume at reference density; 0: off
  double volume_max = 0;                ///< as volume_min
  bool viscosity_in_wave_speed = true;  ///< false for TimeStep@NotConsiderVisForCp
  double tension_weight = 1;            ///< of the critical speed of a fluid in tension
  bool keep_strain = false;             ///< accumulate the strain columns (volume update 4, outputs exx..)
  bool artificial_viscosity = true;     ///< false: q = 0, in the stress and in the critical speed
};

class ConstitutiveModel {
 public:
  virtual ~ConstitutiveModel() = default;

  virtual const std::string& name() const = 0;
  /// Columns beyond ColumnSet::mechanics() that this material's particles carry under these options.
  virtual ColumnSet columns(const UpdateOptions& options) const = 0;
  /// Bulk stiffness wave speed at rest, for messages and the first step; 0 for a rigid body.
  virtual double initial_sound_speed() const = 0;
  /// Shear wave speed at rest; 0 for a fluid.
  virtual double initial_shear_speed() const { return 0; }
  virtual double reference_density() const = 0;
  /// A rigid body takes no velocity from the grid and never deforms.
  virtual bool rigid() const { return false; }
  /// Stress of a bar: along x, which the caller rotates to the bar's axis.
  virtual bool uniaxial() const { return false; }

  /// Initial state of new particles whose position, velocity, mass, volume and identity are set, and the
  /// temperature where the material does not set it; all else is zero: energy, temperature, the pressure of a
  /// body placed at another density, history. Also sets sound_speed and critical_speed.
  virtual void initialise(Batch& batch, const UpdateOptions& options) const = 0;

  /// One step: from `gradient` and `dt` to stress, volume, energy, state, sound_speed and critical_speed.
  virtual void update(Batch& batch, const UpdateOptions& options) const = 0;

  /// Why the material has no tangent, as the predicate of a sentence whose subject is the material; empty if
  /// it has one.
  virtual std::string tangent_fault() const { return "has no tangent"; }
  /// The derivative of the stress at the end of the step that update() would compute from the same columns,
  /// gradient and dt. Columns and batch are unchanged. At a kink (yield, an apex) it is that of the branch
  /// taken; with volume update 1 the cell's strain is held constant. A lane whose volume would not remain
  /// positive has the tangent of the step that keeps its volume. Only if tangent_fault() is empty.
  virtual void tangent(const Batch& /*batch*/, const UpdateOptions& /*options*/,
                       StressTangent& /*result*/) const {
    throw std::logic_error(name() + " " + tangent_fault());
  }

  /// Derived quantities for output and for the thermal summary; 0 where the law has none.
  virtual double specific_heat() const { return 0; }
  /// Heat conductivity; 0: adiabatic.
  virtual double conductivity() const { return 0; }

  /// For contact between components.
  virtual FailedComponentRule failed_component_rule() const { return {}; }
};

}  // namespace mpm::core
