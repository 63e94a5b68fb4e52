// The tangents of materials: which have one, Hooke's law at rest, and what is left of the stress beyond it.
// That a tangent is the derivative of its law in general is a check of every law
// (physics/checks/tangent.cpp).

#include <cmath>
#include <set>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "core/scene/solution.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Mat3;
using core::Sym3;
using physics::PointDriver;

namespace {

const core::UpdateOptions implicit_steps{.volume_update = static_cast<int>(core::VolumeUpdate::mid_point),
                                         .artificial_viscosity = false};
constexpr double dt = 1e-6;

std::array<double, 6> components(const Sym3<double>& a) { return {a.xx, a.yy, a.zz, a.xy, a.yz, a.xz}; }

Mat3<double> matrix(const std::array<double, 9>& a) {
  return {a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]};
}

std::string fault_of(const core::MaterialInput& input) { return make(input)->tangent_fault(); }

core::MaterialInput copper_with(const std::string& law, const core::ParameterValues& more) {
  core::MaterialInput input = copper(law);
  for (const auto& [name, value] : more) input.strength.values[name] = value;
  return input;
}

}  // namespace

TEST_CASE("which laws have a tangent", "[physics][tangent]") {
  std::set<std::string> strength, eos;
  for (const Sample& s : samples()) {
    if (!fault_of(s.input).empty()) continue;
    strength.insert(s.input.strength.type);
    if (s.input.eos) eos.insert(s.input.eos->type);
  }
  CHECK(strength == std::set<std::string>{"IsoElastic", "CauchyElastic", "ElaPlastic", "IsoHarden", "Voce",
                                          "SimJohnsonCook", "JohnsonCook", "DruckerPrager", "DFFoam",
                                          "MooneyRivlin", "NeoHookean", "Corotated"});
  CHECK(eos == std::set<std::string>{"Gruneisen", "Polynomial", "Polynomial2"});
}

TEST_CASE("a material without a tangent says why", "[physics][tangent]") {
  CHECK(fault_of(copper("IsoHarden", true)).empty());
  CHECK(fault_of(sample("Null + Gruneisen").input) ==
        "has the StrengthModel Null, for which there is no tangent");
  CHECK(fault_of(sample("Rigid").input) == "has the StrengthModel Rigid, for which there is no tangent");
  CHECK(fault_of(sample("Elastic_1D").input) ==
        "has the StrengthModel Elastic_1D, for which there is no tangent");
  CHECK(fault_of(sample("JohnsonCook damaged").input) ==
        "has a FailureModel, or damage that makes it fail, for which there is no tangent");
  core::MaterialInput failing = copper("IsoHarden");
  failing.failures.push_back({{"PlaStrain", {{"epmax", 0.01}}, {}}, false});
  CHECK(fault_of(failing) ==
        "has a FailureModel, or damage that makes it fail, for which there is no tangent");
  core::MaterialInput jwl = copper("IsoHarden");
  jwl.eos = core::LawInput{
      "JWL", {{"A", 371e9}, {"B", 3.2e9}, {"R1", 4.2}, {"R2", 0.95}, {"w", 0.3}, {"E0", 7e9}}, {}};
  CHECK(fault_of(jwl) == "has the EquationOfState JWL, for which there is no tangent");
  CHECK(fault_of(copper_with("IsoHarden", {{"SpecHeat", 383}, {"CoefficientOfThermalConductivity", 400}})) ==
        "has heat conduction, for which there is no tangent");
  CHECK(fault_of(copper_with("IsoHarden", {{"SpecHeat", 383}, {"TemperatureCoefficient", 17e-6}})) ==
        "has thermal expansion, for which there is no tangent");
  const auto fluid = make(sample("Null + Gruneisen").input);
  PointDriver point(*fluid, {});
  CHECK_THROWS_AS(point.tangent({}, dt), std::logic_error);
}

TEST_CASE("the tangent at rest is Hooke's law", "[physics][tangent]") {
  for (const Sample& s : samples()) {
    const auto material = make(s.input);
    if (!material->tangent_fault().empty()) continue;
    INFO(s.label);
    PointDriver point(*material, {.update = implicit_steps});
    if (std::abs(point.value(Column::pressure)) > 0) continue;  // a gas, or one placed with energy
    const double rho = s.input.reference_density, shear = rho * std::pow(material->initial_shear_speed(), 2);
    const double bulk = rho * std::pow(material->initial_sound_speed(), 2) - 4.0 / 3 * shear;
    const PointDriver::Tangent tangent = point.tangent({}, dt);
    double worst = 0;
    for (std::size_t k = 0; k < 9; ++k) {
      std::array<double, 9> unit{};
      unit[k] = 1;
      const Mat3<double> h = matrix(unit);
      const double pressure = (bulk - 2.0 / 3 * shear) * (h.xx + h.yy + h.zz);
      const std::array<double, 6> hooke{pressure + 2 * shear * h.xx, pressure + 2 * shear * h.yy,
                                        pressure + 2 * shear * h.zz, shear * (h.xy + h.yx),
                                        shear * (h.yz + h.zy),       shear * (h.xz + h.zx)};
      for (std::size_t i = 0; i < 6; ++i) worst = std::max(worst, std::abs(tangent[i][k] - hooke[i]));
    }
    CHECK(worst <= 1e-13 * bulk + 1e-13 * shear);
  }
}

TEST_CASE("beyond the tangent the stress is of second order", "[physics][tangent]") {
  const std::array<double, 9> h{-0.012, 0.02, -0.005, 0.004, 0.017, 0.011, -0.007, 0.009, 0.003};
  const std::array<double, 9> change{0.6, -0.2, 0.3, 0.5, -0.4, 0.1, 0.2, 0.7, -0.3};
  for (const Sample& s : samples()) {
    const auto material = make(s.input);
    if (!material->tangent_fault().empty()) continue;
    INFO(s.label);
    PointDriver point(*material, {.update = implicit_steps});
    const Mat3<double> l = (1 / dt) * matrix(h);
    point.step((0.5 / dt) * matrix(change), 0.01 * dt);  // somewhere, under stress
    const PointDriver::State state = point.save();
    const auto stress = [&](double size) {
      std::array<double, 9> g = h;
      for (std::size_t k = 0; k < 9; ++k) g[k] += size * change[k];
      point.restore(state);
      point.step((1 / dt) * matrix(g), dt);
      return components(point.stress());
    };
    const PointDriver::Tangent tangent = point.tangent(l, dt);
    const std::array<double, 6> at = stress(0);
    const auto rest = [&](double size) {
      const std::array<double, 6> now = stress(size);
      double square = 0;
      for (std::size_t i = 0; i < 6; ++i) {
        double linear = at[i];
        for (std::size_t k = 0; k < 9; ++k) linear += tangent[i][k] * size * change[k];
        square += std::pow(now[i] - linear, 2);
      }
      return std::sqrt(square);
    };
    const double rough = rest(1e-4), fine = rest(1e-5);
    CHECK(rough > 0);
    CHECK(std::log10(rough / fine) > 1.9);
    CHECK(std::log10(rough / fine) < 2.1);
  }
}

TEST_CASE("without artificial viscosity compression adds neither stress nor wave speed",
          "[physics][tangent]") {
  const auto material = make(copper("IsoHarden", true));
  PointDriver with(*material, {.cell_size = 1e-3}),
      without(*material, {.cell_size = 1e-3, .update = {.artificial_viscosity = false}});
  for (PointDriver* point : {&with, &without}) point->step({-1e4, 0, 0, 0, 0, 0, 0, 0, 0}, dt);
  CHECK(with.value(Column::viscous_pressure) > 0);
  CHECK(with.critical_speed() > with.sound_speed());
  CHECK(without.value(Column::viscous_pressure) == 0);
  CHECK(without.critical_speed() == without.sound_speed());
}

}  // namespace mpm::tests
