#include "core/expressions/formula.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <muParser.h>

#include "core/scene/expression.hpp"

namespace mpm::core {

namespace {

double choose(double condition, double yes, double no) { return condition != 0 ? yes : no; }

/// The parser's operator = assigns to variables: the character is allowed only in comparisons.
bool assigns(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || (text[i - 1] != '<' && text[i - 1] != '>' && text[i - 1] != '!')) {
      return true;
    }
  }
  return false;
}

bool is_name(std::string_view token) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !token.empty() && letter(token.front());
}

void define_functions(mu::Parser& parser) { parser.DefineFun("if", choose); }

bool is_function(const std::string& name) {
  mu::Parser parser;
  define_functions(parser);
  return parser.GetFunDef().contains(name);
}

/// The parser's error as a message to the user.
Formula::Check refusal(const mu::ParserError& fault) {
  Formula::Check check;
  std::string token = fault.GetToken();
  while (!token.empty() && token.back() == ' ') token.pop_back();
  constexpr std::size_t longest = 40;
  if (token.size() > longest) {
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(token[end]) & 0xC0) == 0x80) --end;  // a whole character
    token = token.substr(0, end) + "...";
  }
  const auto at = [&] { return fmt::format("at character {}", fault.GetPos() + 1); };
  switch (fault.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
      if (is_function(token)) {
        check.error =
            fmt::format("function '{0}' {1} needs its arguments in parentheses: {0}(...)", token, at());
        break;
      }
      if (is_name(token)) check.unknown_name = token;
      check.error = fmt::format("unknown name '{}' {}", token, at());
      break;
    case mu::ecUNEXPECTED_EOF: check.error = "unexpected end of the expression"; break;
    case mu::ecEMPTY_EXPRESSION: check.error = "empty"; break;
    case mu::ecEXPRESSION_TOO_LONG: check.error = "the expression is too long"; break;
    case mu::ecMISSING_PARENS: check.error = "a closing parenthesis is missing"; break;
    case mu::ecTOO_MANY_PARAMS: check.error = fmt::format("too many arguments of '{}'", token); break;
    case mu::ecTOO_FEW_PARAMS: check.error = fmt::format("too few arguments of '{}'", token); break;
    default: check.error = fmt::format("unexpected '{}' {}", token, at());
  }
  return check;
}

}  // namespace

std::string in_words(const Expression& expression) {
  return fmt::format("{}:{}: <{} {}=\"{}\">", expression.source.file, expression.source.line,
                     expression.element, expression.attribute, expression.text);
}

VariableSet variables_named(std::string_view text) {
  VariableSet set;
  for (std::size_t i = 0; i < variable_names.size(); ++i)
    set[i] = text.find(variable_names[i]) != std::string_view::npos;
  return set;
}

std::string in_words(const VariableSet& variables) {
  std::string text;
  for (std::size_t i = 0; i < variable_names.size(); ++i) {
    if (!variables[i]) continue;
    if (!text.empty()) text += ", ";
    text += variable_names[i];
  }
  return text;
}

std::string_view not_finite_in_words(double value) { return std::isnan(value) ? "not a number" : "infinite"; }

struct Formula::Parser {
  mu::Parser parser;
  std::array<double, variable_names.size()> values{};

  explicit Parser(std::string_view text) {
    for (std::size_t i = 0; i < values.size(); ++i)
      parser.DefineVar(std::string(1, variable_names[i]), &values[i]);
    parser.DefineConst("pi", std::numbers::pi);
    define_functions(parser);
    parser.SetExpr(std::string(text));
  }
};

Formula::Check Formula::check(std::string_view text) {
  if (assigns(text)) return {"'=' is an assignment; use == for equality", {}, {}, {}};
  try {
    Parser parser(text);
    Check found;
    const double value = parser.parser.Eval();
    if (parser.parser.GetNumResults() != 1) return {"a comma is outside of a function call", {}, {}, {}};
    for (const auto& [name, address] : parser.parser.GetUsedVar())
      found.uses.set(variable_names.find(name.front()));
    if (found.uses.none()) found.constant = value;
    return found;
  } catch (const mu::ParserError& fault) { return refusal(fault); }
}

std::vector<std::string> Formula::known_names() {
  const Parser parser("0");
  std::vector<std::string> names;
  for (const auto& [name, function] : parser.parser.GetFunDef()) names.push_back(name);
  for (const auto& [name, value] : parser.parser.GetConst()) names.push_back(name);
  return names;
}

Formula::Formula(const std::string& text) : parser_(std::make_unique<Parser>(text)) {
  parser_->parser.Eval();  // compiles it
}
Formula::~Formula() = default;
Formula::Formula(Formula&&) noexcept = default;
Formula& Formula::operator=(Formula&&) noexcept = default;

double Formula::operator()(const PlaceAndTime& at) {
  for (int a = 0; a < 3; ++a) {
    parser_->values[static_cast<std::size_t>(a)] = at.place[a];
    parser_->values[static_cast<std::size_t>(3 + a)] = at.first_place[a];
  }
  parser_->values[6] = at.time;
  try {
    return parser_->parser.Eval();
  } catch (const mu::ParserError&) {  // muParser may be built to throw instead of returning NaN
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace mpm::core
