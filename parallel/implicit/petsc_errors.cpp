#include "parallel/implicit/petsc_errors.hpp"

#include <utility>

#include <fmt/format.h>
#include <mpi.h>

namespace mpm::parallel {

namespace {

std::string first_error;  // NOLINT: PETSc's handlers have no state of their own that survives

PetscErrorCode keep_error(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                          PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL || first_error.empty())
    first_error = fmt::format("{} (in PETSc's {})", message != nullptr ? message : "", function);
  return code;
}

}  // namespace

void keep_petsc_errors() { check_petsc(PetscPushErrorHandler(keep_error, nullptr)); }

void check_petsc(PetscErrorCode code) {
  if (code == 0) return;
  const std::string what = take_petsc_error();
  throw PetscFailure(
      "PETSc: " + (what.empty() ? fmt::format("PETSc error {}", static_cast<int>(code)) : what), code);
}

std::string take_petsc_error() { return std::exchange(first_error, {}); }

}  // namespace mpm::parallel
