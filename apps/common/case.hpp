// The case named on the command line: an input file, or a restart file with its embedded input.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/options.hpp"
#include "core/scene/catalogue.hpp"
#include "core/scene/scene.hpp"
#include "parallel/mpi.hpp"

namespace mpm::apps {

struct Case {
  std::shared_ptr<const core::Scene> scene;
  std::string bytes;                    ///< of the input file; stored in every restart file
  std::optional<std::string> restart;   ///< the file to continue from
  std::string restart_job;              ///< the job named in it
  std::vector<core::Diagnostic> notes;  ///< input settings without effect
};

/// A note as printed in the log and by mpm_check.
std::string to_line(const core::Diagnostic& note);

/// Throws InputErrors where the scene takes implicit steps and their solver cannot be loaded.
void require_newton_solver(const core::Scene& scene);

/// Rank 0 reads, every rank gets the same scene or the same InputErrors. Collective.
Case load_case(const RunOptions& options, const parallel::Communicator& world,
               const core::Catalogue& catalogue);

/// -h5pt. Collective.
ExitCode convert_restart(const RunOptions& options, const parallel::Communicator& world,
                         const core::Catalogue& catalogue);

}  // namespace mpm::apps
