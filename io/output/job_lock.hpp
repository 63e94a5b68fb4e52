// One run at a time writes the files of a job in a folder: `<folder>/<job>.lock`.
// Rank 0 locks byte 0 of the file exclusively and every rank shares byte 1, both as open file description
// locks (F_OFD_SETLK), which the system releases whenever the process ends. A run begins when its rank 0 has
// held both bytes exclusively, hence not before the last rank of a killed run has ended. The file names the
// holder; a normal end removes it. A file left by a killed run has no effect. Limit: if the file system has
// no locks, none is taken, and notice() reports it. Tested by tests/io/output/job_lock_test.cpp and
// tests/system/robust_lock.py.
#pragma once

#include <memory>
#include <string>

#include "core/communication/reductions.hpp"

namespace mpm::io {

class JobLock {
 public:
  /// Waits some seconds for another run, or remaining ranks of a killed one, to end; then throws a FileError
  /// that names the holder. The folder must exist. Collective.
  JobLock(const std::string& path, core::Reductions& ranks);
  ~JobLock();
  JobLock(const JobLock&) = delete;
  JobLock& operator=(const JobLock&) = delete;

  /// Ends the lock and removes the file. Collective.
  void release(core::Reductions& ranks);
  /// Notice for the user; usually empty.
  const std::string& notice() const { return notice_; }

  /// Waits like the constructor, for the same time at most, until no run holds the lock; takes no lock and
  /// creates no file. On one rank.
  static void wait_for(const std::string& path);

 private:
  void take(const std::string& path, int ranks);
  std::string path_;
  int handle_ = -1;
  bool first_ = false;  ///< rank 0
  std::string notice_;
};

}  // namespace mpm::io
