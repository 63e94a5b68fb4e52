#include "apps/common/point_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "io/input/text.hpp"

namespace mpm::apps {

namespace {

using physics::Leg;
namespace legs = physics::legs;

struct Kind {
  std::string_view name;
  std::string_view usage;
  std::string_view meaning;
};

constexpr std::array<Kind, 11> kinds{{
    {"uniaxial_stress", "E [E...]", "axial strain E along x, lateral stress zero (a tensile test)"},
    {"uniaxial_strain", "E [E...]", "axial strain E along x, no lateral strain (a plate impact)"},
    {"triaxial", "E [E...] confining P",
     "axial strain under constant lateral pressure P, which is applied first:\n"
     "      E < 0 compression, E > 0 extension"},
    {"biaxial", "E [E...] [confining P]", "axial strain, z held (plane strain), y under pressure P"},
    {"equibiaxial", "E [E...]", "equal strain in x and y, z free (a bulge test)"},
    {"simple_shear", "G [G...]", "shear gamma_xy = G"},
    {"hydrostatic", "E [E...]", "volumetric strain E, equal in all directions"},
    {"pressure", "P [P...]", "to pressure P by equal strains in all directions"},
    {"mixed", "e_xx=E s_yy=S ... time T",
     "each of xx, yy, zz, xy, yz, xz by its strain e or its stress s at the end; strains count from the\n"
     "      start of the leg, and components not named have zero strain"},
    {"hold", "time T", "no strain for a time T (relaxation)"},
    {"table", "FILE",
     "deformation gradient F over time: lines of time F11 F12 F13 F21 ... F33,\n"
     "      the first with F = 1 0 0 0 1 0 0 0 1"},
}};

constexpr std::array<std::string_view, 5> options{"stress", "rate", "time", "steps", "confining"};

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n,", at);
    if (begin == text.npos) break;
    at = std::min(text.find_first_of(" \t\r\n,", begin), text.size());
    words.push_back(text.substr(begin, at - begin));
  }
  return words;
}

/// To the digits of a table.
bool is_identity(const core::Mat3<double>& f) {
  constexpr double digits = 1e-9;
  const core::Mat3<double> d = f - core::Mat3<double>{1, 0, 0, 0, 1, 0, 0, 0, 1};
  return std::ranges::all_of(std::array{d.xx, d.xy, d.xz, d.yx, d.yy, d.yz, d.zx, d.zy, d.zz},
                             [](double x) { return std::abs(x) <= digits; });
}

struct Component {
  std::string_view name;
  double core::Sym3<double>::*member;
  core::Mat3<double> direction;  ///< velocity gradient per unit rate of the strain
};

// Shear strains are tensor components here, as in the output.
constexpr std::array<Component, 6> components{{
    {"xx", &core::Sym3<double>::xx, {1, 0, 0, 0, 0, 0, 0, 0, 0}},
    {"yy", &core::Sym3<double>::yy, {0, 0, 0, 0, 1, 0, 0, 0, 0}},
    {"zz", &core::Sym3<double>::zz, {0, 0, 0, 0, 0, 0, 0, 0, 1}},
    {"xy", &core::Sym3<double>::xy, {0, 1, 0, 1, 0, 0, 0, 0, 0}},
    {"yz", &core::Sym3<double>::yz, {0, 0, 0, 0, 0, 1, 0, 1, 0}},
    {"xz", &core::Sym3<double>::xz, {0, 0, 1, 0, 0, 0, 1, 0, 0}},
}};

core::Sym3<double> unit(double core::Sym3<double>::*member) {
  core::Sym3<double> s{};
  s.*member = 1;
  return s;
}

/// Parses one leg of the text.
class LegReader {
 public:
  LegReader(std::string_view text, const PathDefaults& defaults) : text_(text), defaults_(defaults) {
    const std::vector<std::string_view> words = words_of(text);
    kind_ = words.front();
    std::ranges::replace(kind_, '-', '_');
    if (std::ranges::find(kinds, kind_, &Kind::name) == kinds.end()) {
      std::vector<std::string_view> names;
      std::vector<std::string> list;
      for (const Kind& k : kinds) {
        names.push_back(k.name);
        list.emplace_back(k.name);
      }
      fail(fmt::format("unknown path '{}'{}; expected one of {}", kind_, io::did_you_mean(kind_, names),
                       io::join(list, ", ")));
    }
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (kind_ == "table" && file_.empty() && !is_option(words[i])) {
        file_ = words[i];
      } else if (is_option(words[i])) {
        if (i + 1 == words.size()) fail(fmt::format("'{}' must be followed by a number", words[i]));
        option(words[i], number(words[i + 1]));
        ++i;
      } else if (kind_ == "mixed" && words[i].find('=') != words[i].npos) {
        assignments_.push_back(words[i]);
      } else {
        numbers_.push_back(number(words[i]));
      }
    }
    if (rate_ && time_) fail("has both a rate and a time: give one of them");
  }

  std::vector<Leg> read() const {
    if (confining_ && kind_ != "triaxial" && kind_ != "biaxial")
      fail("only triaxial and biaxial have a confining pressure");
    if (stress_ && kind_ != "uniaxial_stress" && kind_ != "simple_shear")
      fail("only uniaxial_stress and simple_shear end at a stress; 'mixed' prescribes any other");
    if (kind_ == "uniaxial_strain") return strains(legs::uniaxial_strain);
    if (kind_ == "uniaxial_stress") return stress_ ? to_stress() : strains(legs::uniaxial_stress);
    if (kind_ == "simple_shear") return stress_ ? to_stress() : strains(legs::simple_shear);
    if (kind_ == "hydrostatic") return strains(legs::hydrostatic);
    if (kind_ == "equibiaxial") return strains(legs::equibiaxial);
    if (kind_ == "triaxial" || kind_ == "biaxial") return confined();
    if (kind_ == "pressure") return pressures();
    if (kind_ == "mixed") return {finished(mixed())};
    if (kind_ == "hold") {
      if (!time_ || !numbers_.empty()) fail("expected: hold time T");
      return {finished(legs::hold(*time_))};
    }
    if (file_.empty()) fail("expected: table FILE");
    Leg leg;
    leg.kind = kind_;
    leg.measure = {1, 0, 0, 0, 0, 0};
    leg.from_zero = true;
    leg.table = read_deformation(file_);
    leg.steps = steps_.value_or(std::max(1, defaults_.steps / static_cast<int>(leg.table.size() - 1)));
    return {leg};
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw PathError(fmt::format("path \"{}\": {}", io::trim(text_), why));
  }

  static bool is_option(std::string_view word) { return std::ranges::find(options, word) != options.end(); }

  double number(std::string_view word) const {
    if (const std::optional<double> value = io::parse_real(word)) return *value;
    fail(fmt::format("'{}' is neither a number nor an option{}", word,
                     io::did_you_mean(word, {options.begin(), options.end()})));
  }

  void option(std::string_view name, double value) {
    const auto positive = [&] {
      if (!(value > 0)) fail(fmt::format("{} {} must be greater than 0", name, value));
    };
    if (name == "stress") {
      stress_ = value;
    } else if (name == "confining") {
      confining_ = value;
    } else if (name == "rate") {
      positive();
      rate_ = value;
    } else if (name == "time") {
      positive();
      time_ = value;
    } else {
      if (!(value >= 1) || value != std::floor(value) || value > 1e9)
        fail(fmt::format("steps {} must be a whole number of at least 1", value));
      steps_ = static_cast<int>(value);
    }
  }

  void need_numbers() const {
    if (numbers_.empty()) {
      const Kind& kind = *std::ranges::find(kinds, kind_, &Kind::name);
      fail(fmt::format("expected: {} {} [rate R | time T] [steps N]", kind.name, kind.usage));
    }
  }

  Leg finished(Leg leg) const {
    leg.kind = kind_;
    leg.steps = steps_.value_or(defaults_.steps);
    leg.rate = rate_.value_or(defaults_.rate);
    if (time_) leg.time = time_;
    return leg;
  }

  std::vector<Leg> strains(const std::function<Leg(double)>& make) const {
    need_numbers();
    std::vector<Leg> made;
    for (const double target : numbers_) made.push_back(finished(make(target)));
    return made;
  }

  std::vector<Leg> to_stress() const {
    if (!numbers_.empty()) fail("gives both a strain and a stress as the end: give one of them");
    if (!rate_ && !time_) fail("a leg that ends at a stress requires a time (or a rate of the stress)");
    Leg leg = kind_ == "uniaxial_stress" ? legs::uniaxial_stress(0) : legs::simple_shear(0);
    leg.strain.reset();
    const core::Sym3<double> weight =
        unit(kind_ == "simple_shear" ? &core::Sym3<double>::xy : &core::Sym3<double>::xx);
    leg.controls.insert(leg.controls.begin(), {leg.direction, weight, *stress_, true});
    return {finished(leg)};
  }

  std::vector<Leg> confined() const {
    need_numbers();
    if (!confining_ && kind_ == "triaxial")
      fail("requires the lateral pressure, as in: triaxial -0.05 confining 10");
    const double p = confining_.value_or(0);
    std::vector<Leg> made =
        strains([&](double e) { return kind_ == "triaxial" ? legs::triaxial(e, p) : legs::biaxial(e, p); });
    if (p != 0) {
      Leg first = legs::pressure(p, time_ ? *time_ : std::abs(numbers_[0]) / rate_.value_or(defaults_.rate));
      first.steps = std::max(1, steps_.value_or(defaults_.steps) / 10);
      made.insert(made.begin(), first);
    }
    return made;
  }

  std::vector<Leg> pressures() const {
    need_numbers();
    if (rate_) fail("a leg that ends at a pressure takes a time, not a rate");
    std::vector<Leg> made;
    for (const double p : numbers_) made.push_back(finished(legs::pressure(p, time_.value_or(1))));
    return made;
  }

  Leg mixed() const {
    if (!numbers_.empty() || assignments_.empty()) fail("expected: mixed e_xx=0.01 s_yy=-10 ... time T");
    if (!time_) fail("requires a time");
    Leg leg;
    leg.kind = kind_;
    leg.from_zero = true;
    core::Mat3<double> total{};
    std::vector<std::string_view> seen;
    for (const std::string_view word : assignments_) {
      const std::size_t equals = word.find('=');
      const std::string_view name = word.substr(0, equals);
      const double value = number(word.substr(equals + 1));
      const auto component = name.size() == 4
                                 ? std::ranges::find(components, name.substr(2), &Component::name)
                                 : components.end();
      if (component == components.end() || name[1] != '_' || (name[0] != 'e' && name[0] != 's'))
        fail(
            fmt::format("'{}' is not a component; expected e_ (strain) or s_ (stress) followed by xx, yy, "
                        "zz, xy, yz or xz",
                        name));
      if (std::ranges::find(seen, component->name) != seen.end())
        fail(fmt::format("{} is prescribed twice", component->name));
      seen.push_back(component->name);
      const core::Sym3<double> one = unit(component->member);
      if (seen.size() == 1) leg.measure = one;
      if (name[0] == 's') {
        leg.controls.push_back({component->direction, one, value, true});
      } else {
        double core::Mat3<double>::*const entries[] = {
            &core::Mat3<double>::xx, &core::Mat3<double>::xy, &core::Mat3<double>::xz,
            &core::Mat3<double>::yx, &core::Mat3<double>::yy, &core::Mat3<double>::yz,
            &core::Mat3<double>::zx, &core::Mat3<double>::zy, &core::Mat3<double>::zz};
        for (const auto entry : entries) total.*entry += value * component->direction.*entry;
      }
    }
    // The first component is the measure; all strains grow with time, so the drive is one unit of the leg.
    leg.direction = total;
    leg.whole = true;
    return leg;
  }

  std::string_view text_;
  const PathDefaults& defaults_;
  std::string kind_;
  std::vector<double> numbers_;
  std::vector<std::string_view> assignments_;
  std::string file_;
  std::optional<double> stress_, rate_, time_, confining_;
  std::optional<int> steps_;
};

/// Whether the strains of b are measured from the start of the sequence of legs to which a belongs.
bool same_run(const Leg& a, const Leg& b) {
  if (a.kind != b.kind || a.kind == "mixed" || a.kind == "table") return false;
  const bool confined = a.kind == "triaxial" || a.kind == "biaxial";
  return !confined || a.controls[0].target == b.controls[0].target;
}

}  // namespace

std::vector<Leg> parse_path(std::string_view text, const PathDefaults& defaults) {
  std::vector<Leg> all;
  std::optional<Leg> last;  // other than hold
  for (int round = 0; round < defaults.repeat; ++round) {
    for (const std::string_view part : io::split(text, ';')) {
      if (part.empty()) continue;  // a semicolon at the end
      const LegReader reader(part, defaults);
      std::vector<Leg> legs = reader.read();
      // A confined leg that continues at the same pressure does not require a leg to reach it.
      if (legs.size() > 1 && legs[0].kind != legs[1].kind && last && same_run(*last, legs[1]))
        legs.erase(legs.begin());
      for (Leg& leg : legs) {
        if (leg.kind == "hold") {  // belongs to the sequence of legs that it interrupts
          if (last) leg.measure = last->measure;
        } else {
          leg.from_zero = !last || !same_run(*last, leg);
          last = leg;
        }
        all.push_back(std::move(leg));
      }
    }
  }
  if (all.empty()) throw PathError("the path is empty; as in: --path \"uniaxial_stress 0.2 rate 1000\"");
  return all;
}

std::vector<physics::DeformationRow> read_deformation(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw PathError(fmt::format("table {}: cannot be read", file));
  std::vector<physics::DeformationRow> rows;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || !io::parse_real(words[0])) continue;
    const auto fail = [&](const std::string& why) {
      throw PathError(fmt::format("table {}, line {}: {}", file, number, why));
    };
    std::array<double, 10> v{};
    if (words.size() != v.size()) fail(fmt::format("{} numbers, expected time and nine of F", words.size()));
    for (std::size_t i = 0; i < v.size(); ++i) {
      const std::optional<double> value = io::parse_real(words[i]);
      if (!value) fail(fmt::format("'{}' is not a number", words[i]));
      v[i] = *value;
    }
    rows.push_back({v[0], {v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9]}});
    if (!(determinant(rows.back().gradient) > 0)) fail("the determinant of F is not positive");
    // The point starts undeformed, and goes from row to row.
    if (rows.size() == 1 && !is_identity(rows[0].gradient))
      fail("the first F is not the identity, 1 0 0 0 1 0 0 0 1: begin with the undeformed material");
    if (rows.size() > 1 && !(rows.back().time > rows[rows.size() - 2].time))
      fail("the time does not increase");
  }
  if (rows.size() < 2) throw PathError(fmt::format("table {}: fewer than two rows of numbers", file));
  return rows;
}

std::string path_help() {
  std::string text =
      "A path is one or more legs, separated by semicolons:\n"
      "  KIND NUMBERS [rate R | time T] [steps N]\n\n";
  for (const Kind& kind : kinds)
    text += fmt::format("  {} {}\n      {}\n", kind.name, kind.usage, kind.meaning);
  text +=
      "\nStrains are logarithmic and rates true; pressure is positive in compression, strain and stress in "
      "tension.\n"
      "Several numbers are reached in sequence, measured from the start of consecutive legs of the same "
      "kind.\n"
      "'stress S time T' instead of the strain ends a uniaxial_stress or simple_shear leg at that "
      "stress.\n\n"
      "  --path \"uniaxial_stress 0.2 rate 1000\"\n"
      "  --path \"uniaxial_stress 0.01 -0.01\" --repeat 5                     five cycles\n"
      "  --path \"triaxial -0.1 confining 10; triaxial -0.05 confining 10\"   compression and back\n"
      "  --path \"uniaxial_stress stress 100 time 1; hold time 5\"            load, then relaxation\n"
      "  --path \"mixed e_xx=0.01 s_yy=-20 s_zz=0 time 1\"                    any mix of six strains and "
      "stresses\n";
  return text;
}

}  // namespace mpm::apps
