#include "io/output/job_lock.hpp"

#include <cstdlib>
#include <filesystem>

#include <catch2/catch.hpp>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/output/file.hpp"
#include "io/output/file_error.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;

namespace {

/// A process that takes the lock and keeps it until it is killed.
pid_t another_run(const std::string& path) {
  int ends[2] = {};
  REQUIRE(::pipe(ends) == 0);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    core::SoloCommunication solo;
    const io::JobLock lock(path, solo);
    if (::write(ends[1], "x", 1) != 1) ::_exit(1);
    for (;;) ::pause();
  }
  char word = 0;
  REQUIRE(::read(ends[0], &word, 1) == 1);
  ::close(ends[0]);
  ::close(ends[1]);
  return child;
}

void kill(pid_t child) {
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

}  // namespace

TEST_CASE("A job is locked until its run ends, and a killed run leaves nothing that holds") {
  const Folder folder("lock");
  core::SoloCommunication solo;
  const std::string path = folder / "a.lock";
  const pid_t child = another_run(path);
  CHECK_THROWS_WITH(io::JobLock(path, solo),
                    Catch::Contains("a.lock' is held by process " + std::to_string(child) + " on ") &&
                        Catch::Contains("the run was not started"));
  { const io::JobLock other(folder / "b.lock", solo); }
  kill(child);
  CHECK(std::filesystem::exists(path));
  io::JobLock lock(path, solo);
  CHECK(lock.notice().empty());
  CHECK_THAT(io::read_file(path), Catch::Contains("process " + std::to_string(::getpid())));
  lock.release(solo);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("A lock that was removed while somebody waited for it is made anew") {
  const Folder folder("lock_removed");
  core::SoloCommunication solo;
  const std::string path = folder / "a.lock";
  for (int i = 0; i < 20; ++i) {
    io::JobLock first(path, solo);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      const io::JobLock second(path, solo);
      ::_exit(std::filesystem::exists(path) ? 0 : 1);  // for a third one to find
    }
    ::usleep(static_cast<useconds_t>(1000 * i));
    first.release(solo);
    int status = -1;
    ::waitpid(child, &status, 0);
    CHECK(status == 0);
    std::filesystem::remove(path);
  }
}

TEST_CASE("Where there can be no lock file that is said") {
  core::SoloCommunication solo;
  CHECK_THROWS_WITH(io::JobLock("/nowhere/a.lock", solo), Catch::Contains("cannot write '/nowhere/a.lock'"));
  io::JobLock::wait_for("/nowhere/a.lock");
}
