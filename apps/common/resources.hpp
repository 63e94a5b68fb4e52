// Tests whether system resources are available: libraries terminate the program if they are not.
#pragma once

#include <stdexcept>
#include <string>

namespace mpm::apps {

/// The system refuses threads; the same on every rank. Exit code 6.
class NoThreads : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Starts `more` additional threads at once and ends them. Returns an empty text or the system's message.
/// They use the default stack size; a larger OMP_STACKSIZE is not tested.
std::string why_no_threads(int more);

/// Tests whether enough file descriptors for MPI and the output files can be opened. Empty, or a message with
/// the remedy.
std::string why_no_descriptors();

}  // namespace mpm::apps
