#pragma once
// One brick with particles anywhere in it, faces, edges and corners included, and the textbook's shape
// functions at them (thesis 2-17), for the tests of the transfer kernels.

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/particles/block_pool.hpp"
#include "core/shape/linear.hpp"

namespace mpm::tests {

/// 10 x 11 x 9 oblong cells, origin negative: brick (2, 2, 2) has 2 x 3 x 1 cells.
inline core::GridGeometry transfer_geometry() {
  core::GridGeometry g;
  g.origin = {-7.3, -20, 1e-3};
  g.cell = {0.7, 1.3, 2.1};
  g.inverse_cell = {1 / 0.7, 1 / 1.3, 1 / 2.1};
  g.cells = {10, 11, 9};
  return g;
}

struct TransferCase {
  core::GridGeometry geometry = transfer_geometry();
  core::NodeBlockShape shape;
  core::BrickCoord brick;
  core::BlockPool pool{core::ColumnLayout()};
  core::ParticleTile tile;
  std::vector<std::vector<double>> particles;  ///< their columns, in the order of ColumnSet::mechanics()

  TransferCase(core::BrickCoord b, int count, unsigned seed) : brick(b) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int n = 0; n < count; ++n) {
      std::vector<double>& p = particles.emplace_back();
      for (int c = 0; c < pool.layout().columns(); ++c) p.push_back(2 * unit(random) - 1);
      for (int a = 0; a < 3; ++a) {
        const double cells = geometry.last_cell(b, a) + 1;
        double s = cells * unit(random);
        if (n % 5 == a) s = std::floor(s);  // on faces, edges (n % 5 == 3: none)
        if (n % 5 == 4) s = std::floor(s);  // corners
        // The grid's upper face belongs to the last cell.
        const int first = core::brick_cells * (a == 0 ? b.x : a == 1 ? b.y : b.z);
        if (n % 11 == 7 && first + cells == static_cast<double>(geometry.cells[static_cast<std::size_t>(a)]))
          s = cells;
        p[static_cast<std::size_t>(a)] = geometry.origin[a] + geometry.cell[a] * (first + s);
      }
      p[6] = 0.5 + unit(random);  // mass
      p[7] = 0.5 + unit(random);  // volume
      append(pool, tile, p.data());
    }
  }

  core::BrickFrame frame() const { return {geometry, shape, brick}; }
  core::LinearPlace block_place(const double* block) const { return {frame(), pool.layout(), block}; }

  /// Scaled position in the brick, cell and fraction; a point that round-off puts below its brick is in its
  /// first cell.
  struct Place {
    std::array<int, 3> cell;
    std::array<double, 3> fraction;
  };
  Place place(const std::vector<double>& p) const {
    Place at{};
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      const int first = core::brick_cells * (a == 0 ? brick.x : a == 1 ? brick.y : brick.z);
      const double s = (p[i] - geometry.origin[a]) * geometry.inverse_cell[a] - first;
      const int last = geometry.last_cell(brick, a);
      at.cell[i] = std::min(std::max(static_cast<int>(std::floor(s)), 0), last);
      at.fraction[i] = s - at.cell[i];
    }
    return at;
  }
  /// f(node, S, gradient of S) for the eight nodes of a particle's cell.
  template <class F>
  void for_each_node(const std::vector<double>& p, F f) const {
    const Place at = place(p);
    for (int n = 0; n < 8; ++n) {
      const int d[3] = {n & 1, (n >> 1) & 1, n >> 2};
      double w[3], dw[3];
      for (int a = 0; a < 3; ++a) {
        w[a] = d[a] == 1 ? at.fraction[static_cast<std::size_t>(a)]
                         : 1 - at.fraction[static_cast<std::size_t>(a)];
        dw[a] = (d[a] == 1 ? 1 : -1) / geometry.cell[a];
      }
      f(shape.index(at.cell[0] + d[0], at.cell[1] + d[1], at.cell[2] + d[2]), w[0] * w[1] * w[2],
        core::Vec3<double>{dw[0] * w[1] * w[2], w[0] * dw[1] * w[2], w[0] * w[1] * dw[2]});
    }
  }
};

}  // namespace mpm::tests
