// Which settings of the input have no effect, where, and why.
#pragma once

#include <string_view>
#include <unordered_set>
#include <vector>

#include "core/scene/scene.hpp"
#include "io/input/node.hpp"

namespace mpm::io {

/// Position in the traversal of the input: the element, and its material or body.
struct SettingPlace {
  const core::Scene& scene;
  const Node& node;
  const core::MaterialInput* material = nullptr;
  const core::BodyInput* body = nullptr;
  /// Operands of the Bool bodies.
  const std::unordered_set<const core::BodyInput*>* operands = nullptr;

  const core::LawInput& strength() const { return material->strength; }
  double eos(std::string_view name) const { return material->eos ? material->eos->value_or(name, 0) : 0; }
};

/// A setting that may have no effect.
struct IdleRule {
  std::string_view path;  ///< of the element
  /// Attributes checked where they are given with a value other than the default; none: the element itself;
  /// "*": all attributes of the element except the first, its switch, and those named after it.
  std::vector<std::string_view> attributes;
  bool (*idle)(const SettingPlace&);
  std::string_view why;
};

const std::vector<IdleRule>& idle_rules();
/// Those of them below Material.
std::vector<IdleRule> idle_rules_of_materials();

/// Whether particles of this strength model have an effective plastic strain; true for a user's model.
bool has_plastic_strain(std::string_view strength_type);
/// Whether the law itself has damage, with these parameters.
bool has_damage(const core::LawInput& law);
/// Whether particles of the material can fail.
bool can_fail(const core::MaterialInput& material);

}  // namespace mpm::io
