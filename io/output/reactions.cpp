#include "io/output/reactions.hpp"

#include <fmt/format.h>

#include "io/output/provenance.hpp"

namespace mpm::io {

using core::ReactionSums;

namespace {

std::vector<std::string> names_of(const std::vector<ReactionColumns>& columns, const core::Model& model) {
  std::vector<std::string> names, bodies;
  for (const core::Body& body : model.bodies) bodies.push_back(body.name);
  bodies = distinct_names(bodies, "body");
  for (const ReactionColumns& c : columns) {
    const core::Reaction& reaction = model.reactions[c.reaction];
    const std::string of = fmt::format("[{}:{}]", reaction.by_contact ? "contact" : "drive",
                                       bodies[static_cast<std::size_t>(reaction.body)]);
    for (const char* name : {"fx", "fy", "fz"})
      if (c.force) names.push_back(name + of);
    for (const char* name : {"mx", "my", "mz"})
      if (c.moment) names.push_back(name + of);
  }
  return names;
}

/// Of the values of all sums.
std::vector<double> impulses_of(const std::vector<double>& sums) {
  std::vector<double> impulses;
  for (std::size_t i = 0; i < sums.size(); i += ReactionSums::count)
    for (std::size_t k = 0; k < 6; ++k) impulses.push_back(sums[i + ReactionSums::impulse + k]);
  return impulses;
}

}  // namespace

Reactions::Reactions(std::vector<ReactionColumns> columns, const core::Model& model)
    : columns_(std::move(columns)), names_(names_of(columns_, model)), means_(6 * columns_.size(), names_) {}

std::string Reactions::legend() const {
  if (columns_.empty()) return {};
  return "# fx[contact:body] ...: force and moment of contact on a rigid body, fx[drive:body] ... those that "
         "keep a body in its prescribed motion; means since the row before, moments about the centre of "
         "mass\n";
}

std::vector<double> Reactions::sums(const core::Model& model, core::Reductions& ranks) const {
  std::vector<core::ExactSum> sums;
  for (const ReactionColumns& c : columns_) {
    const ReactionSums& mine = model.reactions[c.reaction].since_start;
    sums.insert(sums.end(), mine.sums.begin(), mine.sums.end());
  }
  ranks.sum(std::span(sums));
  std::vector<double> values;
  for (const core::ExactSum& sum : sums) values.push_back(sum.value());
  return values;
}

void Reactions::begin(const core::Model& model, core::Reductions& ranks) {
  if (!columns_.empty()) means_.begin(impulse_time(model.clock), impulses_of(sums(model, ranks)));
}

std::vector<double> Reactions::next(const core::Model& model, core::Reductions& ranks) {
  if (columns_.empty()) return {};
  const std::vector<double> values = sums(model, ranks);
  const auto value = [&](std::size_t i, std::size_t sum) { return values[ReactionSums::count * i + sum]; };
  const auto vector = [](auto component) {
    return core::Vec3<double>{component(0), component(1), component(2)};
  };
  const std::vector<double> means = means_.next(impulse_time(model.clock), impulses_of(values));
  std::vector<double> row;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto force = vector([&](std::size_t a) { return means[6 * i + a]; });
    auto moment = vector([&](std::size_t a) { return means[6 * i + 3 + a]; });
    const double mass = value(i, ReactionSums::mass);
    if (mass > 0) {
      const auto centre = vector([&](std::size_t a) { return value(i, ReactionSums::place + a) / mass; });
      moment = moment - cross(centre, force);
    }
    for (int a = 0; a < 3 && columns_[i].force; ++a) row.push_back(force[a]);
    for (int a = 0; a < 3 && columns_[i].moment; ++a) row.push_back(moment[a]);
  }
  return row;
}

}  // namespace mpm::io
