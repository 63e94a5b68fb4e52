// Questions that the rules of materials and those of the run both ask of a place in the input.
#pragma once

#include <algorithm>

#include "io/input/idle_rules.hpp"

namespace mpm::io {

inline bool contact_is_off(const SettingPlace& at) { return !at.scene.contact.enable; }
inline bool regression(const SettingPlace& at) {
  return at.scene.contact.enable && at.scene.contact.normal == core::ContactInput::Normal::regression;
}
inline bool steps_are_implicit(const SettingPlace& at) {
  return at.scene.solution.integration == core::Integration::implicit;
}

template <class Test>
bool any_body(const core::Scene& scene, Test test) {
  return std::ranges::any_of(scene.components, [&](const core::ComponentInput& component) {
    return std::ranges::any_of(component.bodies, test);
  });
}

}  // namespace mpm::io
