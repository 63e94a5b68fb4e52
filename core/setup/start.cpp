#include "core/setup/start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "core/particle_range.hpp"
#include "core/step/conduction.hpp"
#include "core/step/finite.hpp"
#include "core/step/speeds.hpp"
#include "core/step/totals.hpp"

namespace mpm::core {

namespace {

/// This rank's fastest particle, by speed plus wave speed; on ties, the one with the smallest identity.
struct Fastest {
  double speed = 0, identity = std::numeric_limits<double>::infinity();
  double wave = 0;
  Vec3<double> position{}, velocity{};
  int body = -1;

  /// Lane `i` of a batch of body `number`, after its critical speed is computed. A NaN speed counts as
  /// infinite.
  void offer(int number, const Batch& batch, int i, double wave_weight);
};

/// Throws InputErrors for the body of the particle with the smallest identity of all ranks. `words`: text
/// about this rank's, if it has one. Collective.
[[noreturn]] void refuse_particle(const Model& model, double identity, int body, const std::string& words,
                                  Reductions& ranks) {
  OffendingParticle mine;
  if (body >= 0) mine.offer(identity, [&] { return fmt::format("{} {}", body, words); });
  const std::string first = first_of_all(ranks, mine).words;
  std::size_t end = 0;
  const BodyInput& input = *active_bodies(*model.scene)[std::stoul(first, &end)];
  throw InputErrors(
      {Diagnostic{input.source.file, input.source.line, "Body", "name", input.name, first.substr(end + 1)}});
}

void Fastest::offer(int number, const Batch& batch, int i, double wave_weight) {
  const ConstParticle p(*batch.layout, batch.block[i / block_lanes] + i % block_lanes);
  const Vec3<double> v = p.vector(Column::velocity_x);
  double sum = wave_weight * batch.critical_speed[i] + std::sqrt(dot(v, v));
  if (std::isnan(sum)) sum = std::numeric_limits<double>::infinity();
  const double id = p[Column::identity];
  if (sum < speed || (sum == speed && id >= identity)) return;
  *this = {sum, id, batch.critical_speed[i], p.vector(Column::position_x), v, number};
}

/// Throws InputErrors, on every rank, for the first particle whose state or energy is not finite. Collective.
void refuse_undefined(const Model& model, Reductions& ranks) {
  int body = -1;
  const OffendingParticle lost = first_not_finite(model, &body);
  if (!ranks.any(body >= 0)) return;
  refuse_particle(
      model, lost.identity, body,
      "its initial state is not finite; correct its velocity, its density or its material: " + lost.words,
      ranks);
}

/// Throws InputErrors, on every rank, for a first step so short that the number of steps to the end would
/// overflow; names the fastest particle, of which `mine` is this rank's. Collective.
void refuse_endless(const Model& model, const Fastest& mine, Reductions& ranks) {
  const SolutionInput& solution = model.scene->solution;
  if (solution.integration != Integration::explicit_dynamics) return;  // this length bounds no step
  const TimeStepInput& how = solution.time_step;
  constexpr double most_steps = 9223372036854775808.0;  // 2^63
  const auto endless = [&](double dt) { return !(dt * most_steps > solution.end_time); };
  const double dt = how.specified > 0 ? how.specified : how.factor * model.clock.critical_dt;
  if (!endless(dt)) return;
  const std::string what =
      fmt::format("with the first time step of {:.3g}, EndTime {:.6g} would require more than 2^63 steps", dt,
                  solution.end_time);
  if (how.specified > 0)
    throw InputErrors(solution.source, "TimeStep", what + ": increase `specified`, or check the units");
  const double fastest = ranks.largest(mine.speed);
  if (!endless(how.factor * critical_step(*model.grid, fastest))) {
    throw InputErrors(solution.source, "Solution",
                      what +
                          "; heat conduction limits the step: check CoefficientOfThermalConductivity and "
                          "SpecHeat, and the units");
  }
  const bool ours = mine.speed == fastest;
  const Vec3<double>&x = mine.position, &v = mine.velocity;
  refuse_particle(
      model, mine.identity, ours ? mine.body : -1,
      fmt::format("{}: particle {:.0f} at ({:.6g}, {:.6g}, {:.6g}) has the velocity ({:.6g}, {:.6g}, {:.6g}) "
                  "and the wave speed {:.6g}; check both, and the units",
                  what, mine.identity, x.x, x.y, x.z, v.x, v.y, v.z, mine.wave),
      ranks);
}

/// Initialises this rank's particles of the bodies that `wanted` marks; returns the fastest of them.
Fastest initialise(Model& model, const std::vector<bool>& wanted) {
  const double wave_weight = 1 / wave_limit(model);
  Fastest fastest;
  const GridGeometry& geometry = model.grid->geometry();
  for (Brick& brick : model.grid->bricks()) {
    for (const ParticleTile& tile : brick.tiles) {
      if (!wanted[static_cast<std::size_t>(tile.body)]) continue;
      Batch batch{};
      const auto start = [&] {
        batch.cell_size = geometry.smallest_cell();
        batch.grid = &geometry;
        model.bodies[static_cast<std::size_t>(tile.body)].model->initialise(batch, model.options);
        for (int i = 0; i < batch.particles; ++i) fastest.offer(tile.body, batch, i, wave_weight);
        batch = {};
      };
      for (const ParticleBlock& block : blocks_of(model, brick, tile)) {
        batch.layout = block.layout;
        batch.block[batch.blocks++] = block.data;
        batch.particles += block.used;
        if (batch.blocks == batch_blocks) start();
      }
      if (batch.blocks > 0) start();
    }
  }
  return fastest;
}

/// Kinetic and internal, of the bodies that `wanted` marks.
double energy_of(const Totals& totals, const std::vector<bool>& wanted) {
  ExactSum sum;
  for (std::size_t b = 0; b < totals.bodies.size(); ++b)
    if (wanted[b]) sum.add(totals.bodies[b].kinetic + totals.bodies[b].internal);
  return sum.value();
}

void refuse_infinite(double energy, const Model& model) {
  if (std::isfinite(energy)) return;
  throw InputErrors(model.scene->components.front().source, "Component",
                    "the total energy of all particles overflows: check the units");
}

/// Scales the particles' masses to the mass that the input gives a rigid body.
void give_masses(Model& model, const std::vector<bool>& joined, Reductions& ranks) {
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  for (std::size_t b = 0; b < joined.size(); ++b) {
    if (!joined[b] || !inputs[b]->rigid_inertia) continue;
    const auto over_particles = [&](auto f) {
      for (const ParticleBlock& block : blocks_of(model)) {
        if (block.body != static_cast<int>(b)) continue;
        for (const Particle p : block) f(p[Column::mass]);
      }
    };
    ExactSum mass;
    over_particles([&](double m) { mass.add(m); });
    ranks.sum(std::span(&mass, 1));
    const double scale = inputs[b]->rigid_inertia->mass / mass.value();
    over_particles([&](double& m) { m *= scale; });
  }
}

double critical_step_of(const Model& model, const Fastest& fastest, Reductions& ranks) {
  return ranks.smallest(std::min(critical_step(*model.grid, fastest.speed), conduction_step(model)));
}

}  // namespace

void start_run(Model& model, Reductions& ranks) {
  const std::vector<bool> all(model.bodies.size(), true);
  give_masses(model, all, ranks);
  const Fastest fastest = initialise(model, all);
  refuse_undefined(model, ranks);
  model.clock.critical_dt = model.clock.first_critical_dt = critical_step_of(model, fastest, ranks);
  refuse_endless(model, fastest, ranks);
  const Totals totals = compute_totals(model, ranks);
  model.initial_energy = totals.kinetic + totals.internal;
  refuse_infinite(model.initial_energy, model);
}

void start_bodies(Model& model, std::span<const std::size_t> bodies, Reductions& ranks) {
  std::vector<bool> joined(model.bodies.size());
  for (const std::size_t b : bodies) joined[b] = true;
  give_masses(model, joined, ranks);
  const Fastest fastest = initialise(model, joined);
  refuse_undefined(model, ranks);
  const double critical = critical_step_of(model, fastest, ranks);
  model.clock.critical_dt = std::min(model.clock.critical_dt, critical);
  model.clock.first_critical_dt = std::min(model.clock.first_critical_dt, critical);
  refuse_endless(model, fastest, ranks);
  model.initial_energy += energy_of(compute_totals(model, ranks), joined);
  refuse_infinite(model.initial_energy, model);
}

}  // namespace mpm::core
