#include "parallel/mpi_exchange.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>

#include "parallel/parcels.hpp"

namespace mpm::parallel {

using core::BrickCoord;
using core::BrickCount;
using core::BrickGrid;
using core::Travellers;

namespace {

constexpr int tag_migrate = 3;

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

// Doubles as integers of the same order, so that MPI_MIN need not know about NaN: it is below everything.
constexpr std::int64_t not_a_number = std::numeric_limits<std::int64_t>::min();

std::int64_t ordered(double x) {
  if (x != x) return not_a_number;
  const auto bits = std::bit_cast<std::int64_t>(x);
  return bits < 0 ? bits ^ std::numeric_limits<std::int64_t>::max() : bits;
}

double from_ordered(std::int64_t i) {
  if (i == not_a_number) return std::numeric_limits<double>::quiet_NaN();
  return std::bit_cast<double>(i < 0 ? i ^ std::numeric_limits<std::int64_t>::max() : i);
}

}  // namespace

bool MpiExchange::any(bool mine) {
  std::int64_t one = mine ? 1 : 0;
  comm_.reduce(std::span(&one, 1), MPI_MAX);
  return one != 0;
}

void MpiExchange::minimum(std::span<double> values) {
  std::vector<std::int64_t> keys(values.size());
  std::transform(values.begin(), values.end(), keys.begin(), ordered);
  comm_.reduce(keys, MPI_MIN);
  std::transform(keys.begin(), keys.end(), values.begin(), from_ordered);
}

void MpiExchange::sum(std::span<std::int64_t> values) { comm_.reduce(values, MPI_SUM); }

void MpiExchange::sum(std::span<core::ExactSum> values) {
  std::vector<std::int64_t> limbs;
  for (core::ExactSum& v : values) {
    v.normalise();
    limbs.insert(limbs.end(), v.raw().begin(), v.raw().end());
  }
  comm_.reduce(limbs, MPI_SUM);
  auto from = limbs.begin();
  for (core::ExactSum& v : values) {
    const auto to = v.raw();
    std::copy_n(from, to.size(), to.begin());
    from += static_cast<std::ptrdiff_t>(to.size());
    v.normalise();
  }
}

std::vector<BrickCount> MpiExchange::merged(std::span<const BrickCount> counts) const {
  // Each brick's counts meet on one rank first, so that no rank holds what all ranks found in one brick.
  const auto ranks = static_cast<std::size_t>(size());
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

std::vector<std::int32_t> MpiExchange::owners(const BrickGrid& grid, std::span<const BrickCount> bricks,
                                              const core::DecompositionInput& how) {
  boxes_.reset();
  const bool automatic = how.method == core::PartitionMethod::automatic;
  if (how.method == core::PartitionMethod::uniform || (automatic && how.dimensions)) {
    boxes_ =
        how.dimensions ? boxes_of_grid(grid.geometry(), *how.dimensions) : boxes_of_bricks(bricks, size());
  }
  std::vector<std::int32_t> owner(bricks.size());
  if (boxes_) {
    std::transform(bricks.begin(), bricks.end(), owner.begin(),
                   [&](const BrickCount& b) { return boxes_->owner(b.brick); });
  } else {
    if (rank() == 0) owner = split_graph(bricks, grid.shape(), size(), how.imbalance_tolerance);
    comm_.broadcast(std::as_writable_bytes(std::span(owner)));
  }
  return owner;
}

void MpiExchange::partition(BrickGrid& grid, std::span<const BrickCount> counts,
                            const core::DecompositionInput& how) {
  core::check_decomposition(how, size());
  const std::vector<BrickCount> bricks = merged(counts);
  const std::vector<std::int32_t> owner = owners(grid, bricks, how);
  directory_.clear();
  for (std::size_t i = 0; i < bricks.size(); ++i) directory_.assign(bricks[i].brick, owner[i]);

  std::vector<BrickCoord> owned, ghosts;
  for (const BrickCount& b : bricks) {
    if (!mine(b.brick)) continue;
    owned.push_back(b.brick);
    for_each_neighbour(b.brick, [&](BrickCoord n) {
      if (directory_.contains(n) && !mine(n)) ghosts.push_back(n);
    });
  }
  sort_unique(ghosts);
  grid.reset(std::move(owned), std::move(ghosts));
}

bool MpiExchange::touches_mine(BrickCoord b) const {
  bool touches = mine(b);
  for_each_neighbour(b, [&](BrickCoord n) { touches = touches || mine(n); });
  return touches;
}

/// Bring the grid in line with the directory, in which bricks were added or removed, not both.
void MpiExchange::refresh(BrickGrid& grid, std::span<const BrickCoord> changed) {
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
  std::erase_if(ghosts, [&](BrickCoord b) { return !directory_.contains(b) || mine(b) || !touches_mine(b); });
  sort_unique(ghosts);
  grid.reset(std::move(owned), std::move(ghosts));
}

std::int32_t MpiExchange::owner_of_new(const BrickGrid& grid, BrickCoord b, std::int32_t asker) const {
  if (boxes_) return boxes_->owner(b);
  std::array<std::pair<std::int32_t, int>, core::neighbourhood> shared{};  // rank, nodes
  std::size_t ranks = 0;
  for_each_neighbour(b, [&](BrickCoord n) {
    const std::int32_t owner = directory_.owner(n);
    if (owner == Directory::nobody) return;
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

void MpiExchange::claim(BrickGrid& grid, std::span<const BrickCoord> wanted) {
  std::vector<BrickCoord> unknown;
  std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(unknown),
               [&](BrickCoord b) { return !directory_.contains(b); });
  sort_unique(unknown);
  const Gathered<BrickCoord> asked = comm_.all_gather(std::span<const BrickCoord>(unknown));
  if (asked.items.empty()) return;

  std::vector<std::pair<BrickCoord, std::int32_t>> claims;  // brick, asker
  for (std::int32_t r = 0; r < size(); ++r) {
    for (const BrickCoord b : asked.of(r)) claims.emplace_back(b, r);
  }
  std::stable_sort(claims.begin(), claims.end(), [](auto& a, auto& b) { return key_less(a.first, b.first); });
  std::vector<BrickCoord> added;
  for (const auto& [brick, asker] : claims) {
    if (directory_.contains(brick)) continue;
    directory_.assign(brick, owner_of_new(grid, brick, asker));
    added.push_back(brick);
  }
  refresh(grid, added);
}

void MpiExchange::retire(BrickGrid& grid, std::span<const BrickCoord> empty) {
  for (const BrickCoord b : empty) {
    if (!mine(b) || grid.brick(grid.find(b)).particles() > 0) {
      throw std::logic_error("a brick is retired that holds particles or is another rank's");
    }
  }
  const std::vector<BrickCoord> removed = comm_.all_gather(empty).items;
  if (removed.empty()) return;
  for (const BrickCoord b : removed) directory_.remove(b);
  refresh(grid, removed);
}

namespace {

[[noreturn]] void throw_lost(const Travellers::Head& head, const std::string& why) {
  const BrickCoord to = head.to;
  throw std::logic_error("a particle of body " + std::to_string(head.body) + " travels to brick (" +
                         std::to_string(to.x) + ", " + std::to_string(to.y) + ", " + std::to_string(to.z) +
                         "), which " + why);
}

}  // namespace

std::int32_t MpiExchange::owner_of_traveller(const Travellers::Head& head) const {
  const std::int32_t owner = directory_.owner(head.to);
  if (owner == Directory::nobody) throw_lost(head, "does not exist");
  return owner;
}

void MpiExchange::migrate(const BrickGrid& grid, Travellers& travellers, std::span<const int> columns_of) {
  const std::vector<HaloPartner>& partners = halo_.partners(grid);
  const auto self = static_cast<std::ptrdiff_t>(partners.size());
  std::vector<std::uint32_t> destination;
  destination.reserve(travellers.size());
  for (const Travellers::Head& head : travellers.heads) {
    const std::int32_t owner = owner_of_traveller(head);
    const auto p = std::lower_bound(partners.begin(), partners.end(), owner,
                                    [](const HaloPartner& h, std::int32_t r) { return h.rank < r; });
    const bool is_partner = p != partners.end() && p->rank == owner;
    if (owner != rank() && !is_partner) {
      throw_lost(head, "belongs to rank " + std::to_string(owner) +
                           ", but no brick of that rank is next to one of rank " + std::to_string(rank()));
    }
    destination.push_back(static_cast<std::uint32_t>(is_partner ? p - partners.begin() : self));
  }

  const Parcels parcels = pack(travellers, destination, partners.size() + 1, columns_of);
  Requests requests;
  for (std::size_t p = 0; p < partners.size(); ++p) {
    requests.send_unannounced(comm_, parcels.of(p).data(), parcels.of(p).size_bytes(), partners[p].rank,
                              tag_migrate);
  }
  const auto stay = parcels.of(partners.size());
  std::vector<double> arrived(stay.begin(), stay.end());
  for (const HaloPartner& p : partners) comm_.receive_onto(arrived, p.rank, tag_migrate);
  requests.wait_all();
  travellers = unpack(std::move(arrived), columns_of);
}

void MpiExchange::scatter(const BrickGrid&, Travellers& travellers, std::span<const int> columns_of) {
  std::vector<std::uint32_t> destination;
  destination.reserve(travellers.size());
  for (const Travellers::Head& head : travellers.heads) {
    destination.push_back(static_cast<std::uint32_t>(owner_of_traveller(head)));
  }
  const Parcels parcels = pack(travellers, destination, static_cast<std::size_t>(size()), columns_of);
  travellers = {};  // at most twice the particles at any time
  travellers = unpack(comm_.all_to_all(std::span<const double>(parcels.data), parcels.begin), columns_of);
}

std::vector<std::string> MpiExchange::gather(const std::string& mine) {
  const Gathered<char> all = comm_.all_gather(std::span<const char>(mine));
  std::vector<std::string> lines;
  for (int r = 0; r < size(); ++r) lines.emplace_back(all.of(r).begin(), all.of(r).end());
  return lines;
}

core::Exchange::Spread MpiExchange::spread(double mine) {
  std::array<double, 2> ends{mine, -mine};
  double total = mine;
  comm_.reduce(ends, MPI_MIN);
  comm_.reduce(std::span(&total, 1), MPI_SUM);
  return {ends[0], total / size(), -ends[1]};
}

}  // namespace mpm::parallel
