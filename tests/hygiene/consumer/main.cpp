// A user's program against an installed tree, which calls every library that it links: a scene is read (io),
// given its materials (physics) and stepped on the ranks of MPI (parallel) by the explicit step (core). A
// block that flies freely keeps its momentum, 48 x (2, 1, 0), and its centre moves with its velocity.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

#include "core/setup/build_model.hpp"
#include "core/step/stepper.hpp"
#include "core/step/totals.hpp"
#include "core/version.hpp"
#include "io/input/reader.hpp"
#include "io/output/particle_order.hpp"
#include "parallel/mpi_exchange.hpp"
#include "physics/catalogue.hpp"
#include "physics/material/material.hpp"

namespace {

constexpr std::string_view input = R"(<?xml version="1.0" encoding="utf-8"?>
<PeneBlast version="1.0">
  <Material name="soft">
    <ReferenceDensity value="2"/>
    <StrengthModel type="IsoElastic" Young="1000" Poisson="0.3"/>
  </Material>
  <Component name="all">
    <Body name="block" material="soft" type="Block">
      <Geometry dp="0.5" x0="2" y0="2" z0="2" lx="4" ly="3" lz="2"/>
      <InitialVelocity vx="2" vy="1" vz="0"/>
    </Body>
  </Component>
  <Grid>
    <Cell type="regular">
      <XMin value="0" boundary="0"/><XMax value="12" boundary="0"/>
      <YMin value="0" boundary="0"/><YMax value="8" boundary="0"/>
      <ZMin value="0" boundary="0"/><ZMax value="8" boundary="0"/>
      <DCell dx="1" dy="1" dz="1"/>
    </Cell>
  </Grid>
  <Solution><EndTime value="1"/></Solution>
</PeneBlast>
)";

/// The value, and a complaint if it is not what it must be to round-off.
bool right(const char* name, double value, double expected) {
  std::printf("%s %.15g\n", name, value);
  if (std::abs(value - expected) <= 1e-12 * std::abs(expected)) return true;
  std::printf("%s: expected %.15g\n", name, expected);
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace mpm;
  const parallel::Environment environment(argc, argv);
  parallel::MpiExchange exchange(parallel::Communicator::world());
  std::printf("mpm %s %s, %d lanes\n", core::version.data(), core::git_hash.data(), MPM_SIMD_LANES);

  const auto scene = std::make_shared<core::Scene>(io::parse_scene(input, "block.xmp", physics::catalogue()));
  core::Model model = core::prepare_model(scene, physics::make_materials(*scene), {});
  core::discretise(model, exchange);
  core::start_clock(model, exchange);
  core::Stepper stepper(model, exchange);
  while (model.clock.time < 1) stepper.step();

  const core::Totals totals = core::compute_totals(model, exchange);
  std::printf("state %016llx\n", static_cast<unsigned long long>(io::state_hash(model, exchange)));
  bool good = core::simd_lanes == MPM_SIMD_LANES;
  good = right("particles", static_cast<double>(totals.particles), 8 * 24) && good;
  good = right("momentum", totals.momentum.x, 96) && good;
  good = right("centre", totals.bodies[0].centre.x, 4 + 2 * model.clock.time) && good;
  return good ? 0 : 1;
}
