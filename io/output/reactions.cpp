#include "io/output/reactions.hpp"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "io/output/provenance.hpp"

namespace mpm::io {

namespace {

using core::ReactionSums;

core::Vec3<double> values_of(const ReactionSums& of, ReactionSums::Sum first) {
  return {of.sums[first].value(), of.sums[first + 1].value(), of.sums[first + 2].value()};
}

}  // namespace

Reactions::Reactions(std::vector<ReactionColumns> columns)
    : columns_(std::move(columns)), last_(1 + 6 * columns_.size()), earlier_(last_) {}

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
  if (model.clock.time > last_[0]) {
    earlier_ = last_;
    last_[0] = model.clock.time;
  }
  const double interval = last_[0] - earlier_[0];
  std::vector<double> row;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    ReactionSums all;
    std::copy_n(sums.begin() + static_cast<std::ptrdiff_t>(ReactionSums::count * i), ReactionSums::count,
                all.sums.begin());
    core::Vec3<double> mean[2];
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t at = 1 + 6 * i + k;
      last_[at] = all.sums[k].value();
      if (interval > 0) mean[k / 3][static_cast<int>(k % 3)] = (last_[at] - earlier_[at]) / interval;
    }
    const double mass = all.sums[ReactionSums::mass].value();
    if (mass > 0) mean[1] = mean[1] - cross((1 / mass) * values_of(all, ReactionSums::place), mean[0]);
    for (int a = 0; a < 3 && columns_[i].force; ++a) row.push_back(mean[0][a]);
    for (int a = 0; a < 3 && columns_[i].moment; ++a) row.push_back(mean[1][a]);
  }
  return row;
}

std::vector<std::uint64_t> Reactions::memory() const {
  if (columns_.empty()) return {};
  std::vector<std::uint64_t> memory;
  for (const std::vector<double>* row : {&last_, &earlier_})
    for (const double value : *row) memory.push_back(std::bit_cast<std::uint64_t>(value));
  return memory;
}

void Reactions::recall(std::span<const std::uint64_t> memory) {
  if (memory.empty() || memory.size() != memory_length()) return;
  auto next = memory.begin();
  for (std::vector<double>* row : {&last_, &earlier_})
    for (double& value : *row) value = std::bit_cast<double>(*next++);
}

}  // namespace mpm::io
