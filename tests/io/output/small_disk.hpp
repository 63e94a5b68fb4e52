// Disks that fill up: a limit on the size of files, and a file system of few bytes where the user may mount
// one.
#pragma once

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <string>

#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

namespace mpm::tests {

/// While it lives, no file of this process can grow beyond `bytes`.
class SmallDisk {
 public:
  explicit SmallDisk(std::size_t bytes) : old_action_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const struct rlimit limit { bytes, old_.rlim_max };
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_action_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  void (*old_action_)(int);
  struct rlimit old_ {};
};

/// A file system of its own; false where it could not be mounted.
class FullFileSystem {
 public:
  explicit FullFileSystem(std::size_t bytes)
      : path_(
            (std::filesystem::temp_directory_path() / ("mpm_disk_" + std::to_string(::getpid()))).string()) {
    std::filesystem::create_directories(path_);
    const std::string options = "size=" + std::to_string(bytes);
    if (mount("tmpfs", path_.c_str(), "tmpfs", 0, options.c_str()) == 0) return;
    reason_ = std::string("a small file system cannot be mounted: ") + std::strerror(errno);
  }
  ~FullFileSystem() {
    if (reason_.empty()) umount(path_.c_str());
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  FullFileSystem(const FullFileSystem&) = delete;
  FullFileSystem& operator=(const FullFileSystem&) = delete;
  explicit operator bool() const { return reason_.empty(); }
  const std::string& reason() const { return reason_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::string reason_;
};

}  // namespace mpm::tests
