// What particles take from nodes, against a plain loop, and against fields that trilinear functions hold
// exactly. Tolerance: eight products of numbers of size 1, rounded at 1e-16; gradients divide by the cell's
// edge of about 1.
#include "core/step/grid_to_particles.hpp"

#include <catch2/catch.hpp>

#include "core/material/batch.hpp"
#include "core/step/particles_to_grid.hpp"
#include "tests/core/step/transfer.hpp"

using namespace mpm::core;
using mpm::tests::BuiltShapes;
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
template <class S, class T, class W, class F>
void over(TransferCase<S, T>& c, W work, F f) {
  for (std::size_t b = 0; b < c.tile.blocks.size(); ++b) {
    double* block = c.pool.block(c.tile.blocks[b]);
    work(block);
    for (std::size_t i = 0; i < block_lanes && block_lanes * b + i < c.particles.size(); ++i) {
      f(c.particles[block_lanes * b + i], block, static_cast<int>(i));
    }
  }
}

/// Sum of S times a component of the records.
template <class S, class T>
double interpolated(const TransferCase<S, T>& c, const std::vector<double>& nodes,
                    const std::vector<double>& p, int component) {
  double sum = 0;
  c.for_each_node(p, [&](int node, double s, const Vec3<double>&) {
    sum += s * nodes[static_cast<std::size_t>(node_doubles * node + component)];
  });
  return sum;
}

/// What the kernels read of the nodes' records.
template <class S, class T>
typename S::Field field_of(const TransferCase<S, T>& c, const std::vector<double>& nodes) {
  typename S::Field field;
  field.take_motion(nodes.data());
  field.take_strain(c.frame(), nodes.data());
  return field;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("Velocity and position take from the nodes what a plain loop takes", "",
                        BuiltShapes) {
  for (const BrickCoord brick : {BrickCoord{0, 0, 0}, {1, 0, 1}, {2, 2, 2}}) {
    TransferCase<TestType> c(brick, 150, 11);
    const std::vector<double> nodes = random_records(c.shape, 3);
    const auto field = field_of(c, nodes);
    const double dt = 0.03;
    double worst = 0;
    over(
        c,
        [&](double* block) {
          Flip(SolutionInput())
              .update_velocities<TestType>(c.frame(), c.block_place(block), c.pool.layout(), field, {},
                                           block);
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

TEMPLATE_LIST_TEST_CASE("Velocity gradients are a plain loop's", "", BuiltShapes) {
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
    BuiltShapes) {
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
          Flip(SolutionInput())
              .update_velocities<TestType>(c.frame(), c.block_place(block), c.pool.layout(), field, {},
                                           block);
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
                        BuiltShapes) {
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

namespace {

/// Velocity in components 0..2 of the records: constant + linear x.
template <class S, class T>
std::vector<double> linear_velocity(const TransferCase<S, T>& c, const double (&linear)[3][3]) {
  std::vector<double> nodes(static_cast<std::size_t>(node_doubles * c.shape.nodes()));
  for (int n = 0; n < c.shape.nodes(); ++n) {
    for (int a = 0; a < 3; ++a) {
      double v = 1 - a;
      for (int b = 0; b < 3; ++b) v += linear[a][b] * c.node_position(n)[b];
      nodes[static_cast<std::size_t>(node_doubles * n + a)] = v;
    }
  }
  return nodes;
}

template <class S, class T>
void takes_linear_field() {
  TransferCase<S, T> c({2, 2, 2}, 100, 21);
  const double linear[3][3] = {{1, -2, 3}, {0.5, 4, -1}, {-3, 2, 0.25}};
  const std::vector<double> nodes = linear_velocity(c, linear);
  const auto field = field_of(c, nodes);
  const ColumnLayout& layout = c.pool.layout();
  double worst_v = 0, worst_c = 0;
  over(
      c,
      [&](double* block) {
        T(SolutionInput())
            .template update_velocities<S>(c.frame(), c.block_place(block), layout, field, {}, block);
      },
      [&](const std::vector<double>& p, const double* block, int lane) {
        for (int a = 0; a < 3; ++a) {
          double v = 1 - a;
          for (int b = 0; b < 3; ++b) {
            v += linear[a][b] * p[static_cast<std::size_t>(b)];
            worst_c = std::max(
                worst_c,
                std::abs(block[layout.offset(next(Column::affine_xx, 3 * a + b)) + lane] - linear[a][b]));
          }
          worst_v = std::max(worst_v, std::abs(block[block_lanes * (3 + a) + lane] - v));
        }
      });
  CHECK(worst_v < 100 * tolerance);  // nodal velocities reach 100
  CHECK(worst_c < 1000 * tolerance);
}

}  // namespace

TEMPLATE_TEST_CASE("APIC and TPIC take a linear velocity field whole", "", UniformGimp, QuadraticBSpline,
                   CubicBSpline) {
  takes_linear_field<TestType, Apic>();
  takes_linear_field<TestType, Tpic>();
}

TEMPLATE_TEST_CASE("APIC's particles take all angular momentum of the nodes", "", UniformGimp,
                   QuadraticBSpline, CubicBSpline) {
  TransferCase<TestType, Apic> c({1, 1, 1}, 200, 22);
  // Momentum to the nodes, and back from their velocities: the sum of x x p, and of the affine parts.
  std::vector<double> contributions(static_cast<std::size_t>(node_doubles * c.shape.nodes()));
  typename TestType::template Scatter<mapped::momentum_mass_force> cell;
  for (std::size_t b = 0; b < c.tile.blocks.size(); ++b) {
    const double* block = c.pool.block(c.tile.blocks[b]);
    add_block<TestType, Apic, mapped::momentum_mass_force>(c.frame(), c.block_place(block), c.pool.layout(),
                                                           block, c.tile.used_lanes(b), cell,
                                                           contributions.data());
  }
  std::vector<double> nodes(contributions.size());
  Vec3<double> of_nodes{}, of_particles{};
  double size = 0;
  for (int n = 0; n < c.shape.nodes(); ++n) {
    const double* at = contributions.data() + node_doubles * n;
    const Vec3<double> p{at[0], at[1], at[2]}, x = c.node_position(n);
    of_nodes = of_nodes + cross(x, p);
    size += std::sqrt(dot(x, x) * dot(p, p));
    for (int a = 0; a < 3; ++a)
      nodes[static_cast<std::size_t>(node_doubles * n + a)] = at[3] > 0 ? at[a] / at[3] : 0;
  }
  const auto field = field_of(c, nodes);
  const ColumnLayout& layout = c.pool.layout();
  over(
      c,
      [&](double* block) {
        Apic(SolutionInput())
            .update_velocities<TestType>(c.frame(), c.block_place(block), layout, field, {}, block);
      },
      [&](const std::vector<double>& p, const double* block, int lane) {
        const double m = p[6];
        const auto get = [&](Column column) { return block[layout.offset(column) + lane]; };
        const Vec3<double> x{p[0], p[1], p[2]};
        const Vec3<double> v{get(Column::velocity_x), get(Column::velocity_y), get(Column::velocity_z)};
        of_particles = of_particles + m * cross(x, v);
        // sum S_i m (x_i - x) x C (x_i - x), with the diagonal D.
        Vec3<double> d{};
        c.for_each_node(p, [&](int node, double s, const Vec3<double>&) {
          for (int a = 0; a < 3; ++a) d[a] += s * std::pow(c.node_position(node)[a] - x[a], 2);
        });
        const auto affine = [&](int a, int b) { return get(next(Column::affine_xx, 3 * a + b)); };
        of_particles = of_particles + m * Vec3<double>{affine(2, 1) * d.y - affine(1, 2) * d.z,
                                                       affine(0, 2) * d.z - affine(2, 0) * d.x,
                                                       affine(1, 0) * d.x - affine(0, 1) * d.y};
      });
  for (int a = 0; a < 3; ++a) CHECK(std::abs(of_nodes[a] - of_particles[a]) < 1e-14 * size);
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
