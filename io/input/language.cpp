// The laws of the catalogue as part of the language: the values of an element's type, and their attributes.

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "io/input/specification.hpp"

namespace mpm::io {

namespace {

struct Family {
  const std::vector<core::TypeInfo>& types;
  const std::vector<core::ParameterInfo>& common;
};

Family family_of(const core::Catalogue& catalogue, LawFamily laws) {
  static const std::vector<core::ParameterInfo> none;
  if (laws == LawFamily::strength) return {catalogue.strength, catalogue.common_strength};
  if (laws == LawFamily::eos) return {catalogue.eos, catalogue.common_eos};
  return {catalogue.failure, none};
}

AttributeSpec row(const core::ParameterInfo& p, std::string_view type) {
  AttributeSpec a;
  a.name = p.name;
  a.required = p.required;
  a.type = p.integer ? ValueType::integer : ValueType::real;
  a.range.min = p.min;
  a.range.max = p.max;
  a.range.min_open = p.min_open;
  a.range.max_open = p.max_open;
  a.for_types = {std::string(type)};
  if (!p.required && !std::isnan(p.default_value)) a.default_value = fmt::format("{}", p.default_value);
  a.unit = p.dimension;
  a.meaning = p.meaning;
  return a;
}

/// A parameter that is the same in several laws is one row with the list of their types.
void add_row(std::vector<AttributeSpec>& rows, AttributeSpec a) {
  const auto same = std::ranges::find_if(rows, [&](const AttributeSpec& b) {
    return a.name == b.name && a.required == b.required && a.type == b.type &&
           a.default_value == b.default_value && a.range.min == b.range.min && a.range.max == b.range.max &&
           a.range.min_open == b.range.min_open && a.range.max_open == b.range.max_open && a.unit == b.unit &&
           a.meaning == b.meaning;
  });
  if (same == rows.end())
    rows.push_back(std::move(a));
  else
    same->for_types.push_back(std::move(a.for_types.front()));
}

void add_groups(ElementSpec& element, const core::TypeInfo& type) {
  std::set<std::string_view> groups;
  for (const core::ParameterInfo& p : type.parameters)
    if (!p.group.empty()) groups.insert(p.group);
  for (const std::string_view group : groups) {
    TogetherSpec together{{}, {std::string(type.name)}};
    for (const core::ParameterInfo& p : type.parameters)
      if (p.group == group) together.names.emplace_back(p.name);
    element.together.push_back(std::move(together));
  }
}

void add_family(ElementSpec& element, const Family& family) {
  const auto type_row = std::ranges::find(element.attributes, "type", &AttributeSpec::name);
  if (type_row == element.attributes.end()) return;
  std::vector<std::string>& words = type_row->range.words;
  for (const core::TypeInfo& type : family.types)
    if (std::ranges::find(words, type.name) == words.end()) words.emplace_back(type.name);
  std::vector<AttributeSpec> rows;
  for (const core::TypeInfo& type : family.types) {
    for (const core::ParameterInfo& p : type.parameters) add_row(rows, row(p, type.name));
    for (const core::ParameterInfo& p : family.common)
      if (std::ranges::find(type.parameters, p.name, &core::ParameterInfo::name) == type.parameters.end())
        add_row(rows, row(p, type.name));
    add_groups(element, type);
  }
  element.attributes.insert(element.attributes.end(), rows.begin(), rows.end());
}

}  // namespace

void add_laws(ElementSpec& element, const core::Catalogue& catalogue) {
  if (element.laws != LawFamily::none) add_family(element, family_of(catalogue, element.laws));
  for (ElementSpec& child : element.children) add_laws(child, catalogue);
}

ElementSpec language(const core::Catalogue& catalogue) {
  ElementSpec root = specification();
  add_laws(root, catalogue);
  return root;
}

}  // namespace mpm::io
