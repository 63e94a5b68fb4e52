#include "io/input/point_file.hpp"

#include <catch2/catch.hpp>
#include <zlib.h>

#include "core/scene/errors.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;

std::size_t count(const std::filesystem::path& path) {
  io::PointFile file(path);
  std::size_t n = 0;
  for (core::PointMass p; file.next(p);) ++n;
  return n;
}

TEST_CASE("a particle file") {
  const test::TemporaryFolder folder;
  io::PointFile file(folder.write("p.txt", "# mass x y z\n1 .5 -2e1 3\r\n\n\t2\t4  5 6"));
  core::PointMass p;
  REQUIRE(file.next(p));
  CHECK(p.mass == 1);
  CHECK(p.position == std::array{0.5, -20., 3.});
  REQUIRE(file.next(p));
  CHECK(p.mass == 2);
  CHECK(p.position == std::array{4., 5., 6.});
  CHECK_FALSE(file.next(p));
  CHECK(count(folder.write("empty.txt", "")) == 0);
}

TEST_CASE("wrong particle files name the line") {
  const test::TemporaryFolder folder;
  const std::pair<std::string, std::string> cases[] = {
      {"1 2 3 4\n1 2 3\n", ":2: expected four numbers `mass x y z`, found ''"},
      {"1 2 3 4 5\n", ":1: expected four numbers `mass x y z`, found '5' after them"},
      {"1 2 three 4\n", ":1: expected four numbers `mass x y z`, found 'three'"},
      {"0 2 3 4\n", ":1: the mass 0 of a particle is not positive"},
      {"1 nan 3 4\n", ":1: expected four numbers `mass x y z`, found 'nan'"},
      {std::string(300000, '1'), ":1: a line longer than 256 KiB; expected `mass x y z`"}};
  for (const auto& [text, message] : cases) {
    const std::filesystem::path path = folder.write("p.txt", text);
    CHECK_THROWS_WITH(count(path), path.string() + message);
  }
  CHECK_THROWS_WITH(count(folder / "none.txt"), (folder / "none.txt").string() + ": no such file");
}

TEST_CASE("a gzipped particle file, whole and cut") {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "p.txt.gz";
  constexpr std::size_t lines = 100000;  // longer than the buffer
  const gzFile out = gzopen(path.c_str(), "wb");
  for (std::size_t i = 0; i < lines; ++i)
    gzprintf(out, "1 %d %d 3\n", static_cast<int>(i), static_cast<int>(i * i % 977));
  gzclose(out);
  CHECK(count(path) == lines);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  CHECK_THROWS_WITH(count(path), Catch::Contains("cannot be read"));
}

}  // namespace
