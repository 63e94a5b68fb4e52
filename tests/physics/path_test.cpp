// Laboratory paths of one particle against closed forms: what a user calibrates with has to be right itself.

#include "physics/point/path.hpp"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Sym3;
using physics::Leg;
using physics::PathEnd;
using physics::PointDriver;
namespace legs = physics::legs;

namespace {

constexpr double young = 124e9, poisson = 0.34;
constexpr double shear = young / (2 * (1 + poisson)), bulk = young / (3 * (1 - 2 * poisson));

Leg in_steps(Leg leg, int steps, double rate = 1) {
  leg.steps = steps;
  leg.rate = rate;
  leg.from_zero = true;
  return leg;
}

PathEnd walk(PointDriver& point, const std::vector<Leg>& path, Sym3<double>* strain = nullptr) {
  return physics::walk(point, path, [&](const physics::PathPoint& at) {
    if (strain) *strain = at.total_strain;
  });
}

core::MaterialInput with(core::MaterialInput input, const core::ParameterValues& values) {
  for (const auto& [name, value] : values) input.strength.values.insert_or_assign(name, value);
  return input;
}

}  // namespace

TEST_CASE("elastic constants come back from every path", "[physics][path]") {
  // Hooke's law holds exactly between Cauchy stress and logarithmic strain while the axes do not turn; what
  // is left is the tolerance of the prescribed stresses, 1e-9.
  const auto material = make(copper("IsoElastic"));
  const double e = 2e-3, p = 50e6;
  struct Row {
    const char* name;
    std::vector<Leg> path;
    Sym3<double> strain, stress;
  };
  const double nu = poisson, lateral = -p / young * (1 - 2 * nu);  // strain under pressure p
  const double sx = young * e / (1 - nu * nu);
  const std::vector<Row> rows{
      {"uniaxial stress",
       {legs::uniaxial_stress(e)},
       {e, -nu * e, -nu * e, 0, 0, 0},
       {young * e, 0, 0, 0, 0, 0}},
      {"uniaxial strain",
       {legs::uniaxial_strain(e)},
       {e, 0, 0, 0, 0, 0},
       {(bulk + 4 * shear / 3) * e, (bulk - 2 * shear / 3) * e, (bulk - 2 * shear / 3) * e, 0, 0, 0}},
      {"triaxial compression",
       {in_steps(legs::pressure(p, 1), 5), in_steps(legs::triaxial(-e, p), 5)},
       {lateral - e, lateral + nu * e, lateral + nu * e, 0, 0, 0},
       {-p - young * e, -p, -p, 0, 0, 0}},
      {"triaxial extension",
       {in_steps(legs::pressure(p, 1), 5), in_steps(legs::triaxial(e, p), 5)},
       {lateral + e, lateral - nu * e, lateral - nu * e, 0, 0, 0},
       {-p + young * e, -p, -p, 0, 0, 0}},
      {"plane strain", {legs::biaxial(e, 0)}, {e, -nu / (1 - nu) * e, 0, 0, 0, 0}, {sx, 0, nu * sx, 0, 0, 0}},
      {"equibiaxial",
       {legs::equibiaxial(e)},
       {e, e, -2 * nu / (1 - nu) * e, 0, 0, 0},
       {young * e / (1 - nu), young * e / (1 - nu), 0, 0, 0, 0}},
      {"hydrostatic",
       {legs::hydrostatic(e)},
       {e / 3, e / 3, e / 3, 0, 0, 0},
       {bulk * e, bulk * e, bulk * e, 0, 0, 0}},
      {"pressure", {legs::pressure(p, 1)}, {lateral, lateral, lateral, 0, 0, 0}, {-p, -p, -p, 0, 0, 0}},
  };
  for (const Row& row : rows) {
    INFO(row.name);
    PointDriver point(*material, {});
    Sym3<double> strain{};
    REQUIRE(walk(point, row.path, &strain).reached);
    const Sym3<double> stress = point.stress();
    for (const auto member : {&Sym3<double>::xx, &Sym3<double>::yy, &Sym3<double>::zz, &Sym3<double>::xy}) {
      CHECK(strain.*member == Approx(row.strain.*member).epsilon(1e-7).margin(1e-10));
      CHECK(stress.*member == Approx(row.stress.*member).epsilon(1e-7).margin(10));
    }
  }
}

TEST_CASE("six prescribed stresses give the strains of Hooke's law", "[physics][path]") {
  const auto material = make(copper("IsoElastic"));
  PointDriver point(*material, {});
  const Sym3<double> wanted{80e6, -30e6, 20e6, 10e6, -15e6, 25e6};
  Leg leg;
  leg.time = 1;
  leg.steps = 4;
  const core::Mat3<double> modes[] = {{1, 0, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 1, 0, 0, 0, 0},
                                      {0, 0, 0, 0, 0, 0, 0, 0, 1}, {0, 1, 0, 1, 0, 0, 0, 0, 0},
                                      {0, 0, 0, 0, 0, 1, 0, 1, 0}, {0, 0, 1, 0, 0, 0, 1, 0, 0}};
  double Sym3<double>::*const members[] = {&Sym3<double>::xx, &Sym3<double>::yy, &Sym3<double>::zz,
                                           &Sym3<double>::xy, &Sym3<double>::yz, &Sym3<double>::xz};
  for (std::size_t i = 0; i < 6; ++i) {
    Sym3<double> weight{};
    weight.*members[i] = 1;
    leg.controls.push_back({modes[i], weight, wanted.*members[i], true});
  }
  Sym3<double> strain{};
  REQUIRE(walk(point, {leg}, &strain).reached);
  const double mean = trace(wanted) / 3;
  const Sym3<double> s = deviator(wanted);
  for (const auto member : members) {
    const bool axial =
        member == &Sym3<double>::xx || member == &Sym3<double>::yy || member == &Sym3<double>::zz;
    const double expected = s.*member / (2 * shear) + (axial ? mean / (3 * bulk) : 0);
    CHECK(point.stress().*member == Approx(wanted.*member).epsilon(1e-8));
    CHECK(strain.*member == Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("radial return: the yield stress back from every path", "[physics][path]") {
  const double yield = 200e6, p = 300e6;
  const auto material = make(copper("ElaPlastic"));
  const auto stress_after = [&](const std::vector<Leg>& path) {
    PointDriver point(*material, {});
    REQUIRE(walk(point, path).reached);
    return point.stress();
  };
  CHECK(stress_after({legs::uniaxial_stress(0.02)}).xx == Approx(yield).epsilon(1e-7));
  // The difference of axial and lateral stress is the yield stress, whatever the pressure.
  CHECK(stress_after({legs::pressure(p, 1), in_steps(legs::triaxial(-0.02, p), 200)}).xx ==
        Approx(-p - yield).epsilon(1e-7));
  CHECK(stress_after({legs::pressure(p, 1), in_steps(legs::triaxial(0.02, p), 200)}).xx ==
        Approx(-p + yield).epsilon(1e-7));
  // Plane strain flows at 2/sqrt(3) of it once the elastic strains stand still; simple shear at 1/sqrt(3).
  const Sym3<double> plane = stress_after({in_steps(legs::biaxial(0.2, 0), 2000)});
  CHECK(plane.xx == Approx(2 / std::sqrt(3.0) * yield).epsilon(1e-6));
  CHECK(plane.zz == Approx(plane.xx / 2).epsilon(1e-4));
  CHECK(stress_after({legs::equibiaxial(0.02)}).yy == Approx(yield).epsilon(1e-7));
  CHECK(stress_after({in_steps(legs::simple_shear(0.02), 1000)}).xy ==
        Approx(yield / std::sqrt(3.0)).epsilon(1e-3));
  // A cycle ends where it began to flow.
  CHECK(stress_after({legs::uniaxial_stress(0.01), legs::uniaxial_stress(-0.01), legs::uniaxial_stress(0.01)})
            .xx == Approx(yield).epsilon(1e-7));
}

TEST_CASE("a bar drawn by stress follows the tangent modulus", "[physics][path]") {
  const double yield = 200e6, tangent = 3e9, target = 260e6;
  const auto material = make(copper("IsoHarden"));
  PointDriver point(*material, {});
  Leg leg = legs::uniaxial_stress(0);
  leg.strain.reset();
  leg.time = 1;
  leg.steps = 400;
  leg.controls.insert(leg.controls.begin(), {leg.direction, {1, 0, 0, 0, 0, 0}, target, true});
  Sym3<double> strain{};
  REQUIRE(walk(point, {leg}, &strain).reached);
  CHECK(point.stress().xx == Approx(target).epsilon(1e-8));
  // The step that crosses yield mixes elastic and plastic lateral strain: first order in its length.
  CHECK(strain.xx == Approx(yield / young + (target - yield) / tangent).epsilon(2e-4));
}

TEST_CASE("a stress that the material does not have ends the walk with its last good state",
          "[physics][path]") {
  const auto material = make(copper("ElaPlastic"));
  PointDriver point(*material, {});
  Leg leg = legs::uniaxial_stress(0);
  leg.strain.reset();
  leg.time = 1;
  leg.controls.insert(leg.controls.begin(), {leg.direction, {1, 0, 0, 0, 0, 0}, 250e6, true});
  const PathEnd end = walk(point, {leg, legs::hold(1)});
  CHECK(!end.reached);
  CHECK(end.leg == 0);
  CHECK(end.wanted == 250e6);
  CHECK(end.found == Approx(200e6).epsilon(1e-3));  // steps of a hundredth, halved six times
  CHECK(end.found <= 200e6 * (1 + 1e-9));
  CHECK(point.stress().xx == end.found);
  CHECK(point.time() == Approx(0.8).epsilon(1e-3));
}

TEST_CASE("Johnson-Cook flow curve at three rates, isothermal and adiabatic", "[physics][path]") {
  // Manual 3-2. Adiabatic with m = 1: d(1 - T*)/(1 - T*) = -k f(e) de, k = beta g/(rho c (melt - room)), so
  //   1 - T* = exp(-k g F(e)),  F = A e + B e^(n+1)/(n+1),  g = 1 + C ln(rate/epso)
  // 1006 steel, whose m is 1 (manual, table 6.2); moduli of steel.
  const double a = 350e6, b = 275e6, n = 0.36, c = 0.022, melt = 1811, room = 293, heat = 452, rho = 7890;
  core::MaterialInput steel = with(copper("JohnsonCook"), {{"Young", 210e9},
                                                           {"Poisson", 0.3},
                                                           {"Yield0", a},
                                                           {"B", b},
                                                           {"n", n},
                                                           {"C", c},
                                                           {"m", 1.0},
                                                           {"melt", melt},
                                                           {"roomt", room},
                                                           {"SpecHeat", heat},
                                                           {"epso", 1.0},
                                                           {"PlasticWorkCoefficient", 0.9}});
  steel.reference_density = rho;
  for (const double beta : {0.0, 0.9}) {
    const auto material = make(with(steel, {{"PlasticWorkCoefficient", beta}}));
    for (const double rate : {1.0, 1e3, 1e5}) {
      INFO("heated fraction " << beta << ", rate " << rate);
      PointDriver point(*material, {});
      double worst = 0, strain_before = 0, stress_before = 0;
      const PathEnd end = physics::walk(
          point, {in_steps(legs::uniaxial_stress(0.5), 2000, rate)}, [&](const physics::PathPoint& at) {
            const double e = point.value(Column::effective_plastic_strain), stress = point.stress().xx;
            // The plastic rate: what is left beside the elastic rate, which matters where the curve is steep.
            const double elastic =
                at.strain > 0 ? (stress - stress_before) / (at.strain - strain_before) / 210e9 : 0;
            strain_before = at.strain;
            stress_before = stress;
            if (at.strain < 0.02) return;
            const double g = 1 + c * std::log(std::max(rate * (1 - elastic), 1.0));  // no less than 1
            const double softening = std::exp(-beta * g / (rho * heat * (melt - room)) *
                                              (a * e + b * std::pow(e, n + 1) / (n + 1)));
            worst = std::max(worst, std::abs(stress / ((a + b * std::pow(e, n)) * g * softening) - 1));
          });
      REQUIRE(end.reached);
      // Isothermal the law is met step by step; adiabatic the heat is of first order in the step, and the
      // density changes by 1e-3.
      CHECK(worst < (beta == 0 ? 1e-6 : 2e-3));
      const double rise = point.value(Column::temperature) - room;
      CHECK((beta == 0 ? rise == 0 : rise > 50));
    }
  }
}

TEST_CASE("a hydrostat against the equation of state", "[physics][path]") {
  // Mie-Grueneisen (manual 3-48): p = pH (1 - gamma0 mu/(2 (1 + mu))) + gamma0 E with dE = -p dV, integrated
  // here by the trapezoidal rule on a fine grid of V. Copper: Meyers' Hugoniot of the sample.
  const auto material = make(copper("IsoElastic", true));
  const double rho = 8960, c0 = 3940, s = 1.49, gamma = 1.96;
  const auto cold = [&](double v) {
    const double mu = 1 / v - 1, d = 1 - (s - 1) * mu;
    return rho * c0 * c0 * mu * (1 + mu) / (d * d) * (1 - gamma * mu * v / 2);
  };
  double v = 1, energy = 0, p = 0;
  const double v_end = std::exp(-0.3);
  const int fine = 100000;
  for (int i = 0; i < fine; ++i) {
    const double dv = (v_end - 1) / fine, next = v + dv, a = cold(next);
    // p' = a + gamma E', E' = E - (p + p') dv/2
    const double p_next = (a + gamma * (energy - 0.5 * p * dv)) / (1 + 0.5 * gamma * dv);
    energy -= 0.5 * (p + p_next) * dv;
    p = p_next;
    v = next;
  }
  PointDriver point(*material, {.update = {.volume_update = 2}});
  REQUIRE(walk(point, {in_steps(legs::hydrostatic(-0.3), 2000)}).reached);
  CHECK(point.volume_ratio() == Approx(v_end).epsilon(1e-12));
  CHECK(point.value(Column::pressure) == Approx(p).epsilon(1e-5));
  CHECK(point.energy() == Approx(energy).epsilon(1e-5));

  // And back from the pressure to the volume.
  PointDriver other(*material, {.update = {.volume_update = 2}});
  REQUIRE(walk(other, {in_steps(legs::pressure(p, 1), 2000)}).reached);
  CHECK(other.volume_ratio() == Approx(v_end).epsilon(1e-5));
}

TEST_CASE("a table of deformation gradients: shear, and a stretch that is turned", "[physics][path]") {
  const auto material = make(copper("IsoElastic"));
  PointDriver by_leg(*material, {}), by_table(*material, {});
  Leg table;
  table.steps = 500;
  table.table = {{0, {1, 0, 0, 0, 1, 0, 0, 0, 1}}, {1, {1, 0.2, 0, 0, 1, 0, 0, 0, 1}}};
  REQUIRE(walk(by_leg, {in_steps(legs::simple_shear(0.2), 500)}).reached);
  REQUIRE(walk(by_table, {table}).reached);
  CHECK(by_table.stress().xy == Approx(by_leg.stress().xy).epsilon(1e-9));
  CHECK(by_table.time() == Approx(1).epsilon(1e-12));

  // F = R(t) U: the stretch along x ends as a stretch along y.
  Leg turned;
  turned.steps = 10;
  const double stretch = 1.001;
  turned.table = {{0, {1, 0, 0, 0, 1, 0, 0, 0, 1}}, {1, {stretch, 0, 0, 0, 1, 0, 0, 0, 1}}};
  for (int degree = 1; degree <= 90; ++degree) {
    const double t = degree * std::numbers::pi / 180, c = std::cos(t), s = std::sin(t);
    turned.table.push_back({1.0 + degree, {c * stretch, -s, 0, s * stretch, c, 0, 0, 0, 1}});
  }
  PointDriver point(*material, {});
  REQUIRE(walk(point, {turned}).reached);
  const double e = std::log(stretch);
  CHECK(point.stress().yy == Approx((bulk + 4 * shear / 3) * e).epsilon(1e-3));
  CHECK(point.stress().xx == Approx((bulk - 2 * shear / 3) * e).epsilon(1e-3));
}

TEST_CASE("every law answers to prescribed stress, or the walk says that it does not", "[physics][path]") {
  for (const Sample& s : samples()) {
    INFO(s.label);
    const auto material = make(s.input);
    PointDriver small(*material, {});
    CHECK(walk(small, {in_steps(legs::uniaxial_stress(-1e-5), 5)}).reached);
    for (const double p : {0.0, 50e6}) {
      PointDriver point(*material, {});
      const double end_strain = -s.strain;
      const PathEnd end =
          walk(point, {legs::pressure(p, 1), in_steps(legs::triaxial(end_strain, p), 200, 1e3),
                       in_steps(legs::triaxial(-end_strain, p), 200, 1e3)});
      const Sym3<double> stress = point.stress();
      const double size = std::abs(stress.xx) + std::abs(stress.yy) + p;
      CHECK(std::isfinite(size));
      const double stiffness = point.density() * point.sound_speed() * point.sound_speed();
      if (end.reached) CHECK(std::abs(stress.yy + p) <= 1e-8 * (size + stiffness * s.strain));
    }
  }
}

}  // namespace mpm::tests
