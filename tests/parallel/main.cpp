// One test program on any number of ranks. Rank 0 reports; another rank does so only when one of its checks
// fails. The ranks of a case wait for each other, so that a failure on one of them ends the whole run.
#define CATCH_CONFIG_RUNNER
#define CATCH_CONFIG_NOSTDOUT
#include <chrono>
#include <iostream>
#include <memory>
#include <sstream>
#include <thread>

#include <catch2/catch.hpp>

#include "tests/parallel/world.hpp"

namespace {

std::unique_ptr<mpm::parallel::Communicator> all_ranks;

std::ostringstream& silent() {
  static std::ostringstream stream;
  return stream;
}

struct LeaveTogether : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;
  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    if (stats.totals.assertions.allOk() || all_ranks->size() == 1) return;
    if (all_ranks->rank() != 0)
      std::cerr << "rank " << all_ranks->rank() << ": " << silent().str() << std::flush;
    std::this_thread::sleep_for(std::chrono::seconds(1));  // for the others that fail here to say so
    mpm::parallel::abort(1);
  }
};
CATCH_REGISTER_LISTENER(LeaveTogether)

}  // namespace

namespace Catch {
std::ostream& cout() { return all_ranks->rank() == 0 ? std::cout : silent(); }
std::ostream& cerr() { return all_ranks->rank() == 0 ? std::cerr : silent(); }
std::ostream& clog() { return all_ranks->rank() == 0 ? std::clog : silent(); }
}  // namespace Catch

namespace mpm::parallel::test {

const Communicator& world() { return *all_ranks; }

bool same_on_all(const std::string& text) {
  const Gathered<char> all = world().all_gather(std::span<const char>(text));
  for (int r = 0; r < world().size(); ++r) {
    if (!std::ranges::equal(all.of(r), text)) return false;
  }
  return true;
}

}  // namespace mpm::parallel::test

int main(int argc, char** argv) {
  mpm::parallel::Environment mpi(argc, argv);
  all_ranks = std::make_unique<mpm::parallel::Communicator>(mpm::parallel::Communicator::world());
  std::int64_t failed = Catch::Session().run(argc, argv);
  all_ranks->reduce(std::span(&failed, 1), MPI_MAX);
  all_ranks.reset();
  return failed == 0 ? 0 : 1;
}
