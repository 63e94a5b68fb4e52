#pragma once
// Expressions of position and time, given in the input instead of numbers: their text and its location in the
// input. core/expressions evaluates them.

#include <string>
#include <vector>

#include "core/scene/errors.hpp"

namespace mpm::core {

struct Expression {
  int component = 0;      ///< component of the quantity whose number it replaces
  std::string text;       ///< of the variables x, y, z, X, Y, Z, t (core/expressions/formula.hpp)
  std::string element;    ///< name of its element
  std::string attribute;  ///< its name
  SourceLocation source;
};

/// Those of one quantity, at most one for each component; the quantity's numbers are 0 in these components.
using Expressions = std::vector<Expression>;

/// `<Element attribute="text">`, with file and line: an expression in a message.
std::string in_words(const Expression& expression);

}  // namespace mpm::core
