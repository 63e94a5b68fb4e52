// Bricks with few particles: masks of nodes, sums and transforms of some nodes against those of all.
#include "core/step/sparse_bricks.hpp"

#include <cmath>
#include <random>
#include <set>

#include <catch2/catch.hpp>

#include "core/shape/sgmp.hpp"
#include "core/step/shared_nodes.hpp"

using namespace mpm::core;

namespace {

constexpr NodeBlockShape shapes[] = {{0, 0}, {1, 0}, {1, 1}};

/// Of `particles` with three (shape.side() - 4, at least two) nodes along an axis, and their nodes.
NodeMask random_mask(const NodeBlockShape& shape, int particles, std::mt19937& random, std::set<int>& nodes) {
  const int n = shape.side() - 3;
  std::uniform_int_distribution<int> site(0, 3);
  NodeMask mask;
  for (int p = 0; p < particles; ++p) {
    const int lowest =
        shape.index(site(random) - shape.below, site(random) - shape.below, site(random) - shape.below);
    mask.add(shape, lowest, n);
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) nodes.insert(lowest + i + shape.side() * (j + shape.side() * k));
  }
  return mask;
}

std::vector<double> random_records(int doubles, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<double> records(static_cast<std::size_t>(doubles));
  for (double& x : records) x = unit(random);
  return records;
}

/// Largest difference of the first `used` doubles of a record; infinite for another record that has changed.
struct Compared {
  double of_some = 0;
  int others_changed = 0;
};
Compared compare(const std::set<int>& some, int stride, int used, const std::vector<double>& all,
                 const std::vector<double>& part, double untouched) {
  Compared found;
  for (int n = 0; n < static_cast<int>(all.size()) / stride; ++n) {
    for (int c = 0; c < used; ++c) {
      const auto at = static_cast<std::size_t>(stride * n + c);
      if (some.contains(n))
        found.of_some = std::max(found.of_some, std::abs(part[at] - all[at]));
      else
        found.others_changed += part[at] != untouched;
    }
  }
  return found;
}

}  // namespace

TEST_CASE("A mask has the nodes that were added, and the cells of which it has all") {
  std::mt19937 random(3);
  for (const NodeBlockShape& shape : shapes) {
    for (int particles : {0, 1, 2, 5}) {
      std::set<int> wanted, given, cells, wanted_cells, rows;
      const NodeMask mask = random_mask(shape, particles, random, wanted);
      mask.for_each(shape, [&](int first, int count) {
        for (int n = first; n < first + count; ++n) given.insert(n);
      });
      CHECK(given == wanted);
      const int low = shape.lowest(), high = shape.highest();
      for (int k = low; k <= high; ++k) {
        for (int j = low; j <= high; ++j) {
          bool any = false;
          for (int i = low; i <= high; ++i) {
            any = any || wanted.contains(shape.index(i, j, k));
            if (i == high || j == high || k == high) continue;
            bool all = true;
            for (int c = 0; c < 8; ++c)
              all = all && wanted.contains(shape.index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)));
            if (all) wanted_cells.insert(shape.index(i, j, k));
          }
          CHECK(mask.has_row(shape, j, k) == any);
        }
      }
      mask.for_each_cell(shape, [&](int i, int j, int k) { cells.insert(shape.index(i, j, k)); });
      CHECK(cells == wanted_cells);
    }
  }
}

TEST_CASE("Sums of the rows of some nodes have the bits of all sums") {
  std::mt19937 random(5);
  for (const NodeBlockShape& shape : shapes) {
    GridGeometry g;
    g.cell = g.inverse_cell = {1, 1, 1};
    g.cells = {12, 12, 12};
    BrickGrid grid(g, shape);
    std::vector<BrickCoord> bricks;
    for (int n = 0; n < 27; ++n)
      if (n % 4 != 1) bricks.push_back({n % 3, n / 3 % 3, n / 9});
    grid.reset(bricks, {});
    const SharedNodes shared(shape);
    const int doubles = node_doubles * shape.nodes();
    const auto check = [&]<NodeArray of>() {
      const int width = record_doubles(of);
      for (Slot s = 0; s < grid.owned(); ++s) {
        const std::vector<double> given = random_records(width * shape.nodes(), random);
        std::copy(given.begin(), given.end(), grid.contributions(of, s));
      }
      for (Slot s = 0; s < grid.owned(); ++s) {
        std::set<int> nodes, in_rows;
        const NodeMask mask = random_mask(shape, 2, random, nodes);
        for (const int n : nodes)
          for (int i = 0; i < shape.side(); ++i) in_rows.insert(n - n % shape.side() + i);
        std::vector<double> all(static_cast<std::size_t>(doubles)), some(all.size(), 7.0);
        sum_contributions<of>(grid, shared, s, all.data());
        sum_contributions<of>(grid, shared, s, mask, some.data());
        const Compared found = compare(in_rows, node_doubles, width, all, some, 7.0);
        CHECK(found.of_some == 0);
        CHECK(found.others_changed == 0);
      }
    };
    check.operator()<NodeArray::first>();
    check.operator()<NodeArray::second>();
  }
}

TEST_CASE("The staggered grid's transforms of some nodes are those of all") {
  std::mt19937 random(7);
  const NodeBlockShape shape = Sgmp::node_block;
  const Vec3<double> inverse_cell{1.5, 0.75, 2.0};
  constexpr double untouched = 7;
  for (int trial = 0; trial < 20; ++trial) {
    std::set<int> nodes, cells;
    const NodeMask mask = random_mask(shape, 1 + trial % 4, random, nodes);
    mask.for_each_cell(shape, [&](int i, int j, int k) {
      cells.insert(i + 1 + sgmp::centres * (j + 1 + sgmp::centres * (k + 1)));
    });
    const int centres = lattice_points.nodes();
    const auto close = [](const Compared& found) {
      CHECK(found.of_some < 1e-14);
      CHECK(found.others_changed == 0);
    };
    const std::vector<double> sums = random_records(sgmp::sum_doubles * centres, random),
                              momenta = random_records(4 * centres, random),
                              motion = random_records(node_doubles * shape.nodes(), random);
    std::vector<double> all(static_cast<std::size_t>(node_doubles * shape.nodes())),
        some(all.size(), untouched);
    sgmp::centres_to_nodes<Onto::nothing>(inverse_cell, sums.data(), all.data());
    sgmp::centres_to_nodes(mask, inverse_cell, sums.data(), some.data());
    close(compare(nodes, node_doubles, node_doubles, all, some, untouched));

    all.assign(static_cast<std::size_t>(4 * shape.nodes()), 0.0), some.assign(all.size(), untouched);
    sgmp::centres_to_nodes<Onto::nothing>(momenta.data(), all.data());
    sgmp::centres_to_nodes(mask, momenta.data(), some.data());
    close(compare(nodes, 4, 4, all, some, untouched));

    all.assign(static_cast<std::size_t>(node_doubles * centres), 0.0), some.assign(all.size(), untouched);
    sgmp::nodes_to_centres(nullptr, motion.data(), all.data());
    sgmp::nodes_to_centres(&mask, motion.data(), some.data());
    close(compare(cells, node_doubles, node_doubles, all, some, untouched));

    all.assign(static_cast<std::size_t>(sgmp::gradient_doubles * centres), 0.0);
    some.assign(all.size(), untouched);
    sgmp::gradients_at_centres(nullptr, inverse_cell, motion.data(), all.data());
    sgmp::gradients_at_centres(&mask, inverse_cell, motion.data(), some.data());
    close(compare(cells, sgmp::gradient_doubles, sgmp::gradient_doubles, all, some, untouched));
  }
}
