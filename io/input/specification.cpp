#include "io/input/specification.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "io/embedded/specification.hpp"
#include "io/input/diagnostics.hpp"
#include "io/input/document.hpp"
#include "io/input/text.hpp"

namespace mpm::io {

namespace {

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (const std::string_view word : split(text, '|')) words.emplace_back(word);
  return words;
}

/// Caught by a caller that knows the line.
class Mistake : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

[[noreturn]] void mistake(std::string_view where, std::string_view what) {
  throw Mistake(fmt::format("{}: {}", where, what));
}

/// The items of spec= and attributeN=, separated by commas, with `ForTypes: A|B` taken out of the last.
struct Items {
  std::vector<std::string_view> items;
  std::vector<std::string> for_types;

  explicit Items(std::string_view text) : items(split(text, ',')) {
    constexpr std::string_view key = "ForTypes:";
    if (items.empty() || !items.back().starts_with(key)) return;
    for_types = words_of(items.back().substr(key.size()));
    items.pop_back();
  }
  std::string_view at(std::size_t i) const { return i < items.size() ? items[i] : std::string_view(); }
  void at_most(std::size_t most) const {
    if (items.size() > most)
      mistake(items[most], fmt::format("one item too many; expected at most {}, and ForTypes: last", most));
  }
};

double bound(std::string_view text) {
  if (text == "inf") return std::numeric_limits<double>::infinity();
  if (text == "-inf") return -std::numeric_limits<double>::infinity();
  const std::optional<double> value = parse_real(text);
  if (!value) mistake(text, "not a bound; expected a number, inf or -inf, as in 0:1");
  return *value;
}

Range parse_range(std::string_view text, ValueType type) {
  Range range;
  if (text.empty()) return range;
  const std::size_t colon = text.find(':');
  if (text == "positive") {
    range.min = 0;
  } else if (text == "negative") {
    range.max = 0;
  } else if (type == ValueType::text || colon == text.npos) {
    range.words = words_of(text);
  } else {
    range.min_open = text.front() == '(';
    range.max_open = text.back() == ')';
    const auto is_bracket = [](char c) { return c == '(' || c == '['; };
    const std::size_t begin = is_bracket(text.front()) ? 1 : 0;
    const std::size_t end = text.back() == ')' || text.back() == ']' ? text.size() - 1 : text.size();
    range.min = bound(trim(text.substr(begin, colon - begin)));
    range.max = bound(trim(text.substr(colon + 1, end - colon - 1)));
  }
  return range;
}

void parse_occurrence(std::string_view text, bool& required, bool& multiple) {
  required = text.starts_with("REQUIRED");
  multiple = text.ends_with("_MULTIPLE");
  const std::string_view bare = multiple ? text.substr(0, text.size() - 9) : text;
  if (bare != "REQUIRED" && bare != "OPTIONAL")
    mistake(text, "not an occurrence; expected REQUIRED, OPTIONAL, REQUIRED_MULTIPLE or OPTIONAL_MULTIPLE");
}

ValueType parse_type(std::string_view text) {
  if (text == "STRING") return ValueType::text;
  if (text == "DOUBLE") return ValueType::real;
  if (text == "INTEGER") return ValueType::integer;
  if (text == "BOOLEAN") return ValueType::boolean;
  mistake(text, "not a data type; expected STRING, DOUBLE, INTEGER or BOOLEAN");
}

AttributeSpec parse_attribute(std::string_view text) {
  const Items items(text);
  items.at_most(4);
  AttributeSpec a;
  a.name = items.at(0);
  if (a.name.empty()) mistake(text, "names no attribute");
  parse_occurrence(items.at(1), a.required, a.multiple);
  a.type = parse_type(items.at(2));
  a.range = parse_range(items.at(3), a.type);
  a.for_types = items.for_types;
  return a;
}

void parse_detail(AttributeSpec& a, std::string_view key, std::string_view value) {
  if (key == "default")
    a.default_value = value;
  else if (key == "unit")
    a.unit = value;
  else if (key == "meaning")
    a.meaning = value;
  else if (key == "insteadOf")
    a.instead_of = value;
  else if (key == "twice")
    a.twice = value;
  else if (key == "word")
    a.word = value;
  else if (key == "expression")
    a.variables = core::variables_named(value);
  else if (key == "later" && value == "*")
    a.later = true;
  else if (key == "later")
    a.later_values = words_of(value);
  else if (key == "also" && value.find('=') != value.npos)
    a.also_word = {std::string(value.substr(0, value.find('='))),
                   std::string(value.substr(value.find('=') + 1))};
  else if (key == "also")
    a.also = value;
  else
    mistake(key, "unknown key");
}

LawFamily parse_laws(std::string_view text) {
  if (text == "strength") return LawFamily::strength;
  if (text == "eos") return LawFamily::eos;
  if (text == "failure") return LawFamily::failure;
  mistake(text, "no such family of laws");
}

/// Key and number of `default12`; the number is 0 where there is none.
std::pair<std::string_view, std::size_t> numbered(std::string_view name) {
  const std::size_t end = name.find_last_not_of("0123456789") + 1;
  const std::optional<std::int64_t> number = parse_integer(name.substr(end));
  return {name.substr(0, end), number ? static_cast<std::size_t>(*number) : 0};
}

void parse_key(ElementSpec& spec, std::string_view name, std::string_view value) {
  const auto [key, number] = numbered(name);
  if (key == "attribute") {
    if (number != spec.attributes.size() + 1) mistake(name, "attributes are numbered from 1 without gaps");
    spec.attributes.emplace_back();  // kept, so that an error here causes none for the next attribute
    spec.attributes.back() = parse_attribute(value);
  } else if (key == "together") {
    const Items items(value);
    spec.together.push_back({words_of(items.at(0)), items.for_types});
  } else if (number > 0) {
    if (number > spec.attributes.size()) mistake(name, "comes before its attribute");
    parse_detail(spec.attributes[number - 1], key, value);
  } else if (key == "spec") {
    const Items items(value);
    items.at_most(3);
    parse_occurrence(items.at(0), spec.required, spec.multiple);
    if (!items.at(1).empty() && items.at(1) != "NO_DATA")
      mistake(items.at(1), "no element of an input holds text; expected NO_DATA");
    spec.for_types = items.for_types;
  } else if (key == "meaning") {
    spec.meaning = value;
  } else if (key == "later") {
    spec.later = true;
  } else if (key == "insteadOf") {
    spec.instead_of = value;
  } else if (key == "laws") {
    spec.laws = parse_laws(value);
  } else {
    mistake(name, "unknown key");
  }
}

ElementSpec parse_element(const Document& document, const XmlElement& element, Diagnostics& mistakes) {
  ElementSpec spec;
  spec.name = element.name;
  bool has_spec = false;
  for (const XmlAttribute& a : document.attributes(element)) {
    has_spec = has_spec || a.name == "spec";
    try {
      parse_key(spec, a.name, a.value);
    } catch (const Mistake& mistake) { mistakes.add(a.line, element.name, a.name, a.value, mistake.what()); }
  }
  if (!has_spec) mistakes.add(element.line, element.name, "attribute 'spec' is missing");
  for (std::uint32_t i = element.first_child; i != 0; i = document.elements()[i].next_sibling) {
    const XmlElement& child = document.elements()[i];
    if (spec.child(child.name))
      mistakes.add(child.line, child.name, fmt::format("described twice in <{}>", spec.name));
    spec.children.push_back(parse_element(document, child, mistakes));
  }
  if (spec.laws != LawFamily::none &&
      std::ranges::find(spec.attributes, "type", &AttributeSpec::name) == spec.attributes.end())
    mistakes.add(element.line, element.name, "has laws, so it needs the attribute 'type' that chooses one");
  return spec;
}

bool contains(const std::vector<std::string>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

}  // namespace

bool Range::bounded() const { return std::isfinite(min) || std::isfinite(max); }

bool Range::contains(double value) const {
  return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
}

bool AttributeSpec::applies_to(std::string_view element_type) const {
  return for_types.empty() || contains(for_types, element_type);
}

bool ElementSpec::applies_to(std::string_view element_type) const {
  return for_types.empty() || contains(for_types, element_type);
}

const ElementSpec* ElementSpec::child(std::string_view child_name) const {
  const auto found = std::ranges::find(children, child_name, &ElementSpec::name);
  return found == children.end() ? nullptr : &*found;
}

const AttributeSpec* ElementSpec::attribute(std::string_view attribute_name,
                                            std::string_view element_type) const {
  for (const AttributeSpec& a : attributes)
    if (a.name == attribute_name && a.applies_to(element_type)) return &a;
  return nullptr;
}

ElementSpec parse_specification(std::string_view xml, const std::string& file) {
  Diagnostics mistakes(file);
  std::optional<XmlError> error;
  const Document document = parse_document(xml, error);
  ElementSpec root;
  if (error)
    mistakes.add(error->line, {}, error->message);
  else
    root = parse_element(document, document.elements().front(), mistakes);
  mistakes.raise_if_any();
  return root;
}

const ElementSpec& specification() {
  static const ElementSpec root = parse_specification(embedded::specification);
  return root;
}

namespace {

std::string interval(const Range& r, std::string_view noun) {
  const bool low = std::isfinite(r.min), high = std::isfinite(r.max);
  if (low && high)
    return fmt::format("{} in {}{}, {}{}", noun, r.min_open ? '(' : '[', r.min, r.max,
                       r.max_open ? ')' : ']');
  if (low)
    return r.min_open ? fmt::format("{} greater than {}", noun, r.min)
                      : fmt::format("{} of at least {}", noun, r.min);
  if (high)
    return r.max_open ? fmt::format("{} less than {}", noun, r.max)
                      : fmt::format("{} of at most {}", noun, r.max);
  return std::string(noun);
}

}  // namespace

std::string expectation(const AttributeSpec& a) {
  std::string text;
  if (!a.range.words.empty()) {
    const std::string words = join(a.range.words, ", ");
    if (a.range.words.size() == 1)
      text = fmt::format("'{}'", words);
    else if (a.multiple)
      text = fmt::format("one or more of {}, joined by |", words);
    else
      text = fmt::format("one of {}", words);
  } else if (a.type == ValueType::boolean) {
    text = "0 or 1";
  } else if (a.type == ValueType::integer) {
    text = interval(a.range, "a whole number");
  } else if (a.type == ValueType::real) {
    text = interval(a.range, "a number");
    if (a.variables.any()) text += " or an expression in " + core::in_words(a.variables);
  } else {
    text = "a text";
  }
  return a.word.empty() ? text : fmt::format("'{}' or {}", a.word, text);
}

}  // namespace mpm::io
