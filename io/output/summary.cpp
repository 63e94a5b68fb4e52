#include "io/output/summary.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/contact/contact_record.hpp"
#include "core/version.hpp"
#include "io/output/file.hpp"
#include "io/output/provenance.hpp"

namespace mpm::io {

using Json = nlohmann::ordered_json;

namespace {

Json to_json(const core::Vec3<double>& v) { return Json::array({v.x, v.y, v.z}); }

Json energy_json(const core::Model& model, const core::Totals& totals) {
  const core::EnergyBalance balance = core::energy_balance(totals, model.initial_energy);
  return {{"kinetic", totals.kinetic},
          {"internal", totals.internal},
          {"external_work", totals.external_work},
          {"dissipated_by_contact", totals.dissipated_by_contact},
          {"total", balance.total},
          {"initial_total", model.initial_energy},
          {"relative_drift", balance.relative_drift}};
}

/// What contact has done since time zero, in all and by pair of components.
Json contact_json(const core::Scene& scene, const core::Totals& totals,
                  const std::vector<core::ContactPairTotals>& of_pairs) {
  const auto components = static_cast<std::int32_t>(core::component_count(scene));
  const core::ContactPairs numbers(core::component_count(scene));
  const auto name = [&](std::int32_t c) {
    return c == core::failed_component(scene) ? std::string("failed particles")
                                              : scene.components[static_cast<std::size_t>(c)].name;
  };
  Json pairs = Json::array();
  for (std::int32_t b = 1; b < components; ++b) {
    for (std::int32_t a = 0; a < b; ++a) {
      const int number = numbers.number(a, b);
      if (number < 0) continue;
      const core::ContactPairTotals& pair = of_pairs[static_cast<std::size_t>(number)];
      pairs.push_back({{"components", {name(a), name(b)}},
                       {"impulse", to_json(pair.impulse)},
                       {"friction_heat", pair.friction_heat}});
    }
  }
  return {{"dissipated", totals.dissipated_by_contact},
          {"friction_heat", totals.friction_heat},
          {"pairs", pairs}};
}

Json body_json(const core::Model& model, const core::Body& body, const core::BodyTotals& totals) {
  const core::Scene& scene = *model.scene;
  Json json{{"name", body.name},
            {"material", scene.materials[static_cast<std::size_t>(body.material)].name},
            {"component", scene.components[static_cast<std::size_t>(body.component)].name},
            {"particles", totals.particles},
            {"active", totals.particles - totals.failed},
            {"failed", totals.failed},
            {"eroded", totals.eroded},
            {"mass", totals.mass},
            {"centre", to_json(totals.centre)},
            {"velocity", to_json(totals.velocity)},
            {"lower", to_json(totals.lower)},
            {"upper", to_json(totals.upper)},
            {"kinetic", totals.kinetic},
            {"internal", totals.internal},
            {"max_epef", totals.max_effective_plastic_strain},
            {"max_temperature", totals.max_temperature}};
  if (body.rigid_state) json["angular_velocity"] = to_json(body.rigid_state->spin);
  return json;
}

Json seconds_json(const RunReport& report) {
  Json seconds{{"total", report.seconds_total},
               {"setup", report.seconds_setup},
               {"loop", report.seconds_loop},
               {"output", report.output.mean}};
  for (const auto& [name, spread] : report.phases) seconds[name] = spread.mean;
  return seconds;
}

/// Of the particles' state, without what the grid needs.
double bytes_per_particle(const core::Model& model, const core::Totals& totals) {
  double bytes = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    bytes +=
        static_cast<double>(totals.bodies[b].particles) * model.bodies[b].pool->layout().bytes_per_particle();
  }
  return totals.particles > 0 ? bytes / static_cast<double>(totals.particles) : 0;
}

}  // namespace

std::string summary_json(const core::Model& model, const core::Totals& totals, const RunReport& report,
                         int ranks, const MemoryUse& memory,
                         const std::vector<core::ContactPairTotals>& pairs) {
  const core::Scene& scene = *model.scene;
  Json bodies = Json::array();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    bodies.push_back(body_json(model, model.bodies[b], totals.bodies[b]));
  }
  Json summary{
      {"job", scene.provenance.job_name},
      {"version", core::version},
      {"git", git_text()},
      {"status", report.status},
      {"reason", report.reason},
      {"ranks", ranks},
      {"threads", report.threads},
      {"steps", model.clock.step},
      {"time", model.clock.time},
      {"end_time", scene.solution.end_time},
      {"particles", totals.particles},
      {"wall_seconds", seconds_json(report)},
      {"particle_steps_per_second",
       report.seconds_loop > 0 ? report.particle_steps / report.seconds_loop : 0.0},
      {"bytes_per_particle", bytes_per_particle(model, totals)},
      {"peak_memory_bytes", {{"max", memory.largest}, {"sum", memory.sum}}},
      {"energy", energy_json(model, totals)},
      {"momentum", to_json(totals.momentum)},
      {"angular_momentum", to_json(totals.angular_momentum)},
      {"bodies", bodies},
      {"input_hash", scene.provenance.hash},
      {"units",
       {{"time", scene.header.time_unit},
        {"length", scene.header.length_unit},
        {"mass", scene.header.mass_unit}}},
  };
  if (model.clock.scheme_since > 0)
    summary["scheme_change"] = {{"to", "USAVG"}, {"after_step", model.clock.scheme_since}};
  if (scene.contact.enable) summary["contact"] = contact_json(scene, totals, pairs);
  return summary.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

void write_summary(const std::string& path, const core::Model& model, const core::Totals& totals,
                   const RunReport& report, core::Reductions& ranks) {
  const MemoryUse memory = peak_memory(ranks);
  const std::vector<core::ContactPairTotals> pairs = core::contact_pair_totals(model, ranks);
  together(ranks, [&] {
    if (ranks.rank() == 0)
      replace_file(path, summary_json(model, totals, report, ranks.size(), memory, pairs));
  });
}

std::string timing_table(const RunReport& report) {
  std::size_t widest = 5;
  for (const auto& [name, spread] : report.phases) widest = std::max(widest, name.size());
  for (const RunReport::Part& part : report.parts) widest = std::max(widest, part.name.size() + 2);
  std::string text = fmt::format("{:<{}} {:>10} {:>10} {:>10} {:>8} {:>10}\n", "phase", widest, "min s",
                                 "mean s", "max s", "share", "imbalance");
  const auto add = [&](const std::string& name, const core::Spread& s) {
    const double share = report.seconds_loop > 0 ? 100 * s.mean / report.seconds_loop : 0;
    const double imbalance = s.mean > 0 ? 100 * (s.max / s.mean - 1) : 0;
    text += fmt::format("{:<{}} {:>10.3f} {:>10.3f} {:>10.3f} {:>7.1f}% {:>9.1f}%\n", name, widest, s.min,
                        s.mean, s.max, share, imbalance);
  };
  double rest = report.seconds_loop - report.output.mean;
  for (const auto& [name, spread] : report.phases) {
    add(name, spread);
    rest -= spread.mean;
    for (const RunReport::Part& part : report.parts)
      if (part.phase == name) add("  " + part.name, part.seconds);
  }
  add("output", report.output);
  text += fmt::format("{:<{}} {:>10} {:>10.3f} {:>10} {:>7.1f}%\n", "other", widest, "", rest, "",
                      report.seconds_loop > 0 ? 100 * rest / report.seconds_loop : 0.0);
  text += fmt::format("{:<{}} {:>10} {:>10.3f}\n", "loop", widest, "", report.seconds_loop);
  return text;
}

}  // namespace mpm::io
