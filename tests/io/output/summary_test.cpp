#include "io/output/summary.hpp"

#include <set>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "io/output/file.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;

namespace {

std::set<std::string> keys(const nlohmann::json& object) {
  std::set<std::string> names;
  for (const auto& entry : object.items()) names.insert(entry.key());
  return names;
}

io::RunReport report() {
  io::RunReport r;
  r.status = "stopped";
  r.reason = "asked to \"stop\"";
  r.threads = 2;
  r.seconds_total = 12;
  r.seconds_loop = 10;
  r.output = {0.5, 1, 1};
  r.phases = {{"particles to grid", {1, 2, 3}}, {"migrate", {4, 4, 4}}};
  r.parts = {{"migrate", "sending", {1, 1, 1}}};
  r.particle_steps = 601e3;
  return r;
}

}  // namespace

TEST_CASE("The summary keeps its contract") {
  const Folder folder("summary");
  core::SoloCommunication solo;
  const core::Model model = small_model(solo);
  const core::Totals totals = core::compute_totals(model, solo);
  io::write_summary(folder / "a.summary.json", model, totals, report(), solo);
  const auto summary = nlohmann::json::parse(io::read_file(folder / "a.summary.json"));
  const std::set<std::string> contract{"job",
                                       "version",
                                       "git",
                                       "status",
                                       "reason",
                                       "ranks",
                                       "threads",
                                       "steps",
                                       "time",
                                       "end_time",
                                       "particles",
                                       "wall_seconds",
                                       "particle_steps_per_second",
                                       "bytes_per_particle",
                                       "peak_memory_bytes",
                                       "energy",
                                       "momentum",
                                       "angular_momentum",
                                       "bodies",
                                       "input_hash",
                                       "units"};
  CHECK(keys(summary) == contract);
  CHECK(keys(summary["energy"]) == std::set<std::string>{"kinetic", "internal", "external_work",
                                                         "dissipated_by_contact", "total", "initial_total",
                                                         "relative_drift"});
  CHECK(keys(summary["wall_seconds"]) ==
        std::set<std::string>{"total", "setup", "loop", "output", "particles to grid", "migrate"});
  CHECK(keys(summary["peak_memory_bytes"]) == std::set<std::string>{"max", "sum"});
  CHECK(summary["job"] == "small");
  CHECK(summary["status"] == "stopped");
  CHECK(summary["reason"] == "asked to \"stop\"");
  CHECK(summary["steps"] == 120);
  CHECK(summary["particles"] == 601);
  CHECK(summary["particle_steps_per_second"] == 60.1e3);
  CHECK(summary["wall_seconds"]["particles to grid"] == 2);
  CHECK(summary["energy"]["kinetic"] == totals.kinetic);
  CHECK(summary["bytes_per_particle"].get<double>() == Approx(8 * (18 * 601 + 3 * 301) / 601.0));
  REQUIRE(summary["bodies"].size() == 3);
  const auto& bar = summary["bodies"][0];
  CHECK(keys(bar) == std::set<std::string>{"name", "material", "component", "particles", "active", "failed",
                                           "eroded", "mass", "centre", "velocity", "lower", "upper",
                                           "kinetic", "internal", "max_epef", "max_temperature"});
  CHECK(bar["component"] == "flyer");
  CHECK(bar["active"].get<int>() + bar["failed"].get<int>() == 300);
  CHECK(bar["failed"].get<int>() > 0);
  CHECK(summary["bodies"][1]["eroded"] == 5);
  CHECK(bar["lower"][2] == totals.bodies[0].lower.z);
}

TEST_CASE("A body without particles has no place") {
  core::SoloCommunication solo;
  const core::Model model = prepared_model(small_scene());
  const auto text = io::summary_json(model, core::compute_totals(model, solo), report(), 1, {}, {});
  const auto summary = nlohmann::json::parse(text);
  CHECK(summary["bodies"][0]["centre"][0].is_null());
  CHECK(summary["bodies"][0]["velocity"][0] == 0);
  CHECK(summary["bytes_per_particle"] == 0);
}

TEST_CASE("The timing table names every phase, the rest and the loop") {
  const std::string table = io::timing_table(report());
  CHECK_THAT(table,
             Catch::Contains("particles to grid      1.000      2.000      3.000    20.0%      50.0%"));
  CHECK_THAT(table,
             Catch::Contains("output                 0.500      1.000      1.000    10.0%       0.0%"));
  CHECK_THAT(table,
             Catch::Contains("migrate                4.000      4.000      4.000    40.0%       0.0%\n"
                             "  sending              1.000      1.000      1.000    10.0%       0.0%\n"));
  CHECK_THAT(table, Catch::Contains("other                             3.000               30.0%"));
  CHECK_THAT(table, Catch::Contains("loop                             10.000"));
}
