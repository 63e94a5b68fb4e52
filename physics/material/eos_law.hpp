// Type-erased equation of state, called once per batch, as physics/material/strength_law.hpp for strength
// models. EosOf<Eos> holds two instances of the pressure stage: the equation alone, and with the burn
// fraction of an explosive.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "physics/eos/traits.hpp"
#include "physics/material/instance.hpp"
#include "physics/material/start.hpp"

namespace mpm::physics {

class EosLaw {
 public:
  EosLaw() = default;
  EosLaw(const EosLaw&) = delete;
  EosLaw& operator=(const EosLaw&) = delete;
  virtual ~EosLaw() = default;

  /// For an explosive: sets compression_burn from its traits.
  void burn(std::optional<double> compression_burn) { burn_ = compression_burn; }

  virtual EosTraits traits() const = 0;
  /// Whether the pressure depends on the internal energy, and so on heat.
  virtual bool depends_on_energy() const = 0;
  /// rho0 c0^2 of the undeformed material, without shear; `strength`: at rest.
  virtual double modulus_at_rest(double e0, const StrengthPoint<double>& strength) const = 0;
  virtual void initialise(core::Batch& batch, const StartRules& rules) const = 0;
  virtual void update(core::Batch& batch, const PressureRules& rules, double* verdict,
                      Instance instance) const = 0;

 protected:
  std::optional<double> burn_;
};

template <class Eos>
class EosOf final : public EosLaw {
 public:
  explicit EosOf(Eos eos) : eos_(std::move(eos)) {}
  const Eos& law() const { return eos_; }

  EosTraits traits() const override {
    EosTraits t;
    t.columns = columns_of(eos_);
    if constexpr (requires { Eos::name; }) t.name = Eos::name;
    t.has_tangent = HasTangent<Eos>;
    if constexpr (requires(const Eos& eos) { eos.p_crush; }) t.crush_pressure = eos_.p_crush;
    if constexpr (requires(const Eos& eos) { eos.solid_has_sound_speed(); })
      t.solid_has_sound_speed = eos_.solid_has_sound_speed();
    return t;
  }
  bool depends_on_energy() const override {
    bool depends = false;
    for (const double mu : {-0.1, 0.0, 0.1}) {
      EosPoint<double> point{};
      point.compression = mu;
      point.relative_volume = 1 / (1 + mu);
      if constexpr (!own_pressure) depends = depends || eos_.linearise(point).b != 0;
    }
    return depends;
  }

  double modulus_at_rest(double e0, const StrengthPoint<double>& strength) const override {
    const double shear = strength.shear_modulus;
    if constexpr (own_pressure) {
      return 4.0 / 3.0 * shear + strength.bulk_modulus;
    } else {
      EosPoint<double> point{};
      point.relative_volume = 1;
      const LinearisedPressure<double> line = start(eos_, point, e0, 0.0);
      return 4.0 / 3.0 * shear + isentropic_modulus(line, 0.0, 1.0, point.pressure, point.energy);
    }
  }

  void initialise(core::Batch& batch, const StartRules& rules) const override {
    with_burn([&](const auto& eos) { initialise_eos<core::Real>(batch, eos, rules); });
  }
  void update(core::Batch& batch, const PressureRules& rules, double* verdict,
              Instance instance) const override {
    as_chosen<Eos>(instance, [&]<class T>(std::type_identity<T>) {
      if constexpr (core::derivatives_of < T >> 0)  // no tangent of an explosive
        update_pressure<T>(batch, eos_, rules, verdict);
      else
        with_burn([&](const auto& eos) { update_pressure<T>(batch, eos, rules, verdict); });
    });
  }

 private:
  static constexpr bool own_pressure = std::is_same_v<Eos, StrengthPressure>;

  template <class F>
  void with_burn(F f) const {
    if constexpr (!own_pressure) {
      if (burn_) return f(Burning<Eos>(eos_, *burn_));
    }
    f(eos_);
  }

  Eos eos_;
};

/// Downcast to a law of that type; null if it is of another type.
template <class Eos>
const Eos* law_cast(const EosLaw& eos) {
  const auto* const of = dynamic_cast<const EosOf<Eos>*>(&eos);
  return of ? &of->law() : nullptr;
}

}  // namespace mpm::physics
