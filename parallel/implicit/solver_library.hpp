// The library with the solver of implicit steps, loaded at run time when a scene needs it.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/implicit/newton_solver.hpp"

namespace mpm::parallel {

class Communicator;

/// Options after -- on the command line that the solver does not know, or values that they cannot have.
class WrongSolverOptions : public std::runtime_error {
  using runtime_error::runtime_error;
};

/// Why implicit steps are not available in this build or installation; empty if they are.
std::string why_no_newton_solver();

/// Loads the library and starts PETSc with its own options. Throws std::runtime_error where that fails.
/// Collective.
std::unique_ptr<core::NewtonSolver> make_newton_solver(const Communicator& world,
                                                       const std::vector<std::string>& options);

}  // namespace mpm::parallel
