#include "io/output/contact_forces.hpp"

#include <fmt/format.h>

namespace mpm::io {

ContactForces::ContactForces(const core::Scene& scene) {
  if (!scene.contact.enable || !scene.contact.record_force) return;
  const auto components = static_cast<std::int32_t>(core::component_count(scene));
  const core::ContactPairs pairs(core::component_count(scene));
  const auto shown = [&](std::int32_t c) {  // failed particles are component 0
    return c < static_cast<std::int32_t>(scene.components.size()) ? c + 1 : 0;
  };
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
  means_ = IntervalMeans(order_.size(), columns_);
}

std::string ContactForces::legend() const {
  if (columns_.empty()) return {};
  return "# contact_x[a,b] ...: force of component a on component b, mean since the row before\n";
}

std::vector<double> ContactForces::impulses(const core::Model& model, core::Reductions& ranks) const {
  std::vector<core::ExactSum> sums;
  for (const core::ContactRecord::Pair& pair : model.ledger.contact.pairs)
    sums.insert(sums.end(), pair.impulse.begin(), pair.impulse.end());
  sums.resize(order_.size());
  ranks.sum(std::span<core::ExactSum>(sums));
  std::vector<double> impulses;
  for (const std::size_t k : order_) impulses.push_back(sums[k].value());
  return impulses;
}

void ContactForces::begin(const core::Model& model, core::Reductions& ranks) {
  if (!columns_.empty()) means_.begin(impulse_time(model.clock), impulses(model, ranks));
}

std::vector<double> ContactForces::next(const core::Model& model, core::Reductions& ranks) {
  if (columns_.empty()) return {};
  return means_.next(impulse_time(model.clock), impulses(model, ranks));
}

}  // namespace mpm::io
