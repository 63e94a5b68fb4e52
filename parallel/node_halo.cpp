#include "parallel/node_halo.hpp"

#include <algorithm>
#include <bitset>
#include <map>
#include <stdexcept>

namespace mpm::parallel {

using core::BrickCoord;
using core::BrickGrid;
using core::NodeArray;
using core::NodeBlockShape;
using core::NodeFields;
using core::Slot;

namespace {

constexpr int tag_halo = 2, tag_components = 6, tag_points = 7;

using NodeSet = std::bitset<NodeBlockShape{core::most_layers, core::most_layers}.nodes()>;

/// Nodes of a brick's node block that the block of its neighbour number n also contains.
std::array<NodeSet, core::neighbourhood> shared_sets(const NodeBlockShape& shape) {
  const auto shares = [&](int node, std::int32_t offset) {
    const int there = node - core::brick_cells * offset;
    return shape.lowest() <= there && there <= shape.highest();
  };
  const int low = shape.lowest(), high = shape.highest() + 1;
  std::array<NodeSet, core::neighbourhood> sets;
  for (int n = 0; n < core::neighbourhood; ++n) {
    const BrickCoord offset = core::neighbour_offset(n);
    for (int k = low; k < high; ++k) {
      for (int j = low; j < high; ++j) {
        for (int i = low; i < high; ++i) {
          if (shares(i, offset.x) && shares(j, offset.y) && shares(k, offset.z)) {
            sets[static_cast<std::size_t>(n)].set(static_cast<std::size_t>(shape.index(i, j, k)));
          }
        }
      }
    }
  }
  return sets;
}

/// One piece for each velocity field.
void append(NodeList& list, Slot slot, int fields, const NodeSet& nodes) {
  for (int field = 0; field < fields; ++field) {
    const auto begin = static_cast<std::uint32_t>(list.nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes.test(i)) list.nodes.push_back(static_cast<std::uint16_t>(i));
    }
    list.pieces.push_back({slot, field, begin, static_cast<std::uint32_t>(list.nodes.size())});
  }
}

/// Slots [first, last) in the order of their bricks' keys.
template <class CoordOf>
std::vector<Slot> by_key(int first, int last, CoordOf coord_of) {
  std::vector<Slot> slots;
  for (Slot s = first; s < last; ++s) slots.push_back(s);
  std::sort(slots.begin(), slots.end(),
            [&](Slot a, Slot b) { return core::key_of(coord_of(a)) < core::key_of(coord_of(b)); });
  return slots;
}

/// copy(position in the message, record's components) for every node of the list, Count doubles each.
template <int Count, class Records, class Copy>
void for_each_node(const NodeList& list, Records records, int width, Copy copy) {
  std::size_t at = 0;
  for (const NodeList::Piece& piece : list.pieces) {
    auto* base = records(piece.slot, piece.field);
    for (std::uint32_t n = piece.begin; n < piece.end; ++n) {
      copy(at, base + width * list.nodes[n]);
      at += Count;
    }
  }
}

template <int Count>
void pack(const BrickGrid& grid, const NodeList& list, NodeFields fields, double* message) {
  for_each_node<Count>(
      list, [&](Slot s, int field) { return grid.contributions(fields.array, s, field) + fields.first; },
      core::record_doubles(fields.array),
      [&](std::size_t at, const double* node) { std::copy_n(node, Count, message + at); });
}

template <int Count>
void unpack(BrickGrid& grid, const NodeList& list, NodeFields fields, const double* message) {
  for_each_node<Count>(
      list, [&](Slot s, int field) { return grid.contributions(fields.array, s, field) + fields.first; },
      core::record_doubles(fields.array),
      [&](std::size_t at, double* node) { std::copy_n(message + at, Count, node); });
}

/// Nodes that no neighbour sends are zero.
void clear_ghosts(BrickGrid& grid) {
  for (const NodeArray of : core::node_arrays) {
    if (!grid.arrays().has(of)) continue;
    for (int g = 0; g < grid.ghosts(); ++g) {
      const Slot s = grid.owned() + g;
      for (int field = 0; field < grid.velocity_fields(s); ++field)
        std::fill_n(grid.contributions(of, s, field), grid.shape().nodes() * core::record_doubles(of), 0.0);
    }
  }
}

/// f(slot) for each brick of the list, once.
template <class F>
void for_each_slot(const NodeList& list, F f) {
  for (const NodeList::Piece& piece : list.pieces) {
    if (piece.field == 0) f(piece.slot);
  }
}

/// f with `count` as a compile-time constant, so that copies have a fixed length.
template <int Count = core::node_doubles, class F>
void with_count(int count, F f) {
  if constexpr (Count > 0) {
    if (count == Count) {
      f(std::integral_constant<int, Count>());
    } else {
      with_count<Count - 1>(count, f);
    }
  }
}

}  // namespace

std::vector<HaloPartner> halo_partners(const BrickGrid& grid, const core::BrickDirectory& directory) {
  const auto shared = shared_sets(grid.shape());
  const auto ghost_of = [&](Slot s) { return grid.ghost(s - grid.owned()); };
  std::map<int, HaloPartner> partners;
  std::vector<NodeSet> from_ghost(static_cast<std::size_t>(grid.ghosts()));

  std::map<int, NodeSet> to_rank;
  for (const Slot s : by_key(0, grid.boundary(), [&](Slot b) { return grid.brick(b).coord; })) {
    to_rank.clear();
    for (std::size_t n = 0; n < core::neighbourhood; ++n) {
      const Slot other = grid.brick(s).neighbour[n];
      if (other < grid.owned()) continue;
      to_rank[directory.owner_nearby(ghost_of(other))] |= shared[n];
      from_ghost[static_cast<std::size_t>(other - grid.owned())] |= shared[core::neighbourhood - 1 - n];
    }
    for (const auto& [rank, nodes] : to_rank) append(partners[rank].send, s, grid.velocity_fields(s), nodes);
  }
  for (const Slot s : by_key(grid.owned(), grid.owned() + grid.ghosts(), ghost_of)) {
    append(partners[directory.owner_nearby(ghost_of(s))].receive, s, grid.velocity_fields(s),
           from_ghost[static_cast<std::size_t>(s - grid.owned())]);
  }

  std::vector<HaloPartner> list;
  for (auto& [rank, partner] : partners) {
    partner.rank = rank;
    list.push_back(std::move(partner));
  }
  return list;
}

void MpiHalo::exchange_components(const BrickGrid& grid, std::vector<std::vector<std::int32_t>>& of_slot) {
  exchange_lists(grid, of_slot, tag_components);
}

void MpiHalo::exchange_points(const BrickGrid& grid, std::vector<std::vector<double>>& of_slot) {
  exchange_lists(grid, of_slot, tag_points);
}

template <class T>
void MpiHalo::exchange_lists(const BrickGrid& grid, std::vector<std::vector<T>>& of_slot, int tag) {
  update(grid);
  // For each brick in the order of the partner's list: how many numbers, and these.
  std::vector<std::vector<double>> lists(partners_.size());
  Requests requests;
  for (std::size_t p = 0; p < partners_.size(); ++p) {
    for_each_slot(partners_[p].send, [&](Slot s) {
      const std::vector<T>& mine = of_slot[static_cast<std::size_t>(s)];
      lists[p].push_back(static_cast<double>(mine.size()));
      lists[p].insert(lists[p].end(), mine.begin(), mine.end());
    });
    requests.send_unannounced(comm_, lists[p].data(), lists[p].size() * sizeof(double), partners_[p].rank,
                              tag);
  }
  for (const HaloPartner& partner : partners_) {
    std::vector<double> list;
    comm_.receive_onto(list, partner.rank, tag);
    auto next = list.begin();
    for_each_slot(partner.receive, [&](Slot s) {
      const auto count = static_cast<std::ptrdiff_t>(*next++);
      of_slot[static_cast<std::size_t>(s)].assign(next, next + count);
      next += count;
    });
  }
  requests.wait_all();
}

void MpiHalo::update(const BrickGrid& grid) {
  if (planned_grid_ == &grid && planned_revision_ == grid.revision()) return;
  if (under_way_) throw std::logic_error("the set of bricks changed during a halo exchange");
  planned_grid_ = &grid;
  planned_revision_ = grid.revision();
  partners_ = halo_partners(grid, directory_);
  // Requests refer to the buffers and are destroyed first.
  for (auto& r : sends_) r = {};
  for (auto& r : receives_) r = {};
  outgoing_.assign(partners_.size(), {});
  incoming_.assign(partners_.size(), {});
  for (std::size_t p = 0; p < partners_.size(); ++p) {
    outgoing_[p].resize(core::node_doubles * partners_[p].send.size());
    incoming_[p].resize(core::node_doubles * partners_[p].receive.size());
  }
  ghosts_are_clear_ = false;
}

void MpiHalo::set_up_requests(int count) {
  if (sends(count).size() == partners_.size()) return;
  const auto doubles = static_cast<std::size_t>(count);
  for (std::size_t p = 0; p < partners_.size(); ++p) {
    const HaloPartner& partner = partners_[p];
    sends(count).add_send(comm_, outgoing_[p].data(), doubles * partner.send.size(), partner.rank, tag_halo);
    receives(count).add_receive(comm_, incoming_[p].data(), doubles * partner.receive.size(), partner.rank,
                                tag_halo);
  }
}

void MpiHalo::begin(BrickGrid& grid, NodeFields fields) {
  if (under_way_) throw std::logic_error("a halo exchange was begun before the last one ended");
  const int count = fields.count;
  if (!grid.arrays().has(fields.array) || fields.first < 0 || count < 1 ||
      fields.end() > core::record_doubles(fields.array)) {
    throw std::logic_error("a halo exchange of components beyond a node's record");
  }
  update(grid);
  if (!ghosts_are_clear_) clear_ghosts(grid);
  ghosts_are_clear_ = true;
  set_up_requests(count);
  under_way_ = fields;
  receives(count).start_all();
  with_count(count, [&](auto constant) {
    for (std::size_t p = 0; p < partners_.size(); ++p) {
      pack<constant>(grid, partners_[p].send, fields, outgoing_[p].data());
      sends(count).start(p);
    }
  });
}

void MpiHalo::end(BrickGrid& grid) {
  if (!under_way_) throw std::logic_error("a halo exchange was ended before it began");
  const NodeFields fields = *under_way_;
  with_count(fields.count, [&](auto constant) {
    for (int p = receives(constant).wait_any(); p >= 0; p = receives(constant).wait_any()) {
      const auto i = static_cast<std::size_t>(p);
      unpack<constant>(grid, partners_[i].receive, fields, incoming_[i].data());
    }
  });
  sends(fields.count).wait_all();
  under_way_.reset();
}

}  // namespace mpm::parallel
