#include "io/output/contact_forces.hpp"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

namespace mpm::io {

ContactForces::ContactForces(const core::Scene& scene) {
  if (!scene.contact.enable || !scene.contact.record_force) return;
  const auto components = static_cast<std::int32_t>(core::component_count(scene));
  const core::ContactPairs pairs(core::component_count(scene));
  const auto shown = [&](std::int32_t c) {  // failed particles are component 0
    return c < static_cast<std::int32_t>(scene.components.size()) ? c + 1 : 0;
  };
  impulses_.assign(3 * pairs.size(), 0.0);
  const auto add = [&](std::int32_t a, std::int32_t b) {
    const int number = pairs.number(a, b);
    if (number < 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns_.push_back(fmt::format("contact_{}[{},{}]", "xyz"[axis], shown(a), shown(b)));
      order_.push_back(3 * static_cast<std::size_t>(number) + axis);
    }
  };
  for (std::int32_t b = 2; b < components; ++b)
    for (std::int32_t a = 0; a < b; ++a) add(a, b);
  add(0, 1);
}

std::string ContactForces::legend() const {
  if (columns_.empty()) return {};
  return "# contact_x[a,b] ...: force of component a on component b, mean since the row before\n";
}

std::vector<double> ContactForces::next(const core::Model& model, core::Reductions& ranks) {
  if (columns_.empty()) return {};
  std::vector<core::ExactSum> sums = model.ledger.contact.impulses;
  sums.resize(impulses_.size());
  ranks.sum(std::span<core::ExactSum>(sums));
  const double interval = model.clock.time - time_;
  std::vector<double> forces;
  for (const std::size_t k : order_) {
    const double impulse = sums[k].value();
    forces.push_back(interval > 0 ? (impulse - impulses_[k]) / interval : 0.0);
    impulses_[k] = impulse;
  }
  time_ = model.clock.time;
  return forces;
}

std::vector<std::uint64_t> ContactForces::memory() const {
  if (columns_.empty()) return {};
  std::vector<std::uint64_t> memory{std::bit_cast<std::uint64_t>(time_)};
  for (const double impulse : impulses_) memory.push_back(std::bit_cast<std::uint64_t>(impulse));
  return memory;
}

void ContactForces::recall(std::span<const std::uint64_t> memory) {
  if (memory.empty()) return;
  time_ = std::bit_cast<double>(memory[0]);
  for (std::size_t i = 0; i < impulses_.size(); ++i) impulses_[i] = std::bit_cast<double>(memory[i + 1]);
}

}  // namespace mpm::io
