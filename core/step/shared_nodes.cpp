#include "core/step/shared_nodes.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "core/simd/lanes.hpp"

namespace mpm::core {

SharedNodes::SharedNodes(const NodeBlockShape& shape, const NodeBlockShape& reached,
                         const NodeBlockShape& wanted)
    : shape_(shape), reached_(reached), wanted_(wanted) {
  require_few_layers(shape);
  const int low = shape.lowest(), high = shape.highest();
  const auto within = [](const NodeBlockShape& block, int i, int j, int k) {
    const auto along = [&](int n) { return block.lowest() <= n && n <= block.highest(); };
    return along(i) && along(j) && along(k);
  };
  std::vector<std::pair<Share, bool>> read;  // and whether the lower neighbour along x has the node
  for (int k = low; k <= high; ++k) {
    for (int j = low; j <= high; ++j) {
      for (int i = low; i <= high; ++i) {
        first_.push_back(shares_.size());
        for (int n = 0; n < neighbourhood; ++n) {
          // The same node, relative to the neighbour's lowest.
          const BrickCoord d = neighbour_offset(n);
          const int a = i - brick_cells * d.x, b = j - brick_cells * d.y, c = k - brick_cells * d.z;
          if (!within(reached, a, b, c)) continue;
          shares_.push_back({n, shape.index(a, b, c)});
          if (within(wanted, i, j, k)) read.push_back({shares_.back(), i <= wanted.highest() - brick_cells});
        }
      }
    }
  }
  first_.push_back(shares_.size());
  lines_[0] = find_lines(read, false);
  lines_[1] = find_lines(std::move(read), true);
}

SharedNodes::Lines SharedNodes::find_lines(std::vector<std::pair<Share, bool>> shares, bool half_records) {
  std::sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.second, a.first.neighbour, a.first.node) <
           std::tuple(b.second, b.first.neighbour, b.first.node);
  });
  Lines found;
  Share last{-1, -1};
  for (const auto& [share, known] : shares) {
    // Records begin at cache lines: two half records share one.
    const bool same_line =
        half_records && share.neighbour == last.neighbour && share.node / 2 == last.node / 2;
    last = share;
    if (same_line) continue;
    found.shares.push_back(share);
    if (!known) found.new_after_lower_x = found.shares.size();
  }
  return found;
}

namespace {

/// By neighbour its contributions, null if it has none.
using Neighbours = std::array<const double*, neighbourhood>;

/// The sums of the wanted nodes of one block, row by row along x. Which neighbours share the nodes of a row
/// is known when this is compiled; absent ones are passed over, which changes no bit as sums begin with +0.
template <int width, NodeBlockShape shape, NodeBlockShape reached, NodeBlockShape wanted>
class RowSums {
 public:
  /// `known`: the shared nodes of the lower neighbour along x are in `carried`. Replaces them, if not null,
  /// by those of this brick.
  template <bool known>
  static void sum(const Neighbours& from, double* carried, double* sums) {
    for (int k = low; k <= high; ++k) {
      for (int j = low; j <= high; ++j) {
        Part row[side];
        sum_row<known>(from, j, k, carried, row);
        put(row, j, k, sums);
        if (carried == nullptr) continue;
        for (int i = 0; i < common; ++i, carried += width) store(carried, row[i + brick_cells]);
      }
    }
  }
  /// The rows that have one of these nodes.
  static void sum(const Neighbours& from, const NodeMask& nodes, double* sums) {
    for (int k = low; k <= high; ++k) {
      for (int j = low; j <= high; ++j) {
        if (!nodes.has_row(shape, j, k)) continue;
        Part row[side];
        sum_row<false>(from, j, k, nullptr, row);
        put(row, j, k, sums);
      }
    }
  }

 private:
  using Part = Lanes<width>;
  static void put(const Part (&row)[wanted.side()], int j, int k, double* sums) {
    double* to = sums + node_doubles * shape.index(low, j, k);
    for (int i = 0; i < side; ++i) store(to + node_doubles * i, row[i]);
  }
  static constexpr int low = wanted.lowest(), high = wanted.highest(), side = wanted.side();
  static constexpr int common = side - brick_cells;  ///< nodes of a row that the next brick along x has too

  /// Whether the neighbour at offset `d` along an axis contributes to node `i`.
  static constexpr bool has(int i, int d) {
    const int there = i - brick_cells * d;
    return reached.lowest() <= there && there <= reached.highest();
  }

  template <bool known>
  [[gnu::always_inline]] static void sum_row(const Neighbours& from, int j, int k, const double* carried,
                                             Part (&row)[side]) {
    alignas(64) static constexpr double no_row[width * shape.side()] = {};
    const double* const zeros = no_row + width * (low - shape.lowest());
    for (int i = 0; i < side; ++i) row[i] = known && i < common ? load<Part>(carried + width * i) : Part(0.0);
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        const double* const* along_x = &from[static_cast<std::size_t>(9 * (z + 1) + 3 * (y + 1))];
        if (!has(k, z) || !has(j, y) || !(along_x[0] || along_x[1] || along_x[2])) continue;
        const int at = width * shape.index(low, j - brick_cells * y, k - brick_cells * z);
        const double* rows[3];
        for (int x = 0; x < 3; ++x) rows[x] = along_x[x] == nullptr ? zeros : along_x[x] + at;
        add_row<known>(rows, row, std::make_integer_sequence<int, side>());
      }
    }
  }

  template <bool known, int... i>
  [[gnu::always_inline]] static void add_row(const double* const (&rows)[3], Part (&row)[side],
                                             std::integer_sequence<int, i...>) {
    const auto add = [&]<int n>() {
      if constexpr (known && n < common) return;
      for (int x = -1; x <= 1; ++x)
        if (has(low + n, x)) row[n] += load<Part>(rows[x + 1] + width * (n - brick_cells * x));
    };
    (add.template operator()<i>(), ...);
  }
};

/// f<shape, reached, wanted>() with the blocks of `shared`.
template <class F>
void with_blocks(const SharedNodes& shared, F f) {
  const auto are = [&](const NodeBlockShape& shape, const NodeBlockShape& reached,
                       const NodeBlockShape& wanted) {
    return shared.shape() == shape && shared.reached() == reached && shared.wanted() == wanted;
  };
  constexpr NodeBlockShape small{0, 0}, below{1, 0}, both{1, 1};
  if (are(small, small, small)) return f.template operator()<small, small, small>();
  if (are(below, below, below)) return f.template operator()<below, below, below>();
  if (are(both, both, both)) return f.template operator()<both, both, both>();
  if (are(both, small, both)) return f.template operator()<both, small, both>();
  if (are(both, both, small)) return f.template operator()<both, both, small>();
  throw std::logic_error("sums over node blocks that no shape function has");
}

/// `contributions_of(slot)`: those of a neighbour, null if it has none.
template <class F>
Neighbours neighbours_of(const BrickGrid& grid, Slot slot, F contributions_of) {
  const Brick& brick = grid.brick(slot);
  Neighbours from;
  for (std::size_t n = 0; n < neighbourhood; ++n)
    from[n] = brick.neighbour[n] == no_slot ? nullptr : contributions_of(brick.neighbour[n]);
  return from;
}

template <NodeArray of, class F>
void sum_over_neighbours(const BrickGrid& grid, const SharedNodes& shared, Slot slot, F contributions_of,
                         CarriedSums<of>* carried, double* sums) {
  const Neighbours from = neighbours_of(grid, slot, contributions_of);
  const bool known = carried != nullptr && carried->begins(grid, slot);
  double* records = carried == nullptr ? nullptr : carried->records(slot);
  with_blocks(shared, [&]<NodeBlockShape shape, NodeBlockShape reached, NodeBlockShape wanted>() {
    using Rows = RowSums<record_doubles(of), shape, reached, wanted>;
    if (known)
      Rows::template sum<true>(from, records, sums);
    else
      Rows::template sum<false>(from, records, sums);
  });
}

}  // namespace

template <NodeArray of>
void sum_contributions(const BrickGrid& grid, const SharedNodes& shared, Slot slot, double* sums) {
  sum_over_neighbours<of>(
      grid, shared, slot, [&](Slot s) { return grid.contributions(of, s); }, nullptr, sums);
}
template <NodeArray of>
void sum_contributions(const BrickGrid& grid, const SharedNodes& shared, Slot slot, CarriedSums<of>& carried,
                       double* sums) {
  sum_over_neighbours<of>(
      grid, shared, slot, [&](Slot s) { return grid.contributions(of, s); }, &carried, sums);
}
template <NodeArray of>
void sum_contributions(const BrickGrid& grid, const SharedNodes& shared, Slot slot, const NodeMask& some,
                       double* sums) {
  const Neighbours from = neighbours_of(grid, slot, [&](Slot s) { return grid.contributions(of, s); });
  with_blocks(shared, [&]<NodeBlockShape shape, NodeBlockShape reached, NodeBlockShape wanted>() {
    RowSums<record_doubles(of), shape, reached, wanted>::sum(from, some, sums);
  });
}
template <NodeArray of>
void sum_contributions(const BrickGrid& grid, const SharedNodes& shared, Slot slot, std::int32_t component,
                       double* sums) {
  const auto of_component = [&](Slot s) -> const double* {
    const int field = grid.field_of(s, component);
    return field < 0 ? nullptr : grid.contributions(of, s, field);
  };
  sum_over_neighbours<of>(grid, shared, slot, of_component, nullptr, sums);
}

#define MPM_INSTANTIATE(of)                                                                                  \
  template void sum_contributions<of>(const BrickGrid&, const SharedNodes&, Slot, double*);                  \
  template void sum_contributions<of>(const BrickGrid&, const SharedNodes&, Slot, CarriedSums<of>&,          \
                                      double*);                                                              \
  template void sum_contributions<of>(const BrickGrid&, const SharedNodes&, Slot, const NodeMask&, double*); \
  template void sum_contributions<of>(const BrickGrid&, const SharedNodes&, Slot, std::int32_t, double*);
MPM_INSTANTIATE(NodeArray::first)
MPM_INSTANTIATE(NodeArray::second)
MPM_INSTANTIATE(NodeArray::third)
MPM_INSTANTIATE(NodeArray::fourth)
MPM_INSTANTIATE(NodeArray::sixth)
MPM_INSTANTIATE(NodeArray::seventh)
#undef MPM_INSTANTIATE

}  // namespace mpm::core
