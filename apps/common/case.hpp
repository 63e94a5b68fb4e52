// The case that the command line names: an input file, or a restart file with the input that it carries.
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
  std::string bytes;                    ///< of the input file, as every restart file will carry them
  std::optional<std::string> restart;   ///< the file to continue from
  std::string restart_job;              ///< the job named in it
  std::vector<core::Diagnostic> notes;  ///< what the input states without effect
};

/// A note as the log and mpm_check show it.
std::string to_line(const core::Diagnostic& note);

/// Rank 0 reads, every rank gets the same scene or the same InputErrors. Collective.
Case load_case(const RunOptions& options, const parallel::Communicator& world,
               const core::Catalogue& catalogue);

/// -h5pt. Collective.
ExitCode convert_restart(const RunOptions& options, const parallel::Communicator& world,
                         const core::Catalogue& catalogue);

}  // namespace mpm::apps
