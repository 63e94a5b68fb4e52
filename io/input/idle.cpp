#include "io/input/idle.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <unordered_set>

#include <fmt/format.h>

#include "io/input/contact_notes.hpp"
#include "io/input/idle_rules.hpp"
#include "io/input/method_notes.hpp"
#include "io/input/shape_notes.hpp"
#include "io/input/text.hpp"

namespace mpm::io {

namespace {

using core::MaterialInput;
using core::Scene;

/// Whether the attribute is given with a value other than the default; the default of a required number is 0.
bool asked(const Node& node, std::string_view attribute) {
  const AttributeSpec* row = node.spec().attribute(attribute, node.type());
  const XmlAttribute* given = node.find(attribute);
  if (row == nullptr || given == nullptr) return false;
  const std::string standard = row->default_value.value_or(row->required ? "0" : "");
  const std::string_view value = canonical_word(*row, given->value);
  const auto number = parse_real(value), default_number = parse_real(standard);
  return number && default_number ? *number != *default_number : value != standard;
}

std::vector<std::string> asked(const Node& node, const IdleRule& rule) {
  std::vector<std::string> names;
  const auto add = [&](std::string_view name) {
    if (asked(node, name) && std::ranges::find(names, name) == names.end()) names.emplace_back(name);
  };
  if (rule.attributes.front() == "*") {
    for (const AttributeSpec& row : std::span(node.spec().attributes).subspan(1))
      if (std::ranges::find(rule.attributes, row.name) == rule.attributes.end()) add(row.name);
  } else {
    for (const std::string_view name : rule.attributes) add(name);
  }
  return names;
}

class Walk {
 public:
  explicit Walk(const Scene& scene)
      : scene_(scene), times_(idle_rules().size()), notes_(idle_rules().size()) {
    for (const core::ComponentInput& component : scene.components)
      for (const core::BodyInput& body : component.bodies)
        if (const auto* difference = std::get_if<core::BoolGeometry>(&body.geometry))
          operands_.insert(
              {&core::body_at(scene, difference->minuend), &core::body_at(scene, difference->subtrahend)});
  }

  void element(const Node& node, const std::string& path, const MaterialInput* material,
               const core::BodyInput* body) {
    if (path == "Material") material = &scene_.materials[materials_++];
    if (path == "Component") {
      component_ = &scene_.components[components_++];
      bodies_ = 0;
    }
    if (path == "Component/Body") body = &component_->bodies[bodies_++];
    for (std::size_t i = 0; i < idle_rules().size(); ++i)
      if (idle_rules()[i].path == path) apply(i, {scene_, node, material, body, &operands_});
    for (const ElementSpec& child : node.spec().children)
      for (const Node& n : node.children(child.name))
        element(n, path.empty() ? child.name : path + "/" + child.name, material, body);
  }

  /// One note for each rule that applies: the first place and the number of places.
  std::vector<core::Diagnostic> notes() {
    std::vector<core::Diagnostic> found;
    for (std::size_t i = 0; i < notes_.size(); ++i) {
      if (times_[i] == 0) continue;
      if (times_[i] > 1) notes_[i].message += fmt::format(" (and {} more such cases)", times_[i] - 1);
      found.push_back(std::move(notes_[i]));
    }
    return found;
  }

 private:
  void apply(std::size_t number, const SettingPlace& at) {
    const IdleRule& rule = idle_rules()[number];
    std::vector<std::string> names;
    if (!rule.attributes.empty()) {
      names = asked(at.node, rule);
      if (names.empty()) return;
    }
    if (!rule.idle(at) || times_[number]++ > 0) return;
    core::Diagnostic& note = notes_[number];
    note.file = scene_.provenance.path;
    note.line = at.node.line();
    note.element = at.node.name();
    if (names.size() == 1) {
      const XmlAttribute* given = at.node.find(names.front());
      note.line = given->line;
      note.attribute = given->name;
      note.value = given->value;
    }
    note.message = names.size() > 1 ? fmt::format("{} have no effect: {}", join(names, ", "), rule.why)
                                    : fmt::format("no effect: {}", rule.why);
  }

  const Scene& scene_;
  std::unordered_set<const core::BodyInput*> operands_;
  std::vector<int> times_;
  std::vector<core::Diagnostic> notes_;
  std::size_t materials_ = 0, components_ = 0, bodies_ = 0;
  const core::ComponentInput* component_ = nullptr;
};

}  // namespace

std::vector<core::Diagnostic> idle_settings(const Node& root, const Scene& scene) {
  Walk walk(scene);
  walk.element(root, "", nullptr, nullptr);
  std::vector<core::Diagnostic> notes = walk.notes();
  if (scene.contact.enable)
    note_contact(root, scene, notes);
  else
    note_no_contact(scene, notes);
  note_blocks(scene, notes);
  note_wide_spacings(scene, notes);
  note_single_particles(scene, notes);
  note_linear_functions(root, scene, notes);
  note_soft_drivers(scene, notes);
  note_free_axes(scene, notes);
  note_scheme(root, scene, notes);
  note_no_bodies(scene, notes);
  std::ranges::stable_sort(notes, {}, &core::Diagnostic::line);
  return notes;
}

}  // namespace mpm::io
