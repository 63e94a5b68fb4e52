// Requests to stop: signals and the wall clock.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace mpm::apps {

/// From now on SIGINT, SIGTERM and SIGUSR1 are noted instead of ending the program; a second SIGINT ends it.
void watch_signals();

/// The last signal noted, or 0.
int noted_signal();

class WallClock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace mpm::apps
