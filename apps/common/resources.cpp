#include "apps/common/resources.hpp"

#include <cerrno>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include "core/scene/limits.hpp"
#include "core/simd/denormals.hpp"

namespace mpm::apps {

std::string why_no_descriptors() {
  constexpr std::size_t wanted = 32;
  std::vector<int> open_now;
  std::string refusal;
  while (open_now.size() < wanted && refusal.empty()) {
    const int fd = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (fd >= 0) {
      open_now.push_back(fd);
    } else {
      refusal = std::generic_category().message(errno) + ": only " + std::to_string(open_now.size()) +
                " more files can be opened, of the " + std::to_string(wanted) +
                " that a run may need; raise the limit (ulimit -n)";
    }
  }
  for (const int fd : open_now) close(fd);
  return refusal;
}

namespace {

/// Starts `more` additional threads at once and ends them. Returns an empty text or the system's message.
/// They use the default stack size; a larger OMP_STACKSIZE is not tested.
std::string why_no_threads(int more) {
  std::mutex mutex;
  std::condition_variable change;
  bool end = false;
  std::string refusal;
  std::vector<std::thread> threads;
  try {
    for (int i = 0; i < more; ++i) {
      threads.emplace_back([&] {
        std::unique_lock lock(mutex);
        change.wait(lock, [&] { return end; });
      });
    }
  } catch (const std::system_error& e) { refusal = e.code().message(); }
  {
    const std::lock_guard lock(mutex);
    end = true;
  }
  change.notify_all();
  for (std::thread& t : threads) t.join();
  return refusal;
}

}  // namespace

int choose_threads(const core::Scene& scene) {
  const bool environment = std::getenv("OMP_NUM_THREADS") != nullptr;
  const int threads = scene.solution.threads.value_or(environment ? omp_get_max_threads() : 1);
  if (threads > core::most_threads) {
    throw core::InputErrors(core::SourceLocation{}, {},
                            fmt::format("{} threads per rank are more than {}: set OMP_NUM_THREADS lower",
                                        threads, core::most_threads));
  }
  omp_set_num_threads(threads);
  return threads;
}

void start_threads(int threads, core::Reductions& ranks) {
  const std::string refusal = why_no_threads(threads - 1);
  if (ranks.any(!refusal.empty())) {
    for (const std::string& text : ranks.gather(refusal)) {
      if (!text.empty())
        throw NoThreads(
            fmt::format("the system refuses {} threads per rank: {}; request fewer with OpenMPSetting "
                        "or OMP_NUM_THREADS, or raise the limit (ulimit -u, ulimit -v)",
                        threads, text));
    }
  }
#pragma omp parallel
  core::flush_denormals_to_zero();
}

}  // namespace mpm::apps
