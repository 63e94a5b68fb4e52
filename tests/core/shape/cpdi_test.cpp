// How the domains of CPDI and CPDI2 follow the motion, and what becomes of wide and tangled ones.
#include "core/shape/cpdi.hpp"

#include <random>

#include <catch2/catch.hpp>

#include "core/material/batch.hpp"
#include "tests/core/step/transfer.hpp"

using namespace mpm::core;
using mpm::tests::DomainCorners;
using mpm::tests::Matrix;
using mpm::tests::means_over;
using mpm::tests::read_domain;
using mpm::tests::TransferCase;
using mpm::tests::Vector;
using mpm::tests::write_domain;

namespace {

/// Velocity and strain velocity A x on the nodes, x from the grid's origin.
template <class S>
std::vector<double> linear_motion(const TransferCase<S>& c, const Matrix& A) {
  std::vector<double> nodes(static_cast<std::size_t>(node_doubles * c.shape.nodes()));
  for (int n = 0; n < c.shape.nodes(); ++n) {
    const Vec3<double> x = c.node_position(n) - c.geometry.origin;
    const Vector at = {x.x, x.y, x.z};
    for (std::size_t a = 0; a < 3; ++a) {
      double v = 0;
      for (std::size_t b = 0; b < 3; ++b) v += A[a][b] * at[b];
      nodes[node_doubles * static_cast<std::size_t>(n) + a] = v;
      nodes[node_doubles * static_cast<std::size_t>(n) + 4 + a] = v;
    }
  }
  return nodes;
}

template <class S>
DomainCounts advance(TransferCase<S>& c, const typename S::Field& field, double dt, double* block,
                     bool free) {
  const ColumnLayout& layout = c.pool.layout();
  const auto place = c.block_place(block);
  const typename S::Sample sample(place, field);
  if constexpr (std::is_same_v<S, Cpdi>) {
    Row rows[9];
    sample.gradient(c.frame(), rows, 0);
    if (free) sample.move(layout, dt, block);
    return S::deform(c.frame(), layout, rows, 0, dt, block, 8);
  } else {
    if (free) sample.move(layout, dt, block);
    sample.carry(layout, dt, block);
    return S::settle(c.frame(), layout, free, block, 8);
  }
}

Vector times(const Matrix& F, const Vector& x) {
  Vector y{};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) y[a] += F[a][b] * x[b];
  return y;
}

/// Of particle `lane` in a block.
Vector position(const double* block, int lane) {
  return {block[lane], block[block_lanes + lane], block[2 * block_lanes + lane]};
}

/// Largest distance of the corners from F times their first places, and of the particle from F times its own.
template <class S>
std::array<double, 2> error_after(const Matrix& A, const Matrix& F, double dt, int steps) {
  TransferCase<S> c({1, 1, 1}, 8, 31);
  double* block = c.pool.block(c.tile.blocks[0]);
  const ColumnLayout& layout = c.pool.layout();
  for (int l = 0; l < 8; ++l) {  // in the middle of the brick
    Vector half{};
    for (int a = 0; a < 3; ++a) {
      block[block_lanes * a + l] =
          c.geometry.origin[a] + c.geometry.cell[a] * (c.first_node(a) + 1.5 + 0.11 * l);
      half[static_cast<std::size_t>(a)] = 0.2 * c.geometry.cell[a];
    }
    write_domain<S>(layout, mpm::tests::any_domain<S>(half, [&] { return 0.1 * l; }), block + l, block_lanes);
  }
  std::vector<double> first(block, block + layout.block_doubles());
  const std::vector<double> nodes = linear_motion(c, A);
  typename S::Field field;
  field.take_motion(nodes.data());
  for (int n = 0; n < steps; ++n) {
    const DomainCounts counts = advance(c, field, dt, block, true);
    CHECK(counts.wide + counts.tangled == 0);
  }
  double corner_error = 0, particle_error = 0;
  const Vector origin = {c.geometry.origin.x, c.geometry.origin.y, c.geometry.origin.z};
  for (int l = 0; l < 8; ++l) {
    const DomainCorners before = read_domain<S>(layout, first.data() + l, block_lanes),
                        after = read_domain<S>(layout, block + l, block_lanes);
    Vector x = position(first.data(), l);
    for (std::size_t a = 0; a < 3; ++a) x[a] -= origin[a];
    const Vector moved = times(F, x), at = position(block, l);
    for (std::size_t a = 0; a < 3; ++a)
      particle_error = std::max(particle_error, std::abs(at[a] - origin[a] - moved[a]));
    for (std::size_t k = 0; k < 8; ++k) {
      const Vector exact = times(F, before[k]);
      for (std::size_t a = 0; a < 3; ++a)
        corner_error = std::max(corner_error, std::abs(after[k][a] - exact[a]));
    }
  }
  return {corner_error, particle_error};
}

}  // namespace

TEMPLATE_TEST_CASE("Domains follow the deformation gradient exactly: simple shear, stretch, and both", "",
                   Cpdi, Cpdi2) {
  const double dt = 0.001;
  const int steps = 40;
  // Simple shear: (I + dt A)^n = I + n dt A.
  const Matrix shear = {{{0, 0.9, 0}, {0, 0, 0}, {0, 0, 0}}};
  const auto sheared =
      error_after<TestType>(shear, {{{1, 0.9 * steps * dt, 0}, {0, 1, 0}, {0, 0, 1}}}, dt, steps);
  CHECK(sheared[0] < 1e-14);
  CHECK(sheared[1] < 1e-13);  // coordinates reach 20
  const Matrix stretch = {{{1.2, 0, 0}, {0, -0.4, 0}, {0, 0, 0.7}}};
  const auto along = [&](double rate) { return std::pow(1 + dt * rate, steps); };
  const auto stretched = error_after<TestType>(
      stretch, {{{along(1.2), 0, 0}, {0, along(-0.4), 0}, {0, 0, along(0.7)}}}, dt, steps);
  CHECK(stretched[0] < 1e-13);
  CHECK(stretched[1] < 1e-13);
  const Matrix any = {{{0.4, -0.9, 0.3}, {0.5, -0.2, 0.1}, {-0.3, 0.2, 0.25}}};
  Matrix F = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int n = 0; n < steps; ++n) {
    Matrix next = F;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        for (std::size_t k = 0; k < 3; ++k) next[a][b] += dt * any[a][k] * F[k][b];
    F = next;
  }
  const auto general = error_after<TestType>(any, F, dt, steps);
  CHECK(general[0] < 1e-13);
  CHECK(general[1] < 1e-12);
}

TEST_CASE(
    "CPDI2's corners take the grid's velocity at their own places, and its particles keep to centroids") {
  TransferCase<Cpdi2> c({1, 1, 1}, 8, 32);
  double* block = c.pool.block(c.tile.blocks[0]);
  const ColumnLayout& layout = c.pool.layout();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<double> nodes(static_cast<std::size_t>(node_doubles * c.shape.nodes()));
  for (double& x : nodes) x = unit(random);
  for (const bool free : {true, false}) {
    const std::vector<double> before(block, block + layout.block_doubles());
    Cpdi2::Field field;
    field.take_motion(nodes.data());
    const double dt = 0.02;
    CHECK(advance(c, field, dt, block, free).tangled == 0);
    double worst = 0, off_centre = 0, moved = 0;
    for (int l = 0; l < 8; ++l) {
      if (l % 7 == 3) continue;  // wide
      const Vector x = position(before.data(), l), y = position(block, l);
      const DomainCorners old = read_domain<Cpdi2>(layout, before.data() + l, block_lanes),
                          now = read_domain<Cpdi2>(layout, block + l, block_lanes);
      DomainCorners exact = old;
      for (std::size_t k = 0; k < 8; ++k) {
        for (int n = 0; n < c.shape.nodes(); ++n) {
          double hats = 1;
          for (std::size_t a = 0; a < 3; ++a) {
            const int axis = static_cast<int>(a);
            hats *= std::max(
                1 - std::abs(x[a] + old[k][a] - c.node_position(n)[axis]) / c.geometry.cell[axis], 0.0);
          }
          for (std::size_t a = 0; a < 3; ++a)
            exact[k][a] += dt * hats * nodes[node_doubles * static_cast<std::size_t>(n) + a];
        }
      }
      const Vector centroid = means_over(exact).centroid;
      for (std::size_t a = 0; a < 3; ++a) {
        if (free) worst = std::max(worst, std::abs(y[a] - x[a] - centroid[a]));
        moved = std::max(moved, std::abs(y[a] - x[a]));
        off_centre = std::max(off_centre, std::abs(means_over(now).centroid[a]));
        for (std::size_t k = 0; k < 8; ++k)
          worst = std::max(worst, std::abs(now[k][a] - (exact[k][a] - centroid[a])));
      }
    }
    CHECK(worst < 2e-14);  // coordinates reach 20
    CHECK(off_centre < 1e-15);
    CHECK((moved > 0) == free);
  }
}

TEMPLATE_TEST_CASE("Domains that reach more than a cell are counted, and evaluated as if squeezed to a cell",
                   "", Cpdi, Cpdi2) {
  TransferCase<TestType> c({1, 1, 1}, 8, 33);
  double* block = c.pool.block(c.tile.blocks[0]);
  const ColumnLayout& layout = c.pool.layout();
  for (int l = 0; l < 8; ++l) {
    Vector half{};
    for (std::size_t a = 0; a < 3; ++a) half[a] = 0.3 * c.geometry.cell[static_cast<int>(a)];
    if (l == 2) half[1] *= 5;
    if (l == 5) half[0] *= 9;
    write_domain<TestType>(layout, mpm::tests::box(half), block + l, block_lanes);
  }
  const std::vector<double> nodes = linear_motion(c, {});
  typename TestType::Field field;
  field.take_motion(nodes.data());
  const std::vector<double> before(block, block + layout.block_doubles());
  const DomainCounts counts = advance(c, field, 0.1, block, true);
  CHECK(counts.wide == 2);
  CHECK(counts.tangled == 0);
  double change = 0;  // of columns: the domain itself keeps its size
  for (int l = 0; l < 8; ++l) {
    const DomainCorners old = read_domain<TestType>(layout, before.data() + l, block_lanes),
                        now = read_domain<TestType>(layout, block + l, block_lanes);
    for (std::size_t k = 0; k < 8; ++k)
      for (std::size_t a = 0; a < 3; ++a) change = std::max(change, std::abs(now[k][a] - old[k][a]));
  }
  CHECK(change < 1e-14);
  // Along y, the corners of lane 2 are a cell away, along the other axes where they were.
  const auto place = c.block_place(block);
  double reach[3] = {};
  TestType::for_each_node(place, 2, c.geometry.inverse_cell,
                          [&](int node, double, const Vec3<double>& slope) {
                            for (int a = 0; a < 3; ++a)
                              reach[a] += slope[a] * (c.node_position(node)[a] - block[block_lanes * a + 2]);
                          });
  for (const double r : reach) CHECK(r == Approx(1).epsilon(1e-13));
  const double y = (block[block_lanes + 2] - c.geometry.origin.y) * c.geometry.inverse_cell.y;
  const double fraction = y - std::floor(y);
  for (int k = 0; k < corners; ++k)
    CHECK(std::abs(place.corner[1][k][2] - fraction) == Approx(1).margin(1e-12));
}

TEMPLATE_TEST_CASE("Domains that fill a cell stay in it, whatever round-off does to their corners", "", Cpdi,
                   Cpdi2) {
  TransferCase<TestType> c({1, 1, 1}, 8, 36);
  double* block = c.pool.block(c.tile.blocks[0]);
  const Vector first = position(block, 0);
  for (int l = 0; l < 8; ++l) {
    Vector half{};
    for (int a = 0; a < 3; ++a) {
      const double h = c.geometry.cell[a], origin = c.geometry.origin[a];
      const double cell = std::floor((first[static_cast<std::size_t>(a)] - origin) / h);
      block[block_lanes * a + l] = origin + (cell + 0.25 + 0.5 * (l >> a & 1)) * h;
      half[static_cast<std::size_t>(a)] = (0.25 + 1e-14 * (l % 3 - 1)) * h;
    }
    write_domain<TestType>(c.pool.layout(), mpm::tests::box(half), block + l, block_lanes);
  }
  const auto place = c.block_place(block);
  CHECK(place.far == 0);
  CHECK(place.values().shared);
  for (const auto& axis : place.corner)
    for (const auto& corner : axis)
      CHECK(std::ranges::all_of(corner, [](double x) { return 0 <= x && x < 1; }));
}

TEMPLATE_TEST_CASE("Particles have the same bits whatever the unused lanes of their block hold", "", Cpdi,
                   Cpdi2) {
  constexpr std::size_t count = 64;
  TransferCase<TestType> c({1, 1, 1}, count, 37);
  std::mt19937 random(38);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<double> nodes(static_cast<std::size_t>(node_doubles * c.shape.nodes()));
  for (double& u : nodes) u = unit(random);
  typename TestType::Field field;
  field.take_motion(nodes.data());
  const ColumnLayout& layout = c.pool.layout();
  std::vector<double> block(static_cast<std::size_t>(layout.block_doubles()));
  const auto put = [&](int lane, std::size_t particle) {
    const std::vector<double>& columns = c.particles[particle % count];
    for (std::size_t i = 0; i < columns.size(); ++i)
      block[block_lanes * i + static_cast<std::size_t>(lane)] = columns[i];
  };
  const auto results = [&](int used) {
    const auto place = c.block_place(block.data(), used);
    const typename TestType::Interpolation increment(place, field.increment());
    Row rows[9];
    TestType::gradient(c.frame(), place, field, rows, 0);
    std::vector<double> found;
    for (int l = 0; l < used; ++l) {
      for (int a = 0; a < 3; ++a) found.push_back(increment.value[a][l]);
      for (const Row& row : rows) found.push_back(row[l]);
    }
    return found;
  };
  for (std::size_t first = 0; first < count; ++first) {
    const int used = 1 + static_cast<int>(first % 7);
    for (int l = 0; l < block_lanes; ++l) put(l, first);  // all in one cell, but for the unused ones below
    const std::vector<double> alone = results(used);
    int different = 0;
    for (std::size_t other = 0; other < count; ++other) {
      for (int l = used; l < block_lanes; ++l) put(l, other + static_cast<std::size_t>(l));
      different += results(used) != alone;
    }
    CHECK(different == 0);
  }
}

TEST_CASE("A tangled hexahedron becomes the parallelepiped of its mean edges, or else a cube") {
  TransferCase<Cpdi2> c({1, 1, 1}, 8, 34);
  double* block = c.pool.block(c.tile.blocks[0]);
  const ColumnLayout& layout = c.pool.layout();
  const Vector half = {0.2, 0.3, 0.4};
  for (int l = 0; l < 8; ++l) {
    DomainCorners corner = mpm::tests::box(half);
    if (l == 1) corner[7] = {-0.19, -0.29, -0.39};  // pushed through the others
    if (l == 4)
      for (Vector& x : corner) x[2] = -x[2];  // inside out
    if (l == 6) corner[3][1] = std::nan("");
    write_domain<Cpdi2>(layout, corner, block + l, block_lanes);
    block[layout.offset(Column::volume) + l] = 0.027;
  }
  const Vector at = position(block, 1);
  CHECK(Cpdi2::settle(c.frame(), layout, true, block, 6).tangled == 2);  // lane 6 is out of use
  CHECK(Cpdi2::settle(c.frame(), layout, true, block, 8).tangled == 1);
  CHECK(Cpdi2::settle(c.frame(), layout, true, block, 8).tangled == 0);
  // The mean edges of lane 1: three of the four along each axis are whole.
  const DomainCorners one = read_domain<Cpdi2>(layout, block + 1, block_lanes);
  const double away[3] = {0.39, 0.59, 0.79};  // of its corner from where it belongs
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double edge = 0.5 * (one[std::size_t{1} << k][a] - one[0][a]);
      CHECK(edge == Approx((a == k ? half[a] : 0) - away[a] / 8).margin(1e-15));
    }
    CHECK(position(block, 1)[a] == Approx(at[a] - away[a] / 8));
    CHECK(one[0][a] + one[7][a] == Approx(0).margin(1e-15));
  }
  for (const int l : {4, 6}) {
    const DomainCorners cube = mpm::tests::box({0.15, 0.15, 0.15});
    const DomainCorners now = read_domain<Cpdi2>(layout, block + l, block_lanes);
    for (std::size_t k = 0; k < 8; ++k)
      for (std::size_t a = 0; a < 3; ++a) CHECK(now[k][a] == Approx(cube[k][a]).epsilon(1e-14));
  }
}

TEST_CASE("A parallelepiped that turns inside out becomes a cube of the particle's volume") {
  TransferCase<Cpdi> c({1, 1, 1}, 8, 35);
  double* block = c.pool.block(c.tile.blocks[0]);
  const ColumnLayout& layout = c.pool.layout();
  Row rows[9] = {};
  for (int l = 0; l < 8; ++l) {
    write_domain<Cpdi>(layout, mpm::tests::box({0.2, 0.3, 0.4}), block + l, block_lanes);
    block[layout.offset(Column::volume) + l] = 0.027;
  }
  rows[4][3] = -20;                                                             // dt L = -2
  CHECK(Cpdi::deform(c.frame(), layout, rows, 0, 0.1, block, 3).tangled == 0);  // lane 3 is out of use
  for (int l = 0; l < 8; ++l)
    write_domain<Cpdi>(layout, mpm::tests::box({0.2, 0.3, 0.4}), block + l, block_lanes);
  const DomainCounts counts = Cpdi::deform(c.frame(), layout, rows, 0, 0.1, block, 8);
  CHECK(counts.tangled == 1);
  CHECK(counts.wide == 0);
  const DomainCorners cube = read_domain<Cpdi>(layout, block + 3, block_lanes);
  for (std::size_t a = 0; a < 3; ++a) CHECK(cube[7][a] == Approx(0.15).epsilon(1e-14));
  CHECK(read_domain<Cpdi>(layout, block + 2, block_lanes)[7][2] == Approx(0.4));
}

TEMPLATE_TEST_CASE(
    "In a fluid a domain that reaches more than a cell becomes a cube of the particle's volume", "", Cpdi,
    Cpdi2) {
  TransferCase<TestType> c({1, 1, 1}, 8, 37);
  double* block = c.pool.block(c.tile.blocks[0]);
  const ColumnLayout& layout = c.pool.layout();
  const auto cell = [&](std::size_t a) { return 1 / c.frame().inverse_cell[static_cast<int>(a)]; };
  const auto box_of = [&](int l) {
    Vector half;
    for (std::size_t a = 0; a < 3; ++a)
      half[a] = (l % 2 == 1 && a == static_cast<std::size_t>(l / 2 % 3) ? 1.01 : 0.99) * cell(a);
    return mpm::tests::box(half);
  };
  for (int l = 0; l < 8; ++l) {
    write_domain<TestType>(layout, box_of(l), block + l, block_lanes);
    block[layout.offset(Column::volume) + l] = 0.027;
  }
  TestType::replace_wide(c.frame(), layout, block);
  for (int l = 0; l < 8; ++l) {
    const DomainCorners wanted = l % 2 == 1 ? mpm::tests::box({0.15, 0.15, 0.15}) : box_of(l);
    const DomainCorners now = read_domain<TestType>(layout, block + l, block_lanes);
    for (std::size_t k = 0; k < 8; ++k)
      for (std::size_t a = 0; a < 3; ++a) CHECK(now[k][a] == Approx(wanted[k][a]).epsilon(1e-14));
  }
}

TEMPLATE_TEST_CASE("What infrequent terms see of a particle's nodes is what the kernels use, each node once",
                   "", Cpdi, Cpdi2) {
  TransferCase<TestType> c({2, 2, 2}, 64, 36);
  double worst = 0;
  for (std::size_t b = 0; b < c.tile.blocks.size(); ++b) {
    const auto place = c.block_place(c.pool.block(c.tile.blocks[b]));
    for (int l = 0; l < 8; ++l) {
      std::vector<double> left(static_cast<std::size_t>(4 * c.shape.nodes()));
      const auto add = [&](int node, double sign, double value, const Vec3<double>& slope) {
        double* at = left.data() + 4 * node;
        at[0] += sign * value;
        for (int a = 0; a < 3; ++a) at[1 + a] += sign * slope[a];
      };
      std::vector<int> seen(static_cast<std::size_t>(c.shape.nodes()));
      TestType::for_each_node(place, l, c.geometry.inverse_cell,
                              [&](int node, double value, const Vec3<double>& slope) {
                                ++seen[static_cast<std::size_t>(node)];
                                add(node, 1, value, slope);
                              });
      c.for_each_node(
          c.particles[8 * b + static_cast<std::size_t>(l)],
          [&](int node, double value, const Vec3<double>& slope) { add(node, -1, value, slope); });
      for (const double x : left) worst = std::max(worst, std::abs(x));
      CHECK(*std::max_element(seen.begin(), seen.end()) == 1);
    }
  }
  CHECK(worst < 1e-13);
}
