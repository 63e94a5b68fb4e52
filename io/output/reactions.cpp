#include "io/output/reactions.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "io/output/provenance.hpp"

namespace mpm::io {

using core::ReactionSums;

Reactions::Reactions(std::vector<ReactionColumns> columns)
    : columns_(std::move(columns)), means_(6 * columns_.size()) {}

std::vector<std::string> Reactions::names(const core::Model& model) const {
  std::vector<std::string> names;
  for (const ReactionColumns& c : columns_) {
    const core::Reaction& reaction = model.reactions[c.reaction];
    const std::string of = fmt::format("[{}:{}]", reaction.by_contact ? "contact" : "drive",
                                       safe_name(model.bodies[static_cast<std::size_t>(reaction.body)].name));
    for (const char* name : {"fx", "fy", "fz"})
      if (c.force) names.push_back(name + of);
    for (const char* name : {"mx", "my", "mz"})
      if (c.moment) names.push_back(name + of);
  }
  return names;
}

std::string Reactions::legend() const {
  if (columns_.empty()) return {};
  return "# fx[contact:body] ...: force and moment of contact on a rigid body, fx[drive:body] ... those that "
         "keep a body in its prescribed motion; means since the row before, moments about the centre of "
         "mass\n";
}

std::vector<double> Reactions::next(const core::Model& model, core::Reductions& ranks) {
  if (columns_.empty()) return {};
  std::vector<core::ExactSum> sums;
  for (const ReactionColumns& c : columns_) {
    const ReactionSums& mine = model.reactions[c.reaction].since_start;
    sums.insert(sums.end(), mine.sums.begin(), mine.sums.end());
  }
  ranks.sum(std::span(sums));
  const auto value = [&](std::size_t i, std::size_t sum) {
    return sums[ReactionSums::count * i + sum].value();
  };
  const auto vector = [](auto component) {
    return core::Vec3<double>{component(0), component(1), component(2)};
  };
  std::vector<double> impulses;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) impulses.push_back(value(i, ReactionSums::impulse + k));
  const std::vector<double> means = means_.next(model.clock.time, impulses);
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
