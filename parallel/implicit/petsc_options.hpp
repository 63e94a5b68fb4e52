// The user's options for PETSc: after -- on the command line, in the environment variable PETSC_OPTIONS and
// in files .petscrc. What PETSc would overlook, or end the program for, is found here: words that belong to
// no option, files of options that cannot be read, methods and formats that steps do not go with. Messages
// say where an option comes from. Shown by tests/system/physics_implicit_options.py.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mpi.h>

namespace mpm::parallel {

/// Whether MUMPS goes on where a row has no pivot (its ICNTL(24)), by default: a system that is singular to
/// round-off, as with one particle in a cell, then has a solution, which the residual judges.
inline constexpr const char* null_pivots_of_mumps = "-mat_mumps_icntl_24";

/// The value of an option, wherever it has been given; "" for one without a value.
std::optional<std::string> option_value(const char* name);

class UserOptions {
 public:
  /// Of the words after --. To be made before PETSc is started. Throws WrongSolverOptions where words belong
  /// to no option and where files cannot be read, on all ranks. Collective.
  UserOptions(MPI_Comm comm, std::vector<std::string> words);

  // With PETSc started. These throw WrongSolverOptions on all ranks; collective.
  /// Whether there are any, from wherever.
  bool any() const { return !all_in_words().empty(); }
  /// Refuses what PETSc has read and steps do not go with. `linear`: each step is one linear system.
  void refuse_unsuitable(bool linear, bool matrix_free) const;
  /// After the first solve, when all options that PETSc knows have been asked for.
  void refuse_unused() const;
  /// Refuses all of them, where PETSc says what is wrong, but not with which.
  [[noreturn]] void refuse(std::string_view why) const;

 private:
  /// "after --", for instance.
  std::string_view origin_of(const std::string& name) const;
  std::string all_in_words() const;

  std::vector<std::string> words_;        ///< after --
  std::vector<std::string> environment_;  ///< of PETSC_OPTIONS
};

}  // namespace mpm::parallel
