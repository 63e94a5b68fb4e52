#include "core/units/units.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace mpm::core {

namespace {

struct NamedDimension {
  std::string_view name;
  Dimension dimension;  ///< length, mass, time, temperature
};

constexpr std::array<NamedDimension, 19> dimensions{{
    {"length", {1, 0, 0, 0}},      {"mass", {0, 1, 0, 0}},          {"time", {0, 0, 1, 0}},
    {"temperature", {0, 0, 0, 1}}, {"area", {2, 0, 0, 0}},          {"volume", {3, 0, 0, 0}},
    {"velocity", {1, 0, -1, 0}},   {"acceleration", {1, 0, -2, 0}}, {"density", {-3, 1, 0, 0}},
    {"force", {1, 1, -2, 0}},      {"stress", {-1, 1, -2, 0}},      {"pressure", {-1, 1, -2, 0}},
    {"energy", {2, 1, -2, 0}},     {"power", {2, 1, -3, 0}},        {"momentum", {1, 1, -1, 0}},
    {"viscosity", {-1, 1, -1, 0}}, {"frequency", {0, 0, -1, 0}},    {"1/time", {0, 0, -1, 0}},
    {"degree", {0, 0, 0, 0}},
}};

struct NamedUnit {
  std::string_view name;
  Unit unit;
};

constexpr Dimension length{1, 0, 0, 0}, mass{0, 1, 0, 0}, time{0, 0, 1, 0}, temperature{0, 0, 0, 1};
constexpr Dimension stress{-1, 1, -2, 0}, energy{2, 1, -2, 0}, power_{2, 1, -3, 0}, force{1, 1, -2, 0};

// Of equal units, output uses the first.
constexpr std::array<NamedUnit, 51> units{{
    {"m", {length, 1}},
    {"dm", {length, 1e-1}},
    {"cm", {length, 1e-2}},
    {"mm", {length, 1e-3}},
    {"um", {length, 1e-6}},
    {"nm", {length, 1e-9}},
    {"km", {length, 1e3}},
    {"in", {length, 0.0254}},
    {"ft", {length, 0.3048}},
    {"kg", {mass, 1}},
    {"g", {mass, 1e-3}},
    {"mg", {mass, 1e-6}},
    {"ug", {mass, 1e-9}},
    {"t", {mass, 1e3}},
    {"tonne", {mass, 1e3}},
    {"lb", {mass, 0.45359237}},
    {"s", {time, 1}},
    {"ms", {time, 1e-3}},
    {"us", {time, 1e-6}},
    {"ns", {time, 1e-9}},
    {"min", {time, 60}},
    {"h", {time, 3600}},
    {"K", {temperature, 1}},
    {"Pa", {stress, 1}},
    {"kPa", {stress, 1e3}},
    {"MPa", {stress, 1e6}},
    {"GPa", {stress, 1e9}},
    {"TPa", {stress, 1e12}},
    {"Mbar", {stress, 1e11}},
    {"kbar", {stress, 1e8}},
    {"bar", {stress, 1e5}},
    {"mPa", {stress, 1e-3}},
    {"psi", {stress, 6894.757293168361}},
    {"ksi", {stress, 6894757.293168361}},
    {"J", {energy, 1}},
    {"mJ", {energy, 1e-3}},
    {"uJ", {energy, 1e-6}},
    {"kJ", {energy, 1e3}},
    {"MJ", {energy, 1e6}},
    {"erg", {energy, 1e-7}},
    {"cal", {energy, 4.184}},
    {"W", {power_, 1}},
    {"mW", {power_, 1e-3}},
    {"kW", {power_, 1e3}},
    {"MW", {power_, 1e6}},
    {"N", {force, 1}},
    {"mN", {force, 1e-3}},
    {"kN", {force, 1e3}},
    {"MN", {force, 1e6}},
    {"Hz", {{0, 0, -1, 0}, 1}},
    {"degree", {{0, 0, 0, 0}, 1}},  // angles are pure numbers; laws with angles in degrees receive degrees
}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Replaces the micro sign and middle dot of data sheets, two bytes each in UTF-8, by ASCII.
std::string plain(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 4> replacements{
      {{"\xC2\xB5", 'u'}, {"\xCE\xBC", 'u'}, {"\xC2\xB7", ' '}, {"*", ' '}}};  // micro, mu, dot
  std::string result;
  while (!text.empty()) {
    char next = text.front();
    std::size_t used = 1;
    for (const auto& [from, to] : replacements) {
      if (!text.starts_with(from)) continue;
      next = to;
      used = from.size();
    }
    result.push_back(next);
    text.remove_prefix(used);
  }
  return result;
}

std::string join(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : separator).append(word);
  return text;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// `; did you mean 'x'?` for a name that differs only in case or is written out, otherwise the list.
template <class Table>
std::string suggestion(std::string_view word, const Table& table) {
  std::vector<std::string> names;
  for (const auto& row : table) {
    const bool same = std::ranges::equal(word, row.name, [](char a, char b) { return lower(a) == lower(b); });
    if (same) return fmt::format("; did you mean '{}'?", row.name);
    names.emplace_back(row.name);
  }
  return fmt::format("; known are {}", join(names, ", "));
}

/// product := factor {blank factor};  quotient := product ['/' factor];  factor := (atom | '(' quotient ')')
/// ['^' exponent]. Works on units; a dimension is a unit of size one.
class Parser {
 public:
  using Atom = std::function<Unit(std::string_view name)>;

  Parser(std::string_view text, const Atom& atom, const ExponentOf& exponent_of)
      : text_(text), atom_(atom), exponent_of_(exponent_of) {}

  Unit parse() {
    if (skip(); at_ == text_.size()) fail("is empty");
    const Unit unit = quotient();
    if (at_ != text_.size()) fail(fmt::format("has an unexpected '{}'", text_[at_]));
    return unit;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw UnitError(fmt::format("'{}' {}", text_, why));
  }

  void skip() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }
  bool starts_factor() const {
    return at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '1' || text_[at_] == '(');
  }

  Unit quotient() {
    Unit unit = factor();
    for (skip(); starts_factor(); skip()) unit = times(unit, factor(), 1);
    if (at_ == text_.size() || text_[at_] != '/') return unit;
    ++at_;
    skip();
    unit = times(unit, factor(), -1);
    skip();
    if (starts_factor() || (at_ < text_.size() && text_[at_] == '/'))
      fail("is ambiguous after the slash: put brackets around the denominator, as in J/(kg K)");
    return unit;
  }

  Unit factor() {
    if (!starts_factor()) {
      if (at_ == text_.size()) fail("ends too early");
      fail(fmt::format("has an unexpected '{}'", text_[at_]));
    }
    Unit unit;
    if (text_[at_] == '1') {
      ++at_;
    } else if (text_[at_] == '(') {
      ++at_;
      skip();
      unit = quotient();
      if (at_ == text_.size() || text_[at_] != ')') fail("lacks a closing bracket");
      ++at_;
    } else {
      unit = atom_(word());
    }
    if (at_ < text_.size() && text_[at_] == '^') {
      ++at_;
      const double e = exponent();
      unit = {power(unit.dimension, e), std::pow(unit.in_si, e)};
    }
    return unit;
  }

  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || (text_[at_] >= '0' && text_[at_] <= '9'))) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  double exponent() {
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error == std::errc{} && std::isfinite(value)) {
      at_ = static_cast<std::size_t>(end - text_.data());
      return value;
    }
    const std::string_view name = at_ < text_.size() && is_letter(text_[at_]) ? word() : std::string_view();
    if (name.empty()) fail("lacks an exponent after ^");
    const std::optional<double> found = exponent_of_ ? exponent_of_(name) : std::nullopt;
    if (!found) fail(fmt::format("has the unknown exponent '{}'", name));
    return *found;
  }

  static Unit times(const Unit& a, const Unit& b, int sign) {
    return {a.dimension * power(b.dimension, sign), a.in_si * std::pow(b.in_si, sign)};
  }

  std::string_view text_;
  const Atom& atom_;
  const ExponentOf& exponent_of_;
  std::size_t at_ = 0;
};

std::string power_text(std::string_view symbol, double exponent) {
  return exponent == 1 ? std::string(symbol) : fmt::format("{}^{}", symbol, exponent);
}

/// "kg/(m s^2)" from symbols and exponents.
std::string quotient_text(const std::array<std::string_view, 4>& symbols, const Dimension& d) {
  const std::array<double, 4> exponents{d.mass, d.length, d.time, d.temperature};
  std::vector<std::string> above, below;
  for (std::size_t i = 0; i < 4; ++i) {
    if (exponents[i] > 0) above.push_back(power_text(symbols[i], exponents[i]));
    if (exponents[i] < 0) below.push_back(power_text(symbols[i], -exponents[i]));
  }
  std::string text = above.empty() ? "1" : join(above, " ");
  if (below.empty()) return text;
  if (below.size() == 1) return fmt::format("{}/{}", text, below[0]);
  return fmt::format("{}/({})", text, join(below, " "));
}

/// value * factor; a factor that equals a power of ten up to rounding is replaced by it, so that tabulated
/// decimals are kept: 8960 kg/m^3 is exactly 0.00896 g/mm^3.
double scaled(double value, double factor) {
  const double exponent = std::round(std::log10(factor));
  const double ten = std::pow(10.0, std::abs(exponent));
  const double exact = exponent < 0 ? 1 / ten : ten;
  if (std::abs(factor / exact - 1) > 1e-12) return value * factor;
  return exponent < 0 ? value / ten : value * ten;
}

}  // namespace

Dimension operator*(const Dimension& a, const Dimension& b) {
  return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.temperature + b.temperature};
}

Dimension power(const Dimension& a, double e) {
  return {a.length * e, a.mass * e, a.time * e, a.temperature * e};
}

Dimension operator/(const Dimension& a, const Dimension& b) { return a * power(b, -1); }

std::string to_text(const Dimension& dimension) {
  if (dimension == Dimension{}) return "1";
  for (const NamedDimension& row : dimensions)
    if (row.dimension == dimension && row.name != "frequency") return std::string(row.name);
  return quotient_text({"mass", "length", "time", "temperature"}, dimension);
}

Dimension parse_dimension(std::string_view text, const ExponentOf& exponent_of) {
  const Parser::Atom atom = [](std::string_view name) -> Unit {
    const auto found = std::ranges::find(dimensions, name, &NamedDimension::name);
    if (found == dimensions.end())
      throw UnitError(fmt::format("'{}' is no dimension{}", name, suggestion(name, dimensions)));
    return {found->dimension, 1};
  };
  return Parser(text, atom, exponent_of).parse().dimension;
}

Unit parse_unit(std::string_view text) {
  const Parser::Atom atom = [](std::string_view name) -> Unit {
    const auto found = std::ranges::find(units, name, &NamedUnit::name);
    if (found == units.end())
      throw UnitError(fmt::format("'{}' is no unit{}", name, suggestion(name, units)));
    return found->unit;
  };
  const std::string readable = plain(text);
  return Parser(readable, atom, {}).parse();
}

Quantity parse_quantity(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  Quantity quantity;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, quantity.value);
  if (error != std::errc{} || !std::isfinite(quantity.value))
    throw UnitError(fmt::format("'{}' does not begin with a number", text));
  if (end == last) return quantity;
  if (!is_blank(*end)) throw UnitError(fmt::format("'{}' needs a blank between number and unit", text));
  quantity.unit = parse_unit({end, static_cast<std::size_t>(last - end)});
  return quantity;
}

UnitSystem UnitSystem::parse(std::string_view text) {
  UnitSystem system;
  const std::string readable = plain(text);
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < readable.size();) {
    const std::size_t begin = readable.find_first_not_of(" \t\r\n,-", at);
    if (begin == readable.npos) break;
    at = std::min(readable.find_first_of(" \t\r\n,-", begin), readable.size());
    words.push_back(std::string_view(readable).substr(begin, at - begin));
  }
  if (words.size() == 1 && words[0] == "SI") return system;
  if (words.size() == 1 && words[0] == "cgs") return parse("cm g s");

  constexpr std::array<std::string_view, 3> kinds{"length", "mass", "time"};
  constexpr std::array<Dimension, 3> bases{length, mass, time};
  std::array<bool, 3> given{};
  for (const std::string_view word : words) {
    if (word == "K") continue;  // always
    const auto unit = std::ranges::find(units, word, &NamedUnit::name);
    const auto base = unit == units.end() ? bases.end() : std::ranges::find(bases, unit->unit.dimension);
    if (base == bases.end()) {
      std::vector<NamedUnit> candidates;
      for (const NamedUnit& row : units)
        if (std::ranges::find(bases, row.unit.dimension) != bases.end()) candidates.push_back(row);
      throw UnitError(
          fmt::format("'{}' is no unit of length, mass or time{}", word, suggestion(word, candidates)));
    }
    const auto i = static_cast<std::size_t>(base - bases.begin());
    if (given[i])
      throw UnitError(fmt::format("'{}' names two units of {}, {} and {}", text, kinds[i],
                                  system.bases_[i].symbol, unit->name));
    given[i] = true;
    system.bases_[i] = {unit->name, unit->unit.in_si};
  }
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < 3; ++i)
    if (!given[i]) missing.emplace_back(kinds[i]);
  if (!missing.empty())
    throw UnitError(fmt::format("'{}' lacks a unit of {}; three units are needed, as in \"mm g ms\"", text,
                                join(missing, " and of ")));
  return system;
}

double UnitSystem::in_si(const Dimension& d) const {
  return std::pow(bases_[0].in_si, d.length) * std::pow(bases_[1].in_si, d.mass) *
         std::pow(bases_[2].in_si, d.time);
}

double UnitSystem::value_of(const Quantity& quantity) const {
  return scaled(quantity.value, quantity.unit.in_si / in_si(quantity.unit.dimension));
}

std::string UnitSystem::name() const {
  return fmt::format("{} {} {}", bases_[0].symbol, bases_[1].symbol, bases_[2].symbol);
}

std::string UnitSystem::unit_name(const Dimension& dimension) const {
  if (dimension == Dimension{}) return "1";
  const double size = in_si(dimension);
  const bool derived =
      dimension == stress || dimension == energy || dimension == power_ || dimension == force;
  if (derived)
    for (const NamedUnit& row : units)
      if (row.unit.dimension == dimension && std::abs(row.unit.in_si / size - 1) < 1e-12)
        return std::string(row.name);
  return quotient_text({bases_[1].symbol, bases_[0].symbol, bases_[2].symbol, "K"}, dimension);
}

double convert(double value, const UnitSystem& from, const UnitSystem& to, const Dimension& dimension) {
  return scaled(value, from.in_si(dimension) / to.in_si(dimension));
}

}  // namespace mpm::core
