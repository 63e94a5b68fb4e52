#include "io/input/material_reader.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/input/build.hpp"
#include "io/input/checker.hpp"
#include "io/input/library.hpp"
#include "io/input/reader.hpp"
#include "io/input/text.hpp"
#include "io/input/xml_writer.hpp"

namespace mpm::io {

namespace {

/// The language with only materials required.
ElementSpec language_of_materials(const core::Catalogue& catalogue) {
  ElementSpec root = language(catalogue);
  for (ElementSpec& child : root.children)
    if (child.name != "Material") child.required = false;
  return root;
}

std::optional<std::string_view> attribute(const Document& document, std::uint32_t element,
                                          std::string_view name) {
  for (const XmlAttribute& a : document.attributes(document.elements()[element]))
    if (a.name == name) return a.value;
  return {};
}

std::vector<std::uint32_t> children(const Document& document, std::uint32_t parent, std::string_view name) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = document.elements()[parent].first_child; i != 0;
       i = document.elements()[i].next_sibling)
    if (name.empty() || document.elements()[i].name == name) found.push_back(i);
  return found;
}

std::uint32_t choose(const Document& document, const std::string& name, const Diagnostics& diagnostics) {
  const std::vector<std::uint32_t> materials = children(document, 0, "Material");
  std::vector<std::string_view> names;
  for (const std::uint32_t m : materials) {
    const std::string_view its_name = attribute(document, m, "name").value_or("");
    if (its_name == name || (name.empty() && materials.size() == 1)) return m;
    names.push_back(its_name);
  }
  const std::string list = join({names.begin(), names.end()}, ", ");
  throw core::InputErrors(
      core::SourceLocation{diagnostics.file(), 0}, {},
      names.empty() ? std::string("the file contains no material")
      : name.empty()
          ? fmt::format("the file contains several materials; choose one with --material: {}", list)
          : fmt::format("the file contains no material '{}'{}; it contains {}", name,
                        did_you_mean(name, names), list));
}

/// Up to the rounding of exponents.
bool same(const core::Dimension& a, const core::Dimension& b) {
  constexpr double rounding = 1e-9;
  const core::Dimension d = a / b;
  return std::max({std::abs(d.length), std::abs(d.mass), std::abs(d.time), std::abs(d.temperature)}) <=
         rounding;
}

std::string in_words(const core::Dimension& dimension) {
  return same(dimension, {}) ? "a number without a unit" : "a unit of " + core::to_text(dimension);
}

/// Overrides single values of a material in the document, so that they are checked like all others.
class Setter {
 public:
  Setter(Document& document, std::uint32_t material, const ElementSpec& language, Diagnostics& diagnostics)
      : document_(document),
        material_(material),
        language_(*language.child("Material")),
        diagnostics_(diagnostics),
        units_(units_of(document)) {}

  void set(const std::string& setting) {
    const std::size_t equals = setting.find('=');
    if (equals == setting.npos) return report(setting, "expected NAME=VALUE");
    const std::string_view value = trim(std::string_view(setting).substr(equals + 1));
    std::string_view name = trim(std::string_view(setting).substr(0, equals)), element;
    if (name == "ReferenceDensity") name = "ReferenceDensity.value";
    if (const std::size_t dot = name.find('.'); dot != name.npos) {
      element = name.substr(0, dot);
      name = name.substr(dot + 1);
    }
    std::vector<std::uint32_t> places;
    std::vector<const AttributeSpec*> rows;
    std::vector<std::string> elements;
    std::vector<std::string_view> known;
    for (const std::uint32_t child : children(document_, material_, element)) {
      const ElementSpec* spec = language_.child(document_.elements()[child].name);
      if (!spec) continue;
      const std::string_view type = attribute(document_, child, "type").value_or("");
      for (const AttributeSpec& a : spec->attributes)
        if (a.applies_to(type)) known.push_back(a.name);
      const AttributeSpec* row = spec->attribute(name, type);
      if (!row) continue;
      places.push_back(child);
      rows.push_back(row);
      elements.push_back(fmt::format("{}.{}", spec->name, name));
    }
    if (places.empty())
      return report(setting, fmt::format("the material has no '{}'{}", name, did_you_mean(name, known)));
    if (places.size() > 1)
      return report(setting,
                    fmt::format("more than one law has this parameter: use {}", join(elements, " or ")));
    document_.set_attribute(places[0], name, in_units_of_the_input(value, setting, places[0], *rows[0]), 0);
  }

 private:
  void report(const std::string& setting, const std::string& message) {
    diagnostics_.add(0, {}, fmt::format("--set {}: {}", setting, message));
  }

  /// Of a parameter of the law; its exponents may be other parameters.
  core::Dimension dimension_of(std::uint32_t element, const AttributeSpec& row) const {
    if (row.unit.empty()) return {};
    const ElementSpec& spec = *language_.child(document_.elements()[element].name);
    return core::parse_dimension(row.unit, [&](std::string_view name) -> std::optional<double> {
      if (const auto given = attribute(document_, element, name)) return parse_real(*given);
      const AttributeSpec* other = spec.attribute(name, attribute(document_, element, "type").value_or(""));
      return other && other->default_value ? parse_real(*other->default_value) : std::nullopt;
    });
  }

  std::string in_units_of_the_input(std::string_view value, const std::string& setting, std::uint32_t element,
                                    const AttributeSpec& row) {
    if (parse_real(value) || value.find(' ') == value.npos) return std::string(value);
    try {
      const core::Quantity quantity = core::parse_quantity(value);
      const core::Dimension expected = dimension_of(element, row);
      if (!same(quantity.unit.dimension, expected)) {
        report(setting, fmt::format("expected {}, not of {}", in_words(expected),
                                    core::to_text(quantity.unit.dimension)));
      } else if (units_) {
        return fmt::format("{}", units_->value_of(quantity));
      } else {
        report(setting, "the input does not state its units, so a unit cannot be converted");
      }
    } catch (const core::UnitError& error) { report(setting, error.what()); }
    return std::string(value.substr(0, value.find(' ')));
  }

  Document& document_;
  std::uint32_t material_;
  const ElementSpec& language_;
  Diagnostics& diagnostics_;
  std::optional<core::UnitSystem> units_;
};

}  // namespace

MaterialChoice parse_material(std::string_view bytes, const std::filesystem::path& file,
                              const core::Catalogue& catalogue, const MaterialRequest& request) {
  const ElementSpec root = language_of_materials(catalogue);
  Diagnostics diagnostics(file.string());
  std::optional<XmlError> error;
  Document document = parse_document(bytes, error);
  if (error) diagnostics.add(error->line, {}, error->message);
  diagnostics.raise_if_any();
  if (document.elements().front().name != root.name) {
    check(document, root, false, diagnostics);
    diagnostics.raise_if_any();
  }
  fill_in_from_library(document, library(), diagnostics);
  diagnostics.raise_if_any();
  const std::uint32_t chosen = choose(document, request.material, diagnostics);
  Setter setter(document, chosen, root, diagnostics);
  for (const std::string& setting : request.settings) setter.set(setting);
  check(document, root, false, diagnostics);

  const Node node(document, 0, root, {});
  const BuildContext context{diagnostics, file.parent_path(), false};
  MaterialChoice choice;
  choice.units = units_of(document);
  const std::vector<core::MaterialInput> materials = build_materials(node, context);
  choice.detonations = build_detonations(node, context);
  if (node.child("Solution"))
    choice.volume_update = static_cast<int>(build_solution(node, context).volume.update);
  diagnostics.raise_if_any();
  const std::vector<std::uint32_t> all = children(document, 0, "Material");
  choice.material = materials[static_cast<std::size_t>(std::ranges::find(all, chosen) - all.begin())];
  return choice;
}

MaterialChoice read_material(const std::filesystem::path& job, const core::Catalogue& catalogue,
                             const MaterialRequest& request) {
  const std::filesystem::path file = find_input(job);
  return parse_material(read_bytes(file), file, catalogue, request);
}

MaterialChoice library_material(std::string_view names, std::string_view units,
                                const core::Catalogue& catalogue, std::vector<std::string> settings) {
  XmlWriter writer;
  {
    const auto root = writer.element("PeneBlast");
    writer.text("version", "1.0");
    const auto material = writer.element("Material");
    writer.text("name", names);
    writer.text("library", names);
    writer.text("units", units);
  }
  return parse_material(std::move(writer).take(), "library", catalogue, {{}, std::move(settings)});
}

}  // namespace mpm::io
