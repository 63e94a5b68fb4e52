// Merges the tables of the laws into the Specification.

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "io/input/specification.hpp"

namespace mpm::io {

namespace {

struct Family {
  const std::vector<core::TypeInfo>& types;
  const std::vector<core::ParameterInfo>* common;
};

Family family_of(const core::Catalogue& catalogue, LawFamily laws) {
  if (laws == LawFamily::strength) return {catalogue.strength, &catalogue.common_strength};
  if (laws == LawFamily::eos) return {catalogue.eos, &catalogue.common_eos};
  return {catalogue.failure, nullptr};
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
  a.later = !p.implemented;
  return a;
}

/// A common parameter whose row is the same for every type of the program: one row without ForTypes per type
/// would be the same text again and again, so rows carry the list of types.
void add_row(std::vector<AttributeSpec>& rows, AttributeSpec a) {
  const auto same = std::ranges::find_if(rows, [&](const AttributeSpec& b) {
    return a.name == b.name && a.required == b.required && a.type == b.type &&
           a.default_value == b.default_value && a.range.min == b.range.min && a.range.max == b.range.max &&
           a.range.min_open == b.range.min_open && a.range.max_open == b.range.max_open && a.unit == b.unit &&
           a.meaning == b.meaning && a.later == b.later;
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

/// Types without a table of their own: their common parameters have the common table's range and meaning;
/// whether they are required is the Specification's to say.
void add_common_rows_of_the_rest(std::vector<AttributeSpec>& rows,
                                 const std::vector<core::ParameterInfo>& common) {
  const std::vector<AttributeSpec> specified = rows;
  for (const core::ParameterInfo& p : common) {
    std::erase_if(rows, [&](const AttributeSpec& a) { return a.name == p.name; });
    for (const AttributeSpec& a : specified) {
      if (a.name != p.name) continue;
      for (const std::string& type : a.for_types) {
        AttributeSpec mixed = row(p, type);
        mixed.required = a.required;
        if (mixed.required) mixed.default_value.reset();
        add_row(rows, std::move(mixed));
      }
    }
  }
}

void merge_laws(ElementSpec& element, const Family& family) {
  AttributeSpec& type_row = element.attributes.front();
  std::set<std::string, std::less<>> implemented{"none"};
  for (const core::TypeInfo& t : family.types) {
    if (t.implemented) implemented.emplace(t.name);
    if (std::ranges::find(type_row.range.words, t.name) == type_row.range.words.end())
      type_row.range.words.emplace_back(t.name);
  }
  for (const std::string& word : type_row.range.words)
    if (!implemented.contains(word)) type_row.later_values.push_back(word);
  implemented.erase("none");

  // Rows for all types stay in families without a common table (type, Erosion); so does `type` everywhere.
  const bool no_common = !family.common || family.common->empty();
  std::vector<AttributeSpec> rows;
  std::vector<AttributeSpec> leftover;  // what only the Specification knows
  for (AttributeSpec& a : element.attributes) {
    if (a.for_types.empty() && (no_common || a.name == "type")) {
      rows.push_back(std::move(a));
      continue;
    }
    if (a.for_types.empty()) a.for_types = rows.front().range.words;
    AttributeSpec unknown = a;
    unknown.required = false;
    unknown.later = true;
    unknown.for_types.clear();
    std::erase_if(a.for_types, [&](const std::string& t) {
      if (!implemented.contains(t)) return false;
      unknown.for_types.push_back(t);
      return true;
    });
    if (!a.for_types.empty()) rows.push_back(std::move(a));
    if (!unknown.for_types.empty()) leftover.push_back(std::move(unknown));
  }
  std::erase_if(element.together, [&](const TogetherSpec& t) {
    return std::ranges::any_of(t.for_types,
                               [&](const std::string& type) { return implemented.contains(type); });
  });

  if (family.common) add_common_rows_of_the_rest(rows, *family.common);
  for (const core::TypeInfo& t : family.types) {
    if (!t.implemented) continue;
    for (const core::ParameterInfo& p : t.parameters) add_row(rows, row(p, t.name));
    if (family.common)
      for (const core::ParameterInfo& p : *family.common)
        if (std::ranges::find(t.parameters, p.name, &core::ParameterInfo::name) == t.parameters.end())
          add_row(rows, row(p, t.name));
    add_groups(element, t);
  }
  for (AttributeSpec& a : leftover) {  // without those that a law has under the same name
    std::erase_if(a.for_types, [&](const std::string& t) {
      return std::ranges::any_of(rows,
                                 [&](const AttributeSpec& b) { return a.name == b.name && b.applies_to(t); });
    });
    if (!a.for_types.empty()) rows.push_back(std::move(a));
  }
  element.attributes = std::move(rows);
}

void merge(ElementSpec& element, const core::Catalogue& catalogue) {
  if (element.laws != LawFamily::none) merge_laws(element, family_of(catalogue, element.laws));
  for (ElementSpec& child : element.children) merge(child, catalogue);
}

}  // namespace

ElementSpec language(const core::Catalogue& catalogue) {
  ElementSpec root = specification();
  merge(root, catalogue);
  return root;
}

}  // namespace mpm::io
