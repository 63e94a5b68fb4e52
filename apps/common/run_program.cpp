// mpm_run: from the command line to the exit code.
#include <cstdio>
#include <exception>
#include <new>

#include "apps/common/faults.hpp"
#include "apps/common/options.hpp"
#include "apps/common/resources.hpp"
#include "apps/common/run.hpp"
#include "apps/mpm.hpp"
#include "core/scene/errors.hpp"
#include "io/output/file_error.hpp"
#include "parallel/implicit/solver_library.hpp"
#include "parallel/mpi.hpp"

namespace mpm {

int run(int argc, char** argv, const Registry& registry) {
  // MPI terminates the program, or crashes, if it cannot open files.
  if (const std::string refusal = apps::why_no_descriptors(); !refusal.empty()) {
    std::fprintf(stderr, "mpm_run: %s\n", refusal.c_str());
    return apps::file_error;
  }
  const parallel::Environment environment(argc, argv);
  const parallel::Communicator world = parallel::Communicator::world();
  const bool speak = world.rank() == 0;
  if (apps::say_faults(registry, speak)) return apps::input_error;

  const auto [options, leave] = apps::parse_command_line(argc, argv, speak);
  if (leave) return *leave;

  // Input and file errors are thrown on all ranks together, so all return here and rank 0 prints the message.
  const auto failed = [&](const std::exception& e, apps::ExitCode code) {
    if (speak) std::fprintf(stderr, "%s\n", e.what());
    return code;
  };
  try {
    return apps::run(options, world, registry);
  } catch (const core::InputErrors& e) {
    return failed(e, apps::input_error);
  } catch (const parallel::WrongSolverOptions& e) {
    return failed(e, apps::input_error);
  } catch (const io::FileError& e) { return failed(e, apps::file_error); } catch (const apps::NoThreads& e) {
    return failed(e, apps::out_of_resources);
  } catch (const std::bad_alloc&) {
    // On this rank only; others may be waiting for it.
    std::fprintf(stderr, "rank %d: out of memory: use a larger dp, or more machines\n", world.rank());
    parallel::abort(apps::out_of_resources);
  } catch (const std::exception& e) {
    // A bug or lack of memory, perhaps on one rank only: the others must not wait for it.
    std::fprintf(stderr, "rank %d: %s\n", world.rank(), e.what());
    parallel::abort(1);
  }
}

}  // namespace mpm
