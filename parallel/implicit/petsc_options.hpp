// The user's options for PETSc, after -- on the command line. What PETSc would overlook, or end the program
// for, is found here: words that belong to no option, files of options that cannot be read, methods and
// formats that steps do not go with.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <mpi.h>

namespace mpm::parallel {

/// What is wrong with the words themselves, before PETSc reads them; empty if nothing. Collective.
std::string fault_of_words(MPI_Comm comm, const std::vector<std::string>& words);

/// Refuses what PETSc has read and steps do not go with. `linear`: each step is one linear system.
void refuse_unsuitable_options(bool linear, bool matrix_free);

/// After the first solve, when all options that PETSc knows have been asked for.
void refuse_unused_options();

}  // namespace mpm::parallel
