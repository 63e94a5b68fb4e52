// A strength model behind an interface that is called once per batch: what a material holds. StrengthOf<Law>
// instantiates the stages for one law, whatever equation of state stands beside it: what passes between the
// two lies in the rows of the batch and in plain structs, so that a law is compiled once and goes with all.
//
// No type of vectors crosses the interface: a law may be compiled with other vector instructions than the
// library that calls it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/body.hpp"
#include "physics/eos/traits.hpp"
#include "physics/material/eos_law.hpp"
#include "physics/material/start.hpp"

namespace mpm::physics {

/// What a strength model says of itself; members that a law may have and need not.
struct StrengthTraits {
  bool sets_pressure = false;  ///< `sets_pressure`: it computes the pressure with the deviator
  bool own_pressure = false;   ///< `own_pressure` or sets_pressure: no equation of state beside it
  bool rigid = false;          ///< `rigid`
  bool uniaxial = false;       ///< `uniaxial`: a bar's stress, along x
  /// Unless `linear_elasticity` is false or `hyperelastic` true: energy as of a linear deviator.
  bool linear_elasticity = true;
  bool follows_strain_rate = false;  ///< `follows_strain_rate`: strength follows the rate of the whole strain
  bool heats = false;                ///< `plastic_work_coefficient`
  bool viscous = false;              ///< `is_viscous()`
  TensionRules tension;              ///< `tension_rules()`
  std::optional<double> bulk;        ///< `bulk`, stress
  std::optional<double> failing_damage;    ///< `fails_by_damage()`, `failing_damage()`: fails from there on
  bool erodes_by_damage = false;           ///< `erodes_by_damage()`
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
  /// Hands over the places of lighting, and tells the law of the equation of state beside it, where it asks.
  /// What is wrong with them, or nothing.
  virtual std::string light(const std::vector<core::DetonationItem>& detonations) = 0;
  virtual std::string couple(const EosTraits& eos) = 0;
  /// The equation of state that the law brings with it (`own_eos()`); null where it brings none.
  virtual std::unique_ptr<EosLaw> own_eos() const = 0;

  /// Of the point's density and temperature, at the reference density.
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
    as_chosen(instance, [&]<class T>(std::type_identity<T>) { update_strength<T>(batch, law_, rules); });
  }

 private:
  Law law_;
};

/// The law behind the interface, where it is of that type; else null.
template <class Law>
const Law* law_cast(const StrengthLaw& strength) {
  const auto* const of = dynamic_cast<const StrengthOf<Law>*>(&strength);
  return of ? &of->law() : nullptr;
}

}  // namespace mpm::physics
