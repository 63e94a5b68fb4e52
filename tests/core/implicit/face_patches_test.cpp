// Patches of faces: displacements and forces have the same weights, by node and by unknown, also where bricks
// or ranks share a patch.
#include "core/implicit/face_patches.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/core/communication/ranks_of_threads.hpp"
#include "tests/core/implicit/blocks.hpp"

using namespace mpm::core;
using testing::block;
using testing::three_bricks;

namespace {

constexpr double rounding = 1e-13;

/// Two bricks along x, of a block between walls at the lower faces of x and z, with all nodes that are inside
/// the grid as unknowns; and patches whose points touch any nodes, with any weights.
struct Patches : testing::NodesOfBlocks {
  std::mt19937 random{7};
  FacePatches all;
  std::vector<double> motion;  ///< of the own nodes, none where they are held
  AlignedDoubles displacements;

  explicit Patches(ShapeFunction shape)
      : NodesOfBlocks(std::vector<testing::Block>{{false, block(0.5, {0, 0, 0}, {7, 3, 3})}}, shape, walls()),
        all(model, solo.reductions, fields, unknowns) {
    REQUIRE(model.grid->owned() == 2);
    for (const BrickField& field : fields.all()) {
      double* const record = contributions(field);
      std::fill_n(record, node_doubles * unknowns.nodes(), 0.0);
      for (int n = 0; n < unknowns.nodes(); ++n) {
        const Vec3<double> x = place(field, n);
        if (std::min({x.x, x.y, x.z}) >= 0) record[node_doubles * n + node_field::support.first] = 1;
      }
    }
    number();
    for (std::size_t i = 0; i < 3 * unknowns.own(); ++i)
      motion.push_back((unknowns.held()[i / 3] >> i % 3 & 1) != 0 ? 0 : any());
    unknowns.distribute(motion, displacements);
  }

  static GridGeometry walls() {
    GridGeometry g = three_bricks();
    g.boundary[0] = Boundary::symmetry;
    g.boundary[4] = Boundary::fixed;
    return g;
  }
  double any() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  double* contributions(const BrickField& field) {
    return model.grid->contributions(NodeArray::first, field.slot, field.number);
  }
  Vec3<double> place(const BrickField& field, int node) const {
    return model.grid->geometry().node_place(model.grid->brick(field.slot).coord,
                                             model.grid->shape().node(node));
  }
  const BrickField& field(std::size_t number) const { return fields.all()[number]; }

  /// What a point touches whose material has nodes from `lowest` on.
  FaceTouch touch(const BrickField& field, const Vec3<double>& lowest = {-1, -1, -1}) {
    std::set<std::int32_t> nodes;
    while (nodes.size() < 6) {
      const auto n = static_cast<std::int32_t>(random() % static_cast<unsigned>(unknowns.nodes()));
      const Vec3<double> x = place(field, n);
      if (unknowns.of(field)[n].number >= 0 && x.x >= lowest.x && x.y >= lowest.y && x.z >= lowest.z)
        nodes.insert(n);
    }
    FaceTouch found;
    found.field = field.index;
    double sum = 0;
    for (const std::int32_t n : nodes) sum += found.weights.emplace_back(n, 1.5 + any()).second;
    for (auto& [node, weight] : found.weights) weight /= sum;
    return found;
  }
  /// Two nodes: one on the border of the bricks, and one within a cell of it.
  FaceTouch touch_between(const BrickField& field) const {
    FaceTouch found;
    found.field = field.index;
    for (const double x : {3.0, 4.0, 5.0})
      for (int n = 0; n < unknowns.nodes(); ++n)
        if (place(field, n) == Vec3<double>{x, 2, 3}) found.weights.push_back({n, 0.5});
    return found;
  }
  void add(const FacePatch::Key& key, std::size_t point, FaceTouch touch, const PatchSums& sums) {
    touch.point = point;
    all.add(key, touch, sums);
  }
  static PatchSums sums(double area) {
    PatchSums of;
    of.area = area;
    return of;
  }
  /// Around node (x, 2, *), of a face whose normal is downward.
  static FacePatch::Key around(std::int64_t x) {
    return {1, all_components, FacePatch::many_points, 4, x, 2, 3};
  }
  /// Some of several points and of one, in either brick or in both.
  void add_some() {
    std::size_t point = 0;
    for (const std::int64_t x : {2, 4, 6})
      for (int i = 0; i < 3; ++i)
        for (const std::size_t f : {0U, 1U})
          if (x == 4 || (x == 6) == (f == 1)) add(around(x), point++, touch(field(f)), sums(1.5 + any()));
    add({1, all_components, 17}, 17, touch(field(0)), sums(0.3));
    all.complete();
    REQUIRE(all.all().size() == 4);
  }
  /// Of the unknowns.
  Vec3<double> displacement(const FacePatch& patch) const {
    Vec3<double> sum{};
    for (std::size_t i = 0; i < patch.unknowns.size(); ++i)
      for (int a = 0; a < 3; ++a)
        sum[a] += patch.factors[i][a] *
                  motion[3 * static_cast<std::size_t>(patch.unknowns[i]) + static_cast<std::size_t>(a)];
    return sum;
  }
};

double length(const Vec3<double>& a) { return std::sqrt(dot(a, a)); }

}  // namespace

TEST_CASE("The weights of a patch sum to its area, and its sums are those of its points", "[implicit]") {
  Patches patches(ShapeFunction::linear);
  PatchSums one, other;
  one.area = 2, one.stiffness = 3, one.place = {2, 4, 6}, one.normal = {0, 0, 2}, one.known = 2;
  one.stuck = 1, one.pressure = 5, one.force = {1, 2, 3}, one.gap = {0.1, 0.2, 0.3};
  other.area = 0.5, other.stiffness = 1, other.place = {1, 1, 1}, other.normal = {0.5, 0, 0};
  other.known = 0.25, other.stuck = 0.5, other.pressure = 0.5, other.force = {1, 1, 1}, other.gap = {1, 1, 1};
  patches.add(Patches::around(2), 5, patches.touch(patches.field(0)), one);
  patches.add(Patches::around(2), 8, patches.touch(patches.field(0)), other);
  patches.all.complete();
  REQUIRE(patches.all.all().size() == 1);
  const FacePatch& patch = patches.all.all().front();
  CHECK(patch.points == std::vector<std::size_t>{5, 8});
  CHECK(patch.sums.area == 2.5);
  CHECK(patch.sums.stiffness == 4);
  CHECK(patch.sums.normal == Vec3<double>{0.5, 0, 2});
  CHECK(patch.sums.known == 2.25);
  CHECK(patch.sums.stuck == 1.5);
  CHECK(patch.sums.pressure == 5.5);
  CHECK(patch.sums.force == Vec3<double>{2, 3, 4});
  CHECK(length(patch.sums.gap - Vec3<double>{1.1, 1.2, 1.3}) < rounding);
  CHECK(length(patch.place() - Vec3<double>{1.2, 2, 2.8}) < rounding);
  REQUIRE(patch.parts.size() == 1);
  double area = 0;
  std::set<std::int32_t> nodes;
  for (const auto& [node, weight] : patch.parts.front().weights) area += weight, nodes.insert(node);
  CHECK(area == Approx(2.5));
  CHECK(nodes.size() == patch.parts.front().weights.size());  // each once
}

TEST_CASE("Forces on the nodes are the adjoint of the displacements of patches", "[implicit]") {
  for (const ShapeFunction shape : {ShapeFunction::linear, ShapeFunction::quadratic_bspline}) {
    Patches patches(shape);
    patches.add_some();
    const std::vector<Vec3<double>> displacements = patches.all.displacements(patches.displacements);
    for (const BrickField& field : patches.fields.all())
      std::fill_n(patches.contributions(field), node_doubles * patches.unknowns.nodes(), 0.0);
    double of_patches = 0, of_nodes = 0;
    for (std::size_t p = 0; p < displacements.size(); ++p) {
      const Vec3<double> force{patches.any(), patches.any(), patches.any()};
      patches.all.add_force(patches.all.all()[p], force);
      of_patches += dot(force, displacements[p]);
    }
    patches.unknowns.exchange(mapped::implicit_force);
    patches.unknowns.for_each_own([&](std::size_t i, const double* sum) {
      for (std::size_t a = 0; a < 3; ++a)
        of_nodes += sum[static_cast<std::size_t>(node_field::force.first) + a] * patches.motion[3 * i + a];
    });
    CHECK(std::abs(of_patches) > 0.01);
    CHECK(of_nodes == Approx(of_patches));
  }
}

TEST_CASE("A force on a patch adds its size to the sizes of the forces on nodes", "[implicit]") {
  Patches patches(ShapeFunction::linear);
  patches.add(Patches::around(4), 0, patches.touch(patches.field(0)), Patches::sums(2));
  patches.all.complete();
  double* const record = patches.contributions(patches.field(0));
  std::fill_n(record, node_doubles * patches.unknowns.nodes(), 0.0);
  patches.all.add_force(patches.all.all().front(), {3, -4, 0.5});
  double sizes = 0;
  for (int n = 0; n < patches.unknowns.nodes(); ++n)
    sizes += record[node_doubles * n + node_field::support.first];
  CHECK(sizes == Approx(7.5));
}

TEST_CASE("The factors of the unknowns give the displacements of patches", "[implicit]") {
  for (const ShapeFunction shape : {ShapeFunction::linear, ShapeFunction::quadratic_bspline}) {
    Patches patches(shape);
    patches.add_some();
    const std::vector<Vec3<double>> displacements = patches.all.displacements(patches.displacements);
    for (std::size_t p = 0; p < displacements.size(); ++p) {
      const FacePatch& patch = patches.all.all()[p];
      CHECK(length(patches.displacement(patch) - displacements[p]) < rounding);
      CHECK(std::set<std::int64_t>(patch.unknowns.begin(), patch.unknowns.end()).size() ==
            patch.unknowns.size());
      for (std::size_t i = 0; i < patch.unknowns.size(); ++i)
        for (int a = 0; a < 3; ++a)
          if ((patches.unknowns.held()[static_cast<std::size_t>(patch.unknowns[i])] >> a & 1) != 0)
            CHECK(patch.factors[i][a] == 0);
    }
  }
}

TEST_CASE("The factors of a patch whose nodes are free sum to one", "[implicit]") {
  Patches patches(ShapeFunction::linear);
  for (const std::size_t f : {0U, 1U, 0U})
    patches.add(Patches::around(4), f, patches.touch(patches.field(f), {1, 0, 1}),
                Patches::sums(1.5 + patches.any()));
  patches.all.complete();
  Vec3<double> sum{};
  for (const Vec3<double>& factor : patches.all.all().front().factors) sum = sum + factor;
  CHECK(length(sum - Vec3<double>{1, 1, 1}) < rounding);
}

TEST_CASE("What a wall holds at all points of a patch is not displaced", "[implicit]") {
  Patches patches(ShapeFunction::linear);
  const auto factors = [&](unsigned first, unsigned second) {
    patches.all.clear();
    for (const unsigned held : {first, second}) {
      FaceTouch touch = patches.touch(patches.field(0), {1, 0, 1});
      touch.held = held;
      patches.add(Patches::around(2), 0, touch, Patches::sums(1));
    }
    patches.all.complete();
    REQUIRE(patches.all.all().size() == 1);
    Vec3<double> sum{};
    for (const Vec3<double>& factor : patches.all.all().front().factors) sum = sum + factor;
    return sum;
  };
  CHECK(length(factors(0, 0) - Vec3<double>{1, 1, 1}) < rounding);
  CHECK(length(factors(1, 0) - Vec3<double>{1, 1, 1}) < rounding);
  CHECK(length(factors(3, 1) - Vec3<double>{0, 1, 1}) < rounding);
  CHECK(length(factors(6, 6) - Vec3<double>{1, 0, 0}) < rounding);
  CHECK(factors(7, 7) == Vec3<double>{});
}

TEST_CASE("A patch that two bricks share is one", "[implicit]") {
  Patches patches(ShapeFunction::linear);
  std::map<std::int64_t, double> weights;  // by unknown
  for (const std::size_t f : {0U, 1U}) {
    const BrickField& field = patches.field(f);
    const FaceTouch touch = patches.touch_between(field);
    REQUIRE(touch.weights.size() == 2);
    for (const auto& [node, weight] : touch.weights)
      weights[patches.unknowns.of(field)[node].number] += weight * (f == 0 ? 0.75 : 0.25);
    patches.add(Patches::around(4), f, touch, Patches::sums(f == 0 ? 3 : 1));
  }
  REQUIRE(weights.size() == 3);
  patches.all.complete();
  REQUIRE(patches.all.all().size() == 1);
  const FacePatch& patch = patches.all.all().front();
  CHECK(patch.counts);
  CHECK(patch.sums.area == 4);
  CHECK(patch.parts.size() == 2);
  REQUIRE(patch.unknowns.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(length(patch.factors[i] - weights.at(patch.unknowns[i]) * Vec3<double>{1, 1, 1}) < rounding);
}

TEST_CASE("A patch that two ranks share is known to both and counts on one", "[implicit]") {
  Patches patches(ShapeFunction::linear);
  struct Point {
    FacePatch::Key key;
    FaceTouch touch;
    double area;
  };
  // The second rank has what touches the second brick: all of one patch, and a part of two.
  std::vector<Point> points;
  for (const std::int64_t x : {4, 4, 6, 4})
    for (const std::size_t f : {0U, 1U})
      if (x == 4 || f == 1)
        points.push_back({Patches::around(x), patches.touch(patches.field(f)), 1.5 + patches.any()});
  points.push_back({Patches::around(2), patches.touch(patches.field(0)), 1});
  for (const std::size_t f : {0U, 1U})
    points.push_back({Patches::around(4), patches.touch_between(patches.field(f)), 0.5});
  // One alone sees a second wall.
  for (Point& point : points) point.touch.held = point.touch.field == 0 ? 6 : 2;

  const auto make = [&](Reductions& ranks, int of_field) {
    FacePatches made(patches.model, ranks, patches.fields, patches.unknowns);
    for (const Point& point : points)
      if (of_field < 0 || static_cast<int>(point.touch.field) == of_field)
        made.add(point.key, point.touch, Patches::sums(point.area));
    made.complete();
    return made;
  };
  const FacePatches whole = make(patches.solo.reductions, -1);
  const std::vector<Vec3<double>> displacements = whole.displacements(patches.displacements);
  REQUIRE(whole.all().size() == 3);

  std::vector<std::vector<FacePatch>> parts(2);
  std::vector<std::vector<Vec3<double>>> of_parts(2);
  testing::RanksOfThreads(2).run([&](Reductions& ranks) {
    const FacePatches mine = make(ranks, ranks.rank());
    const auto rank = static_cast<std::size_t>(ranks.rank());
    of_parts[rank] = mine.displacements(patches.displacements);
    parts[rank].assign(mine.all().begin(), mine.all().end());
  });
  REQUIRE(parts[0].size() == 2);
  REQUIRE(parts[1].size() == 2);
  std::map<FacePatch::Key, int> counts;
  for (std::size_t rank = 0; rank < 2; ++rank) {
    for (std::size_t p = 0; p < 2; ++p) {
      const FacePatch& part = parts[rank][p];
      const auto at = std::ranges::find(whole.all(), part.key, &FacePatch::key);
      REQUIRE(at != whole.all().end());
      counts[part.key] += part.counts ? 1 : 0;
      CHECK(part.sums.area == Approx(at->sums.area));
      CHECK(part.on_walls == at->on_walls);
      CHECK(length(of_parts[rank][p] - displacements[static_cast<std::size_t>(at - whole.all().begin())]) <
            rounding);
      REQUIRE(part.unknowns == at->unknowns);
      for (std::size_t i = 0; i < part.unknowns.size(); ++i)
        CHECK(length(part.factors[i] - at->factors[i]) < rounding);
    }
  }
  CHECK(counts.size() == 3);
  for (const auto& [key, count] : counts) CHECK(count == 1);
}
