#include "parallel/implicit/coarse_lattice.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace mpm::parallel {

namespace {

void must_succeed(int code) {
  if (code != MPI_SUCCESS) throw std::runtime_error("MPI fails while grids are made coarser");
}

/// A field and a place in 64 bits, whose order is that of fields, then places, z first.
constexpr int bits = 18, field_bits = 9;
std::int64_t key_of(std::int32_t field, const std::int32_t (&place)[3]) {
  std::int64_t key = field + 1;
  for (int a = 2; a >= 0; --a) key = key << bits | (place[a] + 1);
  return key;
}
std::int32_t field_of(std::int64_t key) { return static_cast<std::int32_t>(key >> 3 * bits) - 1; }
std::int32_t place_of(std::int64_t key, int axis) {
  return static_cast<std::int32_t>(key >> bits * axis & ((std::int64_t{1} << bits) - 1)) - 1;
}

/// A coarse node that this rank interpolates from.
struct Parent {
  std::int64_t key = 0, number = -1;
  std::uint8_t moves = 0;  ///< bits of components with something that moves and interpolates from them
};

/// f(key, weight) of the coarse nodes that a node interpolates from: one or two along each axis.
template <class F>
void for_each_parent(std::int32_t field, const std::int32_t* place, F f) {
  const int n[3] = {1 + (place[0] & 1), 1 + (place[1] & 1), 1 + (place[2] & 1)};
  const double weight = 1.0 / (n[0] * n[1] * n[2]);
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        f(key_of(field, {(place[0] >> 1) + i, (place[1] >> 1) + j, (place[2] >> 1) + k}), weight);
}

/// Of this rank's nodes, sorted by key.
std::vector<Parent> parents_of(const LatticeNodes& fine) {
  std::vector<Parent> parents;
  for (std::size_t i = 0; i < fine.own(); ++i)
    for_each_parent(fine.fields[i], fine.places.data() + 3 * i, [&](std::int64_t key, double) {
      parents.push_back({key, -1, static_cast<std::uint8_t>(7 & ~fine.held[i])});
    });
  std::ranges::sort(parents, {}, &Parent::key);
  std::size_t n = 0;
  for (const Parent& p : parents) {
    if (n > 0 && parents[n - 1].key == p.key)
      parents[n - 1].moves |= p.moves;
    else
      parents[n++] = p;
  }
  parents.resize(n);
  return parents;
}

/// Where ranks with the same parent meet: values travel there by parent, and back.
class Rendezvous {
 public:
  Rendezvous(MPI_Comm comm, const std::vector<Parent>& parents) : comm_(comm), order_(parents.size()) {
    int size = 0;
    must_succeed(MPI_Comm_size(comm, &size));
    const auto ranks = static_cast<std::uint64_t>(size);
    const auto meets_at = [&](const Parent& p) {
      constexpr std::uint64_t mixer = 0x9e3779b97f4a7c15;
      return static_cast<std::size_t>((static_cast<std::uint64_t>(p.key) * mixer >> 32) % ranks);
    };
    there_.count.resize(ranks);
    here_.count.resize(ranks);
    for (const Parent& p : parents) ++there_.count[meets_at(p)];
    must_succeed(MPI_Alltoall(there_.count.data(), 1, MPI_INT, here_.count.data(), 1, MPI_INT, comm));
    for (Stretches* s : {&there_, &here_}) {
      s->begin.assign(ranks + 1, 0);
      std::partial_sum(s->count.begin(), s->count.end(), s->begin.begin() + 1);
    }
    std::vector<int> next = there_.begin;
    for (std::size_t i = 0; i < parents.size(); ++i)
      order_[static_cast<std::size_t>(next[meets_at(parents[i])]++)] = i;
    keys_ = exchange(in_order([&](std::size_t i) { return parents[i].key; }), there_, here_);
    requests_.resize(keys_.size());
    std::iota(requests_.begin(), requests_.end(), std::size_t{0});
    std::ranges::stable_sort(requests_, {}, [&](std::size_t i) { return keys_[i]; });
  }

  /// Sends value(parent) of each; where they meet, change(values of one node, from the lowest rank on, as
  /// their places in the list); and take(parent, changed value).
  template <class Value, class Change, class Take>
  void exchange(Value value, Change change, Take take) const {
    std::vector<std::int64_t> values = exchange(in_order(value), there_, here_);
    for (std::size_t i = 0, end = 0; i < requests_.size(); i = end) {
      while (end < requests_.size() && keys_[requests_[end]] == keys_[requests_[i]]) ++end;
      change(values, std::span(requests_).subspan(i, end - i));
    }
    values = exchange(values, here_, there_);
    for (std::size_t i = 0; i < order_.size(); ++i) take(order_[i], values[i]);
  }

 private:
  struct Stretches {
    std::vector<int> count, begin;  ///< by rank
  };
  template <class Value>
  std::vector<std::int64_t> in_order(Value value) const {
    std::vector<std::int64_t> values;
    values.reserve(order_.size());
    for (const std::size_t i : order_) values.push_back(value(i));
    return values;
  }
  std::vector<std::int64_t> exchange(const std::vector<std::int64_t>& values, const Stretches& from,
                                     const Stretches& to) const {
    std::vector<std::int64_t> received(static_cast<std::size_t>(to.begin.back()));
    must_succeed(MPI_Alltoallv(values.data(), from.count.data(), from.begin.data(), MPI_INT64_T,
                               received.data(), to.count.data(), to.begin.data(), MPI_INT64_T, comm_));
    return received;
  }

  MPI_Comm comm_;
  std::vector<std::size_t> order_;     ///< parents by the rank that they meet at
  Stretches there_, here_;             ///< sent to that rank; met here
  std::vector<std::int64_t> keys_;     ///< that met here
  std::vector<std::size_t> requests_;  ///< their places, equal keys together, lower ranks first
};

}  // namespace

bool has_keys(const LatticeNodes& nodes) {
  const auto below = [](std::int32_t n, int width) { return n >= -1 && n < (1 << width) - 2; };
  return std::ranges::all_of(nodes.places, [&](std::int32_t n) { return below(n, bits); }) &&
         std::ranges::all_of(nodes.fields, [&](std::int32_t n) { return below(n, field_bits); });
}

LatticeNodes coarsen(MPI_Comm comm, const LatticeNodes& fine, Interpolation& interpolation) {
  std::vector<Parent> parents = parents_of(fine);
  const Rendezvous meeting(comm, parents);
  constexpr std::int64_t owned = 8;
  std::vector<std::uint8_t> mine(parents.size());
  using Requests = std::span<const std::size_t>;
  meeting.exchange([&](std::size_t i) { return std::int64_t{parents[i].moves}; },
                   [](std::vector<std::int64_t>& moves, Requests requests) {
                     std::int64_t all = 0;
                     for (const std::size_t r : requests) all |= moves[r];
                     for (const std::size_t r : requests) moves[r] = all;
                     moves[requests.front()] |= owned;
                   },
                   [&](std::size_t i, std::int64_t found) {
                     parents[i].moves = static_cast<std::uint8_t>(found & ~owned);
                     mine[i] = (found & owned) != 0;
                   });
  LatticeNodes coarse;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (mine[i] == 0) continue;
    for (int a = 0; a < 3; ++a) coarse.places.push_back(place_of(parents[i].key, a));
    coarse.fields.push_back(field_of(parents[i].key));
    coarse.held.push_back(static_cast<std::uint8_t>(7 & ~parents[i].moves));
  }
  const auto own = static_cast<std::int64_t>(coarse.own());
  std::int64_t beyond = 0;
  must_succeed(MPI_Scan(&own, &beyond, 1, MPI_INT64_T, MPI_SUM, comm));
  must_succeed(MPI_Allreduce(&own, &coarse.all, 1, MPI_INT64_T, MPI_SUM, comm));
  coarse.first = beyond - own;
  std::int64_t next = coarse.first;
  for (std::size_t i = 0; i < parents.size(); ++i)
    if (mine[i] != 0) parents[i].number = next++;
  meeting.exchange([&](std::size_t i) { return parents[i].number; },
                   [](std::vector<std::int64_t>& numbers, Requests requests) {
                     for (const std::size_t r : requests) numbers[r] = numbers[requests.front()];
                   },
                   [&](std::size_t i, std::int64_t number) { parents[i].number = number; });

  interpolation.sources.clear();
  interpolation.begin.assign(1, 0);
  for (std::size_t i = 0; i < fine.own(); ++i) {
    for_each_parent(fine.fields[i], fine.places.data() + 3 * i, [&](std::int64_t key, double weight) {
      const Parent& parent = *std::ranges::lower_bound(parents, key, {}, &Parent::key);
      Interpolation::Source source{parent.number, {}};
      for (std::size_t a = 0; a < 3; ++a) {
        const bool given = (fine.held[i] >> a & 1) != 0, moves = (parent.moves >> a & 1) != 0;
        source.weight[a] = given && moves ? 0 : weight;
      }
      interpolation.sources.push_back(source);
    });
    interpolation.begin.push_back(interpolation.sources.size());
  }
  return coarse;
}

}  // namespace mpm::parallel
