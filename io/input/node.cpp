#include "io/input/node.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/input/text.hpp"

namespace mpm::io {

namespace {

bool is_word(const AttributeSpec& a, std::string_view value) {
  return std::ranges::find(a.range.words, value) != a.range.words.end();
}

std::string expected(const AttributeSpec& a, std::string_view value) {
  std::vector<std::string_view> words;
  if (a.range.words.size() > 1) words.assign(a.range.words.begin(), a.range.words.end());
  return fmt::format("expected {}{}", expectation(a), did_you_mean(value, words));
}

/// Whether the words or the interval allow a well-formed number.
bool allowed(const AttributeSpec& a, double value) {
  if (a.range.words.empty()) return a.range.contains(value);
  return std::ranges::any_of(a.range.words, [&](const std::string& w) { return parse_real(w) == value; });
}

std::string complaint_about_expression(const AttributeSpec& a, std::string_view value) {
  const core::Formula::Check found = core::Formula::check(value);
  const std::string wanted = fmt::format("expected a number, written like 1.5e-3, or an expression in {}",
                                         core::in_words(a.variables));
  if (!found.error.empty()) {
    std::vector<std::string> names = core::Formula::known_names();
    for (std::size_t i = 0; i < core::variable_names.size(); ++i)
      if (a.variables[i]) names.emplace_back(1, core::variable_names[i]);
    const std::string remedy =
        found.unknown_name.empty() ? "" : did_you_mean(found.unknown_name, {names.begin(), names.end()});
    return fmt::format("{}; {}{}", wanted, found.error, remedy);
  }
  if (const core::VariableSet others = found.uses & ~a.variables; others.any())
    return fmt::format("{}; {} {} not available here", wanted, core::in_words(others),
                       others.count() == 1 ? "is" : "are");
  if (found.constant && !std::isfinite(*found.constant))
    return fmt::format("{}; this is {}", wanted, core::not_finite_in_words(*found.constant));
  return {};
}

std::string complaint_about_one(const AttributeSpec& a, std::string_view value) {
  value = canonical_word(a, value);
  if (!a.word.empty() && value == a.word) return {};
  switch (a.type) {
    case ValueType::text:
      if (a.range.words.empty() ? !value.empty() || !a.required : is_word(a, value)) return {};
      return expected(a, value);
    case ValueType::boolean: return value == "0" || value == "1" ? std::string() : expected(a, value);
    case ValueType::integer: {
      const std::optional<std::int64_t> number = parse_integer(value);
      const bool fits =
          number && *number >= std::numeric_limits<int>::min() && *number <= std::numeric_limits<int>::max();
      return fits && allowed(a, static_cast<double>(*number)) ? std::string() : expected(a, value);
    }
    case ValueType::real: {
      const std::optional<double> number = parse_real(value);
      if (!number && is_written_real(value))
        return "out of the range of double precision (0, or magnitudes from 2.3e-308 to 1.7e308); write 0, "
               "or choose other units";
      if (!number && a.variables.any()) return complaint_about_expression(a, value);
      if (!number) return expected(a, value) + ", written like 1.5e-3";
      return allowed(a, *number) ? std::string() : expected(a, value);
    }
  }
  return {};
}

}  // namespace

std::string_view canonical_word(const AttributeSpec& a, std::string_view value) {
  value = trim(value);
  return !a.also_word.first.empty() && value == a.also_word.first ? std::string_view(a.also_word.second)
                                                                  : value;
}

std::string fault(const AttributeSpec& a, std::string_view value) {
  if (!a.multiple) return complaint_about_one(a, value);
  const std::vector<std::string_view> parts = split(value, '|');
  if (parts.empty() && a.required) return expected(a, value);
  for (const std::string_view part : parts)
    if (const std::string wrong = complaint_about_one(a, part); !wrong.empty())
      return parts.size() == 1 ? wrong : fmt::format("'{}': {}", part, wrong);
  return {};
}

Node::Node(const Document& document, std::uint32_t element, const ElementSpec& spec,
           std::string_view outer_type)
    : document_(&document), element_(element), spec_(&spec), type_(outer_type) {
  if (const AttributeSpec* row = spec.attribute("type", {}); row && !row->multiple) type_ = word("type");
}

const XmlAttribute* Node::find(std::string_view attribute) const {
  const std::span<const XmlAttribute> all = document_->attributes(element());
  const auto by_name = std::ranges::find(all, attribute, &XmlAttribute::name);
  if (by_name != all.end()) return &*by_name;
  const AttributeSpec* row = spec_->attribute(attribute, type_);
  if (!row || row->also.empty()) return nullptr;
  const auto by_other = std::ranges::find(all, row->also, &XmlAttribute::name);
  return by_other != all.end() ? &*by_other : nullptr;
}

std::optional<std::string> Node::text(std::string_view attribute, bool with_default) const {
  const AttributeSpec* row = spec_->attribute(attribute, type_);
  if (!row) return {};
  if (const XmlAttribute* given = find(attribute)) {
    if (!fault(*row, given->value).empty()) return {};
    return std::string(canonical_word(*row, given->value));
  }
  if (!with_default || !row->default_value || row->default_value->starts_with('@')) return {};
  return row->default_value;
}

double Node::real(std::string_view attribute) const {
  const std::optional<std::string> value = text(attribute, true);
  if (!value) return std::numeric_limits<double>::quiet_NaN();
  if (const std::optional<double> number = parse_real(*value)) return *number;
  if (spec_->attribute(attribute, type_)->variables.any())
    return core::Formula::check(*value).constant.value_or(0);
  return std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::string> Node::expression(std::string_view attribute) const {
  const AttributeSpec* row = spec_->attribute(attribute, type_);
  if (!row || row->variables.none()) return {};
  const std::optional<std::string> value = text(attribute, false);
  if (!value || parse_real(*value) || core::Formula::check(*value).uses.none()) return {};
  return value;
}

std::int64_t Node::integer(std::string_view attribute) const {
  const std::optional<std::string> value = text(attribute, true);
  return value ? parse_integer(*value).value_or(0) : 0;
}

std::string Node::word(std::string_view attribute) const { return text(attribute, true).value_or(""); }

std::vector<std::string> Node::words(std::string_view attribute) const {
  std::vector<std::string> result;
  const std::string list = word(attribute);
  for (const std::string_view part : split(list, '|'))
    if (std::ranges::find(result, part) == result.end()) result.emplace_back(part);
  return result;
}

std::optional<double> Node::given_real(std::string_view attribute) const {
  const std::optional<std::string> value = text(attribute, false);
  return value ? parse_real(*value) : std::nullopt;
}

std::optional<std::int64_t> Node::given_integer(std::string_view attribute) const {
  const std::optional<std::string> value = text(attribute, false);
  return value ? parse_integer(*value) : std::nullopt;
}

std::vector<Node> Node::children(std::string_view child_name) const {
  std::vector<Node> result;
  const ElementSpec* child_spec = spec_->child(child_name);
  if (!child_spec) return result;
  for (std::uint32_t i = element().first_child; i != 0; i = document_->elements()[i].next_sibling)
    if (document_->elements()[i].name == child_name) result.emplace_back(*document_, i, *child_spec, type_);
  return result;
}

std::optional<Node> Node::child(std::string_view child_name) const {
  const ElementSpec* child_spec = spec_->child(child_name);
  if (!child_spec) return {};
  for (std::uint32_t i = element().first_child; i != 0; i = document_->elements()[i].next_sibling)
    if (document_->elements()[i].name == child_name) return Node(*document_, i, *child_spec, type_);
  return {};
}

void Node::report(Diagnostics& diagnostics, std::string message) const {
  diagnostics.add(line(), name(), std::move(message));
}

void Node::report(Diagnostics& diagnostics, std::string_view attribute, std::string message) const {
  const XmlAttribute* given = find(attribute);
  if (given)
    diagnostics.add(given->line, name(), given->name, given->value, std::move(message));
  else
    diagnostics.add(line(), name(), std::move(message));
}

}  // namespace mpm::io
