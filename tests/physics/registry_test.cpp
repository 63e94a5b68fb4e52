// Laws from outside the lists, known to a program through its registry: they join materials with the built-in
// ones, appear in the catalogue and pass the tests that hold for every law. What cannot be a law is refused
// by name.

#include "physics/registry.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "core/scene/errors.hpp"
#include "physics/catalogue.hpp"
#include "physics/checks/law_checks.hpp"
#include "physics/material/material.hpp"
#include "physics/point/point_driver.hpp"
#include "physics/strength/elasticity.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::Parameter;
using physics::Registry;

namespace {

/// Elastic with a shear stiffness that wears off with the length of the strain path; without wear IsoElastic.
struct Wearing : physics::IsotropicElasticity {
  static constexpr std::string_view name = "Wearing";
  static constexpr std::string_view summary = "elastic, softer with the length of the strain path";
  static constexpr std::array state{Column::history_0};
  static constexpr bool linear_elasticity = false;
  double wear = 0;
  static constexpr auto parameters() {
    return physics::join(
        physics::elastic_parameters<Wearing>(),
        std::array<Parameter<Wearing>, 1>{{{&Wearing::wear,
                                            {.name = "wear",
                                             .default_value = 0,
                                             .min = 0,
                                             .meaning = "loss of stiffness per length of path"}}}});
  }
  void prepare() { derive_moduli(); }
  template <class T>
  void update(physics::StrengthPoint<T>& point) const {
    point.history_0 += sqrt(contract(point.strain, point.strain));
    point.s = point.s + T(2 * shear / (1.0 + wear * point.history_0)) * point.strain;
    point.shear_modulus = shear / (1.0 + wear * point.history_0);
  }
};

/// A bulk law with a memory: it unloads along a stiffer line from the largest compression reached.
struct Compacting {
  static constexpr std::string_view name = "Compacting";
  static constexpr std::string_view summary = "bilinear, stiffer in unloading";
  static constexpr std::array state{Column::max_compression};
  double loading = 0, unloading = 0;
  static constexpr auto parameters() {
    using P = Compacting;
    const auto modulus = [](double P::*member, std::string_view name, std::string_view meaning) {
      return Parameter<P>{member,
                          {.name = name,
                           .required = true,
                           .min = 0,
                           .min_open = true,
                           .dimension = "stress",
                           .meaning = meaning}};
    };
    return std::array{modulus(&P::loading, "Kl", "modulus of loading"),
                      modulus(&P::unloading, "Ku", "modulus of unloading, at least Kl")};
  }
  std::string fault() const { return unloading >= loading ? "" : "Ku must not be smaller than Kl"; }
  template <class T>
  physics::LinearisedPressure<T> linearise(physics::EosPoint<T>& point) const {
    point.max_compression = core::max(point.max_compression, point.compression);
    const T a = loading * point.max_compression + unloading * (point.compression - point.max_compression);
    return {a, 0.0, unloading, 0.0};
  }
};

/// Fails where the von Mises stress exceeds a limit.
struct MisesLimit {
  static constexpr std::string_view name = "MisesLimit";
  static constexpr std::string_view summary = "von Mises stress above smax";
  static constexpr std::array<Column, 0> state{};
  double smax = 0;
  static constexpr auto parameters() {
    return std::array<Parameter<MisesLimit>, 1>{{{&MisesLimit::smax,
                                                  {.name = "smax",
                                                   .required = true,
                                                   .min = 0,
                                                   .min_open = true,
                                                   .dimension = "stress",
                                                   .meaning = "stress at failure"}}}};
  }
  template <class T>
  core::MaskOf<T> fails(const physics::FailurePoint<T>& point) const {
    return mises(point.s) > point.threshold_factor * smax;
  }
};

/// Wearing with one thing in its table changed.
template <int fault>
struct Faulty : Wearing {
  static constexpr std::string_view name = fault == 5 ? "Two words" : "Faulty";
  static constexpr auto parameters() {
    core::ParameterInfo info{.name = "wear", .default_value = 0, .min = 0, .meaning = "a number"};
    if (fault == 0) info.min = -core::unbounded;
    if (fault == 1) info.meaning = "";
    if (fault == 2) info.default_value = -1;
    if (fault == 3) info.dimension = "stresss";
    if (fault == 4) info.name = "Young";
    if (fault == 6) info.max = -1;
    if (fault == 7) info.min = -core::unbounded, info.any_number = true;
    return physics::join(physics::elastic_parameters<Faulty>(),
                         std::array<Parameter<Faulty>, 1>{{{&Faulty::wear, info}}});
  }
};

template <int fault>
std::string refusal() {
  Registry registry;
  registry.add<Faulty<fault>>();
  std::string text;
  for (const std::string& line : registry.faults()) text += line + "\n";
  const auto laws = registry.catalogue().strength;
  // What is refused is left out, and nothing else is.
  CHECK(std::ranges::count(laws, Faulty<fault>::name, &core::TypeInfo::name) == (text.empty() ? 1 : 0));
  return text;
}

/// Stiffer along one pair of axes and than its wave speed; declares a column that it does not use.
struct Bad : physics::IsotropicElasticity {
  static constexpr std::string_view name = "Bad";
  static constexpr std::string_view summary = "not a law";
  static constexpr std::array state{Column::history_0};
  static constexpr auto parameters() { return physics::elastic_parameters<Bad>(); }
  void prepare() { derive_moduli(); }
  template <class T>
  void update(physics::StrengthPoint<T>& point) const {
    point.s = point.s + T(2 * shear) * point.strain;
    point.s.xy = point.s.xy + shear * point.strain.xy;
    point.shear_modulus = 0.5 * shear;
  }
};

struct SameAsBuiltIn : Wearing {
  static constexpr std::string_view name = "IsoElastic";
};
struct SameEos : Compacting {
  static constexpr std::string_view name = "PAlpha";
};
struct SameFailure : MisesLimit {
  static constexpr std::string_view name = "none";
};

Registry own_laws() { return Registry().add<Wearing>().add<Compacting>().add<MisesLimit>(); }

core::MaterialInput input_of(double wear, bool with_eos, bool fails) {
  core::MaterialInput input;
  input.name = "own";
  input.reference_density = 2000;
  input.strength = {"Wearing", {{"Young", 10e9}, {"Poisson", 0.25}, {"wear", wear}}, {}};
  if (with_eos) input.eos = core::LawInput{"Compacting", {{"Kl", 4e9}, {"Ku", 9e9}}, {}};
  if (fails) input.failures.push_back({{"MisesLimit", {{"smax", 50e6}}, {}}, false});
  return input;
}

}  // namespace

TEST_CASE("laws from outside join the catalogue, beside all others", "[physics][registry]") {
  const Registry registry = own_laws();
  CHECK(registry.faults().empty());
  CHECK(registry.added() == std::vector<std::string>{"StrengthModel Wearing", "EquationOfState Compacting",
                                                     "FailureModel MisesLimit"});
  const core::Catalogue mine = registry.catalogue(), plain = physics::catalogue();
  CHECK(mine.strength.size() == plain.strength.size() + 1);
  CHECK(mine.eos.size() == plain.eos.size() + 1);
  CHECK(mine.failure.size() == plain.failure.size() + 1);
  const auto law = std::ranges::find(mine.strength, "Wearing", &core::TypeInfo::name);
  REQUIRE(law != mine.strength.end());
  CHECK(law->parameters.size() == 3);
  CHECK(law->parameters[2].meaning == "loss of stiffness per length of path");
}

TEST_CASE("laws from outside pass the tests that hold for every law", "[physics][registry]") {
  const Registry registry = own_laws();
  for (const bool with_eos : {false, true}) {
    for (const bool fails : {false, true}) {
      const physics::LawSample sample{input_of(20, with_eos, fails), {}};
      for (const physics::LawCheck& check : physics::law_checks()) {
        // This equation's wave speed is that of unloading, also while it loads.
        if (with_eos && check.name == "wave") continue;
        for (const std::string& fault : check.failures(sample, registry))
          FAIL_CHECK("eos " << with_eos << ", failure " << fails << ", " << check.name << ": " << fault);
      }
    }
  }
}

TEST_CASE("the tests find a law that is wrong", "[physics][registry]") {
  const Registry registry = Registry().add<Bad>();
  core::MaterialInput input = input_of(0, false, false);
  input.strength = {"Bad", {{"Young", 10e9}, {"Poisson", 0.25}}, {}};
  std::vector<std::string_view> failed;
  for (const physics::LawCheck& check : physics::law_checks()) {
    if (!check.failures({input, {}}, registry).empty()) failed.push_back(check.name);
  }
  const auto found = [&](std::string_view name) { return std::ranges::count(failed, name) == 1; };
  CHECK(found("objectivity"));
  CHECK(found("wave"));
  CHECK(found("declared"));
  CHECK_FALSE(found("restart"));
  CHECK_FALSE(found("rest"));
}

TEST_CASE("a law from outside that is IsoElastic gives its bits", "[physics][registry]") {
  const Registry registry = own_laws();
  core::MaterialInput mine = input_of(0, false, false), plain = mine;
  for (const bool with_gruneisen : {false, true}) {
    if (with_gruneisen)
      mine.eos = core::LawInput{"Gruneisen", {{"C0", 2000.0}, {"S1", 1.4}, {"gamma0", 1.5}}, {}};
    plain.eos = mine.eos;
    plain.strength = {"IsoElastic", {{"Young", 10e9}, {"Poisson", 0.25}}, {}};
    const auto a = physics::make_material(mine, {}, registry), b = physics::make_material(plain);
    CHECK(a->initial_sound_speed() == b->initial_sound_speed());
    physics::PointDriver own(*a, {.cell_size = 1e-3}), built_in(*b, {.cell_size = 1e-3});
    const RandomPath path(3, 0.02, 2e-5);
    for (int i = 0; i < 200; ++i) {
      own.step(path.gradient((i + 0.5) * 1e-7), 1e-7);
      built_in.step(path.gradient((i + 0.5) * 1e-7), 1e-7);
    }
    for (const Column c : {Column::s_xx, Column::s_xy, Column::pressure, Column::internal_energy}) {
      CHECK(own.value(c) == built_in.value(c));
      CHECK(own.value(c) != 0);
    }
  }
}

TEST_CASE("what cannot be a law is refused by name", "[physics][registry]") {
  using Catch::Matchers::Contains;
  using Catch::Matchers::Equals;
  CHECK_THAT(refusal<0>(),
             Equals("StrengthModel 'Faulty', parameter 'wear': no range: add .min, .max or both, "
                    "or .any_number = true if every finite number is valid\n"));
  CHECK_THAT(refusal<1>(), Equals("StrengthModel 'Faulty', parameter 'wear': no meaning: add .meaning, one "
                                  "line for the keyword reference\n"));
  CHECK_THAT(refusal<2>(), Contains("parameter 'wear': its default lies outside of its range"));
  CHECK_THAT(refusal<3>(), Contains("parameter 'wear': dimension 'stresss': "));
  CHECK_THAT(refusal<4>(), Contains("parameter 'Young': it is declared twice"));
  CHECK_THAT(refusal<5>(), Contains("StrengthModel 'Two words': the name is not a word"));
  CHECK_THAT(refusal<6>(), Contains("no number lies in its range"));
  CHECK_THAT(refusal<7>(), Equals(""));

  const auto only = [](const Registry& registry) {
    REQUIRE(registry.faults().size() == 1);
    return registry.faults().front();
  };
  CHECK_THAT(only(Registry().add<SameAsBuiltIn>()),
             Equals("StrengthModel 'IsoElastic': a built-in law has this name: choose another"));
  CHECK_THAT(only(Registry().add<SameEos>()),
             Equals("EquationOfState 'PAlpha': a built-in law has this name: choose another"));
  CHECK_THAT(only(Registry().add<SameFailure>()),
             Equals("FailureModel 'none': the word 'none' means no failure model: choose another"));
  CHECK_THAT(only(Registry().add<Wearing>().add<Wearing>()),
             Equals("StrengthModel 'Wearing': another law of this name was added before: choose another"));
}

TEST_CASE("what a law from outside says of its numbers reaches the user", "[physics][registry]") {
  using Catch::Matchers::Contains;
  core::MaterialInput input = input_of(0, true, false);
  input.eos->values["Ku"] = 1e9;
  CHECK_THROWS_WITH(physics::make_material(input, {}, own_laws()),
                    Contains("Ku must not be smaller than Kl"));
  // A program without the law says so.
  CHECK_THROWS_WITH(physics::make_material(input), Contains("Wearing is not implemented"));
}

}  // namespace mpm::tests
