// Records of all ranks, in the order of ranks.
#include "core/communication/gather_records.hpp"

#include <vector>

#include <catch2/catch.hpp>

#include "core/communication/solo.hpp"
#include "tests/core/communication/ranks_of_threads.hpp"

using namespace mpm::core;

namespace {

/// With zero bytes, and with a size that is no power of two.
struct Record {
  double value;
  int number[3];
  bool operator==(const Record&) const = default;
};

/// `count` records of a rank.
std::vector<Record> records_of(int rank, int count) {
  std::vector<Record> made;
  for (int i = 0; i < count; ++i) made.push_back({0.1 * i, {rank, i, 0}});
  return made;
}

}  // namespace

TEST_CASE("One rank gathers its own records in their order") {
  SoloReductions solo;
  const std::vector<Record> mine = records_of(0, 5), none;
  CHECK(gather_records(std::span(mine), solo) == mine);
  CHECK(gather_records(std::span(none), solo).empty());
}

TEST_CASE("Every rank gathers the records of all, by rank, and any may have none") {
  const std::vector<int> counts{0, 3, 0, 2};
  std::vector<Record> expected;
  for (int r = 0; r < 4; ++r)
    for (const Record& of : records_of(r, counts[static_cast<std::size_t>(r)])) expected.push_back(of);
  std::vector<std::vector<Record>> found(4);
  testing::RanksOfThreads(4).run([&](Reductions& ranks) {
    const auto rank = static_cast<std::size_t>(ranks.rank());
    const std::vector<Record> mine = records_of(ranks.rank(), counts[rank]);
    found[rank] = gather_records(std::span(mine), ranks);
  });
  for (const std::vector<Record>& of_rank : found) CHECK(of_rank == expected);
}
