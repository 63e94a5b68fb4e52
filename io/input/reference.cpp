#include "io/input/reference.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "io/input/specification.hpp"
#include "io/input/text.hpp"
#include "io/output/variables.hpp"

namespace mpm::io {

namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

std::string value_column(const AttributeSpec& a) {
  if (a.range.words.empty() || a.type != ValueType::text) return expectation(a);
  std::vector<std::string> words;
  for (const std::string& word : a.range.words) {
    const bool later = std::ranges::find(a.later_values, word) != a.later_values.end();
    words.push_back(fmt::format("`{}`{}", word, later ? " (not yet)" : ""));
  }
  return join(words, ", ") + (a.multiple ? ", joined by |" : "");
}

std::string default_column(const AttributeSpec& a) {
  if (a.required) return "required";
  if (!a.default_value) return "";
  return a.default_value->starts_with('@') ? a.default_value->substr(1)
                                           : fmt::format("`{}`", *a.default_value);
}

std::string meaning_column(const AttributeSpec& a) {
  std::string text = a.meaning;
  const auto add = [&](std::string more) { text += (text.empty() ? "" : "; ") + std::move(more); };
  if (!a.also.empty()) add(fmt::format("also spelled `{}`", a.also));
  if (!a.also_word.first.empty())
    add(fmt::format("`{}` is accepted for `{}`", a.also_word.first, a.also_word.second));
  if (a.later)
    add(a.default_value ? "not yet: only the default" : "not yet");
  else if (!a.later_values.empty() && a.type != ValueType::text)
    add("not yet: " + join(a.later_values, ", "));
  return text;
}

/// Rows, with a column of types if any row has types.
std::string table(const std::vector<const AttributeSpec*>& rows, bool with_types) {
  if (rows.empty()) return {};
  const bool types =
      with_types && std::ranges::any_of(rows, [](const auto* a) { return !a->for_types.empty(); });
  std::string text =
      fmt::format("| attribute |{} value | default | unit | meaning |\n|---|{}---|---|---|---|\n",
                  types ? " types |" : "", types ? "---|" : "");
  for (const AttributeSpec* a : rows)
    text +=
        fmt::format("| `{}` |{} {} | {} | {} | {} |\n", a->name,
                    types ? fmt::format(" {} |", join(a->for_types, ", ")) : "", escaped(value_column(*a)),
                    escaped(default_column(*a)), a->unit, escaped(meaning_column(*a)));
  return text + '\n';
}

std::string summary_of(const core::Catalogue& catalogue, LawFamily laws, std::string_view type) {
  const auto& list = laws == LawFamily::strength ? catalogue.strength
                     : laws == LawFamily::eos    ? catalogue.eos
                                                 : catalogue.failure;
  const auto found = std::ranges::find(list, type, &core::TypeInfo::name);
  return found == list.end() ? "" : std::string(found->summary);
}

/// The types of a row in the language's order, or the shorter "all", "all but ...".
std::vector<std::string> shortest(const std::vector<std::string>& types,
                                  const std::vector<std::string>& all) {
  std::vector<std::string> with, without;
  for (const std::string& type : all)
    (std::ranges::find(types, type) != types.end() ? with : without).push_back(type);
  if (types.empty() || without.empty()) return {"all"};
  return without.size() < with.size() ? std::vector{"all but " + join(without, ", ")} : with;
}

/// Attributes shared by many types, then a table of its own attributes for each type.
std::string law_tables(const ElementSpec& element, const core::Catalogue& catalogue) {
  const std::vector<std::string>& all = element.attributes.front().range.words;
  const auto shared = [&](const AttributeSpec& a) { return a.for_types.empty() || a.for_types.size() >= 4; };
  std::vector<AttributeSpec> common;
  for (const AttributeSpec& a : element.attributes) {
    if (!shared(a)) continue;
    common.push_back(a);
    common.back().for_types = shortest(a.for_types, all);
  }
  std::vector<const AttributeSpec*> rows;
  for (const AttributeSpec& a : common) rows.push_back(&a);
  std::string text = table(rows, true);
  for (const std::string& type : all) {
    const std::string summary = summary_of(catalogue, element.laws, type);
    text += fmt::format("`type=\"{}\"`{}\n\n", type, summary.empty() ? "" : ": " + summary);
    rows.clear();
    for (const AttributeSpec& a : element.attributes)
      if (!shared(a) && a.applies_to(type)) rows.push_back(&a);
    text += table(rows, false);
  }
  return text;
}

std::string occurrence(const ElementSpec& element) {
  if (element.required) return element.multiple ? "once or more" : "once";
  return element.multiple ? "any number of times" : "at most once";
}

std::string section(const ElementSpec& element, const std::string& parents, int depth,
                    const core::Catalogue& catalogue) {
  const std::string path = parents.empty() ? element.name : fmt::format("{} / {}", parents, element.name);
  std::string text = fmt::format("{} {}\n\n{}. Occurs {}",
                                 std::string(static_cast<std::size_t>(std::clamp(depth, 2, 4)), '#'), path,
                                 element.meaning, occurrence(element));
  if (!element.for_types.empty()) text += fmt::format(", with type {}", join(element.for_types, ", "));
  text += element.later ? ". **Not implemented yet.**\n\n" : ".\n\n";
  for (const TogetherSpec& group : element.together)
    text +=
        fmt::format("Given together or not at all{}: {}.\n\n",
                    group.for_types.empty() ? "" : fmt::format(", with type {}", join(group.for_types, ", ")),
                    join(group.names, ", "));
  if (element.laws != LawFamily::none) {
    text += law_tables(element, catalogue);
  } else {
    std::vector<const AttributeSpec*> rows;
    for (const AttributeSpec& a : element.attributes) rows.push_back(&a);
    text += table(rows, true);
  }
  for (const ElementSpec& child : element.children)
    text += section(child, depth == 1 ? std::string() : path, depth + 1, catalogue);
  return text;
}

std::string functions_in_words() {
  std::vector<std::string> names;
  for (const std::string& name : core::Formula::known_names())
    if (name != "if" && !name.starts_with('_')) names.push_back(fmt::format("`{}`", name));
  return join(names, " ");
}

/// Of all output variables.
std::string variable_section() {
  std::string text =
      "## Output variables\n\n"
      "Words of `var` in PostProcessing and TimeHistory. Numbers of bodies and materials are in the order of "
      "the input. A variable that a body's\n"
      "material does not have is written as 0.\n\n"
      "| var | unit | meaning |\n|---|---|---|\n";
  for (const VariableInfo& v : variable_table)
    text += fmt::format("| `{}` | {} | {} |\n", v.name, v.dimension, escaped(v.meaning));
  return text + '\n';
}

}  // namespace

std::string keyword_reference(const core::Catalogue& catalogue) {
  std::string text =
      "# Keyword reference\n\n"
      "Generated by `mpm_check --reference` from `io/input/Specification.xml` and the laws' parameter "
      "tables.\n"
      "Names are case-sensitive. Units are chosen by the user and must be consistent; unit 1 means "
      "dimensionless.\n"
      "Pressure is positive in compression, stress in tension. The program rejects what is marked "
      "\"not yet\" with a message\n"
      "that it is not implemented yet.\n\n"
      "Where the table says so, an expression may replace a number, as in `vx=\"0.1*sin(pi*x/25)\"`. Its "
      "result is in the\n"
      "units of the input. Variables: `x`, `y`, `z`, the current position of the particle; `X`, `Y`, `Z`, "
      "its initial position;\n"
      "`t`, the time; all in the global frame. Operators: `+ - * / ^`, comparisons (in XML `<` is written "
      "`&lt;`), `&&`, `||`,\n"
      "`a ? b : c`. Functions and constants: `if(condition, a, b)`, where any condition other than 0 is "
      "true, and\n" +
      functions_in_words() +
      ";\n`log` is the natural logarithm like `ln`. If a result is not finite, the run stops with a message "
      "that names the particle.\n\n" +
      section(language(catalogue), "", 1, catalogue) + variable_section();
  text.pop_back();
  return text;
}

}  // namespace mpm::io
