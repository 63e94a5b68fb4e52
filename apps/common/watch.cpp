#include "apps/common/watch.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/step/migration.hpp"
#include "core/step/witness.hpp"

namespace mpm::apps {

namespace {

core::Witness first_with_negative_energy(const core::Model& model) {
  core::Witness first;
  std::vector<double> columns;
  core::for_each_block(model, [&](int body, const core::ColumnLayout& layout, const double* block, int used) {
    for (int lane = 0; lane < used; ++lane) {
      if (!(block[layout.offset(core::Column::internal_energy) + lane] < 0)) continue;
      first.offer(block[layout.offset(core::Column::identity) + lane], [&] {
        columns.clear();
        for (int c = 0; c < layout.columns(); ++c) columns.push_back(block[core::block_lanes * c + lane]);
        return core::describe_particle(model.bodies[static_cast<std::size_t>(body)], columns.data());
      });
    }
  });
  return first;
}

}  // namespace

Watch::Watch(const core::Scene& scene, double time) : warn_(scene.solution.warn), scene_(scene) {
  const auto note = [&](const auto& points, const std::string& body, const char* load) {
    if (!points.empty() && points.back().time >= time)
      load_ends_.emplace(points.back().time, fmt::format("{} of body \"{}\"", load, body));
  };
  for (const core::ComponentInput& component : scene.components) {
    for (const core::BodyInput& body : component.bodies) {
      if (body.prescribed_acceleration)
        note(body.prescribed_acceleration->points, body.name, "PrescribedAcceleration");
      for (const core::SurfaceLoad& load : body.surface_loads) note(load.points, body.name, "Traction");
    }
  }
}

void Watch::after_step(const core::Model& model, const core::Stepper::Incidents& mine,
                       core::Exchange& exchange, io::Log& log) {
  for (; !load_ends_.empty() && load_ends_.begin()->first < model.clock.time;
       load_ends_.erase(load_ends_.begin())) {
    log.warn("time {:.6g}: the last Coefficient of {} has passed, its load is zero from now on",
             model.clock.time, load_ends_.begin()->second);
  }
  if (!warn_.negative_internal_energy && !warn_.negative_volume && !warn_.outside_grid) return;
  std::int64_t counts[3] = {warn_.negative_internal_energy ? mine.events.negative_energy : 0,
                            warn_.negative_volume ? mine.events.negative_volume : 0,
                            warn_.outside_grid ? mine.left_grid : 0};
  exchange.sum(std::span<std::int64_t>(counts));
  static constexpr const char* words[3] = {"with internal energy below zero",
                                           "whose volume would have vanished", "left the grid"};
  for (int i = 0; i < 3; ++i) {
    if (counts[i] == 0) continue;
    if (warn_.level == core::WarnInput::Level::per_particle && warned_[i]) continue;
    std::string text = fmt::format("step {}, time {:.6g}: {} particle(s) {}", model.clock.step,
                                   model.clock.time, counts[i], words[i]);
    const core::Witness first = i == 0   ? first_with_negative_energy(model)
                                : i == 2 ? mine.first_left
                                         : core::Witness{};
    if (i != 1) text += "; the first: " + core::first_of_all(exchange, first).words;
    if (warn_.level == core::WarnInput::Level::stop) throw core::NumericalFailure(text);
    warned_[i] = true;
    log.warn("{}", text);
  }
}

void Watch::after_report(const core::Model& model, const core::Totals& totals) const {
  if (!scene_.solution.energy_fraction) return;
  const double drift = core::energy_balance(totals, model.initial_energy).relative_drift;
  if (std::abs(drift) <= *scene_.solution.energy_fraction) return;
  throw core::NumericalFailure(fmt::format(
      "step {}, time {:.6g}: the total energy is off by {:.3g} of itself, more than EnergyFraction {:.3g}",
      model.clock.step, model.clock.time, drift, *scene_.solution.energy_fraction));
}

bool Watch::near_boundary(const core::Model& model, core::Exchange& exchange) const {
  if (!scene_.solution.near_boundary_stop) return false;
  const core::GridGeometry& g = model.grid->geometry();
  bool near = false;
  core::for_each_block(model, [&](int, const core::ColumnLayout& layout, const double* block, int used) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double* x = block + layout.offset(core::next(core::Column::position_x, axis));
      for (int i = 0; i < used; ++i) {
        const std::int64_t cell = g.cell_index(x[i], axis);
        near = near || (cell == 0 && g.boundary[2 * a] == core::Boundary::free) ||
               (cell == g.cells[a] - 1 && g.boundary[2 * a + 1] == core::Boundary::free);
      }
    }
  });
  return exchange.any(near);
}

}  // namespace mpm::apps
