#include "io/input/checker.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "io/input/node.hpp"
#include "io/input/text.hpp"

namespace mpm::io {

namespace {

/// The names of the elements that may contain `name`.
void find_parents(const ElementSpec& spec, std::string_view name, std::vector<std::string>& parents) {
  if (spec.child(name)) parents.push_back(fmt::format("<{}>", spec.name));
  for (const ElementSpec& child : spec.children) find_parents(child, name, parents);
}

class Checker {
 public:
  Checker(const Document& document, const ElementSpec& language, bool accept_later, Diagnostics& diagnostics)
      : document_(document), language_(language), accept_later_(accept_later), diagnostics_(diagnostics) {}

  void run() {
    const XmlElement& root = document_.elements().front();
    if (root.name != language_.name) {
      diagnostics_.add(root.line, root.name,
                       fmt::format("the root of an input file is <{}>", language_.name));
      return;
    }
    element(Node(document_, 0, language_, {}));
    for (const Document::StrayText& text : document_.stray_texts())
      diagnostics_.add(text.line, document_.elements()[text.element].name,
                       fmt::format("text is not allowed here: '{}'", text.text));
  }

 private:
  void element(const Node& node) {
    if (node.spec().later && !accept_later_)
      node.report(diagnostics_, "known, but not implemented yet; remove the element");
    misspelt_.clear();
    for (const XmlAttribute& a : document_.attributes(node.element())) attribute(node, a);
    missing_attributes(node);
    together(node);
    children(node);
  }

  void attribute(const Node& node, const XmlAttribute& given) {
    const auto report = [&](std::string message) {
      diagnostics_.add(given.line, node.name(), given.name, given.value, std::move(message));
    };
    const AttributeSpec* row = node.spec().attribute(given.name, node.type());
    if (!row) {
      for (const AttributeSpec& other : node.spec().attributes) {
        if (!other.also.empty() && other.also == given.name) row = &other;
        if (!other.instead_of.empty() && other.instead_of == given.name) {
          misspelt_.push_back(other.name);
          return report(fmt::format("the right spelling is '{}'", other.name));
        }
      }
      if (!row && hangs_on_wrong_type(node, given.name)) return;
      if (!row) return report(unknown_attribute(node, given.name));
      if (node.find(row->name) != &given)
        return report(fmt::format("the same attribute as '{}', which is also given", row->name));
    }
    if (std::string wrong = fault(*row, given.value); !wrong.empty())
      report(std::move(wrong));
    else if (!accept_later_)
      later(node, *row, given);
  }

  /// The type itself is wrong or missing, which has already been reported.
  static bool hangs_on_wrong_type(const Node& node, std::string_view name) {
    return node.type().empty() && std::ranges::any_of(node.spec().attributes,
                                                      [&](const AttributeSpec& a) { return a.name == name; });
  }

  std::string unknown_attribute(const Node& node, std::string_view name) {
    std::vector<std::string> types;
    std::vector<std::string_view> names;
    for (const AttributeSpec& a : node.spec().attributes) {
      if (a.name == name) types.insert(types.end(), a.for_types.begin(), a.for_types.end());
      if (a.applies_to(node.type())) names.push_back(a.name);
    }
    if (!types.empty())
      return fmt::format("not available with type {}, only with {}", node.type(), join(types, ", "));
    if (names.empty()) return "no such attribute; the element has no attributes";
    std::vector<std::string> list(names.begin(), names.end());
    constexpr std::size_t short_list = 12;
    std::string message = "no such attribute";
    if (list.size() <= short_list) message += fmt::format("; expected {}", join(list, ", "));
    misspelt_.emplace_back(nearest(name, names));
    return message + did_you_mean(name, names);
  }

  void later(const Node& node, const AttributeSpec& row, const XmlAttribute& given) {
    const std::string_view value = canonical_word(row, given.value);
    const auto listed = [&](std::string_view v) {
      return std::ranges::find(row.later_values, v) != row.later_values.end();
    };
    const std::vector<std::string_view> values = row.multiple ? split(value, '|') : std::vector{value};
    const bool other_than_default =
        row.later &&
        !(row.default_value && (value == *row.default_value ||
                                (parse_real(value) && parse_real(value) == parse_real(*row.default_value))));
    if (!other_than_default && std::ranges::none_of(values, listed)) return;

    std::vector<std::string> ready;
    for (const std::string& word : row.range.words)
      if (!listed(word)) ready.push_back(word);
    std::string remedy = "remove the attribute";
    if (row.default_value && !row.default_value->starts_with('@'))
      remedy += fmt::format(" or set it to its default, {}", *row.default_value);
    else if (!row.later_values.empty() && row.type == ValueType::boolean)
      remedy = "set it to 0";
    else if (!ready.empty())
      remedy = fmt::format("use {}{}", ready.size() > 1 ? "one of " : "", join(ready, ", "));
    diagnostics_.add(given.line, node.name(), given.name, given.value,
                     fmt::format("known, but not implemented yet; {}", remedy));
  }

  void missing_attributes(const Node& node) {
    if (node.element().incomplete) return;
    for (const AttributeSpec& row : node.spec().attributes) {
      if (!row.required || !row.applies_to(node.type()) || node.find(row.name)) continue;
      if (std::ranges::find(misspelt_, row.name) != misspelt_.end()) continue;
      node.report(diagnostics_, fmt::format("attribute '{}' is missing: {}{}", row.name, expectation(row),
                                            row.meaning.empty() ? "" : fmt::format(" ({})", row.meaning)));
    }
  }

  void together(const Node& node) {
    for (const TogetherSpec& group : node.spec().together) {
      if (!group.for_types.empty() &&
          std::ranges::find(group.for_types, node.type()) == group.for_types.end())
        continue;
      std::vector<std::string> missing;
      for (const std::string& name : group.names)
        if (!node.find(name)) missing.push_back(name);
      if (missing.empty() || missing.size() == group.names.size()) continue;
      node.report(diagnostics_, fmt::format("{} must be given together or not at all; missing: {}",
                                            join(group.names, ", "), join(missing, ", ")));
    }
  }

  void children(const Node& node) {
    std::map<std::string_view, int> first_line;
    for (std::uint32_t i = node.element().first_child; i != 0; i = document_.elements()[i].next_sibling) {
      const XmlElement& child = document_.elements()[i];
      const ElementSpec* spec = node.spec().child(child.name);
      if (!spec) {
        diagnostics_.add(child.line, child.name, unknown_element(node, child.name));
        continue;
      }
      const auto [first, is_first] = first_line.emplace(child.name, child.line);
      if (!node.type().empty() && !spec->applies_to(node.type()))
        diagnostics_.add(child.line, child.name, fmt::format("not available with type {}", node.type()));
      else if (!is_first && !spec->multiple)
        diagnostics_.add(
            child.line, child.name,
            fmt::format("may occur only once in <{}>; the first is on line {}", node.name(), first->second));
      element(Node(document_, i, *spec, node.type()));
    }
    if (node.element().incomplete) return;
    for (const ElementSpec& spec : node.spec().children)
      if (spec.required && !first_line.contains(spec.name) &&
          (spec.for_types.empty() || (!node.type().empty() && spec.applies_to(node.type()))))
        node.report(diagnostics_, fmt::format("element <{}> is missing", spec.name));
  }

  std::string unknown_element(const Node& parent, std::string_view name) {
    std::vector<std::string_view> names;
    for (const ElementSpec& child : parent.spec().children) {
      if (!child.instead_of.empty() && child.instead_of == name)
        return fmt::format("the right spelling is '{}'", child.name);
      names.push_back(child.name);
    }
    std::vector<std::string> parents;
    find_parents(language_, name, parents);
    if (!parents.empty())
      return fmt::format("belongs in {}, not in <{}>", join(parents, " or "), parent.name());
    return fmt::format("no such element in <{}>{}", parent.name(), did_you_mean(name, names));
  }

  const Document& document_;
  const ElementSpec& language_;
  const bool accept_later_;
  Diagnostics& diagnostics_;
  std::vector<std::string>
      misspelt_;  ///< names probably meant by wrong names on this element; not reported as missing
};

}  // namespace

void check(const Document& document, const ElementSpec& language, bool accept_later,
           Diagnostics& diagnostics) {
  Checker(document, language, accept_later, diagnostics).run();
}

}  // namespace mpm::io
