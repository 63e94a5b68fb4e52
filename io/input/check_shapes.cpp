// Reports errors that core finds in the shapes of bodies, with the lines of the input.

#include "core/discretise/shape_check.hpp"
#include "io/input/build.hpp"

namespace mpm::io {

namespace {

/// The elements of a body to which errors refer.
class Elements {
 public:
  explicit Elements(const Node& body) : body_(body), geometry_(body.child("Geometry")) {
    if (!geometry_) return;
    points_ = geometry_->children("Point");
    elements_ = geometry_->children("Element");
  }
  /// Null where the input has no such element, which was reported as missing.
  const Node* find(const core::ShapeFault& fault) const {
    if (fault.element == body_.name()) return &body_;
    if (fault.element == "Geometry") return geometry_ ? &*geometry_ : nullptr;
    const std::vector<Node>& children = fault.element == "Point" ? points_ : elements_;
    return fault.child < children.size() ? &children[fault.child] : nullptr;
  }

 private:
  const Node& body_;
  std::optional<Node> geometry_;
  std::vector<Node> points_, elements_;
};

/// Whether the element has a valid value of the attribute; other faults have been reported.
bool states(const Node& node, const std::string& attribute) {
  const XmlAttribute* given = node.find(attribute);
  const AttributeSpec* row = node.spec().attribute(attribute, node.type());
  return given != nullptr && row != nullptr && fault(*row, given->value).empty();
}

void report(const Node& body, std::vector<core::ShapeFault> faults, const BuildContext& context) {
  if (faults.empty()) return;
  const Elements elements(body);
  for (core::ShapeFault& fault : faults) {
    const Node* node = elements.find(fault);
    if (node == nullptr) continue;
    if (fault.attribute.empty())
      node->report(context.diagnostics, std::move(fault.message));
    else if (states(*node, fault.attribute))
      node->report(context.diagnostics, fault.attribute, std::move(fault.message));
  }
}

}  // namespace

void check_shapes(const Node& root, const core::Scene& scene, const BuildContext& context) {
  std::size_t c = 0;
  for (const Node& component : root.children("Component")) {
    std::size_t b = 0;
    for (const Node& body : component.children("Body")) {
      const core::BodyInput& input = core::body_at(scene, {c, b++});
      if (!input.type.empty()) report(body, core::shape_faults(scene, input), context);
    }
    ++c;
  }
}

}  // namespace mpm::io
