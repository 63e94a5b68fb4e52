#include "parallel/implicit/solver_library.hpp"

#include <filesystem>

#include <dlfcn.h>
#include <mpi.h>

#include "parallel/mpi.hpp"

namespace mpm::parallel {

namespace {

using Make = core::NewtonSolver*(MPI_Comm, const core::ImplicitInput*, const std::vector<std::string>*);

#ifdef MPM_SOLVER_LIBRARY
/// Where the library may be: found by the loader, beside the code that calls it, or in the library folder
/// next to the program's.
std::vector<std::string> places() {
  std::vector<std::string> found{MPM_SOLVER_LIBRARY};
  namespace fs = std::filesystem;
  const auto add = [&](const fs::path& code) {
    const fs::path folder = code.parent_path();
    for (const char* from : {".", "../lib", "../" MPM_LIBRARY_FOLDER})
      found.push_back((folder / from / MPM_SOLVER_LIBRARY).string());
  };
  Dl_info here;
  if (dladdr(reinterpret_cast<void*>(&why_no_newton_solver), &here) != 0) add(fs::absolute(here.dli_fname));
  std::error_code unknown;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", unknown); !unknown) add(program);
  return found;
}

/// Stays loaded: PETSc and MPI have handlers in it.
void* library(std::string& why) {
  static std::string failure;
  static void* const handle = [] {
    for (const std::string& place : places()) {
      if (void* const found = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL)) return found;
      // Of a file that is there the reason counts, not that the other places have none.
      const std::string reason = dlerror();
      if (failure.empty() || reason.find("No such file") == std::string::npos) failure = reason;
    }
    return static_cast<void*>(nullptr);
  }();
  why = failure;
  return handle;
}
#endif

}  // namespace

std::string why_no_newton_solver() {
#ifdef MPM_SOLVER_LIBRARY
  std::string why;
  if (library(why) != nullptr) return {};
  return "the library " MPM_SOLVER_LIBRARY " cannot be loaded: " + why;
#else
  return "this build has no implicit solver: configure it with -DMPM_WITH_PETSC=ON";
#endif
}

std::unique_ptr<core::NewtonSolver> make_newton_solver(
    [[maybe_unused]] const Communicator& world, [[maybe_unused]] const core::ImplicitInput& steps,
    [[maybe_unused]] const std::vector<std::string>& options) {
#ifdef MPM_SOLVER_LIBRARY
  std::string why;
  if (void* const loaded = library(why)) {
    if (auto* const make = reinterpret_cast<Make*>(dlsym(loaded, "mpm_make_newton_solver")))
      return std::unique_ptr<core::NewtonSolver>(make(world.handle(), &steps, &options));
  }
#endif
  throw std::runtime_error(why_no_newton_solver());
}

}  // namespace mpm::parallel
