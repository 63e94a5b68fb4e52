// Whether material touches a point on a face, by what its particles give the nodes.
#include "core/implicit/face_touch.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include <catch2/catch.hpp>

#include "core/implicit/implicit_passes.hpp"
#include "core/shape/list.hpp"
#include "core/step/cells_in_use.hpp"
#include "tests/core/implicit/blocks.hpp"
#include "tests/core/step/case.hpp"

using namespace mpm::core;
using testing::block;
using testing::three_bricks;

namespace {

/// Of this build, without those whose particles have a size or a domain.
std::vector<ShapeFunction> shapes() {
  std::vector<ShapeFunction> all;
  for (const ShapeFunction shape : {ShapeFunction::linear, ShapeFunction::ddmp, ShapeFunction::sgmp,
                                    ShapeFunction::quadratic_bspline, ShapeFunction::cubic_bspline})
    if (with_known_shape(shape, []<class S>(std::type_identity<S>) { return is_built<S>; }))
      all.push_back(shape);
  return all;
}
bool is_spline(ShapeFunction shape) {
  return shape == ShapeFunction::sgmp || shape == ShapeFunction::quadratic_bspline ||
         shape == ShapeFunction::cubic_bspline;
}

/// A soft block, of which the first brick has a part.
struct SoftBlock : testing::NodesOfBlocks {
  mpm::tests::KeepFloatingPoint keep;
  std::unique_ptr<CellsInUse> cells;
  std::unique_ptr<ImplicitPasses> passes;
  MaterialAtFaces material;

  SoftBlock(const BlockGeometry& of, ShapeFunction shape, const GridGeometry& g = three_bricks())
      : NodesOfBlocks(std::vector<testing::Block>{{false, of}}, shape, g),
        cells(make_cells_in_use(model, solo.halo)),
        passes(make_implicit_passes(model, nullptr, {}, fields)),
        material(model, fields, unknowns) {
    if (cells) {
      cells->find();
      cells->finish_exchange();
    }
    passes->begin_step(1, 1);
    passes->map_start();
    number();
    passes->map_motion();
    unknowns.exchange(mapped::implicit_motion);
    material.take_moduli();
    passes->map_surface();
    unknowns.exchange(mapped::implicit_surface);
    material.take_surface();
  }
  const BrickField& first() const { return fields.all()[0]; }
  std::optional<FaceTouch> touch(const Vec3<double>& x, const Vec3<double>& normal,
                                 bool is_known = false) const {
    FacePoint point;
    point.normal = normal;
    return material.touch(first(), point, x, is_known);
  }
  Vec3<double> mean_place(const FaceTouch& touch) const {
    Vec3<double> sum{};
    for (const auto& [node, weight] : touch.weights)
      sum = sum + weight * model.grid->geometry().node_place(model.grid->brick(first().slot).coord,
                                                             model.grid->shape().node(node));
    return sum;
  }
};

double sum_of_weights(const FaceTouch& touch) {
  double sum = 0;
  for (const auto& [node, weight] : touch.weights) sum += weight;
  return sum;
}

/// A block 1.5 cells high across `axis`, above or below a face in any place in a cell; and points at a
/// distance from it, on the face of another body.
struct Face {
  int axis;
  bool above;
  double at;
  SoftBlock soft;

  Face(ShapeFunction shape, int across, bool is_above, double part_of_cell)
      : axis(across),
        above(is_above),
        at(is_above ? 2.5 - part_of_cell : 1.5 + part_of_cell),
        soft(of(), shape) {}
  BlockGeometry of() const {
    Vec3<double> origin{0.25, 0.25, 0.25}, size{4, 4, 4};
    origin[axis] = above ? at : at - 1.5;
    size[axis] = 1.5;
    return block(0.5, origin, size);
  }
  std::optional<FaceTouch> touch(double gap, bool is_known = false, bool reversed = false) const {
    Vec3<double> x{2.4, 2.4, 2.4}, normal{};
    x[axis] = above ? at - gap : at + gap;
    x[(axis + 1) % 3] = 1.8;
    normal[axis] = above != reversed ? 1 : -1;
    return soft.touch(x, normal, is_known);
  }
};

template <class F>
void for_each_face(F f) {
  for (const ShapeFunction shape : shapes())
    for (const int axis : {0, 1, 2})
      for (const bool above : {false, true})
        for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          CAPTURE(static_cast<int>(shape), axis, above, part);
          f(shape, Face(shape, axis, above, part));
        }
}

}  // namespace

TEST_CASE("Material touches the points at its face, wherever that is in a cell", "[implicit]") {
  for_each_face([](ShapeFunction, const Face& face) {
    for (const double gap : {-0.3, 0.0, 0.15}) {
      const std::optional<FaceTouch> touch = face.touch(gap);
      REQUIRE(touch);
      CHECK(sum_of_weights(*touch) == Approx(1));
      CHECK(touch->held == 0);
      for (const auto& [node, weight] : touch->weights)
        CHECK(face.soft.unknowns.of(face.soft.first())[node].number >= 0);
      const double c = testing::Stressless::sound_speed;
      CHECK(touch->modulus == Approx(testing::density * c * c));
    }
  });
}

TEST_CASE("Material does not touch what is away from it, nor a face that looks away from it", "[implicit]") {
  for_each_face([](ShapeFunction shape, const Face& face) {
    CHECK_FALSE(face.touch(is_spline(shape) ? 0.7 : 1.3));
    CHECK_FALSE(face.touch(1.6, true));
    for (const double gap : {0.0, 0.15}) CHECK_FALSE(face.touch(gap, false, true));
  });
}

TEST_CASE("Material that has touched a point may leave it by more before it does not", "[implicit]") {
  for_each_face([](ShapeFunction shape, const Face& face) {
    if (is_spline(shape)) CHECK(face.touch(0.8, true));
  });
}

TEST_CASE("Weights of nodes inside the material are those of the place", "[implicit]") {
  for (const ShapeFunction shape : shapes()) {
    CAPTURE(static_cast<int>(shape));
    const SoftBlock soft(block(0.5, {0, 0, 0}, {6, 6, 6}), shape);
    for (const Vec3<double>& x : {Vec3<double>{2.1, 2.3, 2.6}, {2.9, 2.45, 2.05}, {2.5, 3, 2.2}}) {
      // Material is all around, and grows by rounding errors alone: in the direction of some axis.
      int touches = 0;
      for (int side = 0; side < 6; ++side) {
        Vec3<double> normal{};
        normal[side / 2] = side % 2 == 0 ? 1 : -1;
        const std::optional<FaceTouch> touch = soft.touch(x, normal);
        if (!touch) continue;
        ++touches;
        const Vec3<double> off = soft.mean_place(*touch) - x;
        CHECK(std::sqrt(dot(off, off)) < 1e-13);
      }
      CHECK(touches > 0);
    }
  }
}

TEST_CASE("Material beside a face does not touch it", "[implicit]") {
  for (const ShapeFunction shape : shapes()) {
    CAPTURE(static_cast<int>(shape));
    // From 0.5 to 2.25 along x; two cells are below the point, and two above.
    const SoftBlock soft(block(0.25, {0.5, 0.5, 0}, {1.75, 4, 6}), shape);
    for (const double side : {1.0, -1.0}) {
      CHECK(soft.touch({2.35, 2.1, 2.5}, {-1, 0, 0}));
      CHECK_FALSE(soft.touch({2.35, 2.1, 2.5}, {0, 0, side}));
    }
  }
}

TEST_CASE("Walls hold a point whose nearest node along the face is on them", "[implicit]") {
  GridGeometry g = three_bricks();
  g.boundary[0] = Boundary::symmetry;
  g.boundary[2] = Boundary::fixed;
  for (const ShapeFunction shape : shapes()) {
    CAPTURE(static_cast<int>(shape));
    const SoftBlock soft(block(0.5, {0, 0, 0}, {4, 4, 2.25}), shape, g);
    const auto held = [&](double x, double y) {
      const std::optional<FaceTouch> touch = soft.touch({x, y, 2.25}, {0, 0, -1});
      REQUIRE(touch);
      CHECK(sum_of_weights(*touch) == Approx(1));
      return touch->held;
    };
    CHECK(held(0.3, 1.7) == 1);
    CHECK(held(0.6, 1.7) == 0);
    CHECK(held(1.3, 0.4) == 7);
    CHECK(held(1.3, 0.8) == 0);
    CHECK(held(0.2, 0.2) == 7);
  }
  // The nearest node of all has no material, those below it along the normal have.
  const SoftBlock soft(block(0.5, {0, 0, 0}, {4, 4, 2}), ShapeFunction::linear, g);
  const std::optional<FaceTouch> touch = soft.touch({0.3, 1.7, 2.6}, {0, 0, -1});
  REQUIRE(touch);
  CHECK(touch->held == 1);
}

TEST_CASE("The axis nearest to a direction, and the node nearest to a place", "[implicit]") {
  CHECK(axis_of({0.6, -0.8, 0}) == 1);
  CHECK(axis_of({-0.9, 0.1, 0.4}) == 0);
  CHECK(axis_of({0, 0, -1}) == 2);
  GridGeometry g = three_bricks();
  g.origin = {-2, 1, 0};
  g.cell = {0.5, 2, 1};
  g.inverse_cell = {2, 0.5, 1};
  CHECK(nearest_node(g, {-1.3, 3.9, 0.4}, 0) == 1);
  CHECK(nearest_node(g, {-1.3, 3.9, 0.4}, 1) == 1);
  CHECK(nearest_node(g, {-1.3, 4.1, 0.4}, 1) == 2);
  CHECK(nearest_node(g, {-1.3, 3.9, 0.4}, 2) == 0);
}
