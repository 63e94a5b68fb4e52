#pragma once
// Expressions of place and time that stand in the input in place of numbers, as text with its place in the
// input. core/expressions evaluates them.

#include <string>
#include <vector>

#include "core/scene/errors.hpp"

namespace mpm::core {

struct Expression {
  int component = 0;      ///< of the quantity, in which it stands in place of a number
  std::string text;       ///< of the variables x, y, z, X, Y, Z, t (core/expressions/formula.hpp)
  std::string element;    ///< name of the element that holds it
  std::string attribute;  ///< its name
  SourceLocation source;
};

/// Those of one quantity, at most one for each component; the quantity's numbers are 0 in these components.
using Expressions = std::vector<Expression>;

/// `<Element attribute="text">`, with file and line: an expression in a message.
std::string in_words(const Expression& expression);

}  // namespace mpm::core
