// Point bodies: inline and files, plain and gzipped; and what is said about bad files.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <unistd.h>
#include <zlib.h>

#include "tests/core/discretise/support.hpp"

using namespace mpm::core;
using namespace mpm::core::testing;
using Catch::Matchers::Contains;

namespace {

/// A file in a folder of its own, gone at the end.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text) {
    static int number = 0;
    folder_ = std::filesystem::temp_directory_path() /
              ("mpm-points-" + std::to_string(getpid()) + "-" + std::to_string(number++));
    std::filesystem::create_directory(folder_);
    path_ = (folder_ / name).string();
    write(text);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove_all(folder_); }

  const std::string& path() const { return path_; }
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

std::string gzipped(const std::string& text) {
  const TemporaryFile file("packed.gz", "");
  gzFile packed = gzopen(file.path().c_str(), "wb");
  gzwrite(packed, text.data(), static_cast<unsigned>(text.size()));
  gzclose(packed);
  std::ifstream in(file.path(), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

PointGeometry from_file(const std::string& path) {
  PointGeometry geometry;
  geometry.file = path;
  return geometry;
}

std::string fault(const std::string& text) {
  const TemporaryFile file("bad.txt", text);
  try {
    source(from_file(file.path()));
  } catch (const InputErrors& errors) {
    std::string what = errors.what();
    for (std::size_t at; (at = what.find(file.path())) != std::string::npos;)
      what.replace(at, file.path().size(), "bad.txt");
    return what;
  }
  return "no fault";
}

/// Some 20,000 lines: more than a read of a block, and five units.
std::string many_lines(std::vector<PointMass>& points) {
  std::string text = "# mass x y z\n\n";
  for (int i = 0; i < 20000; ++i) {
    char line[200];
    const PointMass point{1e-3 * (i + 1), {0.1 * i, -1.0 / (i + 1), 1e-5 * i * i}};
    std::snprintf(line, sizeof line, "%.17g\t%.17g   %.17g %.17g%s\n", point.mass, point.position[0],
                  point.position[1], point.position[2], i % 1000 == 0 ? " ! every thousandth\r" : "");
    points.push_back(point);
    text += line;
    if (i % 777 == 0) text += "   \n# a comment\n";
  }
  return text;
}

bool agree(const Seeds& seeds, const std::vector<PointMass>& points) {
  if (seeds.size() != points.size()) return false;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (seeds[i].identity != i || seeds[i].mass != points[i].mass ||
        seeds[i].position != points[i].position || seeds[i].volume != points[i].mass / density)
      return false;
  return true;
}

}  // namespace

TEST_CASE("inline points keep mass, place and order", "[discretise]") {
  PointGeometry geometry;
  geometry.points = {{2, {1, 2, 3}}, {3, {-1, 0, 0.5}}};
  const auto from = source(geometry);
  CHECK(agree(all(*from), geometry.points));
  CHECK(from->identities() == 2);
  CHECK(from->bounds() == std::array<Position, 2>{{{-1, 0, 0.5}, {1, 2, 3}}});
  CHECK(from->solid_volume() == 5 / density);
}

TEST_CASE("point files, plain and gzipped, in any shares", "[discretise]") {
  std::vector<PointMass> points;
  const std::string text = many_lines(points);
  const TemporaryFile plain("points.txt", text);
  const TemporaryFile packed("points.txt.gz", gzipped(text));
  REQUIRE(std::filesystem::file_size(packed.path()) < text.size() / 2);
  for (const std::string& path : {plain.path(), packed.path()}) {
    const auto from = source(from_file(path));
    CHECK(from->units() == 5);
    CHECK(agree(all(*from), points));
    CHECK(agree(all(*from), points));  // once more: back to the start
    Seeds pieces;
    for (std::uint64_t unit = 0; unit < 5; ++unit) from->generate(unit, unit + 1, pieces);
    CHECK(agree(pieces, points));
    pieces.clear();
    for (const std::uint64_t unit : {3, 0, 4, 1, 2}) from->generate(unit, unit + 1, pieces);
    std::sort(pieces.begin(), pieces.end(),
              [](const Seed& a, const Seed& b) { return a.identity < b.identity; });
    CHECK(agree(pieces, points));
  }
}

TEST_CASE("point files: what a line may look like", "[discretise]") {
  const TemporaryFile file(
      "odd.txt", "\xEF\xBB\xBF 1 2 3 4\r\n+1 .5 -.5 1.e0\n1E-3\t1e+3 25.4 -0# no blank before\n\n2 0 0 0");
  const Seeds seeds = all(from_file(file.path()));
  REQUIRE(seeds.size() == 4);
  CHECK(seeds[0].position == Position{2, 3, 4});
  CHECK(seeds[1].position == Position{0.5, -0.5, 1});
  CHECK(seeds[2].position == Position{1000, 25.4, 0});
  CHECK(seeds[3].mass == 2);
}

TEST_CASE("point files: every bad line is named", "[discretise]") {
  CHECK(fault("1 0 0 0\n1 0 0\n\n-1 0 0 0\n1 0 zero 0\n1 2 3 4 5\nnan 0 0 0\n1 1e999 0 0\n0 0 0 0\n") ==
        "bad.txt:2: expected four numbers, mass x y z, found 3\n"
        "bad.txt:4: mass: expected more than 0, found -1\n"
        "bad.txt:5: y: expected a number, found `zero`\n"
        "bad.txt:6: expected four numbers, mass x y z, found more: `5`\n"
        "bad.txt:7: mass: expected a number, found `nan`\n"
        "bad.txt:8: x: expected a number, found `1e999`\n"
        "bad.txt:9: mass: expected more than 0, found 0");
  CHECK_THAT(fault("1,2,3,4\n"), Contains("bad.txt:1: mass: expected a number, found `1,2,3,4`"));
  CHECK_THAT(fault("\x1b[31m 1 1 1\n"), Contains("found `?[31m`"));
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "wrong\n";
  CHECK_THAT(fault(many),
             Contains("bad.txt:20: ") && Contains("980 more lines are invalid") && !Contains("bad.txt:21:"));
}

TEST_CASE("point files: missing, empty, no text, cut off, changed", "[discretise]") {
  const std::string element = "case.xmp:7: <Geometry file=\"bad.txt\">: ";
  CHECK(fault("# nothing\n\n") == element + "the file contains no particles: expected lines of mass x y z");
  CHECK(fault(std::string(5000000, 'x')) ==
        element + "line 1 is longer than 4096 characters: this is not a file of particles");
  CHECK_THROWS_WITH(
      source(from_file("/nowhere/points.txt")),
      "case.xmp:7: <Geometry file=\"/nowhere/points.txt\">: the file of particles cannot be opened: No "
      "such file or directory");
  CHECK_THROWS_WITH(source(from_file("/")), Contains("Is a directory"));

  std::vector<PointMass> points;
  const std::string text = many_lines(points);
  const std::string packed = gzipped(text);
  CHECK_THAT(fault(packed.substr(0, packed.size() / 2)), Contains(element + "reading stopped after line"));
  std::string damaged = packed;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] + 1);
  CHECK_THAT(fault(damaged), Contains("reading stopped after line") || Contains("expected"));

  const TemporaryFile file("points.txt", text);
  const auto from = source(from_file(file.path()));
  file.write("1 2 3 4\n");
  Seeds seeds;
  CHECK_THROWS_WITH(from->generate(0, 5, seeds), Contains("the file changed while it was read"));
}
