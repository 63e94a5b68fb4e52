// Threads and file descriptors of the system, tested before use: libraries terminate the program if they are
// refused.
#pragma once

#include <stdexcept>
#include <string>

#include "core/communication/reductions.hpp"
#include "core/scene/scene.hpp"

namespace mpm::apps {

/// The system refuses threads; the same on every rank. Exit code 6.
class NoThreads : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Threads per rank: from the scene, else from the environment, else one, so that many ranks on few cores
/// stay efficient.
int choose_threads(const core::Scene& scene);

/// Starts all threads at once. OpenMP terminates the program if the system refuses one, so this is tested
/// first. Throws NoThreads on every rank if any rank is refused. Collective.
void start_threads(int threads, core::Reductions& ranks);

/// Tests whether enough file descriptors for MPI and the output files can be opened. Empty, or a message with
/// the remedy.
std::string why_no_descriptors();

}  // namespace mpm::apps
