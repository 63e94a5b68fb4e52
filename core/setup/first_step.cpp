#include "core/setup/first_step.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/material/batch.hpp"
#include "core/step/finite.hpp"
#include "core/step/speeds.hpp"

namespace mpm::core {

namespace {

/// Throws InputErrors for the body of the particle with the smallest identity of all ranks. `words`: of this
/// rank's, if it has one. Collective.
[[noreturn]] void refuse_particle(const Model& model, double identity, int body, const std::string& words,
                                  Exchange& exchange) {
  Witness mine;
  if (body >= 0) mine.offer(identity, [&] { return fmt::format("{} {}", body, words); });
  const std::string first = first_of_all(exchange, mine).words;
  std::size_t end = 0;
  const BodyInput& input = *active_bodies(*model.scene)[std::stoul(first, &end)];
  throw InputErrors(
      {Diagnostic{input.source.file, input.source.line, "Body", "name", input.name, first.substr(end + 1)}});
}

}  // namespace

void Fastest::offer(int number, const Batch& batch, int i) {
  const ColumnLayout& layout = *batch.layout;
  const double* at = batch.block[i / block_lanes] + i % block_lanes;
  const auto vector = [&](Column c) {
    const double* x = at + layout.offset(c);
    return Vec3<double>{x[0], x[block_lanes], x[2 * block_lanes]};
  };
  const Vec3<double> v = vector(Column::velocity_x);
  double sum = batch.critical_speed[i] + std::sqrt(dot(v, v));
  if (std::isnan(sum)) sum = std::numeric_limits<double>::infinity();
  const double id = at[layout.offset(Column::identity)];
  if (sum < speed || (sum == speed && id >= identity)) return;
  *this = {sum, id, batch.critical_speed[i], vector(Column::position_x), v, number};
}

void refuse_undefined(const Model& model, Exchange& exchange) {
  int body = -1;
  const Witness lost = first_not_finite(model, &body);
  if (!exchange.any(body >= 0)) return;
  refuse_particle(
      model, lost.identity, body,
      "its state at the start is not all finite numbers; correct its velocity, its density or its "
      "material: " +
          lost.words,
      exchange);
}

void refuse_endless(const Model& model, const Fastest& mine, Exchange& exchange) {
  const SolutionInput& solution = model.scene->solution;
  const TimeStepInput& how = solution.time_step;
  constexpr double most_steps = 9223372036854775808.0;  // 2^63
  const auto endless = [&](double dt) { return !(dt * most_steps > solution.end_time); };
  const double dt = how.specified > 0 ? how.specified : how.factor * model.clock.critical_dt;
  if (!endless(dt)) return;
  const std::string what =
      fmt::format("the first time step of {:.3g} would take more than 2^63 steps to EndTime {:.6g}", dt,
                  solution.end_time);
  if (how.specified > 0)
    throw InputErrors(solution.source, "TimeStep", what + ": increase `specified`, or check the units");
  double fastest[1] = {-mine.speed};
  exchange.minimum(fastest);
  if (!endless(how.factor * critical_step(*model.grid, -fastest[0]))) {
    throw InputErrors(solution.source, "Solution",
                      what +
                          ", for heat would spread so fast: check CoefficientOfThermalConductivity and "
                          "SpecHeat, and the units");
  }
  const bool ours = mine.speed == -fastest[0];
  const Vec3<double>&x = mine.position, &v = mine.velocity;
  refuse_particle(
      model, mine.identity, ours ? mine.body : -1,
      fmt::format("{}: particle {:.0f} at ({:.6g}, {:.6g}, {:.6g}) has the velocity ({:.6g}, {:.6g}, {:.6g}) "
                  "and the wave speed {:.6g}; check both, and the units",
                  what, mine.identity, x.x, x.y, x.z, v.x, v.y, v.z, mine.wave),
      exchange);
}

}  // namespace mpm::core
