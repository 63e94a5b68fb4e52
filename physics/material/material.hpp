// A material: strength model, equation of state and failure models composed, as the input states them, behind
// the interface that the step knows. Each stage is one pass over the batch, and each law is chosen once per
// batch.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/material/constitutive_model.hpp"
#include "core/scene/body.hpp"
#include "core/scene/material.hpp"
#include "core/scene/scene.hpp"
#include "physics/eos/list.hpp"
#include "physics/failure/list.hpp"
#include "physics/failure/threshold_scatter.hpp"
#include "physics/material/common_parameters.hpp"
#include "physics/material/pressure_stage.hpp"
#include "physics/material/strength_stage.hpp"
#include "physics/strength/list.hpp"

namespace mpm::physics {

class Material final : public core::ConstitutiveModel {
 public:
  struct FailureEntry {
    FailureModel model;
    bool erodes = false;
  };
  /// Laws read and prepared; make_material does that from the input.
  struct Laws {
    std::string name;
    double reference_density = 0;
    CommonParameters common;
    CommonEosParameters common_eos;
    StrengthModel strength;
    EquationOfState eos;
    std::vector<FailureEntry> failures;
    core::RandomFailureInput random_failure;
  };
  explicit Material(Laws laws);

  const std::string& name() const override { return laws_.name; }
  core::ColumnSet columns(const core::UpdateOptions& options) const override;
  double initial_sound_speed() const override { return initial_sound_speed_; }
  double initial_shear_speed() const override { return initial_shear_speed_; }
  double reference_density() const override { return laws_.reference_density; }
  bool rigid() const override { return rigid_; }
  bool uniaxial() const override { return uniaxial_; }
  double specific_heat() const override { return laws_.common.specific_heat; }
  double conductivity() const override { return laws_.common.conductivity; }
  core::FailedComponentRule failed_component_rule() const override {
    return {laws_.common.failure_damage_threshold, scatters_ && laws_.random_failure.random_damage};
  }
  void initialise(core::Batch& batch, const core::UpdateOptions& options) const override;
  void update(core::Batch& batch, const core::UpdateOptions& options) const override;

  /// The same update with another value type: double or a Lanes<L>, for the comparison of instances.
  template <class T>
  void update_as(core::Batch& batch, const core::UpdateOptions& options) const;
  template <class T>
  void initialise_as(core::Batch& batch, const core::UpdateOptions& options) const;

  const Laws& laws() const { return laws_; }

 private:
  template <class T, class Law, class PlainEos>
  void initialise_pair(core::Batch& batch, const PressureRules& rules, const Law& law,
                       const PlainEos& plain_eos) const;
  StrengthRules strength_rules() const;
  PressureRules pressure_rules(const core::UpdateOptions& options) const;
  void scatter_thresholds();
  void draw_thresholds(core::Batch& batch) const;

  Laws laws_;
  double initial_modulus_ = 0;
  double initial_sound_speed_ = 0, initial_shear_speed_ = 0;
  bool fails_ = false;                ///< carries the column `failed`
  bool heats_ = false;                ///< carries the column `temperature`
  bool viscous_ = false;              ///< has shear viscosity
  bool expands_ = false;              ///< with heat: carries the columns `temperature` and `thermal_strain`
  bool scatters_ = false;             ///< carries the column `threshold_factor`
  bool follows_deformation_ = false;  ///< carries the deformation gradient
  TensionRules tension_;              ///< of the strength model
  bool rigid_ = false, uniaxial_ = false;
};

/// `detonations`: where and when explosives are lit. Throws core::InputErrors where parameters contradict
/// each other.
std::unique_ptr<core::ConstitutiveModel> make_material(
    const core::MaterialInput& input, const std::vector<core::DetonationItem>& detonations = {});

/// All materials of a scene, in its order. Throws what is wrong with any of them, together.
std::vector<std::unique_ptr<core::ConstitutiveModel>> make_materials(const core::Scene& scene);

}  // namespace mpm::physics
