// What particles take from nodes, against a plain loop, and against fields that trilinear functions hold
// exactly. Tolerance: eight products of numbers of size 1, rounded at 1e-16; gradients divide by the cell's
// edge of about 1.
#include "core/step/grid_to_particles.hpp"

#include <catch2/catch.hpp>

#include "core/material/batch.hpp"
#include "core/transfer/flip.hpp"
#include "tests/core/step/transfer.hpp"

using namespace mpm::core;
using mpm::tests::TransferCase;

namespace {

constexpr double tolerance = 1e-14;

struct Gradients {
  double row[9][block_lanes];
};

std::vector<double> random_records(const NodeBlockShape& shape, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<double> nodes(static_cast<std::size_t>(node_doubles * shape.nodes()));
  for (double& x : nodes) x = unit(random);
  return nodes;
}

/// f(particle's columns before, its block, its lane) over the blocks of the case; `work(block)` before each
/// block.
template <class S, class W, class F>
void over(TransferCase<S>& c, W work, F f) {
  for (std::size_t b = 0; b < c.tile.blocks.size(); ++b) {
    double* block = c.pool.block(c.tile.blocks[b]);
    work(block);
    for (std::size_t i = 0; i < block_lanes && block_lanes * b + i < c.particles.size(); ++i) {
      f(c.particles[block_lanes * b + i], block, static_cast<int>(i));
    }
  }
}

/// Sum of S times a component of the records.
template <class S>
double interpolated(const TransferCase<S>& c, const std::vector<double>& nodes, const std::vector<double>& p,
                    int component) {
  double sum = 0;
  c.for_each_node(p, [&](int node, double s, const Vec3<double>&) {
    sum += s * nodes[static_cast<std::size_t>(node_doubles * node + component)];
  });
  return sum;
}

/// What the kernels read of the nodes' records.
template <class S>
typename S::Field field_of(const TransferCase<S>& c, const std::vector<double>& nodes) {
  typename S::Field field;
  field.take_motion(nodes.data());
  field.take_strain(c.frame(), nodes.data());
  return field;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("Velocity and position take from the nodes what a plain loop takes", "", Shapes) {
  for (const BrickCoord brick : {BrickCoord{0, 0, 0}, {1, 0, 1}, {2, 2, 2}}) {
    TransferCase<TestType> c(brick, 150, 11);
    const std::vector<double> nodes = random_records(c.shape, 3);
    const auto field = field_of(c, nodes);
    const double dt = 0.03;
    double worst = 0;
    over(
        c,
        [&](double* block) {
          Flip::update_velocities<TestType>(c.block_place(block), c.pool.layout(), field, block);
        },
        [&](const std::vector<double>& p, const double* block, int lane) {
          for (int a = 0; a < 3; ++a) {
            const double v = p[static_cast<std::size_t>(3 + a)] + interpolated(c, nodes, p, 4 + a);
            worst = std::max(worst, std::abs(block[block_lanes * (3 + a) + lane] - v));
          }
        });
    CHECK(worst < tolerance);
    worst = 0;
    over(
        c,
        [&](double* block) {
          move_with_grid<TestType>(c.block_place(block), c.pool.layout(), field, dt, block);
        },
        [&](const std::vector<double>& p, const double* block, int lane) {
          for (int a = 0; a < 3; ++a) {
            const double x = p[static_cast<std::size_t>(a)] + dt * interpolated(c, nodes, p, a);
            worst = std::max(worst, std::abs(block[block_lanes * a + lane] - x));
          }
        });
    CHECK(worst < 20 * tolerance);  // coordinates reach 20
  }
}

TEMPLATE_LIST_TEST_CASE("Velocity gradients are a plain loop's", "", Shapes) {
  for (const BrickCoord brick : {BrickCoord{1, 0, 1}, {2, 2, 2}}) {
    TransferCase<TestType> c(brick, 150, 12);
    const std::vector<double> nodes = random_records(c.shape, 4);
    const auto field = field_of(c, nodes);
    Gradients second;
    double worst = 0;
    over(
        c, [&](double* block) { TestType::gradient(c.frame(), c.block_place(block), field, second.row, 0); },
        [&](const std::vector<double>& p, const double*, int lane) {
          double l[9] = {};
          c.for_each_node(p, [&](int node, double, const Vec3<double>& g) {
            const double* at = nodes.data() + node_doubles * node;
            for (int a = 0; a < 3; ++a) {
              for (int b = 0; b < 3; ++b) { l[3 * a + b] += at[4 + a] * g[b]; }
            }
          });
          for (int i = 0; i < 9; ++i) { worst = std::max(worst, std::abs(second.row[i][lane] - l[i])); }
        });
    CHECK(worst < 10 * tolerance);
  }
}

TEMPLATE_LIST_TEST_CASE(
    "Constant and linear velocity fields come out exactly, in the cell, on its faces, edges and corners", "",
    Shapes) {
  for (const BrickCoord brick : {BrickCoord{0, 0, 0}, {2, 2, 2}}) {
    TransferCase<TestType> c(brick, 150, 13);
    const double constant[3] = {3, -2, 0.5}, linear[3][3] = {{1, -2, 3}, {0.5, 4, -1}, {-3, 2, 0.25}};
    const int first[3] = {brick_cells * brick.x, brick_cells * brick.y, brick_cells * brick.z};
    std::vector<double> nodes(static_cast<std::size_t>(node_doubles * c.shape.nodes()));
    for (int k = c.shape.lowest(); k <= c.shape.highest(); ++k) {
      for (int j = c.shape.lowest(); j <= c.shape.highest(); ++j) {
        for (int i = c.shape.lowest(); i <= c.shape.highest(); ++i) {
          const int index[3] = {i, j, k};
          for (int a = 0; a < 3; ++a) {
            double v = constant[a];
            for (int b = 0; b < 3; ++b) v += linear[a][b] * c.geometry.cell[b] * (first[b] + index[b]);
            nodes[static_cast<std::size_t>(node_doubles * c.shape.index(i, j, k) + 4 + a)] = v;
          }
        }
      }
    }
    const auto field = field_of(c, nodes);
    Gradients g;
    Row strain;
    double worst_v = 0, worst_g = 0, worst_strain = 0;
    over(
        c,
        [&](double* block) {
          TestType::gradient(c.frame(), c.block_place(block), field, g.row, 0);
          TestType::cell_divergence(c.frame(), c.block_place(block), field, 0.01, strain, 0);
          Flip::update_velocities<TestType>(c.block_place(block), c.pool.layout(), field, block);
        },
        [&](const std::vector<double>& p, const double* block, int lane) {
          for (int a = 0; a < 3; ++a) {
            double v = p[static_cast<std::size_t>(3 + a)] + constant[a];
            for (int b = 0; b < 3; ++b) {
              v += linear[a][b] * (p[static_cast<std::size_t>(b)] - c.geometry.origin[b]);
              worst_g = std::max(worst_g, std::abs(g.row[3 * a + b][lane] - linear[a][b]));
            }
            worst_v = std::max(worst_v, std::abs(block[block_lanes * (3 + a) + lane] - v));
          }
          worst_strain = std::max(worst_strain, std::abs(strain[lane] - 0.01 * (1 + 4 + 0.25)));
        });
    // Nodal velocities reach 100.
    CHECK(worst_v < 100 * tolerance);
    CHECK(worst_g < 100 * tolerance);
    CHECK(worst_strain < 100 * tolerance);
  }
}

TEMPLATE_LIST_TEST_CASE("The cell's strain is that of its middle, the same for all its particles", "",
                        Shapes) {
  TransferCase<TestType> c({1, 0, 1}, 150, 14);
  const std::vector<double> nodes = random_records(c.shape, 9);
  const auto field = field_of(c, nodes);
  Row strain;
  double worst = 0;
  over(
      c,
      [&](const double* block) {
        TestType::cell_divergence(c.frame(), c.block_place(block), field, 1, strain, 0);
      },
      [&](const std::vector<double>& p, const double*, int lane) {
        const auto at = c.place(p);
        double sum = 0;  // of the differences across the cell, each averaged over four edges
        for (int n = 0; n < 8; ++n) {
          const int d[3] = {n & 1, (n >> 1) & 1, n >> 2};
          const int node = c.shape.index(at.cell[0] + d[0], at.cell[1] + d[1], at.cell[2] + d[2]);
          for (int a = 0; a < 3; ++a) {
            sum += 0.25 * (d[a] == 1 ? 1 : -1) / c.geometry.cell[a] *
                   nodes[static_cast<std::size_t>(node_doubles * node + 4 + a)];
          }
        }
        worst = std::max(worst, std::abs(strain[lane] - sum));
      });
  CHECK(worst < 10 * tolerance);
}

TEST_CASE("Lanes outside the brick are found, lanes out of use are not") {
  TransferCase<Linear> c({1, 1, 1}, 8, 15);
  double* block = c.pool.block(c.tile.blocks[0]);
  const auto put = [&](int lane, int axis, double cells) {
    block[block_lanes * axis + lane] = c.geometry.origin[axis] + c.geometry.cell[axis] * cells;
  };
  for (int lane = 0; lane < 8; ++lane) {
    for (int a = 0; a < 3; ++a) put(lane, a, 6);
  }
  CHECK(lanes_outside(c.frame(), c.pool.layout(), block, 8) == 0);
  put(0, 0, 8.01);
  put(2, 1, 3.99);
  put(5, 2, -100);
  block[block_lanes * 1 + 6] = std::nan("");
  CHECK(lanes_outside(c.frame(), c.pool.layout(), block, 8) ==
        ((1u << 0) | (1u << 2) | (1u << 5) | (1u << 6)));
  CHECK(lanes_outside(c.frame(), c.pool.layout(), block, 5) == ((1u << 0) | (1u << 2)));
}
