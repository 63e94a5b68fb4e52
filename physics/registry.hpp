// The laws available to a program: those of the lists, and a user's own. A program passes its registry to
// mpm::run (apps/mpm.hpp); input checking, the keyword reference, mpm_point and the generic tests use its
// laws.
//
//   mpm::Registry registry;
//   registry.add<MyLaw>();
//
// A law is a struct as in physics/strength/iso_harden.hpp, physics/eos/jwl.hpp or
// physics/failure/plastic_strain.hpp; its function update, linearise or fails determines its family. add()
// compiles it once, with the flags of this project, for use with every law of the other families. It rejects,
// by name: a name already in use, a parameter without range or meaning, and headers of another build than the
// library. Tested by tests/physics/registry_test.cpp and tests/hygiene/consumer.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/scene/catalogue.hpp"
#include "core/scene/material.hpp"
#include "physics/laws.hpp"
#include "physics/material/eos_law.hpp"
#include "physics/material/failure_law.hpp"
#include "physics/material/strength_law.hpp"

namespace mpm::physics {

/// A law of a family: its table, and its factory. `chosen` selects among laws of one name.
template <class Interface>
struct LawEntry {
  core::TypeInfo info;
  bool (*chosen)(const core::LawInput&) = nullptr;  ///< null: selected by the name alone
  std::unique_ptr<Interface> (*make)(const core::LawInput&, double reference_density) = nullptr;
};
using StrengthLawEntry = LawEntry<StrengthLaw>;
using EosLawEntry = LawEntry<EosLaw>;
using FailureLawEntry = LawEntry<FailureLaw>;

/// The elements of the input, for messages.
inline constexpr std::string_view strength_element = "StrengthModel", eos_element = "EquationOfState",
                                  failure_element = "FailureModel";

template <class Law>
concept IsStrength = requires(const Law& law, StrengthPoint<double>& point) {
  law.update(point);
};
template <class Law>
concept IsEos = requires(const Law& law, EosPoint<double>& point) {
  law.linearise(point);
};
template <class Law>
concept IsFailure = requires(const Law& law, const FailurePoint<double>& point) {
  law.fails(point);
};

template <class Law>
struct FamilyOf;
template <IsStrength Law>
struct FamilyOf<Law> {
  using Interface = StrengthLaw;
  using Holder = StrengthOf<Law>;
  static constexpr std::string_view element = strength_element;
};
template <IsEos Law>
struct FamilyOf<Law> {
  using Interface = EosLaw;
  using Holder = EosOf<Law>;
  static constexpr std::string_view element = eos_element;
};
template <IsFailure Law>
struct FamilyOf<Law> {
  using Interface = FailureLaw;
  using Holder = FailureOf<Law>;
  static constexpr std::string_view element = failure_element;
};

template <class Law>
auto entry_of() {
  using Family = FamilyOf<Law>;
  LawEntry<typename Family::Interface> entry;
  entry.info = {Law::name, Law::summary, parameter_infos<Law>()};
  if constexpr (requires(const core::LawInput& input) { Law::chosen_by(input); })
    entry.chosen = [](const core::LawInput& input) { return Law::chosen_by(input); };
  entry.make = [](const core::LawInput& input,
                  double density) -> std::unique_ptr<typename Family::Interface> {
    return std::make_unique<typename Family::Holder>(read_law<Law>(input, Family::element, density));
  };
  return entry;
}

/// Properties in which headers and library must agree.
struct BuildTraits {
  int lanes = 0, columns = 0;
  std::size_t batch = 0, strength_point = 0, parameter_info = 0;
  bool assertions = false;
  friend bool operator==(const BuildTraits&, const BuildTraits&) = default;

  /// Those of the calling file.
  static constexpr BuildTraits here() {
    BuildTraits t{MPM_SIMD_LANES, core::column_count, sizeof(core::Batch), sizeof(StrengthPoint<double>),
                  sizeof(core::ParameterInfo)};
#ifdef MPM_ASSERTIONS
    t.assertions = true;
#endif
    return t;
  }
};

class Registry {
 public:
  Registry();  ///< the laws of the lists

  /// Adds an external law. Its errors are appended to faults(), and the law is omitted.
  template <class Law>
  Registry& add() {
    static_assert(
        IsStrength<Law> || IsEos<Law> || IsFailure<Law>,
        "a law has template <class T> functions: a strength model `void update(StrengthPoint<T>&) "
        "const`, an equation of state `LinearisedPressure<T> linearise(EosPoint<T>&) const`, a failure model "
        "`core::MaskOf<T> fails(const FailurePoint<T>&) const`");
    static_assert(
        requires { std::string_view(Law::name), std::string_view(Law::summary); },
        "a law defines its name in the input and one line for the keyword reference: static constexpr "
        "std::string_view name, summary");
    static_assert(
        requires { Law::state.size(); },
        "a law lists the columns of its state: static constexpr std::array state{...}, or "
        "std::array<core::Column, 0> state{}");
    static_assert(
        requires { Law::parameters().size(); },
        "a law defines its parameters: static constexpr auto parameters(), a std::array of "
        "physics::Parameter");
    take(entry_of<Law>(), BuildTraits::here());
    return *this;
  }
  /// Errors in the added laws, one sentence each; the programs do not start if there are any.
  const std::vector<std::string>& faults() const { return faults_; }
  /// The external laws: "StrengthModel Wearing".
  const std::vector<std::string>& added() const { return added_; }

  /// The parameter tables of all laws, for the input reader and the keyword reference.
  core::Catalogue catalogue() const;

  /// Creates the law that the input names. All throw core::InputErrors.
  std::unique_ptr<StrengthLaw> make_strength(const core::LawInput& input, double reference_density) const;
  std::unique_ptr<EosLaw> make_eos(const core::LawInput& input, double reference_density) const;
  std::unique_ptr<FailureLaw> make_failure(const core::LawInput& input, double reference_density) const;

 private:
  void take(StrengthLawEntry entry, const BuildTraits& build);
  void take(EosLawEntry entry, const BuildTraits& build);
  void take(FailureLawEntry entry, const BuildTraits& build);

  std::vector<StrengthLawEntry> strength_;
  std::vector<EosLawEntry> eos_;
  std::vector<FailureLawEntry> failure_;
  std::vector<std::string> faults_, added_;
};

/// The laws of the lists alone.
const Registry& built_in_laws();

// The lists, compiled (physics/material/built_in_*.cpp).
std::vector<StrengthLawEntry> built_in_strength();
std::vector<EosLawEntry> built_in_eos();
std::vector<FailureLawEntry> built_in_failure();

}  // namespace mpm::physics
