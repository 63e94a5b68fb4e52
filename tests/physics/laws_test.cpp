// What holds for every law, over the samples of tests/physics/samples.cpp: nothing here knows a law's name,
// so a law that is added is tested by the same statements.

#include <algorithm>
#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>

#include "core/simd/lanes.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

using core::Column;
using core::Mat3;
using core::Sym3;
using physics::Material;
using physics::PointDriver;

constexpr double duration = 2e-5;  // s: strain rates of some 1000/s

double norm(const Sym3<double>& a) { return std::sqrt(contract(a, a)); }

/// Largest stress of the path, as the scale of what is negligible.
template <class Visit>
double walk(PointDriver& point, const RandomPath& path, int steps, Visit visit) {
  double largest = 0;
  const double dt = path.duration() / steps;
  for (int i = 0; i < steps; ++i) {
    point.step(path.gradient((i + 0.5) * dt), dt);
    largest = std::max(largest, norm(point.stress()));
    visit();
  }
  return largest;
}
double walk(PointDriver& point, const RandomPath& path, int steps) {
  return walk(point, path, steps, [] {});
}

bool sets_pressure(const Material& material) {
  return std::visit([]<class Law>(const Law&) { return physics::SetsPressure<Law>; },
                    material.laws().strength);
}

/// Its stored energy is not that of a linear elastic deviator.
bool hyperelastic(const Material& material) {
  return std::visit(
      []<class Law>(const Law&) {
        return requires { requires Law::hyperelastic; };
      },
      material.laws().strength);
}

PointDriver::Update scalar_update(const Material& material) {
  return [&material](core::Batch& batch, const core::UpdateOptions& options) {
    material.update_as<double>(batch, options);
  };
}

}  // namespace

TEST_CASE("scalar and vector instances of every law agree to round-off", "[physics][laws]") {
  for (const Sample& s : samples()) {
    INFO(s.label);
    const auto material = make(s.input);
    const RandomPath path(1, s.strain, duration);
    PointDriver::Options options;
    options.cell_size = 1e-3;
    options.extra_columns = {Column::yield_stress};
    PointDriver vector(*material, options), scalar(*material, options, scalar_update(*material));
    const double scale = walk(vector, path, 200);
    walk(scalar, path, 200);
    // Contraction and the library's exp and log differ: a few roundings a step, of the largest stress met,
    // and of the moduli behind the differences of nearly equal volumes.
    const double stiffness = s.input.reference_density * std::pow(material->initial_sound_speed(), 2);
    CHECK(norm(vector.stress() - scalar.stress()) <= 1e-12 * scale + 1e-13 * stiffness);
    CHECK(std::abs(vector.energy() - scalar.energy()) <= 1e-12 * std::max(scale, std::abs(scalar.energy())));
    for (Column column : {Column::effective_plastic_strain, Column::temperature, Column::damage}) {
      if (vector.has(column))
        CHECK(vector.value(column) == Approx(scalar.value(column)).epsilon(1e-11).margin(1e-14));
    }
  }
}

TEST_CASE("without strain there is no stress", "[physics][laws]") {
  for (const Sample& s : samples()) {
    INFO(s.label);
    const auto material = make(s.input);
    PointDriver point(*material, {.cell_size = 1e-3});
    const double p = point.value(Column::pressure), e = point.energy();
    for (int i = 0; i < 10; ++i) point.step({}, 1e-7);
    CHECK(norm(point.deviator()) == 0);
    // 1 + mu comes from a division, so mu at rest is zero to round-off.
    const double stiffness = s.input.reference_density * std::pow(material->initial_sound_speed(), 2);
    CHECK(std::abs(point.value(Column::pressure) - p) <= 4e-16 * stiffness);
    CHECK(point.energy() == e);
    CHECK(point.events().not_finite == 0);
  }
}

TEST_CASE("every law goes on from its columns alone, to the last bit", "[physics][laws]") {
  // What a restart does: a material made anew, the particles' columns and the time.
  constexpr int steps = 100;
  for (const Sample& s : samples()) {
    INFO(s.label);
    const RandomPath path(2, s.strain, duration);
    const double dt = duration / steps;
    const auto first = make(s.input), second = make(s.input);
    PointDriver through(*first, {.cell_size = 1e-3}), after(*second, {.cell_size = 1e-3});
    for (int i = 0; i < steps; ++i) {
      if (i == steps / 2) after.restore(through.save());
      const Mat3<double> l = path.gradient((i + 0.5) * dt);
      through.step(l, dt);
      if (i >= steps / 2) after.step(l, dt);
    }
    const auto expected = through.save(), found = after.save();
    CHECK(std::memcmp(expected.block.data(), found.block.data(), expected.block.size() * sizeof(double)) ==
          0);
    CHECK(after.critical_speed() == through.critical_speed());
  }
}

TEST_CASE("every law gives the same answer in SI and in mm-g-ms", "[physics][laws]") {
  const Units& units = mm_g_ms;
  for (const Sample& s : samples()) {
    INFO(s.label);
    const auto si = make(s.input), other = make(convert(s.input, units));
    const RandomPath path(2, s.strain, duration), converted_path(2, s.strain, duration * units.time);
    PointDriver a(*si, {.cell_size = 1e-3}), b(*other, {.cell_size = 1e-3 * units.length});
    const double scale = walk(a, path, 100);
    walk(b, converted_path, 100);
    const double stiffness = s.input.reference_density * std::pow(si->initial_sound_speed(), 2);
    // Only the roundings of the conversion differ; an absolute tolerance inside a law would show at once.
    CHECK(norm(a.stress() - (1 / units.stress()) * b.stress()) <= 1e-11 * scale + 1e-13 * stiffness);
    CHECK(std::abs(a.energy() - b.energy() / units.stress()) <=
          1e-11 * std::max(scale, std::abs(a.energy())));
    CHECK(a.critical_speed() == Approx(b.critical_speed() / units.velocity()).epsilon(1e-11));
    for (Column column :
         {Column::effective_plastic_strain, Column::temperature, Column::damage, Column::failed}) {
      if (a.has(column)) CHECK(a.value(column) == Approx(b.value(column)).epsilon(1e-10).margin(1e-14));
    }
  }
}

TEST_CASE("plastic laws end each step on or below their yield surface", "[physics][laws]") {
  for (const Sample& s : samples()) {
    const auto material = make(s.input);
    // Laws that set the pressure have surfaces of both invariants, and tests of their own for the return.
    if (sets_pressure(*material)) continue;
    PointDriver::Options options;
    options.extra_columns = {Column::yield_stress};
    PointDriver point(*material, options);
    if (!point.has(Column::effective_plastic_strain)) continue;
    INFO(s.label);
    const RandomPath path(3, s.strain, duration);
    double strain = 0, worst = 0, worst_outside = 0;
    int plastic_steps = 0;
    walk(point, path, 100, [&] {
      const double yield = point.value(Column::yield_stress), equivalent = mises(point.deviator());
      const bool failed = point.has(Column::failed) && point.value(Column::failed) > 0;
      if (!failed && point.value(Column::effective_plastic_strain) > strain) {
        ++plastic_steps;
        worst = std::max(worst, std::abs(equivalent - yield) / yield);
      }
      worst_outside = std::max(worst_outside, (equivalent - yield) / yield);
      strain = point.value(Column::effective_plastic_strain);
    });
    CHECK(plastic_steps > 10);
    CHECK(worst < 1e-8);
    CHECK(worst_outside < 1e-8);
  }
}

TEST_CASE("plastic flow and viscous flow never give energy back", "[physics][laws]") {
  for (const Sample& s : samples()) {
    if (!s.solid) continue;
    INFO(s.label);
    const auto material = make(s.input);
    if (hyperelastic(*material)) continue;
    PointDriver point(*material, {});
    const RandomPath path(4, s.strain, duration);
    const int steps = 400;
    const double dt = duration / steps;
    double shear = 0;
    if (const auto young = s.input.strength.values.find("Young"); young != s.input.strength.values.end()) {
      shear = young->second / (2 * (1 + s.input.strength.at("Poisson")));
    }
    double dissipated = 0, scale = 0;
    for (int i = 0; i < steps; ++i) {
      const Mat3<double> l = path.gradient((i + 0.5) * dt);
      const Sym3<double> before = point.deviator();
      const double energy = point.energy(), p = point.value(Column::pressure),
                   v = point.value(Column::volume);
      point.step(l, dt);
      if (point.has(Column::failed) && point.value(Column::failed) > 0) break;
      // What the stress work puts in, less what the elastic deviator stores: E* of the energy equation
      // without -p dV.
      const double v0 = point.value(Column::mass) / s.input.reference_density;
      const double dv = point.value(Column::volume) - v;
      const double work = (point.energy() - energy) + 0.5 * (p + point.value(Column::pressure)) * dv / v0;
      const double mean_volume = 0.5 * (point.value(Column::volume) + v) / v0;
      const double stored =
          shear > 0 ? (contract(point.deviator(), point.deviator()) - contract(before, before)) / (4 * shear)
                    : 0;
      const double step_dissipation = work - mean_volume * stored;
      const double volume_work = std::abs((p + point.value(Column::pressure)) * dv / v0);
      scale =
          std::max({scale, std::abs(work), std::abs(energy), volume_work, std::abs(mean_volume * stored)});
      CHECK(step_dissipation >= -1e-12 * scale);
      dissipated += step_dissipation;
    }
    CHECK(dissipated >= -1e-12 * scale);
  }
}

TEST_CASE("every law converges with first order or better as the step is refined", "[physics][laws]") {
  for (const Sample& s : samples()) {
    if (!s.solid) continue;
    INFO(s.label);
    const auto material = make(s.input);
    const RandomPath path(5, s.strain, duration);
    const auto stress_after = [&](int steps) {
      PointDriver point(*material, {});
      const double scale = walk(point, path, steps);
      return std::pair{point.stress(), scale};
    };
    const auto [exact, scale] = stress_after(51200);
    double first = 0, last = 0;
    constexpr int coarse = 200, levels = 4;
    for (int level = 0; level < levels; ++level) {
      const double error = norm(stress_after(coarse << level).first - exact) / scale;
      if (level == 0) first = error;
      last = error;
    }
    const double order = std::log2(first / last) / (levels - 1);
    INFO("error " << first << " -> " << last << ", order " << order);
    // Errors of round-off size have no order; the moment of failure is only known to a step, so errors
    // scatter.
    CHECK((order > (s.input.failures.empty() ? 0.95 : 0.7) || last < 1e-9));
    CHECK(last < 5e-3);
  }
}

}  // namespace mpm::tests
