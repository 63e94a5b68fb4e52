// Whether the system gives a rank what it asks for, tried before a library ends the program for want of it.
#pragma once

#include <stdexcept>
#include <string>

namespace mpm::apps {

/// The system refuses threads; the same on every rank. Exit code 6.
class NoThreads : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Starts `more` threads beside this one, all alive at once, and ends them. Empty, or the system's words.
/// Their stacks are the system's usual ones; a larger OMP_STACKSIZE is not tried.
std::string why_no_threads(int more);

/// Whether so many file descriptors can be opened as MPI and the output files may need. Empty, or what to do.
std::string why_no_descriptors();

}  // namespace mpm::apps
