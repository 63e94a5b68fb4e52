// The programs as functions, for projects that add their own laws:
//
//   #include "apps/mpm.hpp"
//   #include "my_law.hpp"
//   int main(int argc, char** argv) { return mpm::run(argc, argv, mpm::Registry().add<MyLaw>()); }
//
// is an mpm_run with MyLaw. If the registry refuses a law, each function reports the reason and returns exit
// code 2. See README.md, "Adding a material".
#pragma once

#include "physics/registry.hpp"

namespace mpm {

using physics::Registry;

/// mpm_run, also under mpirun: initialises and finalises MPI. Returns the exit code. Collective.
int run(int argc, char** argv, const Registry& registry);
/// mpm_point, with --test for the generic tests of a law; without MPI.
int run_point(int argc, char** argv, const Registry& registry);
/// mpm_check, with --reference for the keyword reference; without MPI.
int run_check(int argc, char** argv, const Registry& registry);

}  // namespace mpm
