// The library with the solver of implicit steps, loaded at run time when a scene needs it.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/implicit/newton_solver.hpp"
#include "core/scene/solution.hpp"

namespace mpm::parallel {

class Communicator;

/// Options of the user that the solver does not know, or values that they cannot have.
class WrongSolverOptions : public std::runtime_error {
  using runtime_error::runtime_error;
};

/// Why implicit steps are not available in this build or installation; empty if they are.
std::string why_no_newton_solver();

/// Loads the library and starts PETSc with its own options, those after -- among them. Throws
/// WrongSolverOptions for options that such steps do not go with, as far as they are known before the first
/// solve, std::runtime_error where the start fails otherwise. Collective.
std::unique_ptr<core::NewtonSolver> make_newton_solver(const Communicator& world,
                                                       const core::ImplicitInput& steps,
                                                       const std::vector<std::string>& options);

}  // namespace mpm::parallel
