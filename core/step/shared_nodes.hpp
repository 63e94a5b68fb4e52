// Nodal sums of one brick: of the contributions of all bricks that share a node.
//
// Every brick has its own copy of shared nodes. All copies are summed in the order of the neighbours'
// coordinates, so they agree bit for bit on any rank.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

/// Which bricks share each node of a brick, in summation order; built once per node block shape.
class SharedNodes {
 public:
  /// Throws std::logic_error for more than most_layers of nodes beyond the brick.
  explicit SharedNodes(const NodeBlockShape& shape) : SharedNodes(shape, shape) {}
  /// A brick contributes to the nodes of the smaller block `reached` alone.
  SharedNodes(const NodeBlockShape& shape, const NodeBlockShape& reached)
      : SharedNodes(shape, reached, shape) {}
  /// Only the nodes of the smaller block `wanted` are summed.
  SharedNodes(const NodeBlockShape& shape, const NodeBlockShape& reached, const NodeBlockShape& wanted);

  struct Share {
    int neighbour;  ///< 0..26
    int node;       ///< its number in that brick
  };
  const NodeBlockShape& shape() const { return shape_; }
  const NodeBlockShape& reached() const { return reached_; }
  const NodeBlockShape& wanted() const { return wanted_; }
  int nodes() const { return shape_.nodes(); }
  /// Those that are summed; if not null, only those of `some`.
  NodeSelection summed(const NodeMask* some = nullptr) const { return {shape_, wanted_, some}; }
  /// What to prefetch for a brick's sums, for records of `width` doubles: a record in each of their cache
  /// lines, brick by brick. `after_lower_x`: without those that the sums of its lower neighbour along x have
  /// read.
  std::span<const Share> lines(int width, bool after_lower_x) const {
    const Lines& of = lines_[width < node_doubles ? 1 : 0];
    const std::span<const Share> all = of.shares;
    return after_lower_x ? all.first(of.new_after_lower_x) : all;
  }
  /// f(node, shares) for every node of the block.
  template <class F>
  void for_each_node(F f) const {
    for (int n = 0; n < nodes(); ++n) {
      const std::size_t first = first_[static_cast<std::size_t>(n)];
      f(n, std::span(shares_).subspan(first, first_[static_cast<std::size_t>(n) + 1] - first));
    }
  }

 private:
  struct Lines {
    std::vector<Share> shares;  ///< those that the lower neighbour along x has not read come first
    std::size_t new_after_lower_x = 0;
  };
  static Lines find_lines(std::vector<std::pair<Share, bool>> shares, bool half_records);

  NodeBlockShape shape_, reached_, wanted_;
  std::vector<Share> shares_;       ///< by node
  std::vector<std::size_t> first_;  ///< of each node's shares, and the end
  Lines lines_[2];                  ///< of whole and of half records
};

/// Sums that the next brick along x shares, a third of them or more: kept from brick to brick by a thread
/// that processes bricks in their order, in one pass.
template <NodeArray of>
class CarriedSums {
 public:
  /// Before a pass, as contributions have changed.
  void forget() { from_ = no_slot; }
  /// Whether it has those of the lower neighbour along x.
  bool begins(const BrickGrid& grid, Slot slot) const {
    return from_ != no_slot && grid.brick(slot).neighbour[lower_x_index] == from_;
  }
  /// Row by row the sums of the nodes that are shared; those of `slot` replace them.
  double* records(Slot slot) {
    from_ = slot;
    return records_.data();
  }

 private:
  static constexpr int widest = 1 + 2 * most_layers;  // nodes of a row that two bricks share
  static constexpr int rows = NodeBlockShape{most_layers, most_layers}.side();
  Slot from_ = no_slot;
  alignas(64) std::array<double, record_doubles(of) * widest * rows * rows> records_;
};

/// sums = contributions of the brick and its 26 neighbours; components first .. first + 3 of records of
/// node_doubles for arrays of half a line, all components for the first. A brick that does not exist
/// contributes zeros, so every copy of a node adds the same numbers. Records of nodes that are not wanted
/// stay as they are.
template <NodeArray of>
void sum_contributions(const BrickGrid& grid, const SharedNodes& shared, Slot slot, double* sums);
/// The same with what the last brick has left in `carried`.
template <NodeArray of>
void sum_contributions(const BrickGrid& grid, const SharedNodes& shared, Slot slot, CarriedSums<of>& carried,
                       double* sums);
/// The same of the rows along x that have some of these nodes.
template <NodeArray of>
void sum_contributions(const BrickGrid& grid, const SharedNodes& shared, Slot slot, const NodeMask& some,
                       double* sums);
/// The same of one component's velocity field. Where the neighbourhood holds one component, both are equal.
template <NodeArray of>
void sum_contributions(const BrickGrid& grid, const SharedNodes& shared, Slot slot, std::int32_t component,
                       double* sums);

}  // namespace mpm::core
