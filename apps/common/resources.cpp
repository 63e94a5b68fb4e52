#include "apps/common/resources.hpp"

#include <cerrno>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

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

}  // namespace mpm::apps
