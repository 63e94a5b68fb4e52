#include "io/output/status_file.hpp"

#include <algorithm>
#include <span>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "io/output/memory_use.hpp"
#include "io/output/provenance.hpp"

namespace mpm::io {

namespace {

constexpr int width = 24;

/// The quantities that .sta lists for a body or a material.
constexpr const char* group_columns[] = {"px", "py", "pz", "kinetic", "internal", "vx", "vy", "vz"};

/// And for a rigid body in contact: its centre of mass and angular velocity.
constexpr const char* rigid_columns[] = {"cx", "cy", "cz", "wx", "wy", "wz"};

std::vector<ReactionColumns> all_reactions(const core::Model& model) {
  std::vector<ReactionColumns> columns;
  for (std::size_t r = 0; r < model.reactions.size(); ++r) columns.push_back({r});
  return columns;
}

std::string head_of(const core::Model& model, const Reactions& reactions, const ContactForces& forces) {
  std::string head = fmt::format("#{:>{}}", "step", width - 1);
  const auto add = [&](const std::string& name) { head += fmt::format(" {:>{}}", name, width); };
  for (const char* name :
       {"time", "dt", "kinetic", "internal", "external_work", "total", "relative_drift", "px", "py", "pz"}) {
    add(name);
  }
  const auto add_groups = [&](const std::string& kind, const std::vector<std::string>& names) {
    for (const std::string& name : distinct_names(names, kind))
      for (const char* column : group_columns) add(fmt::format("{}[{}:{}]", column, kind, name));
  };
  std::vector<std::string> bodies, materials;
  for (const core::Body& b : model.bodies) bodies.push_back(b.name);
  for (const auto& m : model.materials) materials.push_back(m->name());
  add_groups("body", bodies);
  add_groups("material", materials);
  if (model.scene->contact.enable) {
    add("contact_dissipation");
    add("friction_heat");
  }
  const std::vector<std::string> body_names = distinct_names(bodies, "body");
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const char* column : rigid_columns)
      if (model.bodies[b].rigid_state) add(fmt::format("{}[rigid:{}]", column, body_names[b]));
  for (const std::string& column : forces.columns()) add(column);
  for (const std::string& column : reactions.names()) add(column);
  if (model.scene->output.statistics.memory) {
    add("memory_max");
    add("memory_sum");
  }
  if (model.scene->output.statistics.cell_occupancy) add("cell_occupancy");
  return head;
}

/// Of each material, the sum over its bodies.
std::vector<core::Quantities> material_sums(const core::Model& model, const core::Totals& totals) {
  std::vector<core::Quantities> sums(model.materials.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    core::Quantities& sum = sums[static_cast<std::size_t>(model.bodies[b].material)];
    sum.mass += totals.bodies[b].mass;
    sum.kinetic += totals.bodies[b].kinetic;
    sum.internal += totals.bodies[b].internal;
    sum.momentum = sum.momentum + totals.bodies[b].momentum;
  }
  return sums;
}

double total_cells(const core::Model& model) {
  const auto& cells = model.grid->geometry().cells;
  return static_cast<double>(cells[0]) * static_cast<double>(cells[1]) * static_cast<double>(cells[2]);
}

}  // namespace

StatusFile::StatusFile(const std::string& path, const core::Model& model,
                       const std::optional<TableContinuation>& from, core::Reductions& ranks)
    : reactions_(all_reactions(model), model),
      forces_(*model.scene),
      file_(path, to_text(provenance_of(*model.scene), "# ") + reactions_.legend() + forces_.legend(), {},
            head_of(model, reactions_, forces_), from, ranks),
      memory_(model.scene->output.statistics.memory),
      occupancy_(model.scene->output.statistics.cell_occupancy) {
  reactions_.begin(model, ranks);
  forces_.begin(model, ranks);
}

void StatusFile::add(const core::Model& model, const core::Totals& totals, core::Reductions& ranks) {
  const core::Clock& clock = model.clock;
  const core::EnergyBalance balance = core::energy_balance(totals, model.initial_energy);
  std::string row = fmt::format("{:>{}}", clock.step, width);
  const auto add = [&](double value) { row += fmt::format(" {:>{}.16e}", value, width); };
  const auto add_group = [&](const core::Quantities& q) {
    for (int a = 0; a < 3; ++a) add(q.momentum[a]);
    add(q.kinetic);
    add(q.internal);
    for (int a = 0; a < 3; ++a) add(q.mass > 0 ? q.momentum[a] / q.mass : 0);
  };
  for (const double value : {clock.time, clock.dt, totals.kinetic, totals.internal, totals.external_work,
                             balance.total, balance.relative_drift}) {
    add(value);
  }
  for (int a = 0; a < 3; ++a) add(totals.momentum[a]);
  for (const core::BodyTotals& b : totals.bodies) add_group(b);
  for (const core::Quantities& sum : material_sums(model, totals)) add_group(sum);
  if (model.scene->contact.enable) {
    add(totals.dissipated_by_contact);
    add(totals.friction_heat);
  }
  for (const core::Body& body : model.bodies) {
    if (!body.rigid_state) continue;
    for (int a = 0; a < 3; ++a) add(body.rigid_state->centre[a]);
    for (int a = 0; a < 3; ++a) add(body.rigid_state->spin[a]);
  }
  for (const double value : forces_.next(model, ranks)) add(value);
  for (const double value : reactions_.next(model, ranks)) add(value);
  if (memory_) {
    const MemoryUse use = peak_memory(ranks);
    add(static_cast<double>(use.largest));
    add(static_cast<double>(use.sum));
  }
  if (occupancy_) add(static_cast<double>(core::occupied_cells(model, ranks)) / total_cells(model));
  file_.add(clock.step, row);
  file_.flush(ranks);
  ++rows_;
}

std::string StatusFile::mark() const {
  std::string text = file_.mark().text();
  for (const IntervalMeans* means : {&reactions_.means(), &forces_.means()})
    for (const std::uint64_t word : means->memory()) text += fmt::format(" {}", word);
  return text;
}

void StatusFile::recall(const std::string& mark) {
  std::istringstream words(mark);
  if (TableMark of_table; !(words >> of_table)) return;
  std::vector<std::uint64_t> memory;
  for (std::uint64_t word = 0; words >> word;) memory.push_back(word);
  std::span<const std::uint64_t> left = memory;
  for (IntervalMeans* means : {&reactions_.means(), &forces_.means()}) {
    const std::size_t size = std::min(means->memory().size(), left.size());
    means->recall(left.first(size));
    left = left.subspan(size);
  }
}

}  // namespace mpm::io
