// The expressions of a run's loads (core/scene/expression.hpp), with a parser of its own for each thread,
// made once. A result that is not finite counts as 0; the step then ends with the particle's name.
#pragma once

#include <cstddef>
#include <vector>

#include "core/expressions/formula.hpp"
#include "core/model.hpp"
#include "core/scene/expression.hpp"
#include "core/step/offending_particle.hpp"

namespace mpm::core {

class LoadFunctions {
 public:
  LoadFunctions();

  struct Term {
    const Expression* input = nullptr;
    std::size_t formula = 0;
    VariableSet uses;
  };
  /// The expressions of a quantity: those of time alone have the same value for all particles.
  struct Terms {
    std::vector<Term> of_time, of_place;
  };
  /// Equal texts share a parser. The expressions must outlive this.
  Terms add(const Expressions& expressions);

  /// Adds to each component's value that of its term, for all particles of a body.
  void add_values(const std::vector<Term>& of_time, const Body& body, double time, double* components);
  /// The same for one particle: its column c is lane[layout.offset(c)]. Thread-safe.
  void add_values(const std::vector<Term>& of_place, const Body& body, const double* lane, double time,
                  double* components);
  /// Derivative of a term for a change of the particle's place along an axis, by a central difference over
  /// 2 `step`. Thread-safe.
  double slope(const Term& term, const Body& body, const double* lane, double time, int axis, double step);

  /// That with the smallest identity since the last call; first of all, an expression of time alone.
  OffendingParticle take_fault();

 private:
  struct alignas(128) OfThread {
    std::vector<Formula> formulas;
    OffendingParticle fault;
  };
  OfThread& mine();
  double evaluate(OfThread& mine, const Term& term, const Body& body, const double* lane,
                  const PlaceAndTime& at);

  std::vector<std::string> texts_;  ///< of the formulas
  std::vector<OfThread> threads_;
};

}  // namespace mpm::core
