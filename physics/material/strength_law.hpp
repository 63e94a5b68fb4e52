// Type-erased strength model, called once per batch; a material holds one. StrengthOf<Law> instantiates the
// stages for one law, independently of the equation of state: they communicate through rows of the batch and
// plain structs, so that a law is compiled once and works with all.
//
// No vector type crosses the interface: a law may be compiled for other vector instructions than the library
// that calls it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/body.hpp"
#include "physics/eos/traits.hpp"
#include "physics/material/eos_law.hpp"
#include "physics/material/start.hpp"

namespace mpm::physics {

/// Properties of a strength model; all of these members are optional in a law.
struct StrengthTraits {
  std::string_view name;       ///< in the input
  bool has_tangent = false;    ///< `has_tangent` (physics/material/instance.hpp)
  bool sets_pressure = false;  ///< `sets_pressure`: it computes the pressure with the deviator
  bool own_pressure = false;   ///< `own_pressure` or sets_pressure: no equation of state beside it
  bool rigid = false;          ///< `rigid`
  bool uniaxial = false;       ///< `uniaxial`: a bar's stress, along x
  /// Unless `linear_elasticity` is false or `hyperelastic` true: energy of a linear elastic deviator.
  bool linear_elasticity = true;
  bool follows_strain_rate = false;      ///< `follows_strain_rate`: strength depends on the total strain rate
  bool heats = false;                    ///< `plastic_work_coefficient`
  bool viscous = false;                  ///< `is_viscous()`
  TensionRules tension;                  ///< `tension_rules()`
  std::optional<double> bulk;            ///< `bulk`, stress
  std::optional<double> failing_damage;  ///< `fails_by_damage()`, `failing_damage()`: damage at failure
  bool erodes_by_damage = false;         ///< `erodes_by_damage()`
  double largest_volume = 0;             ///< `largest_volume`, over m/rho0; 0: no bound (kinematics.hpp)
  std::optional<double> compression_burn;  ///< `compression_burn` (physics/eos/burning.hpp): an explosive
};

class StrengthLaw {
 public:
  StrengthLaw() = default;
  StrengthLaw(const StrengthLaw&) = delete;
  StrengthLaw& operator=(const StrengthLaw&) = delete;
  virtual ~StrengthLaw() = default;

  virtual StrengthTraits traits() const = 0;
  virtual core::ColumnSet columns() const = 0;
  /// Passes the points of ignition to the law, and the traits of the equation of state, where it needs them.
  /// Returns the errors, or an empty text.
  virtual std::string light(const std::vector<core::DetonationItem>& detonations) = 0;
  virtual std::string couple(const EosTraits& eos) = 0;
  /// The equation of state that the law provides (`own_eos()`); null if it provides none.
  virtual std::unique_ptr<EosLaw> own_eos() const = 0;

  /// At the point's density and temperature, from the reference density.
  virtual StrengthPoint<double> at_rest(const StrengthPoint<double>& point) const = 0;
  virtual void initialise(core::Batch& batch, const StartRules& rules) const = 0;
  virtual void update(core::Batch& batch, const StrengthRules& rules, Instance instance) const = 0;
};

template <class Law>
class StrengthOf final : public StrengthLaw {
 public:
  explicit StrengthOf(Law law) : law_(std::move(law)) {}
  const Law& law() const { return law_; }

  StrengthTraits traits() const override {
    StrengthTraits t;
    t.name = Law::name;
    t.has_tangent = HasTangent<Law>;
    static_assert(
        !SetsPressure<Law> || requires(const Law& law) { law.bulk; },
        "a law that sets the pressure states `bulk`, the bulk modulus at rest");
    t.sets_pressure = SetsPressure<Law>;
    t.own_pressure = SetsPressure<Law> || requires { requires Law::own_pressure; };
    t.rigid = requires { requires Law::rigid; };
    t.uniaxial = requires { requires Law::uniaxial; };
    t.linear_elasticity = !requires { requires Law::hyperelastic; }
    &&!requires { requires !Law::linear_elasticity; };
    t.follows_strain_rate = requires { requires Law::follows_strain_rate; };
    t.heats = requires(const Law& law) { law.plastic_work_coefficient; };
    if constexpr (requires { Law::largest_volume; }) t.largest_volume = Law::largest_volume;
    if constexpr (requires(const Law& law) { law.is_viscous(); }) t.viscous = law_.is_viscous();
    if constexpr (requires(const Law& law) { law.bulk; }) t.bulk = law_.bulk;
    if constexpr (requires(const Law& law) { law.tension_rules(); }) t.tension = law_.tension_rules();
    if constexpr (requires(const Law& law) { law.fails_by_damage(); }) {
      if (law_.fails_by_damage()) t.failing_damage = 1;
    }
    if constexpr (requires(const Law& law) { law.failing_damage(); }) {
      if (t.failing_damage) t.failing_damage = law_.failing_damage();
    }
    if constexpr (requires(const Law& law) { law.erodes_by_damage(); })
      t.erodes_by_damage = law_.erodes_by_damage();
    if constexpr (Burns<Law>) t.compression_burn = law_.compression_burn;
    return t;
  }
  core::ColumnSet columns() const override { return columns_of(law_); }
  std::string light(const std::vector<core::DetonationItem>& detonations) override {
    if constexpr (requires(Law & law) { law.light(detonations); }) return law_.light(detonations);
    return {};
  }
  std::string couple(const EosTraits& eos) override {
    if constexpr (requires(Law & law) { law.couple(eos); }) return law_.couple(eos);
    return {};
  }
  std::unique_ptr<EosLaw> own_eos() const override {
    if constexpr (requires(const Law& law) { law.own_eos(); })
      return std::make_unique<EosOf<decltype(law_.own_eos())>>(law_.own_eos());
    return nullptr;
  }

  StrengthPoint<double> at_rest(const StrengthPoint<double>& point) const override {
    StrengthPoint<double> placed = point;
    if constexpr (SetsPressure<Law>) law_.place(placed, 1.0);
    return rest(law_, placed);
  }
  void initialise(core::Batch& batch, const StartRules& rules) const override {
    initialise_strength<core::Real>(batch, law_, rules);
  }
  void update(core::Batch& batch, const StrengthRules& rules, Instance instance) const override {
    as_chosen<Law>(instance, [&]<class T>(std::type_identity<T>) { update_strength<T>(batch, law_, rules); });
  }

 private:
  Law law_;
};

/// Downcast to a law of that type; null if it is of another type.
template <class Law>
const Law* law_cast(const StrengthLaw& strength) {
  const auto* const of = dynamic_cast<const StrengthOf<Law>*>(&strength);
  return of ? &of->law() : nullptr;
}

}  // namespace mpm::physics
