// PETSc's error codes as exceptions: the first error in PETSc's own words, instead of a stack from every
// rank.
#pragma once

#include <stdexcept>
#include <string>

#include <petscsys.h>

namespace mpm::parallel {

class PetscFailure : public std::runtime_error {
 public:
  PetscFailure(const std::string& what, PetscErrorCode code) : runtime_error(what), code_(code) {}
  PetscErrorCode code() const { return code_; }

 private:
  PetscErrorCode code_;
};

/// From now on PETSc's errors are kept for the functions below; PetscPopErrorHandler ends it.
void keep_petsc_errors();

/// Throws PetscFailure with PETSc's description of the first error.
void check_petsc(PetscErrorCode code);
inline void check_mpi(int code) { check_petsc(static_cast<PetscErrorCode>(code)); }

/// PETSc's description of the first error, which is forgotten; empty without one.
std::string take_petsc_error();

}  // namespace mpm::parallel
