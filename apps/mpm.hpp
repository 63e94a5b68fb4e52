// The programs as functions, for a program with laws of its own:
//
//   #include "apps/mpm.hpp"
//   #include "my_law.hpp"
//   int main(int argc, char** argv) { return mpm::run(argc, argv, mpm::Registry().add<MyLaw>()); }
//
// is an mpm_run that knows MyLaw. A law that the registry refuses ends each of them at once, with the reason
// and exit code 2. README.md, "Adding a material", has the whole of it.
#pragma once

#include "physics/registry.hpp"

namespace mpm {

using physics::Registry;

/// mpm_run, also under mpirun: starts and ends MPI. The exit code of the process. Collective.
int run(int argc, char** argv, const Registry& registry);
/// mpm_point, with --test for the tests that hold for every law; without MPI.
int run_point(int argc, char** argv, const Registry& registry);
/// mpm_check, with --reference for the keyword reference; without MPI.
int run_check(int argc, char** argv, const Registry& registry);

}  // namespace mpm
