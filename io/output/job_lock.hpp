// One run at a time writes the files of a job in a folder: `<folder>/<job>.lock`.
//
// Rank 0 holds byte 0 of the file for itself and every rank shares byte 1, both as locks that belong to the
// open file (F_OFD_SETLK): the system takes them back when the process ends, however it ends. A run begins
// when its rank 0 has had both bytes for itself, so not before the last rank of a killed run is gone. The
// file says who holds it; a clean end removes it. One that a killed run has left has no effect.
//
// Limit: where the file system has no locks, none is taken, and notice() says so. Shown by
// tests/io/output/job_lock_test.cpp and tests/system/robust_lock.py.
#pragma once

#include <memory>
#include <string>

#include "core/communication/reductions.hpp"

namespace mpm::io {

class JobLock {
 public:
  /// Waits some seconds for another run, or what is left of a killed one, to end; a FileError says who holds
  /// the lock. The folder must exist. Collective.
  JobLock(const std::string& path, core::Reductions& ranks);
  ~JobLock();
  JobLock(const JobLock&) = delete;
  JobLock& operator=(const JobLock&) = delete;

  /// The run has ended and writes no more: the file goes. Collective.
  void release(core::Reductions& ranks);
  /// What the user should know; mostly empty.
  const std::string& notice() const { return notice_; }

  /// Waits as the constructor does, and for as long at most, until nobody holds the lock; takes and makes
  /// nothing. On one rank.
  static void wait_for(const std::string& path);

 private:
  void take(const std::string& path, int ranks);
  std::string path_;
  int handle_ = -1;
  bool first_ = false;  ///< of the ranks
  std::string notice_;
};

}  // namespace mpm::io
