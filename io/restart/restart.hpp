// Job_<step>.pe: the whole state of a run in one HDF5 file, readable on any number of ranks, from which the
// run goes on with the same bits.
//
// The file holds its scene, so it needs no other. It is made under the name `....part`, checked by checksums
// over every byte, and gets its own name when it is complete; the newest two of a job are kept. guard.hpp
// describes the first block of the file, contents.hpp the rest. Shown by tests/io/restart.
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

/// What a restart file carries beside the model.
struct RestartExtra {
  std::string scene_text;              ///< the bytes of the .xmp; needed on rank 0 alone
  std::vector<std::uint64_t> tracked;  ///< HistoryFile::tracked()
  /// Where the run's other files stood, in the words of those who write them; needed on rank 0 alone.
  std::map<std::string, std::string> marks;
};

/// `folder/job_120.pe`
std::string restart_path(const std::string& folder, const std::string& job, std::int64_t step);
/// The job of `.../job_120.pe`, without folder; the whole stem if it does not end in a step.
std::string job_of_restart(const std::string& path);

/// Writes the state, then removes all but the newest two restart files of the job. Returns the path. On
/// failure the older files are as they were. With the file's name the run's point of return moves: what goes
/// on from it does not write again must be on the disk before. Throws FileError. Collective.
std::string write_restart(const std::string& folder, const std::string& job, const core::Model& model,
                          const RestartExtra& extra, core::Reductions& ranks);

/// The input that a restart file was made from.
struct RestartScene {
  std::string text;  ///< the bytes of the .xmp
  std::string path;  ///< of the .xmp when it was read
  std::string job_name;
};
/// Throws FileError. On this rank alone.
RestartScene read_restart_scene(const std::string& path);

struct RestartResult {
  RestartExtra extra;  ///< without the scene's text
  std::vector<std::size_t>
      new_bodies;  ///< numbers of bodies that the file does not have; left without particles
  std::vector<std::string> notices;  ///< what the user should know; the same on all ranks
};

/// Fill a model whose bodies and grid are prepared, but hold nothing: particles, clock, ledger. On the grid
/// that the file was written with, the state is the same to the last bit; on another, particles are dealt out
/// anew. A body that is not in the model must be deactivated in its scene: what it held is booked as removed.
/// Throws FileError for a file that is damaged or cannot be read, InputErrors for a scene that does not fit
/// it. Collective.
RestartResult read_restart(const std::string& path, core::Model& model, core::Communication& communication);

/// Check every byte. Throws FileError. Collective.
void verify_restart(const std::string& path, core::Reductions& ranks);

/// The file of the job that was written last and is undamaged, whatever its own name: the job's name in it
/// counts. `notices` says which ones were passed over. Collective.
std::optional<std::string> find_newest_restart(const std::string& folder, const std::string& job,
                                               core::Reductions& ranks, std::vector<std::string>& notices);

/// state_hash() of the model that the file was written from. On this rank alone.
std::uint64_t restart_state_hash(const std::string& path);

/// What -h5pt does: the particles of a restart file as an .h5part file of one time. Collective.
void restart_to_h5part(const std::string& path, const std::string& h5part,
                       const std::vector<Variable>& variables, bool double_precision,
                       core::Communication& communication);

}  // namespace mpm::io
