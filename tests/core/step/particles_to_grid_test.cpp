// What particles add to nodes, against a plain loop over particles and nodes. Tolerance: both add up to some
// ten products per node, in different orders, each rounded to 1e-16 of the largest. A particle on the face
// between two cells may be in either by round-off; what a node gets of it differs by 1e-14 of it then, as S
// or its jump vanishes for mass and momentum; for forces the cell decides, so both sides ask for it in the
// same way.
#include "core/step/particles_to_grid.hpp"

#include <catch2/catch.hpp>

#include "tests/core/step/transfer.hpp"

using namespace mpm::core;
using mpm::tests::BuiltShapes;
using mpm::tests::TransferCase;

namespace {

template <NodeFields what, class S, class T>
std::vector<double> by_kernel(const TransferCase<S, T>& c) {
  constexpr int width = record_doubles(what.array);
  std::vector<double> nodes(static_cast<std::size_t>(width * c.shape.nodes()));
  typename S::template Sums<what> sums(nodes.data());
  typename S::template Scatter<what> cell;
  cell.clear();
  for (std::size_t b = 0; b < c.tile.blocks.size(); ++b) {
    const int used = c.tile.used_lanes(b);
    const double* block = c.pool.block(c.tile.blocks[b]);
    add_block<S, T, what>(c.frame(), c.block_place(block), c.pool.layout(), block, used, cell, sums.records);
  }
  cell.flush(c.frame(), sums.records);
  sums.finish(c.frame());
  return nodes;
}

/// Affine: each node gets m (v + C (x_i - x)).
template <NodeFields what, class S, class T>
std::vector<double> plain(const TransferCase<S, T>& c) {
  constexpr int width = record_doubles(what.array);
  std::vector<double> nodes(static_cast<std::size_t>(width * c.shape.nodes()));
  for (const std::vector<double>& p : c.particles) {
    const double v[3] = {p[3], p[4], p[5]}, m = p[6], volume = p[7], total = p[14] + p[15];
    const double sigma[3][3] = {
        {p[8] - total, p[11], p[13]}, {p[11], p[9] - total, p[12]}, {p[13], p[12], p[10] - total}};
    const ColumnLayout& layout = c.pool.layout();
    c.for_each_node(p, [&](int node, double s, const Vec3<double>& g) {
      double* at = nodes.data() + width * node;
      for (int a = 0; a < 3; ++a) {
        double u = v[a];
        for (int b = 0; b < 3; ++b) {
          const Column affine = next(Column::affine_xx, 3 * a + b);
          if (layout.has(affine))
            u += p[layout.index(affine)] * (c.node_position(node)[b] - p[static_cast<std::size_t>(b)]);
        }
        if (maps_momentum(what)) at[a] += m * u * s;
        if constexpr (maps_force(what)) {
          for (int b = 0; b < 3; ++b) at[4 + a] -= volume * sigma[a][b] * g[b];
        }
      }
      if (maps_mass(what)) at[3] += m * s;
    });
  }
  return nodes;
}

template <NodeFields what, class S, class T>
void compare(const TransferCase<S, T>& c) {
  const std::vector<double> one = by_kernel<what>(c), two = plain<what>(c);
  double worst = 0, scale = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    worst = std::max(worst, std::abs(one[i] - two[i]));
    scale = std::max(scale, std::abs(two[i]));
  }
  CHECK(worst <= 1e-14 * scale);
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("All that is mapped to the nodes is what a plain loop maps", "", BuiltShapes) {
  for (const BrickCoord brick : {BrickCoord{0, 0, 0}, {1, 0, 1}, {2, 2, 2}}) {
    for (const int count : {0, 1, 7, 8, 9, 200}) {
      INFO("brick " << brick.x << brick.y << brick.z << ", particles " << count);
      const TransferCase<TestType> c(brick, count, 7u * static_cast<unsigned>(count) + 1);
      compare<mapped::momentum_mass_force>(c);
      compare<mapped::momentum_mass>(c);
      compare<mapped::momentum>(c);
      compare<mapped::force>(c);
    }
  }
}

TEMPLATE_TEST_CASE("Affine velocities are mapped to the nodes as a plain loop maps them", "", UniformGimp,
                   QuadraticBSpline, CubicBSpline) {
  for (const BrickCoord brick : {BrickCoord{0, 0, 0}, {2, 2, 2}}) {
    const TransferCase<TestType, Apic> c(brick, 100, 8);
    compare<mapped::momentum_mass_force>(c);
    compare<mapped::momentum_mass>(c);
    compare<mapped::momentum>(c);
  }
}

TEMPLATE_LIST_TEST_CASE("The nodes get all mass and momentum, and forces that balance each other", "",
                        BuiltShapes) {
  const TransferCase<TestType> c({1, 1, 1}, 333, 5);
  const std::vector<double> nodes = by_kernel<mapped::momentum_mass_force>(c);
  double sum[8] = {}, size[8] = {}, all[4] = {};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    sum[i % 8] += nodes[i];
    size[i % 8] += std::abs(nodes[i]);
  }
  for (const auto& p : c.particles) {
    for (std::size_t a = 0; a < 3; ++a) all[a] += p[6] * p[3 + a];
    all[3] += p[6];
  }
  // Sums over some hundred nodes, rounded to 1e-16 of what is summed.
  for (int a = 0; a < 4; ++a) CHECK(std::abs(sum[a] - all[a]) < 1e-14 * size[a]);
  for (int a = 4; a < 7; ++a) CHECK(std::abs(sum[a]) < 1e-14 * size[a]);
  CHECK(size[7] == 0);
}

TEMPLATE_LIST_TEST_CASE("Lanes out of use add nothing, whatever is in them", "", BuiltShapes) {
  TransferCase<TestType> c({1, 0, 1}, 11, 6);
  const std::vector<double> before = by_kernel<mapped::momentum_mass_force>(c);
  double* block = c.pool.block(c.tile.blocks[1]);
  for (int column = 0; column < c.pool.layout().columns(); ++column) {
    for (int lane = 3; lane < block_lanes; ++lane) block[block_lanes * column + lane] = std::nan("");
  }
  CHECK(by_kernel<mapped::momentum_mass_force>(c) == before);
}
