#include "core/contact/failed_component.hpp"

namespace mpm::core {

std::int32_t component_of(const Model& model, int body, const double* columns) {
  const Body& of = model.bodies[static_cast<std::size_t>(body)];
  const bool failed = has_failed_component(*model.scene) &&
                      of.model->failed_component_rule().holds_for(of.pool->layout(), columns);
  return failed ? failed_component(*model.scene) : of.component;
}

FailedComponent::FailedComponent(const Model& model) {
  if (!has_failed_component(*model.scene)) return;
  for (const Body& body : model.bodies) rules_.push_back(body.model->failed_component_rule());
  number_ = failed_component(*model.scene);
}

unsigned FailedComponent::Membership::misplaced(const ColumnLayout& layout, const double* block,
                                                int used) const {
  const unsigned failed = bits(rule->holds<Lanes<block_lanes>>(layout, block));
  const unsigned all = (1u << used) - 1;
  return (of_failed ? ~failed : failed) & all;
}

}  // namespace mpm::core
