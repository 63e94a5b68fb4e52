// Failed particles in a component of their own: the same bits on any ranks and threads, and after a restart.
#include <catch2/catch.hpp>
#include <omp.h>

#include "core/setup/build_model.hpp"
#include "core/setup/prepare_model.hpp"
#include "core/step/stepper.hpp"
#include "core/step/totals.hpp"
#include "io/input/reader.hpp"
#include "io/output/particle_order.hpp"
#include "io/restart/restart.hpp"
#include "parallel/communication.hpp"
#include "physics/material/material.hpp"
#include "physics/registry.hpp"
#include "tests/io/output/small_disk.hpp"
#include "tests/io/output/small_model.hpp"
#include "tests/parallel/world.hpp"

using namespace mpm;
using namespace mpm::parallel::test;

namespace {

std::string block(const char* name, const char* geometry, const char* velocity) {
  return std::string("<Body name=\"") + name +
         "\" material=\"brittle\" type=\"Block\"><Geometry dp=\"0.5\" " + geometry + "/><InitialVelocity " +
         velocity + "/></Body>\n";
}

/// Two brittle blocks that meet over borders of bricks and ranks.
std::shared_ptr<core::Scene> collision(const physics::Registry& registry, const char* algorithm, bool parts) {
  const std::string text =
      "<PeneBlast version=\"1.0\">\n<Material name=\"brittle\"><ReferenceDensity value=\"8.93e-3\"/>"
      "<StrengthModel type=\"JohnsonCook\" Young=\"117e3\" Poisson=\"0.35\" Yield0=\"90\" B=\"292\" "
      "n=\"0.31\" C=\"0.025\" m=\"1.09\" melt=\"1356\" SpecHeat=\"383\" epso=\"1e-3\" D1=\"0.02\" "
      "D2=\"0.05\" "
      "D3=\"-1\" D4=\"0.014\" D5=\"1.12\" FailedType=\"1\" FailureDamageThreshold=\"0.6\"/>"
      "<EquationOfState type=\"Gruneisen\" C0=\"3940\" S1=\"1.49\" gamma0=\"1.96\"/></Material>\n"
      "<Component name=\"flyer\">" +
      block("flyer", "x0=\"1.1\" y0=\"3.3\" z0=\"4.2\" lx=\"4\" ly=\"4\" lz=\"4\"",
            "vx=\"600\" vy=\"100\" vz=\"0\"") +
      "</Component>\n<Component name=\"target\">" +
      block("target", "x0=\"5.6\" y0=\"4.7\" z0=\"3.4\" lx=\"4\" ly=\"5\" lz=\"4\"",
            "vx=\"-500\" vy=\"-100\" vz=\"60\"") +
      "</Component>\n<Grid><Cell type=\"regular\">"
      "<XMin value=\"0\" boundary=\"0\"/><XMax value=\"18\" boundary=\"0\"/>"
      "<YMin value=\"0\" boundary=\"0\"/><YMax value=\"16\" boundary=\"0\"/>"
      "<ZMin value=\"0\" boundary=\"0\"/><ZMax value=\"12\" boundary=\"0\"/>"
      "<DCell dx=\"1\" dy=\"1\" dz=\"1\"/></Cell></Grid>\n<Solution algorithm=\"" +
      std::string(algorithm) +
      "\"><EndTime value=\"1\"/><TimeStep factor=\"0.5\"/></Solution>\n<Output/></PeneBlast>\n";
  auto scene = std::make_shared<core::Scene>(io::parse_scene(text, "collision.xmp", registry.catalogue()));
  scene->contact.enable = true;
  scene->contact.failed_to_component = parts;
  return scene;
}

struct Run {
  core::Communication& exchange;
  core::Model model;
  std::optional<core::Stepper> stepper;

  Run(core::Communication& with, const std::shared_ptr<core::Scene>& scene, const physics::Registry& registry,
      const std::string& restart = {})
      : exchange(with),
        model(core::prepare_model(scene, physics::make_materials(*scene, registry), core::ColumnSet{})) {
    if (restart.empty())
      core::build_model(model, exchange);
    else
      io::read_restart(restart, model, exchange);
    stepper.emplace(model, exchange);
  }
  void step(int n) {
    for (int i = 0; i < n; ++i) stepper->step();
  }
  std::uint64_t hash() { return io::state_hash(model, exchange.reductions); }
  /// Of failed particles in bricks that hold others of their body too.
  bool parted() const {
    for (const core::Brick& brick : model.grid->bricks()) {
      for (std::size_t t = 1; t < brick.tiles.size(); ++t)
        if (brick.tiles[t].body == brick.tiles[t - 1].body) return true;
    }
    return false;
  }
};

constexpr int steps = 60;

}  // namespace

TEST_CASE("Failed particles form a component with the same bits on any ranks and threads") {
  const physics::Registry& registry = physics::built_in_laws();
  parallel::MpiCommunication exchange(world());
  core::SoloCommunication solo;
  const int threads = omp_get_max_threads();
  for (const char* algorithm : {"MUSL", "USF", "USL", "USAVG"}) {
    INFO(algorithm);
    const auto scene = collision(registry, algorithm, true);
    omp_set_num_threads(1);
    Run alone(solo, scene, registry), stays(solo, collision(registry, algorithm, false), registry);
    alone.step(steps), stays.step(steps);
    CHECK(alone.parted());
    CHECK_FALSE(stays.parted());
    const core::Totals totals = core::compute_totals(alone.model, solo);
    CHECK(totals.bodies[0].failed > 20);
    CHECK(totals.bodies[0].failed < totals.bodies[0].particles);
    for (const int n : {1, 2}) {
      omp_set_num_threads(n);
      Run together(exchange, scene, registry);
      together.step(steps);
      CHECK(together.hash() == alone.hash());
    }
    omp_set_num_threads(threads);
  }
}

TEST_CASE("A run with a component of failed particles is resumed on any ranks with the same bits") {
  const physics::Registry& registry = physics::built_in_laws();
  parallel::MpiCommunication exchange(world());
  core::SoloCommunication solo;
  const auto scene = collision(registry, "MUSL", true);
  Run alone(solo, scene, registry);
  alone.step(steps);
  const tests::Folder folder("failed_component");  // of each rank
  const std::string path = io::write_restart(folder.path(), "half", alone.model, {}, solo);
  Run again(exchange, scene, registry, path);
  CHECK(again.hash() == alone.hash());
  alone.step(steps / 2);
  again.step(steps / 2);
  CHECK(alone.parted());
  CHECK(again.hash() == alone.hash());
}
