// Header, materials and friction; resolution of names.

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "io/input/build.hpp"
#include "io/input/text.hpp"

namespace mpm::io {

std::optional<std::size_t> resolve(const Node& node, std::string_view attribute, std::string_view kind,
                                   const std::vector<std::string_view>& names, const BuildContext& context) {
  const std::string name = node.word(attribute);
  if (name.empty()) return {};
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  node.report(context.diagnostics, attribute,
              fmt::format("there is no {} of this name{}", kind, did_you_mean(name, names)));
  return {};
}

void check_unique_names(const std::vector<Node>& nodes, std::string_view kind, const BuildContext& context) {
  std::map<std::string, int> lines;
  for (const Node& node : nodes) {
    const std::string name = node.word("name");
    if (name.empty()) continue;
    const auto [first, is_first] = lines.emplace(name, node.line());
    if (!is_first)
      node.report(context.diagnostics, "name",
                  fmt::format("another {} has this name already, on line {}", kind, first->second));
  }
}

core::HeaderInput build_header(const Node& root) {
  core::HeaderInput header;
  const std::optional<Node> node = root.child("Header");
  if (!node) return header;
  const auto value_of = [&](std::string_view child) {
    const std::optional<Node> found = node->child(child);
    return found ? found->word("value") : std::string();
  };
  header.name = value_of("Name");
  header.heading = value_of("Heading");
  header.description = value_of("Description");
  if (const std::optional<Node> unit = node->child("Unit")) {
    header.time_unit = unit->word("time");
    header.length_unit = unit->word("length");
    header.mass_unit = unit->word("mass");
  }
  return header;
}

namespace {

core::LawInput build_law(const Node& node, const BuildContext& context) {
  core::LawInput law{std::string(node.type()), {}, context.at(node)};
  for (const AttributeSpec& row : node.spec().attributes) {
    if (row.type == ValueType::text || !row.applies_to(node.type())) continue;
    const double value = node.real(row.name);
    if (value == value) law.values.emplace(row.name, value);
  }
  return law;
}

std::vector<core::FailureInput> build_failures(const Node& material, const BuildContext& context) {
  std::vector<core::FailureInput> failures;
  const std::vector<Node> nodes = material.children("FailureModel");
  constexpr std::size_t most = 10;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i == most)
      nodes[i].report(context.diagnostics, fmt::format("a material has at most {} failure models", most));
    core::FailureInput failure{build_law(nodes[i], context), nodes[i].boolean("Erosion")};
    failure.values.erase("Erosion");
    if (failure.type != "none") failures.push_back(std::move(failure));
  }
  return failures;
}

core::RandomFailureInput build_random_failure(const Node& material) {
  using Random = core::RandomFailureInput;
  Random random;
  const std::optional<Node> node = material.child("RandomFailure");
  if (!node) return random;
  random.enable = node->boolean("enable");
  random.spread = static_cast<Random::Spread>(node->small_integer("RandomType"));
  random.distribution = static_cast<Random::Distribution>(node->small_integer("FailDistribution"));
  random.gauss_mean = node->real("GaussMean");
  random.gauss_deviation = node->real("GaussStd");
  random.weibull_median = node->real("WeibMed");
  random.weibull_modulus = node->real("WeibMod");
  random.weibull_reference_volume = node->real("WeibRefVol");
  random.weibull_particle_volume = node->real("WeibPartVol");
  random.random_damage = node->boolean("DamageRandom");
  return random;
}

}  // namespace

std::vector<core::MaterialInput> build_materials(const Node& root, const BuildContext& context) {
  std::vector<core::MaterialInput> materials;
  const std::vector<Node> nodes = root.children("Material");
  check_unique_names(nodes, "material", context);
  for (const Node& node : nodes) {
    core::MaterialInput material;
    material.name = node.word("name");
    material.source = context.at(node);
    if (const auto density = node.child("ReferenceDensity"))
      material.reference_density = density->real("value");
    if (const auto strength = node.child("StrengthModel")) {
      material.strength = build_law(*strength, context);
      if (strength->word("limiter") == "shock") material.limiter = core::ViscosityLimiter::shock;
    }
    if (const auto eos = node.child("EquationOfState")) material.eos = build_law(*eos, context);
    material.failures = build_failures(node, context);
    material.random_failure = build_random_failure(node);
    materials.push_back(std::move(material));
  }
  return materials;
}

std::vector<core::FrictionPair> build_frictions(const Node& root,
                                                const std::vector<core::MaterialInput>& materials,
                                                const BuildContext& context) {
  std::vector<core::FrictionPair> pairs;
  const std::optional<Node> friction = root.child("Friction");
  if (!friction) return pairs;
  const std::vector<std::string_view> names = names_of(materials);
  for (const Node& node : friction->children("Coefficient")) {
    const auto first = resolve(node, "mat1", "material", names, context);
    const auto second = resolve(node, "mat2", "material", names, context);
    if (!first || !second) continue;
    const std::size_t low = std::min(*first, *second), high = std::max(*first, *second);
    if (std::ranges::any_of(
            pairs, [&](const auto& p) { return p.first_material == low && p.second_material == high; }))
      node.report(context.diagnostics, "the friction of this pair of materials is given twice");
    const bool rough = node.boolean("rough"), slides = node.find("value") != nullptr;
    if (rough && slides)
      node.report(context.diagnostics, "value", "rough surfaces do not slide: remove value or rough");
    if (!rough && !slides)
      node.report(context.diagnostics, "expected value, the coefficient of friction, or rough=\"1\"");
    pairs.push_back({low, high, {rough ? core::Friction::of_rough : node.real("value"), rough}});
  }
  return pairs;
}

}  // namespace mpm::io
