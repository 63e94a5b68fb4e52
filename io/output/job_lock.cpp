#include "io/output/job_lock.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/output/file_error.hpp"

namespace mpm::io {

namespace {

using namespace std::chrono_literals;

constexpr auto patience = 5s;
constexpr auto pause = 50ms;
constexpr off_t gate = 0;     // held by rank 0 alone
constexpr off_t holders = 1;  // shared by all

enum class Answer { taken, held, no_locks };

/// `type`: F_WRLCK, F_RDLCK or F_UNLCK.
Answer set(int handle, short type, off_t byte) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  while (::fcntl(handle, F_OFD_SETLK, &lock) != 0) {
    if (errno == EINTR) continue;
    return errno == EAGAIN || errno == EACCES ? Answer::held : Answer::no_locks;
  }
  return Answer::taken;
}

int open_lock(const std::string& path, int flags) { return ::open(path.c_str(), flags | O_CLOEXEC, 0666); }

/// Both bytes for this process, or neither.
Answer set_both(int handle) {
  const Answer at_gate = set(handle, F_WRLCK, gate);
  if (at_gate != Answer::taken) return at_gate;
  const Answer at_ranks = set(handle, F_WRLCK, holders);
  if (at_ranks != Answer::taken) {
    const int error = errno;
    set(handle, F_UNLCK, gate);
    errno = error;  // of the lock that was not taken
  }
  return at_ranks;
}

/// Whether the path still refers to the open file: a run that ended may have removed it.
bool leads_to(const std::string& path, int handle) {
  struct stat by_path {
  }, by_handle{};
  return ::stat(path.c_str(), &by_path) == 0 && ::fstat(handle, &by_handle) == 0 &&
         by_path.st_ino == by_handle.st_ino && by_path.st_dev == by_handle.st_dev;
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown host";
}

std::string holder_of(int handle) {
  std::array<char, 512> text{};
  const ssize_t n = ::pread(handle, text.data(), text.size() - 1, 0);
  const std::string all(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  const std::string line = all.substr(0, all.find('\n'));
  return line.empty() ? "unknown" : line;
}

void write_holder(int handle, int number_of_ranks) {
  const std::string text =
      fmt::format("process {} on {}, rank 0 of {}, since {:%Y-%m-%dT%H:%M:%SZ}\n", ::getpid(), host_name(),
                  number_of_ranks, fmt::gmtime(std::time(nullptr)));
  // For information only; the lock does not depend on it.
  if (::ftruncate(handle, 0) != 0 || ::pwrite(handle, text.data(), text.size(), 0) < 0) return;
}

/// Reports a long wait once.
class Patience {
 public:
  /// False after the time limit.
  bool wait(const std::string& path, const std::string& holder) {
    const auto left = end_ - std::chrono::steady_clock::now();
    if (left < 0s) return false;
    const bool long_by_now = left < patience - 1s;
    if (long_by_now && !said_) {
      std::fprintf(stderr, "waiting up to %d seconds for the run that holds '%s' (%s)\n",
                   static_cast<int>(patience.count()), path.c_str(), holder.c_str());
    }
    said_ = said_ || long_by_now;
    std::this_thread::sleep_for(pause);
    return true;
  }

 private:
  std::chrono::steady_clock::time_point end_ = std::chrono::steady_clock::now() + patience;
  bool said_ = false;
};

}  // namespace

JobLock::JobLock(const std::string& path, core::Reductions& ranks) : path_(path), first_(ranks.rank() == 0) {
  together(ranks, [&] {
    if (first_) take(path, ranks.size());
  });
  if (ranks.any(!notice_.empty())) return;  // locks are not supported here
  bool held = false;
  together(ranks, [&] {
    if (!first_) handle_ = open_lock(path, O_RDWR);
    if (handle_ < 0) throw system_error("write", path, errno);
    held = set(handle_, F_RDLCK, holders) != Answer::taken;
  });
  // Rank 0 holds the gate, so no other run can intervene.
  if (ranks.any(held) && first_)
    notice_ = fmt::format(
        "'{}' is not locked on every machine: make sure that only one run writes to this folder", path);
}

JobLock::~JobLock() {
  if (handle_ >= 0) ::close(handle_);
}

void JobLock::take(const std::string& path, int number_of_ranks) {
  Patience patience_left;
  for (;;) {
    handle_ = open_lock(path, O_RDWR | O_CREAT);
    if (handle_ < 0) throw system_error("write", path, errno);
    const Answer answer = set_both(handle_);
    const int error = errno;
    if (answer == Answer::no_locks) {
      notice_ = fmt::format("'{}' cannot be locked ({}): make sure that only one run writes to this folder",
                            path, system_error("lock", path, error).what());
      return;
    }
    if (answer == Answer::taken && leads_to(path, handle_)) break;
    const std::string holder = answer == Answer::held ? holder_of(handle_) : std::string();
    ::close(std::exchange(handle_, -1));
    if (answer == Answer::held && !patience_left.wait(path, holder)) {
      throw FileError(
          fmt::format("the run was not started: another run writes to this folder under the same job name, "
                      "or ranks of a killed run are still alive; '{}' is held by {}. Wait for it to end, "
                      "stop it, or choose another folder "
                      "with --output-dir",
                      path, holder));
    }
  }
  write_holder(handle_, number_of_ranks);
  set(handle_, F_UNLCK, holders);
}

void JobLock::release(core::Reductions& ranks) {
  if (!first_ && handle_ >= 0) ::close(std::exchange(handle_, -1));
  ranks.any(false);  // all other ranks have finished
  if (!first_ || handle_ < 0) return;
  // A run that has opened the file already finds, once rank 0 releases it, that the path no longer refers to
  // it.
  ::unlink(path_.c_str());
  ::close(std::exchange(handle_, -1));
}

void JobLock::wait_for(const std::string& path) {
  Patience patience_left;
  for (;;) {
    const int handle = open_lock(path, O_RDWR);
    if (handle < 0) return;  // no lock file
    const Answer answer = set_both(handle);
    const std::string holder = holder_of(handle);
    ::close(handle);
    if (answer != Answer::held || !patience_left.wait(path, holder)) return;
  }
}

}  // namespace mpm::io
