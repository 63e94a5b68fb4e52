#include "parallel/launch.hpp"

#include <fstream>
#include <new>

#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include "core/scene/errors.hpp"
#include "tests/parallel/world.hpp"

using namespace mpm::parallel;
using namespace mpm::parallel::test;

TEST_CASE("Rank 0's bytes reach every rank") {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{5'000'000}}) {
    std::string bytes(size, 'x');
    for (std::size_t i = 0; i < size; i += 997) bytes[i] = static_cast<char>(i);
    CHECK(broadcast(world(), world().rank() == 0 ? bytes : "something else") == bytes);
  }
}

TEST_CASE("What rank 0 computes, all ranks have") {
  int runs = 0;
  CHECK(on_root_then_all(world(), [&] {
          ++runs;
          return std::string("text\0with a zero", 16);
        }) == std::string("text\0with a zero", 16));
  CHECK(on_root_then_all(world(), [&] { return 0.1; }) == 0.1);
  on_root_then_all(world(), [&] { ++runs; });
  CHECK(runs == (world().rank() == 0 ? 2 : 0));
}

TEST_CASE("What rank 0 throws, all ranks throw") {
  using mpm::core::Diagnostic;
  using mpm::core::InputErrors;
  const std::vector<Diagnostic> diagnostics{{"case.xmp", 12, "Body", "dp", "0", "a length above 0"},
                                            {"", 0, "", "", "", "\nsomething\0else"}};
  try {
    on_root_then_all(world(), [&]() -> int { throw InputErrors(diagnostics); });
    CHECK(false);
  } catch (const InputErrors& e) {
    CHECK(e.what() == std::string(InputErrors(diagnostics).what()));
    REQUIRE(e.diagnostics().size() == 2);
    CHECK(e.diagnostics()[0].line == 12);
    CHECK(e.diagnostics()[0].attribute == "dp");
    CHECK(e.diagnostics()[1].message == diagnostics[1].message);
  }

  struct DiskFull : std::runtime_error {
    using std::runtime_error::runtime_error;
  };
  const auto fails = [] { throw DiskFull("no space left"); };
  CHECK_THROWS_AS((on_root_then_all<std::logic_error, DiskFull>(world(), fails)), DiskFull);
  CHECK_THROWS_WITH((on_root_then_all<DiskFull>(world(), fails)), "no space left");
  CHECK_THROWS_WITH(on_root_then_all(world(), fails), "no space left");
  CHECK_THROWS_AS(on_root_then_all(world(), fails), std::runtime_error);
}

TEST_CASE("Stretches reach their ranks whole, however the messages are cut") {
  const auto ranks = static_cast<std::size_t>(world().size());
  const auto length = [](std::size_t from, std::size_t to) {
    return (from + 2 * to) % 5 == 0 ? 0 : 1000 * from + 77 * to + 3;
  };
  const auto value = [](std::size_t from, std::size_t to, std::size_t i) { return mix(mix(from, to), i); };
  const auto me = static_cast<std::size_t>(world().rank());
  std::vector<std::uint64_t> send, expected;
  std::vector<std::size_t> begin{0};
  for (std::size_t r = 0; r < ranks; ++r) {
    for (std::size_t i = 0; i < length(me, r); ++i) send.push_back(value(me, r, i));
    for (std::size_t i = 0; i < length(r, me); ++i) expected.push_back(value(r, me, i));
    begin.push_back(send.size());
  }
  for (const std::size_t longest : {std::size_t{100}, std::size_t{4096}, std::size_t{1} << 30}) {
    CHECK(world().all_to_all(std::span<const std::uint64_t>(send), begin, longest) == expected);
  }
}

TEST_CASE("Lists, reductions and broadcasts are whole, however their messages are cut") {
  const auto me = static_cast<std::size_t>(world().rank()), ranks = static_cast<std::size_t>(world().size());
  const auto length = [](std::size_t rank) { return rank % 3 == 2 ? 0 : 200 + 37 * rank; };
  std::vector<std::uint64_t> mine, all;
  for (std::size_t r = 0; r < ranks; ++r) {
    for (std::size_t i = 0; i < length(r); ++i) {
      all.push_back(mix(r, i));
      if (r == me) mine.push_back(mix(r, i));
    }
  }
  for (const std::size_t longest : {std::size_t{8}, std::size_t{1000}, std::size_t{1016}, longest_piece}) {
    const auto gathered = world().all_gather(std::span<const std::uint64_t>(mine), longest);
    CHECK(gathered.items == all);
    CHECK(std::ranges::equal(gathered.of(world().rank()), mine));

    std::vector<std::int64_t> whole(500);
    std::vector<double> real(500);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      whole[i] = static_cast<std::int64_t>(i * (me + 1));
      real[i] = static_cast<double>(i) - static_cast<double>(me);
    }
    world().reduce(whole, MPI_SUM, longest);
    world().reduce(real, MPI_MIN, longest);
    int wrong = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      wrong += whole[i] != static_cast<std::int64_t>(i * ranks * (ranks + 1) / 2);
      wrong += real[i] != static_cast<double>(i) - static_cast<double>(ranks - 1);
    }
    CHECK(wrong == 0);

    const int root = world().size() - 1;
    std::vector<std::uint64_t> word = world().rank() == root ? all : std::vector<std::uint64_t>(all.size());
    world().broadcast(std::as_writable_bytes(std::span(word)), root, longest);
    CHECK(word == all);
  }
}

TEST_CASE("A message of unannounced length arrives whole, however it is cut") {
  constexpr std::size_t piece = 64;  // eight doubles
  const int next = (world().rank() + 1) % world().size();
  const int last = (world().rank() + world().size() - 1) % world().size();
  for (const std::size_t length : {0, 1, 7, 8, 9, 16, 100}) {
    std::vector<double> out, in{-1};
    for (std::size_t i = 0; i < length; ++i) out.push_back(static_cast<double>(i) + 0.5);
    Requests requests;
    requests.send_unannounced(world(), out.data(), out.size() * sizeof(double), next, 77, piece);
    requests.send_unannounced(world(), out.data(), out.size() * sizeof(double), next, 77, piece);
    world().receive_onto(in, last, 77, piece);
    world().receive_onto(in, last, 77, piece);
    requests.wait_all();
    std::vector<double> expected{-1};
    for (int twice = 0; twice < 2; ++twice) expected.insert(expected.end(), out.begin(), out.end());
    CHECK(in == expected);
  }
}

TEST_CASE("A failed call names itself") {
  int value = 0;
  CHECK_THROWS_WITH(check(MPI_Bcast(&value, 1, MPI_INT, world().size(), world().handle()), "MPI_Bcast"),
                    Catch::StartsWith("MPI_Bcast: ") && Catch::Contains("root"));
  CHECK_THROWS_AS(count_of(std::size_t{1} << 31), std::length_error);
}

TEST_CASE("A call that fails where no memory is left is out of memory") {
  struct AddressSpace {
    rlimit before{};
    AddressSpace() {
      std::size_t pages = 0;
      std::ifstream("/proc/self/statm") >> pages;
      REQUIRE(getrlimit(RLIMIT_AS, &before) == 0);
      rlimit tight = before;
      tight.rlim_cur = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + (std::size_t{8} << 20);
      REQUIRE(setrlimit(RLIMIT_AS, &tight) == 0);
    }
    ~AddressSpace() { setrlimit(RLIMIT_AS, &before); }
  };
  CHECK_THROWS_AS(check(MPI_ERR_INTERN, "MPI_Allreduce"), MpiError);
  const AddressSpace limit;
  CHECK_THROWS_AS(check(MPI_ERR_INTERN, "MPI_Allreduce"), std::bad_alloc);
}
