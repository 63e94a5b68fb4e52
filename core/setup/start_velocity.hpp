// The velocities with which the particles of a body are created: its prescribed or else its initial velocity,
// numbers or expressions of the initial position.
#pragma once

#include <optional>
#include <vector>

#include "core/expressions/formula.hpp"
#include "core/scene/body.hpp"
#include "core/scene/solution.hpp"

namespace mpm::core {

class StartVelocity {
 public:
  /// `time`: of the creation. The input must outlive this.
  StartVelocity(const BodyInput& input, double time);
  /// Whether particles begin without the body's velocity: in quasi-static steps they move only where their
  /// motion is prescribed.
  static bool is_at_rest(const SolutionInput& solution, const BodyInput& input) {
    return solution.integration == Integration::implicit && solution.implicit &&
           solution.implicit->quasistatic() && !input.prescribed_velocity;
  }

  static const Expressions& expressions_of(const BodyInput& input) {
    return input.prescribed_velocity ? input.prescribed_velocity_expressions
                                     : input.initial_velocity_expressions;
  }

  bool varies() const { return !formulas_.empty(); }
  Vec3<double> at(const Vec3<double>& place);
  struct Fault {
    std::size_t expression = 0;  ///< index into expressions_of
    double value = 0;
  };
  /// The first that is not finite there.
  std::optional<Fault> first_not_finite(const Vec3<double>& place);

 private:
  const Expressions& expressions_;
  std::vector<Formula> formulas_;  ///< of the expressions
  Vec3<double> number_;
  double time_;
};

}  // namespace mpm::core
