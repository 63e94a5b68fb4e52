#include "parallel/decomposition.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <metis.h>

#include "parallel/brick_table.hpp"

namespace mpm::parallel {

using core::BrickCoord;
using core::BrickCount;

int shared_nodes(const core::NodeBlockShape& shape, BrickCoord offset) {
  const auto along = [&](std::int32_t d) { return d == 0 ? shape.side() : 1 + shape.below + shape.above; };
  return along(offset.x) * along(offset.y) * along(offset.z);
}

int UniformBoxes::owner(BrickCoord b) const {
  const BrickCoord d = b - low_;
  const std::array<std::int32_t, 3> at{d.x, d.y, d.z};
  std::array<int, 3> box{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t inside = std::clamp(at[a], 0, extent_[a] - 1);
    box[a] = static_cast<int>(inside * parts_[a] / extent_[a]);
  }
  return box[0] + parts_[0] * (box[1] + parts_[1] * box[2]);
}

UniformBoxes boxes_of_grid(const core::GridGeometry& geometry, std::array<int, 3> parts) {
  std::array<std::int32_t, 3> extent{};
  for (std::size_t a = 0; a < 3; ++a) {
    extent[a] = static_cast<std::int32_t>((geometry.sites(static_cast<int>(a)) + core::brick_cells - 1) /
                                          core::brick_cells);
  }
  return {{}, extent, parts};
}

UniformBoxes boxes_of_bricks(std::span<const BrickCount> bricks, int ranks) {
  if (bricks.empty()) return {{}, {1, 1, 1}, {ranks, 1, 1}};
  BrickCoord low = bricks[0].brick, high = low;
  for (const BrickCount& b : bricks) {
    low = {std::min(low.x, b.brick.x), std::min(low.y, b.brick.y), std::min(low.z, b.brick.z)};
    high = {std::max(high.x, b.brick.x), std::max(high.y, b.brick.y), std::max(high.z, b.brick.z)};
  }
  const std::array<std::int32_t, 3> n{high.x - low.x + 1, high.y - low.y + 1, high.z - low.z + 1};

  std::array<int, 3> best{ranks, 1, 1};
  std::int64_t best_used = -1;
  double best_area = 0;
  for (int x = 1; x <= ranks; ++x) {
    if (ranks % x != 0) continue;
    for (int y = 1; y <= ranks / x; ++y) {
      if (ranks / x % y != 0) continue;
      const std::array<int, 3> p{x, y, ranks / x / y};
      // A rank without bricks is idle: as many non-empty boxes as possible, then the smallest cuts.
      std::int64_t used = 1;
      for (std::size_t a = 0; a < 3; ++a) used *= std::min<std::int64_t>(p[a], n[a]);
      const double area = (p[0] - 1) * double(n[1]) * n[2] + (p[1] - 1) * double(n[0]) * n[2] +
                          (p[2] - 1) * double(n[0]) * n[1];
      if (used > best_used || (used == best_used && area < best_area)) {
        best = p;
        best_used = used;
        best_area = area;
      }
    }
  }
  return {low, n, best};
}

namespace {

// Doubles: sums of weights may overflow integers.
double weight_of(const BrickCount& b) { return std::max(1.0, static_cast<double>(b.particles)); }

/// Largest sum of weights of any rank, over the mean.
double imbalance(std::span<const BrickCount> bricks, std::span<const std::int32_t> owner, int ranks) {
  std::vector<double> sum(static_cast<std::size_t>(ranks));
  for (std::size_t i = 0; i < bricks.size(); ++i)
    sum[static_cast<std::size_t>(owner[i])] += weight_of(bricks[i]);
  const double total = std::accumulate(sum.begin(), sum.end(), 0.0);
  return *std::max_element(sum.begin(), sum.end()) * ranks / total;
}

/// The graph of bricks in METIS's format: neighbours of i are adjacent[begin[i]] to adjacent[begin[i+1]-1].
struct Graph {
  std::vector<idx_t> begin, adjacent, shared, weight;
};

std::optional<Graph> graph_of(std::span<const BrickCount> bricks, const core::NodeBlockShape& shape) {
  // 26 neighbours each must be numbered with idx_t.
  if (bricks.size() > static_cast<std::size_t>(std::numeric_limits<idx_t>::max()) / core::neighbourhood)
    return {};
  BrickTable index;
  for (std::size_t i = 0; i < bricks.size(); ++i) index.assign(bricks[i].brick, static_cast<std::int32_t>(i));

  Graph graph;
  graph.begin.push_back(0);
  for (const BrickCount& b : bricks) {
    for (int n = 0; n < core::neighbourhood; ++n) {
      if (n == core::self_index) continue;
      const BrickCoord offset = core::neighbour_offset(n);
      const std::int32_t other = index.owner(b.brick + offset);
      if (other == BrickTable::no_owner) continue;
      graph.adjacent.push_back(other);
      graph.shared.push_back(shared_nodes(shape, offset));
    }
    graph.begin.push_back(static_cast<idx_t>(graph.adjacent.size()));
  }
  // The sum over all bricks must stay well below the largest idx_t.
  double total = 0;
  for (const BrickCount& b : bricks) total += weight_of(b);
  const double scale = std::min(1.0, double(1 << 29) / total);
  for (const BrickCount& b : bricks) {
    graph.weight.push_back(std::max(1, static_cast<idx_t>(scale * weight_of(b))));
  }
  return graph;
}

/// Nodes shared by bricks of different ranks, twice.
std::int64_t cut(const Graph& graph, std::span<const std::int32_t> owner) {
  std::int64_t nodes = 0;
  for (std::size_t i = 0; i < owner.size(); ++i) {
    for (auto e = static_cast<std::size_t>(graph.begin[i]); e < static_cast<std::size_t>(graph.begin[i + 1]);
         ++e) {
      if (owner[static_cast<std::size_t>(graph.adjacent[e])] != owner[i]) nodes += graph.shared[e];
    }
  }
  return nodes;
}

using Method = decltype(&METIS_PartGraphKway);

std::vector<std::int32_t> metis(Method method, Graph& graph, int ranks) {
  constexpr std::size_t many_bricks = 100'000;
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_UFACTOR] = 10;  // at most 1 % above the mean, where possible
  options[METIS_OPTION_NCUTS] =
      graph.weight.size() < many_bricks ? 8 : 1;  // attempts, of which it keeps the best
  auto vertices = static_cast<idx_t>(graph.weight.size());
  idx_t constraints = 1, parts = ranks, edge_cut = 0;
  std::vector<idx_t> owner(graph.weight.size());
  const int outcome =
      method(&vertices, &constraints, graph.begin.data(), graph.adjacent.data(), graph.weight.data(), nullptr,
             graph.shared.data(), &parts, nullptr, nullptr, options.data(), &edge_cut, owner.data());
  if (outcome != METIS_OK) return {};
  return {owner.begin(), owner.end()};
}

/// Every third bit, from the lowest 21 bits of v.
std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

std::uint64_t morton(BrickCoord b) {
  return spread_bits(static_cast<std::uint32_t>(b.x)) | spread_bits(static_cast<std::uint32_t>(b.y)) << 1 |
         spread_bits(static_cast<std::uint32_t>(b.z)) << 2;
}

}  // namespace

std::vector<std::int32_t> split_curve(std::span<const BrickCount> bricks, int ranks) {
  std::vector<std::size_t> order(bricks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return morton(bricks[a].brick) < morton(bricks[b].brick); });
  double total = 0;
  for (const BrickCount& b : bricks) total += weight_of(b);

  std::vector<std::int32_t> owner(bricks.size());
  double before = 0;
  for (const std::size_t i : order) {
    const double weight = weight_of(bricks[i]);
    const double middle = (before + weight / 2) / total;
    owner[i] = std::min(static_cast<std::int32_t>(middle * ranks), ranks - 1);
    before += weight;
  }
  return owner;
}

std::vector<std::int32_t> split_graph(std::span<const BrickCount> bricks, const core::NodeBlockShape& shape,
                                      int ranks, double tolerance) {
  std::vector<std::int32_t> best = split_curve(bricks, ranks);
  if (ranks == 1 || bricks.size() <= static_cast<std::size_t>(ranks)) return best;
  std::optional<Graph> graph = graph_of(bricks, shape);
  if (!graph) return best;

  // First the imbalance beyond the tolerance, then the number of shared nodes.
  const auto price = [&](std::span<const std::int32_t> owner) {
    return std::pair(std::max(imbalance(bricks, owner, ranks), tolerance), cut(*graph, owner));
  };
  auto least = price(best);
  for (const Method method : {&METIS_PartGraphRecursive, &METIS_PartGraphKway}) {
    std::vector<std::int32_t> owner = metis(method, *graph, ranks);
    if (owner.empty()) continue;
    if (const auto p = price(owner); p < least) {
      least = p;
      best = std::move(owner);
    }
  }
  return best;
}

}  // namespace mpm::parallel
