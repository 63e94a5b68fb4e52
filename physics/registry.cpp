#include "physics/registry.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "core/units/units.hpp"
#include "physics/material/common_parameters.hpp"

namespace mpm::physics {

namespace {

/// Whether a text is a valid attribute name: letters, digits, - and _, not beginning with a digit.
bool is_word(std::string_view text) {
  const auto good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  return !text.empty() && std::ranges::all_of(text, good) &&
         std::isdigit(static_cast<unsigned char>(text.front())) == 0;
}

/// Errors in the parameter itself.
std::vector<std::string> faults_of(const core::ParameterInfo& p) {
  std::vector<std::string> faults;
  if (!is_word(p.name)) faults.emplace_back("its name is not a word of letters, digits, - and _");
  if (p.name == "type" || p.name == "Erosion")
    faults.emplace_back("the input format already has an attribute of this name: choose another");
  if (p.meaning.empty()) faults.emplace_back("no meaning: add .meaning, one line for the keyword reference");
  const bool bounded = std::isfinite(p.min) || std::isfinite(p.max);
  if (!bounded && !p.any_number)
    faults.emplace_back(
        "no range: add .min, .max or both, or .any_number = true if every finite number is valid");
  if (std::isnan(p.min) || std::isnan(p.max) || p.min > p.max ||
      (p.min == p.max && (p.min_open || p.max_open)))
    faults.emplace_back("no number lies in its range");
  const double d = p.default_value;
  if (!p.required && (d < p.min || d > p.max || (p.min_open && d == p.min) || (p.max_open && d == p.max)))
    faults.emplace_back("its default lies outside of its range");
  try {
    core::parse_dimension(p.dimension, [](std::string_view) { return 1.0; });
  } catch (const core::UnitError& error) {
    faults.push_back("dimension '" + std::string(p.dimension) + "': " + error.what());
  }
  return faults;
}

std::vector<std::string> faults_of(const core::TypeInfo& info, const BuildTraits& build) {
  std::vector<std::string> faults;
  if (build != BuildTraits::here())
    faults.emplace_back(
        ": it was compiled with headers or definitions other than the library's (MPM_SIMD_LANES, "
        "MPM_ASSERTIONS, version): link the CMake target mpm::mpm and rebuild");
  if (!is_word(info.name))
    faults.emplace_back(": the name is not a word of letters, digits, - and _, as in type=\"MyLaw\"");
  if (info.summary.empty()) faults.emplace_back(": no summary, one line for the keyword reference");
  std::set<std::string_view> names;
  for (const core::ParameterInfo& p : info.parameters) {
    const std::string where = ", parameter '" + std::string(p.name) + "': ";
    if (!names.insert(p.name).second) faults.push_back(where + "it is declared twice");
    for (const std::string& fault : faults_of(p)) faults.push_back(where + fault);
  }
  return faults;
}

/// Adds an external law to its family, or its errors to `faults`.
template <class Entry>
void take_into(std::vector<Entry>& family, std::size_t built_in, std::string_view element, Entry entry,
               const BuildTraits& build, std::vector<std::string>& faults, std::vector<std::string>& added) {
  const std::string law = std::string(element) + " '" + std::string(entry.info.name) + "'";
  std::vector<std::string> found = faults_of(entry.info, build);
  const auto same = std::ranges::find(family, entry.info.name, [](const Entry& e) { return e.info.name; });
  if (same != family.end()) {
    found.emplace_back(static_cast<std::size_t>(same - family.begin()) < built_in
                           ? ": a built-in law has this name: choose another"
                           : ": another law of this name was added before: choose another");
  }
  if (element == failure_element && entry.info.name == "none")
    found.emplace_back(": the word 'none' means no failure model: choose another");
  for (const std::string& fault : found) faults.push_back(law + fault);
  if (!found.empty()) return;
  added.push_back(std::string(element) + " " + std::string(entry.info.name));
  family.push_back(std::move(entry));
}

/// Laws that share a name and differ by a parameter are one type with the parameters of all.
template <class Entry>
std::vector<core::TypeInfo> types(const std::vector<Entry>& family) {
  std::vector<core::TypeInfo> infos;
  for (const Entry& entry : family) {
    const auto same = std::ranges::find(infos, entry.info.name, &core::TypeInfo::name);
    if (same == infos.end()) {
      infos.push_back(entry.info);
      continue;
    }
    for (const core::ParameterInfo& parameter : entry.info.parameters) {
      if (std::ranges::find(same->parameters, parameter.name, &core::ParameterInfo::name) ==
          same->parameters.end())
        same->parameters.push_back(parameter);
    }
  }
  return infos;
}

template <class Entry>
auto make(const std::vector<Entry>& family, std::string_view element, const core::LawInput& input,
          double reference_density) {
  for (const Entry& entry : family) {
    if (entry.info.name != input.type || (entry.chosen != nullptr && !entry.chosen(input))) continue;
    return entry.make(input, reference_density);
  }
  throw core::InputErrors(input.source, std::string(element), input.type + " is not implemented");
}

}  // namespace

Registry::Registry() : strength_(built_in_strength()), eos_(built_in_eos()), failure_(built_in_failure()) {}

void Registry::take(StrengthLawEntry entry, const BuildTraits& build) {
  static const std::size_t built_in = built_in_strength().size();
  take_into(strength_, built_in, strength_element, std::move(entry), build, faults_, added_);
}
void Registry::take(EosLawEntry entry, const BuildTraits& build) {
  static const std::size_t built_in = built_in_eos().size();
  take_into(eos_, built_in, eos_element, std::move(entry), build, faults_, added_);
}
void Registry::take(FailureLawEntry entry, const BuildTraits& build) {
  static const std::size_t built_in = built_in_failure().size();
  take_into(failure_, built_in, failure_element, std::move(entry), build, faults_, added_);
}

core::Catalogue Registry::catalogue() const {
  core::Catalogue all;
  all.common_strength = parameter_infos<CommonParameters>();
  all.common_eos = parameter_infos<CommonEosParameters>();
  all.strength = types(strength_);
  all.eos = types(eos_);
  all.failure = types(failure_);
  all.failure.insert(all.failure.begin(), {"none", "never fails", {}});
  return all;
}

std::unique_ptr<StrengthLaw> Registry::make_strength(const core::LawInput& input,
                                                     double reference_density) const {
  return make(strength_, strength_element, input, reference_density);
}
std::unique_ptr<EosLaw> Registry::make_eos(const core::LawInput& input, double reference_density) const {
  return make(eos_, eos_element, input, reference_density);
}
std::unique_ptr<FailureLaw> Registry::make_failure(const core::LawInput& input,
                                                   double reference_density) const {
  return make(failure_, failure_element, input, reference_density);
}

const Registry& built_in_laws() {
  static const Registry laws;
  return laws;
}

}  // namespace mpm::physics
