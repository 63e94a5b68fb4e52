// Job_<step>.pe: the complete state of a run in one HDF5 file, from which the run continues bitwise
// identically on any number of ranks. The file contains its scene and is self-contained. It is written under
// the name `....part`, protected by checksums of every byte, and renamed when complete; the newest two of a
// job are kept. guard.hpp describes the first block of the file, contents.hpp the rest. Tested by
// tests/io/restart.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/communication/communication.hpp"
#include "core/model.hpp"
#include "io/output/file_error.hpp"
#include "io/output/variables.hpp"

namespace mpm::io {

/// Contents of a restart file in addition to the model.
struct RestartExtra {
  std::string scene_text;              ///< the bytes of the .xmp; needed on rank 0 only
  std::vector<std::uint64_t> tracked;  ///< HistoryFile::tracked()
  /// Marks of the run's other files, in the format of their writers; needed on rank 0 only.
  std::map<std::string, std::string> marks;
};

/// `folder/job_120.pe`
std::string restart_path(const std::string& folder, const std::string& job, std::int64_t step);
/// The job of `.../job_120.pe`, without folder; the whole stem if it does not end in a step.
std::string job_of_restart(const std::string& path);

/// Writes the state, then removes all but the newest two restart files of the job. Returns the path. On
/// failure the older files are unchanged. Output that a run restarted from this file does not write again
/// must be on disk before. Throws FileError. Collective.
std::string write_restart(const std::string& folder, const std::string& job, const core::Model& model,
                          const RestartExtra& extra, core::Reductions& ranks);

/// The input that a restart file was made from.
struct RestartScene {
  std::string text;  ///< the bytes of the .xmp
  std::string path;  ///< path of the .xmp when it was read
  std::string job_name;
};
/// Throws FileError. On this rank only.
RestartScene read_restart_scene(const std::string& path);

struct RestartResult {
  RestartExtra extra;                   ///< without the scene's text
  std::vector<std::size_t> new_bodies;  ///< indices of bodies missing in the file; left without particles
  std::vector<std::string> notices;     ///< notices for the user; the same on all ranks
};

/// Fills a model with prepared but empty bodies and grid: particles, clock, ledger. On the grid of the file
/// the state is bitwise identical; on another grid the particles are redistributed. A body that is not in the
/// model must be deactivated in its scene; its contents are recorded as removed. Throws FileError for a
/// damaged or unreadable file, InputErrors for an incompatible scene. Collective.
RestartResult read_restart(const std::string& path, core::Model& model, core::Communication& communication);

/// Checks every byte. Throws FileError. Collective.
void verify_restart(const std::string& path, core::Reductions& ranks);

/// The newest undamaged restart file of the job, identified by the job's name in the file, not by the file's
/// name. `notices` lists the files skipped. Collective.
std::optional<std::string> find_newest_restart(const std::string& folder, const std::string& job,
                                               core::Reductions& ranks, std::vector<std::string>& notices);

/// Renames the restart files of the job that were written after `start`, or all of them if the run starts
/// from the beginning, to `<name>.superseded`, and returns the new names: that run is about to overwrite what
/// they refer to in the job's other files. Throws FileError. On one rank, which holds the job's lock.
std::vector<std::string> set_aside_superseded(const std::string& folder, const std::string& job,
                                              const std::optional<std::string>& start);

/// state_hash() of the model in the file. On this rank only.
std::uint64_t restart_state_hash(const std::string& path);

/// For -h5pt: writes the particles of a restart file to an .h5part file of one time. Collective.
void restart_to_h5part(const std::string& path, const std::string& h5part,
                       const std::vector<Variable>& variables, bool double_precision,
                       core::Communication& communication);

}  // namespace mpm::io
