#include "core/step/finite.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "core/particle_range.hpp"
#include "core/step/migration.hpp"
#include "core/step/stepper.hpp"
#include "core/step/totals.hpp"

namespace mpm::core {

namespace {

std::string in_words(const Model& model, int body, const ConstParticle& p) {
  std::vector<double> columns;
  for (int c = 0; c < p.layout().columns(); ++c) columns.push_back(p.nth(c));
  return describe_particle(model.bodies[static_cast<std::size_t>(body)], columns.data());
}

double squared_speed(const ConstParticle& p) {
  const Vec3<double> v = p.vector(Column::velocity_x);
  return dot(v, v);
}

bool is_finite(const ConstParticle& p, double reference_density) {
  bool finite = true;
  for (int c = 0; c < p.layout().columns(); ++c) finite = finite && std::isfinite(p.nth(c));
  const double m = p[Column::mass];
  return finite && std::isfinite(m * squared_speed(p)) &&
         std::isfinite(m * p[Column::internal_energy] / reference_density);
}

/// The particle with the highest value of `measure`, over all ranks; of equal ones the first.
template <class F>
std::string highest_in_words(const Model& model, Reductions& ranks, std::string_view name, F measure) {
  double most = -std::numeric_limits<double>::infinity();
  OffendingParticle highest;
  for (const ConstParticleBlock& block : blocks_of(model)) {
    const Body& body = model.bodies[static_cast<std::size_t>(block.body)];
    for (const ConstParticle p : block) {
      const double value = measure(p, body);
      if (!(value >= most)) continue;
      if (value > most) highest = {};
      most = value;
      highest.offer(p[Column::identity], [&] {
        return in_words(model, block.body, p) + fmt::format(", with {} {:.6g}", name, value);
      });
    }
  }
  return first_of_all(ranks, most == ranks.largest(most) ? highest : OffendingParticle{}).words;
}

}  // namespace

OffendingParticle first_not_finite(const Model& model, int* body_of_first) {
  OffendingParticle first;
  for (const ConstParticleBlock& block : blocks_of(model)) {
    const double density = model.bodies[static_cast<std::size_t>(block.body)].model->reference_density();
    for (const ConstParticle p : block) {
      if (is_finite(p, density)) continue;
      first.offer(p[Column::identity], [&] {
        if (body_of_first != nullptr) *body_of_first = block.body;
        std::string words = in_words(model, block.body, p) + ":";
        for (int c = 0; c < column_count; ++c) {
          const auto column = static_cast<Column>(c);
          if (p.layout().has(column)) words += fmt::format(" {}={:.6g}", name_of(column), p[column]);
        }
        return words;
      });
    }
  }
  return first;
}

std::string fastest_in_words(const Model& model, Reductions& ranks) {
  return highest_in_words(model, ranks, "speed",
                          [](const ConstParticle& p, const Body&) { return std::sqrt(squared_speed(p)); });
}

std::string hottest_in_words(const Model& model, Reductions& ranks) {
  return highest_in_words(model, ranks, "specific internal energy",
                          [](const ConstParticle& p, const Body& body) {
                            return p[Column::internal_energy] / body.model->reference_density();
                          });
}

void require_finite(const Model& model, std::span<const double> totals, Reductions& ranks) {
  if (std::ranges::all_of(totals, [](double value) { return std::isfinite(value); })) return;
  const std::string lost = first_of_all(ranks, first_not_finite(model)).words;
  throw NumericalFailure(
      fmt::format("step {}, time {:.9g}: {}", model.clock.step, model.clock.time,
                  lost.empty() ? "the sum of the particles' energies or momenta overflows" : lost));
}

void require_finite(const Model& model, Reductions& ranks) {
  const Energies energies = compute_energies(model, ranks);
  require_finite(model, std::array{energies.kinetic, energies.internal}, ranks);
}

}  // namespace mpm::core
