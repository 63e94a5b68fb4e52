// A material: the strength model, equation of state and failure models of the input, behind the interface
// that the step uses. Each stage is one pass over the batch, and each law is called once per batch.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/material/constitutive_model.hpp"
#include "core/scene/body.hpp"
#include "core/scene/material.hpp"
#include "core/scene/scene.hpp"
#include "physics/failure/threshold_scatter.hpp"
#include "physics/material/common_parameters.hpp"
#include "physics/material/eos_law.hpp"
#include "physics/material/failure_law.hpp"
#include "physics/material/strength_law.hpp"

namespace mpm::physics {

class Registry;

class Material final : public core::ConstitutiveModel {
 public:
  struct Failure {
    std::unique_ptr<FailureLaw> model;
    bool erodes = false;
  };
  /// Laws after parsing and set-up; make_material creates them from the input.
  struct Laws {
    std::string name;
    double reference_density = 0;
    CommonParameters common;
    CommonEosParameters common_eos;
    std::unique_ptr<StrengthLaw> strength;
    std::unique_ptr<EosLaw> eos;
    std::vector<Failure> failures;
    core::RandomFailureInput random_failure;
    core::ViscosityLimiter limiter = core::ViscosityLimiter::none;
  };
  explicit Material(Laws laws);

  const std::string& name() const override { return laws_.name; }
  core::ColumnSet columns(const core::UpdateOptions& options) const override;
  double initial_sound_speed() const override { return initial_sound_speed_; }
  double initial_shear_speed() const override { return initial_shear_speed_; }
  double reference_density() const override { return laws_.reference_density; }
  bool rigid() const override { return strength_traits_.rigid; }
  bool uniaxial() const override { return strength_traits_.uniaxial; }
  double specific_heat() const override { return laws_.common.specific_heat; }
  double conductivity() const override { return laws_.common.conductivity; }
  core::FailedComponentRule failed_component_rule() const override {
    return {laws_.common.failure_damage_threshold, scatters_ && laws_.random_failure.random_damage};
  }
  void initialise(core::Batch& batch, const core::UpdateOptions& options) const override;
  void update(core::Batch& batch, const core::UpdateOptions& options) const override;
  // physics/material/tangent.cpp
  std::string tangent_fault() const override;
  void tangent(const core::Batch& batch, const core::UpdateOptions& options,
               core::StressTangent& result) const override;

  /// The same update particle by particle, for the comparison of instances.
  void update_scalars(core::Batch& batch, const core::UpdateOptions& options) const;

  const Laws& laws() const { return laws_; }

 private:
  template <class T>
  void update_as(core::Batch& batch, const core::UpdateOptions& options, Instance instance) const;
  /// An update with derivatives.
  void differentiate_update(core::Batch& batch, const core::UpdateOptions& options) const;
  StrengthRules strength_rules() const;
  PressureRules pressure_rules(const core::UpdateOptions& options) const;
  bool limits_viscosity(const core::UpdateOptions& options) const;
  void add_failures_of_damage();
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
  StrengthTraits strength_traits_;
};

/// `detonations`: where and when explosives are ignited. Throws core::InputErrors where parameters contradict
/// each other. Without a registry: the laws of the lists.
std::unique_ptr<Material> make_material(const core::MaterialInput& input,
                                        const std::vector<core::DetonationItem>& detonations,
                                        const Registry& registry);
std::unique_ptr<Material> make_material(const core::MaterialInput& input,
                                        const std::vector<core::DetonationItem>& detonations = {});

/// All materials of a scene, in its order. Throws all errors in them together.
std::vector<std::unique_ptr<core::ConstitutiveModel>> make_materials(const core::Scene& scene,
                                                                     const Registry& registry);
std::vector<std::unique_ptr<core::ConstitutiveModel>> make_materials(const core::Scene& scene);

}  // namespace mpm::physics
