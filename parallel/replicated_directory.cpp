#include "parallel/replicated_directory.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace mpm::parallel {

using core::BrickCoord;
using core::BrickCount;
using core::BrickGrid;

namespace {

bool key_less(BrickCoord a, BrickCoord b) { return core::key_of(a) < core::key_of(b); }

void sort_unique(std::vector<BrickCoord>& bricks) {
  std::sort(bricks.begin(), bricks.end(), key_less);
  bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
}

/// f(brick) for the 26 bricks around b.
template <class F>
void for_each_neighbour(BrickCoord b, F f) {
  for (int n = 0; n < core::neighbourhood; ++n) {
    if (n != core::self_index) f(b + core::neighbour_offset(n));
  }
}

}  // namespace

std::vector<BrickCount> ReplicatedDirectory::merged(std::span<const BrickCount> counts) const {
  // Each brick's counts are combined on one rank first, so that no rank stores the counts of all ranks.
  const auto ranks = static_cast<std::size_t>(comm_.size());
  const auto meeting = [&](const BrickCount& c) {
    return (core::key_of(c.brick) * 0x9e3779b97f4a7c15u >> 32) % ranks;
  };
  std::vector<std::size_t> begin(ranks + 1);
  for (const BrickCount& c : counts) ++begin[meeting(c) + 1];
  for (std::size_t r = 0; r < ranks; ++r) begin[r + 1] += begin[r];
  std::vector<BrickCount> sent(counts.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const BrickCount& c : counts) sent[next[meeting(c)]++] = c;

  const auto by_key = [](const BrickCount& a, const BrickCount& b) { return key_less(a.brick, b.brick); };
  std::vector<BrickCount> met = comm_.all_to_all(std::span<const BrickCount>(sent), begin);
  std::sort(met.begin(), met.end(), by_key);
  std::vector<BrickCount> sums;
  for (const BrickCount& c : met) {
    if (sums.empty() || sums.back().brick != c.brick) {
      sums.push_back(c);
    } else {
      sums.back().particles += c.particles;
    }
  }
  std::vector<BrickCount> all = comm_.all_gather(std::span<const BrickCount>(sums)).items;
  std::sort(all.begin(), all.end(), by_key);
  return all;
}

std::vector<std::int32_t> ReplicatedDirectory::owners_of(const BrickGrid& grid,
                                                         std::span<const BrickCount> bricks,
                                                         const core::DecompositionInput& how) {
  boxes_.reset();
  const bool automatic = how.method == core::PartitionMethod::automatic;
  if (how.method == core::PartitionMethod::uniform || (automatic && how.dimensions)) {
    boxes_ = how.dimensions ? boxes_of_grid(grid.geometry(), *how.dimensions)
                            : boxes_of_bricks(bricks, comm_.size());
  }
  std::vector<std::int32_t> owner(bricks.size());
  if (boxes_) {
    std::transform(bricks.begin(), bricks.end(), owner.begin(),
                   [&](const BrickCount& b) { return boxes_->owner(b.brick); });
  } else {
    if (comm_.rank() == 0) owner = split_graph(bricks, grid.shape(), comm_.size(), how.imbalance_tolerance);
    comm_.broadcast(std::as_writable_bytes(std::span(owner)));
  }
  return owner;
}

void ReplicatedDirectory::partition(BrickGrid& grid, std::span<const BrickCount> counts,
                                    const core::DecompositionInput& how) {
  core::check_decomposition(how, comm_.size());
  const std::vector<BrickCount> bricks = merged(counts);
  const std::vector<std::int32_t> owner = owners_of(grid, bricks, how);
  table_.clear();
  for (std::size_t i = 0; i < bricks.size(); ++i) table_.assign(bricks[i].brick, owner[i]);

  std::vector<BrickCoord> owned, ghosts;
  for (const BrickCount& b : bricks) {
    if (!mine(b.brick)) continue;
    owned.push_back(b.brick);
    for_each_neighbour(b.brick, [&](BrickCoord n) {
      if (table_.contains(n) && !mine(n)) ghosts.push_back(n);
    });
  }
  sort_unique(ghosts);
  grid.reset(std::move(owned), std::move(ghosts));
}

bool ReplicatedDirectory::touches_mine(BrickCoord b) const {
  bool touches = mine(b);
  for_each_neighbour(b, [&](BrickCoord n) { touches = touches || mine(n); });
  return touches;
}

/// Updates the grid after bricks were added to or removed from the directory, not both.
void ReplicatedDirectory::refresh(BrickGrid& grid, std::span<const BrickCoord> changed) {
  const bool concerned = std::any_of(changed.begin(), changed.end(), [&](BrickCoord b) {
    return grid.find(b) != core::no_slot || touches_mine(b);
  });
  if (!concerned) return;

  std::vector<BrickCoord> owned, ghosts;
  for (const core::Brick& b : grid.bricks()) {
    if (mine(b.coord)) owned.push_back(b.coord);
  }
  for (int g = 0; g < grid.ghosts(); ++g) ghosts.push_back(grid.ghost(g));
  for (const BrickCoord b : changed) {
    ghosts.push_back(b);
    if (!mine(b)) continue;
    owned.push_back(b);
    for_each_neighbour(b, [&](BrickCoord n) { ghosts.push_back(n); });
  }
  std::erase_if(ghosts, [&](BrickCoord b) { return !table_.contains(b) || mine(b) || !touches_mine(b); });
  sort_unique(ghosts);
  grid.reset(std::move(owned), std::move(ghosts));
}

std::int32_t ReplicatedDirectory::owner_of_new(const BrickGrid& grid, BrickCoord b,
                                               std::int32_t asker) const {
  if (boxes_) return boxes_->owner(b);
  std::array<std::pair<std::int32_t, int>, core::neighbourhood> shared{};  // rank, nodes
  std::size_t ranks = 0;
  for_each_neighbour(b, [&](BrickCoord n) {
    const std::int32_t owner = table_.owner(n);
    if (owner == no_owner) return;
    std::size_t i = 0;
    while (i < ranks && shared[i].first != owner) ++i;
    if (i == ranks) shared[ranks++] = {owner, 0};
    shared[i].second += shared_nodes(grid.shape(), n - b);
  });
  if (ranks == 0) return asker;
  const auto less = [](auto x, auto y) {
    return x.second != y.second ? x.second < y.second : x.first > y.first;
  };
  return std::max_element(shared.begin(), shared.begin() + static_cast<std::ptrdiff_t>(ranks), less)->first;
}

void ReplicatedDirectory::activate(BrickGrid& grid, std::span<const BrickCoord> wanted) {
  std::vector<BrickCoord> unknown;
  std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(unknown),
               [&](BrickCoord b) { return !table_.contains(b); });
  sort_unique(unknown);
  const Gathered<BrickCoord> asked = comm_.all_gather(std::span<const BrickCoord>(unknown));
  if (asked.items.empty()) return;

  std::vector<std::pair<BrickCoord, std::int32_t>> requests;  // brick, requesting rank
  for (std::int32_t r = 0; r < comm_.size(); ++r) {
    for (const BrickCoord b : asked.of(r)) requests.emplace_back(b, r);
  }
  std::stable_sort(requests.begin(), requests.end(),
                   [](auto& a, auto& b) { return key_less(a.first, b.first); });
  std::vector<BrickCoord> added;
  for (const auto& [brick, asker] : requests) {
    if (table_.contains(brick)) continue;
    table_.assign(brick, owner_of_new(grid, brick, asker));
    added.push_back(brick);
  }
  refresh(grid, added);
}

void ReplicatedDirectory::deactivate(BrickGrid& grid, std::span<const BrickCoord> empty) {
  for (const BrickCoord b : empty) {
    if (!mine(b) || grid.brick(grid.find(b)).particles() > 0) {
      throw std::logic_error("cannot deactivate a brick that holds particles or belongs to another rank");
    }
  }
  const std::vector<BrickCoord> removed = comm_.all_gather(empty).items;
  if (removed.empty()) return;
  for (const BrickCoord b : removed) table_.remove(b);
  refresh(grid, removed);
}

std::vector<std::int32_t> ReplicatedDirectory::owners(std::span<const BrickCoord> bricks) const {
  std::vector<std::int32_t> owners;
  for (const BrickCoord b : bricks) owners.push_back(table_.owner(b));
  return owners;
}

}  // namespace mpm::parallel
