#include "core/step/finite.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/step/migration.hpp"
#include "core/step/stepper.hpp"
#include "core/step/totals.hpp"

namespace mpm::core {

namespace {

std::string in_words(const Model& model, int body, const ColumnLayout& layout, const double* block,
                     int lane) {
  std::vector<double> columns;
  for (int c = 0; c < layout.columns(); ++c) columns.push_back(block[block_lanes * c + lane]);
  return describe_particle(model.bodies[static_cast<std::size_t>(body)], columns.data());
}

double squared_speed(const ColumnLayout& layout, const double* block, int lane) {
  const double* v = block + layout.offset(Column::velocity_x) + lane;
  return v[0] * v[0] + v[block_lanes] * v[block_lanes] + v[2 * block_lanes] * v[2 * block_lanes];
}

}  // namespace

Witness first_not_finite(const Model& model, int* body_of_first) {
  Witness first;
  for_each_block(model, [&](int body, const ColumnLayout& layout, const double* block, int used) {
    const double density = model.bodies[static_cast<std::size_t>(body)].model->reference_density();
    for (int lane = 0; lane < used; ++lane) {
      bool finite = true;
      for (int c = 0; c < layout.columns(); ++c)
        finite = finite && std::isfinite(block[block_lanes * c + lane]);
      const double m = block[layout.offset(Column::mass) + lane];
      finite = finite && std::isfinite(m * squared_speed(layout, block, lane)) &&
               std::isfinite(m * block[layout.offset(Column::internal_energy) + lane] / density);
      if (finite) continue;
      first.offer(block[layout.offset(Column::identity) + lane], [&] {
        if (body_of_first != nullptr) *body_of_first = body;
        std::string words = in_words(model, body, layout, block, lane) + ":";
        for (int c = 0; c < column_count; ++c) {
          const auto column = static_cast<Column>(c);
          if (layout.has(column))
            words += fmt::format(" {}={:.6g}", name_of(column), block[layout.offset(column) + lane]);
        }
        return words;
      });
    }
  });
  return first;
}

std::string fastest_in_words(const Model& model, Exchange& exchange) {
  double most = -1;
  Witness fastest;
  for_each_block(model, [&](int body, const ColumnLayout& layout, const double* block, int used) {
    for (int lane = 0; lane < used; ++lane) {
      const double speed = std::sqrt(squared_speed(layout, block, lane));
      if (!(speed >= most)) continue;
      if (speed > most) fastest = {};
      most = speed;
      fastest.offer(block[layout.offset(Column::identity) + lane], [&] {
        return in_words(model, body, layout, block, lane) + fmt::format(", at the speed {:.6g}", speed);
      });
    }
  });
  double all[1] = {-most};
  exchange.minimum(all);
  return first_of_all(exchange, most == -all[0] ? fastest : Witness{}).words;
}

void require_finite(const Model& model, std::span<const double> totals, Exchange& exchange) {
  if (std::ranges::all_of(totals, [](double value) { return std::isfinite(value); })) return;
  const std::string lost = first_of_all(exchange, first_not_finite(model)).words;
  throw NumericalFailure(fmt::format(
      "step {}, time {:.9g}: {}", model.clock.step, model.clock.time,
      lost.empty() ? "the sum of the particles' energies or momenta is beyond the range of numbers" : lost));
}

void require_finite(const Model& model, Exchange& exchange) {
  const Energies energies = compute_energies(model, exchange);
  require_finite(model, std::array{energies.kinetic, energies.internal}, exchange);
}

}  // namespace mpm::core
