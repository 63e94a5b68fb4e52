#include <bit>
#include <cmath>
#include <map>

#include <catch2/catch.hpp>

#include "parallel/communication.hpp"
#include "parallel/node_halo.hpp"
#include "tests/parallel/world.hpp"

using namespace mpm::parallel;
using namespace mpm::parallel::test;
using mpm::core::BrickCoord;
using mpm::core::BrickGrid;
using mpm::core::NodeArray;
using mpm::core::NodeBlockShape;
using mpm::core::record_doubles;
using mpm::core::Slot;

namespace {

using Node = std::array<std::int32_t, 3>;

/// The node with index `n` of a brick's array, counted from the grid's origin.
Node node_of(const BrickGrid& grid, BrickCoord b, int n) {
  const int side = grid.shape().side(), low = grid.shape().lowest();
  return {4 * b.x + n % side + low, 4 * b.y + n / side % side + low, 4 * b.z + n / side / side + low};
}

bool holds(const BrickGrid& grid, BrickCoord b, Node node) {
  const std::array<std::int32_t, 3> first{4 * b.x, 4 * b.y, 4 * b.z};
  bool inside = true;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t at = node[a] - first[a];
    inside = inside && at >= grid.shape().lowest() && at <= grid.shape().highest();
  }
  return inside;
}

/// Different for every brick, node, component and round; of magnitudes that make sums depend on their order.
double contribution(BrickCoord b, int node, int component, int round) {
  const std::uint64_t h = mix(mix(mix(mix(1, mpm::core::key_of(b)), static_cast<std::uint64_t>(node)),
                                  static_cast<std::uint64_t>(component)),
                              static_cast<std::uint64_t>(round));
  return std::ldexp(static_cast<double>(h >> 11) - 0x1p52, static_cast<int>(h % 40));
}

constexpr std::array both_arrays{NodeArray::first, NodeArray::second};

int number_of(NodeArray of) { return of == NodeArray::first ? 0 : 1; }

/// The second array's values are another round's.
double value_in(NodeArray of, BrickCoord b, int node, int component, int round) {
  return contribution(b, node, component, 2 * round + number_of(of));
}

void fill(BrickGrid& grid, int round) {
  for (const NodeArray of : both_arrays) {
    for (Slot s = 0; s < grid.owned(); ++s) {
      double* values = grid.contributions(of, s);
      for (int n = 0; n < grid.shape().nodes(); ++n) {
        for (int c = 0; c < record_doubles(of); ++c)
          *values++ = value_in(of, grid.brick(s).coord, n, c, round);
      }
    }
  }
}

/// What the ghosts' arrays must hold, kept beside the grid and changed by definition only.
class Expected {
 public:
  explicit Expected(const BrickGrid& grid) : grid_(grid) {
    for (int g = 0; g < grid.ghosts(); ++g) {
      std::vector<int> shared;
      for (int n = 0; n < grid.shape().nodes(); ++n) {
        const Node node = node_of(grid, grid.ghost(g), n);
        if (std::ranges::any_of(grid.bricks(), [&](const auto& b) { return holds(grid, b.coord, node); })) {
          shared.push_back(n);
        }
      }
      shared_.push_back(std::move(shared));
      for (const NodeArray of : both_arrays) values(of).emplace_back(doubles(of), 0.0);
    }
  }
  void arrive(NodeArray of, int first, int count, int round) {
    for (std::size_t g = 0; g < shared_.size(); ++g) {
      for (const int n : shared_[g]) {
        for (int c = first; c < first + count; ++c) {
          values(of)[g][static_cast<std::size_t>(record_doubles(of) * n + c)] =
              value_in(of, grid_.ghost(static_cast<int>(g)), n, c, round);
        }
      }
    }
  }
  bool is_there() const {
    for (const NodeArray of : both_arrays) {
      for (std::size_t g = 0; g < shared_.size(); ++g) {
        const double* is = grid_.contributions(of, grid_.owned() + static_cast<int>(g));
        if (!std::equal(is, is + doubles(of), values_[static_cast<std::size_t>(number_of(of))][g].begin()))
          return false;
      }
    }
    return true;
  }

 private:
  std::size_t doubles(NodeArray of) const {
    return static_cast<std::size_t>(grid_.shape().nodes() * record_doubles(of));
  }
  std::vector<std::vector<double>>& values(NodeArray of) {
    return values_[static_cast<std::size_t>(number_of(of))];
  }

  const BrickGrid& grid_;
  std::array<std::vector<std::vector<double>>, 2> values_;  ///< [array][ghost]
  std::vector<std::vector<int>> shared_;                    ///< of each ghost, nodes
};

/// A directory that knows what it is given.
struct GivenOwners final : mpm::core::BrickDirectory {
  BrickTable table;
  void partition(BrickGrid&, std::span<const mpm::core::BrickCount>,
                 const mpm::core::DecompositionInput&) override {}
  void activate(BrickGrid&, std::span<const BrickCoord>) override {}
  void deactivate(BrickGrid&, std::span<const BrickCoord>) override {}
  std::int32_t owner_nearby(BrickCoord b) const override { return table.owner(b); }
  std::vector<std::int32_t> owners(std::span<const BrickCoord>) const override { return {}; }
};

/// Bricks with random owners, some ranks without any.
void set_up(BrickGrid& grid, BrickTable& table, const std::vector<BrickCoord>& bricks, int ranks_in_use,
            std::mt19937_64& random) {
  table.clear();
  std::vector<BrickCoord> owned;
  for (const BrickCoord b : bricks) {
    const auto owner = static_cast<std::int32_t>(random() % static_cast<unsigned>(ranks_in_use));
    table.assign(b, owner);
    if (owner == world().rank()) owned.push_back(b);
  }
  const auto ghosts = ghosts_of({bricks.begin(), bricks.end()}, table, world().rank());
  grid.reset(owned, {ghosts.begin(), ghosts.end()});
  // Memory as it comes: not zero.
  for (const NodeArray of : both_arrays) {
    for (Slot s = 0; s < grid.owned() + grid.ghosts(); ++s) {
      std::fill_n(grid.contributions(of, s), grid.shape().nodes() * record_doubles(of), std::nan(""));
    }
  }
}

}  // namespace

TEST_CASE("Every node that a ghost shares with a brick of ours arrives, and no other") {
  const NodeBlockShape shape = GENERATE(NodeBlockShape{0, 0}, NodeBlockShape{1, 0}, NodeBlockShape{1, 1});
  const double share = GENERATE(0.15, 0.6, 1.0);
  std::mt19937_64 random(static_cast<unsigned>(100 * share) + static_cast<unsigned>(shape.side()));
  BrickGrid grid(unit_grid(400), shape);
  GivenOwners owners;
  MpiHalo halo(world(), owners);
  const auto bricks = random_bricks(random, {4, 3, 4}, share);
  for (int ranks = std::max(1, world().size() - 1); ranks <= world().size(); ++ranks) {
    set_up(grid, owners.table, bricks, ranks, random);
    Expected expected(grid);
    int round = 0;
    for (const NodeArray of : both_arrays) {
      for (int first = 0; first < record_doubles(of); ++first) {
        for (int count = 1; first + count <= record_doubles(of); ++count) {
          fill(grid, ++round);
          expected.arrive(of, first, count, round);
          halo.begin(grid, {of, first, count});
          halo.end(grid);
          REQUIRE(expected.is_there());
        }
      }
    }
  }
}

TEST_CASE("A changed set of bricks is exchanged anew") {
  std::mt19937_64 random(8);
  BrickGrid grid(unit_grid(400), NodeBlockShape{});
  GivenOwners owners;
  MpiHalo halo(world(), owners);
  for (int round = 0; round < 30; ++round) {
    set_up(grid, owners.table, random_bricks(random, {4, 4, 3}, 0.4), 1 + round % world().size(), random);
    Expected expected(grid);
    for (int i = 0; i < 3; ++i) {
      fill(grid, 3 * round + i);
      const NodeArray of = both_arrays[static_cast<std::size_t>(i % 2)];
      expected.arrive(of, 0, 4, 3 * round + i);
      halo.begin(grid, {of, 0, 4});
      halo.end(grid);
      REQUIRE(expected.is_there());
    }
  }
}

TEST_CASE("All copies of a node sum to the same bits, on one rank or many") {
  const NodeBlockShape shape = GENERATE(NodeBlockShape{0, 0}, NodeBlockShape{1, 0}, NodeBlockShape{1, 1});
  std::mt19937_64 random(9);
  BrickGrid grid(unit_grid(400), shape);
  GivenOwners owners;
  MpiHalo halo(world(), owners);
  const auto bricks = random_bricks(random, {4, 4, 4}, 0.7);
  set_up(grid, owners.table, bricks, world().size(), random);
  fill(grid, 0);
  halo.begin(grid, {NodeArray::second, 0, 4});
  halo.end(grid);

  const auto sum_at = [&](BrickCoord brick, Node node, auto value_of) {
    double sum = 0;
    for (int n = 0; n < mpm::core::neighbourhood; ++n) {
      const BrickCoord other = brick + mpm::core::neighbour_offset(n);
      if (holds(grid, other, node)) sum += value_of(other, node);
    }
    return std::bit_cast<std::uint64_t>(sum);
  };
  const auto index_in = [&](BrickCoord b, Node node) {
    return grid.shape().index(node[0] - 4 * b.x, node[1] - 4 * b.y, node[2] - 4 * b.z);
  };
  // The reference needs no communication: contributions are a known function.
  const std::set<BrickCoord> all(bricks.begin(), bricks.end());
  const auto known = [&](BrickCoord b, Node node) {
    return all.contains(b) ? value_in(NodeArray::second, b, index_in(b, node), 3, 0) : 0.0;
  };
  const auto exchanged = [&](BrickCoord b, Node node) {
    const Slot s = grid.find(b);
    return s == mpm::core::no_slot ? 0.0
                                   : grid.contributions(NodeArray::second, s)[4 * index_in(b, node) + 3];
  };
  struct Copy {
    Node node;
    std::uint64_t bits;
  };
  std::vector<Copy> copies;
  int wrong = 0;
  for (const auto& b : grid.bricks()) {
    for (int n = 0; n < grid.shape().nodes(); ++n) {
      const Node node = node_of(grid, b.coord, n);
      copies.push_back({node, sum_at(b.coord, node, exchanged)});
      if (copies.back().bits != sum_at(b.coord, node, known)) ++wrong;
    }
  }
  CHECK(wrong == 0);
  std::map<Node, std::uint64_t> seen;
  int different = 0;
  for (const Copy& c : world().all_gather(std::span<const Copy>(copies)).items) {
    if (seen.emplace(c.node, c.bits).first->second != c.bits) ++different;
  }
  CHECK(different == 0);
}

TEST_CASE("Halos of a METIS and of a uniform partition, with large messages") {
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400), NodeBlockShape{1, 1});
  std::vector<mpm::core::BrickCount> counts;
  std::mt19937_64 random(10);
  for (const BrickCoord b : random_bricks(random, {12, 11, 10}, 0.97)) {
    if (counts.empty() || world().rank() == 0) counts.push_back({b, 8});
  }
  mpm::core::DecompositionInput how;
  how.method = GENERATE(mpm::core::PartitionMethod::metis, mpm::core::PartitionMethod::uniform);
  exchange.bricks.partition(grid, counts, how);
  Expected expected(grid);
  for (int round = 0; round < 3; ++round) {
    fill(grid, round);
    expected.arrive(NodeArray::first, 0, 8, round);
    exchange.halo.begin(grid, {NodeArray::first, 0, 8});
    exchange.halo.end(grid);
    CHECK(expected.is_there());
  }
}

TEST_CASE("A halo exchange out of order is refused") {
  GivenOwners owners;
  BrickGrid grid(unit_grid(400), NodeBlockShape{});
  MpiHalo halo(world(), owners);
  CHECK_THROWS_AS(halo.end(grid), std::logic_error);
  CHECK_THROWS_AS(halo.begin(grid, {NodeArray::first, 5, 4}), std::logic_error);
  CHECK_THROWS_AS(halo.begin(grid, {NodeArray::second, 1, 4}), std::logic_error);
  halo.begin(grid, {NodeArray::second, 0, 1});
  CHECK_THROWS_AS(halo.begin(grid, {NodeArray::second, 0, 1}), std::logic_error);
  halo.end(grid);
  CHECK_THROWS_AS(BrickGrid(unit_grid(400), NodeBlockShape{0, mpm::core::most_layers + 1}), std::logic_error);
}
