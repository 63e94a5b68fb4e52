#include "io/input/echo.hpp"

#include <fmt/format.h>

#include "io/input/contact_words.hpp"
#include "io/input/echo_parts.hpp"
#include "io/input/text.hpp"
#include "io/input/xml_writer.hpp"

namespace mpm::io {

namespace {

void echo_header(XmlWriter& w, const core::HeaderInput& header) {
  const auto scope = w.element("Header");
  const auto value = [&](std::string_view name, const std::string& text) {
    if (text.empty()) return;
    const auto child = w.element(name);
    w.text("value", text);
  };
  value("Name", header.name);
  value("Heading", header.heading);
  value("Description", header.description);
  const auto unit = w.element("Unit");
  if (!header.time_unit.empty()) w.text("time", header.time_unit);
  if (!header.length_unit.empty()) w.text("length", header.length_unit);
  if (!header.mass_unit.empty()) w.text("mass", header.mass_unit);
}

void echo_values(XmlWriter& w, const core::LawInput& law) {
  w.text("type", law.type);
  for (const auto& [attribute, value] : law.values) w.number(attribute, value);
}

void echo_strength(XmlWriter& w, const core::MaterialInput& material) {
  const auto scope = w.element("StrengthModel");
  echo_values(w, material.strength);
  w.text("limiter", material.limiter == core::ViscosityLimiter::shock ? "shock" : "none");
}

void echo_eos(XmlWriter& w, const core::LawInput& law) {
  const auto scope = w.element("EquationOfState");
  echo_values(w, law);
}

void echo_failure(XmlWriter& w, const core::FailureInput& failure) {
  const auto scope = w.element("FailureModel");
  w.text("type", failure.type);
  w.flag("Erosion", failure.erosion);
  for (const auto& [attribute, value] : failure.values) w.number(attribute, value);
}

void echo_material(XmlWriter& w, const core::MaterialInput& material) {
  const auto scope = w.element("Material");
  w.text("name", material.name);
  {
    const auto density = w.element("ReferenceDensity");
    w.number("value", material.reference_density);
  }
  echo_strength(w, material);
  if (material.eos) echo_eos(w, *material.eos);
  for (const core::FailureInput& failure : material.failures) echo_failure(w, failure);
  const core::RandomFailureInput& random = material.random_failure;
  if (!random.enable) return;
  const auto element = w.element("RandomFailure");
  w.flag("enable", random.enable);
  w.integer("RandomType", static_cast<int>(random.spread));
  w.integer("FailDistribution", static_cast<int>(random.distribution));
  w.number("GaussMean", random.gauss_mean);
  w.number("GaussStd", random.gauss_deviation);
  w.number("WeibMed", random.weibull_median);
  w.number("WeibMod", random.weibull_modulus);
  w.number("WeibRefVol", random.weibull_reference_volume);
  w.number("WeibPartVol", random.weibull_particle_volume);
  w.flag("DamageRandom", random.random_damage);
}

void echo_frictions(XmlWriter& w, const core::Scene& scene) {
  if (scene.frictions.empty()) return;
  const auto scope = w.element("Friction");
  for (const core::FrictionPair& pair : scene.frictions) {
    const auto element = w.element("Coefficient");
    if (pair.friction.rough)
      w.flag("rough", true);
    else
      w.number("value", pair.friction.coefficient);
    w.text("mat1", scene.materials[pair.first_material].name);
    w.text("mat2", scene.materials[pair.second_material].name);
  }
}

void echo_work_plane(XmlWriter& w, const core::WorkPlane& plane) {
  const auto scope = w.element("WorkPlane");
  w.text("name", plane.name);
  w.numbers("r0x", "r0y", "r0z", plane.origin);
  w.numbers("ex", "ey", "ez", plane.z_axis);
  w.numbers("a11", "a21", "a31", plane.x_axis);
}

void echo_detonations(XmlWriter& w, const std::vector<core::DetonationItem>& items) {
  if (items.empty()) return;
  const auto scope = w.element("Detonation");
  for (const core::DetonationItem& item : items) {
    const auto element = w.element("Item");
    const bool plane = item.kind == core::DetonationItem::Kind::plane;
    w.text("type", plane ? "plane" : "point");
    w.number("time", item.time);
    if (!plane) {
      w.numbers("x", "y", "z", item.position);
      continue;
    }
    w.integer("normal", item.normal);
    w.number("location", item.location);
    w.number("left", item.lower[0]);
    w.number("right", item.upper[0]);
    w.number("bottom", item.lower[1]);
    w.number("top", item.upper[1]);
  }
}

void echo_contact(XmlWriter& w, const core::ContactInput& contact) {
  const auto scope = w.element("Contact");
  w.flag("enable", contact.enable);
  w.flag("failure_to_component", contact.failed_to_component);
  w.flag("auto_normal_vector_weight", contact.automatic_weights);
  w.flag("normal_vector_excluding_failure_particle", contact.ignore_failed_normals);
  w.integer("distance_type", static_cast<int>(contact.distance));
  w.number("min_distance", contact.min_distance);
  w.flag("contact_time_step", contact.limits_time_step);
  w.integer("contact_type", static_cast<int>(contact.method));
  w.flag("record_contact_force", contact.record_force);
  w.text("contact_normal", contact_normals[static_cast<std::size_t>(contact.normal)]);
}

void echo_decomposition(XmlWriter& w, const core::DecompositionInput& decomposition) {
  if (decomposition.method == core::PartitionMethod::automatic) return;
  const auto scope = w.element("DomainDecomposition");
  if (decomposition.dimensions)
    for (std::size_t i = 0; i < 3; ++i)
      w.integer(fmt::format("dimension{}", i), (*decomposition.dimensions)[i]);
  w.text("method", decomposition.method == core::PartitionMethod::metis ? "metis" : "uniform");
  if (decomposition.rebalance_interval)
    w.integer("rebalance_interval", *decomposition.rebalance_interval);
  else
    w.text("rebalance_interval", "auto");
  w.number("imbalance_tolerance", decomposition.imbalance_tolerance);
}

}  // namespace

std::string to_text(const core::Scene& scene) {
  XmlWriter w;
  {
    const auto root = w.element("PeneBlast");
    w.text("version", "1.0");
    echo_header(w, scene.header);
    for (const core::MaterialInput& material : scene.materials) echo_material(w, material);
    echo_frictions(w, scene);
    for (const core::WorkPlane& plane : scene.work_planes) echo_work_plane(w, plane);
    for (const core::ComponentInput& component : scene.components) echo_component(w, component, scene);
    echo_detonations(w, scene.detonations);
    echo_grid(w, scene.grid);
    echo_contact(w, scene.contact);
    echo_solution(w, scene.solution);
    echo_output(w, scene.output);
    echo_decomposition(w, scene.decomposition);
  }
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + std::move(w).take();
}

}  // namespace mpm::io
