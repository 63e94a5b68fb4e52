// The input language as data: io/input/Specification.xml and the laws of the catalogue with their parameters.
// The head of that file describes the notation.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/expressions/formula.hpp"
#include "core/scene/catalogue.hpp"

namespace mpm::io {

enum class ValueType { text, real, integer, boolean };

/// The allowed words (any if empty) and the interval of numbers.
struct Range {
  std::vector<std::string> words;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;

  bool bounded() const;
  bool contains(double value) const;
};

struct AttributeSpec {
  std::string name;
  bool required = false;
  bool multiple = false;  ///< values joined by |
  ValueType type = ValueType::text;
  Range range;
  std::vector<std::string> for_types;        ///< empty: for every type
  std::optional<std::string> default_value;  ///< a rule in words if it starts with @
  std::string unit;
  std::string meaning;
  bool later = false;                             ///< any value but the default is not implemented yet
  std::vector<std::string> later_values;          ///< these values are not implemented yet
  std::string instead_of;                         ///< a rejected spelling of the name
  std::string also;                               ///< a second accepted spelling of the name
  std::pair<std::string, std::string> also_word;  ///< accepted spelling of a word, and the word
  std::string twice;  ///< the attribute probably meant where this one occurs twice
  std::string word;   ///< accepted in place of a number
  /// Variables of an expression that may replace the number (core/expressions/formula.hpp).
  core::VariableSet variables;
  bool foreign = false;                    ///< a user's Specification has it, this program has not
  std::vector<std::string> foreign_words;  ///< words that only a user's Specification has

  bool applies_to(std::string_view element_type) const;
};

/// Attributes that must be given together.
struct TogetherSpec {
  std::vector<std::string> names;
  std::vector<std::string> for_types;
};

enum class LawFamily { none, strength, eos, failure };

struct ElementSpec {
  std::string name;
  bool required = false;
  bool multiple = false;
  std::vector<std::string> for_types;
  std::string meaning;
  bool later = false;
  std::string instead_of;
  LawFamily laws = LawFamily::none;
  bool foreign = false;  ///< a user's Specification has it, this program has not
  std::vector<TogetherSpec> together;
  std::vector<AttributeSpec> attributes;
  std::vector<ElementSpec> children;

  bool applies_to(std::string_view element_type) const;
  const ElementSpec* child(std::string_view child_name) const;
  /// The row of an attribute that holds for this type, if there is one.
  const AttributeSpec* attribute(std::string_view attribute_name, std::string_view element_type) const;
};

/// Parses the notation. Throws core::InputErrors with every mistake; `file` is for messages.
ElementSpec parse_specification(std::string_view xml, const std::string& file = "Specification.xml");

/// The built-in Specification.xml, without the laws; the root is PeneBlast.
const ElementSpec& specification();

/// Adds the catalogue's laws to the elements that have `laws`, at any depth: their names to the words of the
/// attribute `type`, their parameters to the attributes.
void add_laws(ElementSpec& element, const core::Catalogue& catalogue);

/// The language that a program with these laws reads.
ElementSpec language(const core::Catalogue& catalogue);

/// `a number greater than 0`, `one of a, b, c` ...
std::string expectation(const AttributeSpec& attribute);

}  // namespace mpm::io
