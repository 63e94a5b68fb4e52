// The nodes of the bricks as unknowns of an implicit step. Where components are in contact each has its own
// field (brick_fields.hpp), and unknowns of its own at the nodes that its particles reach: what follows holds
// for each field, and "the bricks" are those that have it.
//
// A node is active if its support, the sum of S + h |grad S| over the particles, is at least least_support:
// its mass may be tiny where its stiffness is not. Nodes with less are reached by rounding errors; they stay
// where they are. Of the bricks that share an active node the first in summation order that exists owns it;
// owned nodes are numbered rank by rank, brick by brick. What a brick knows of its own nodes reaches the
// others through the exchange of contributions: the owner contributes the value, all others zero, and the sum
// is the value.
//
// Nodes beyond a wall are no unknowns: each follows from its mirror image (core/step/node_update.hpp),
// u_k = sign_k u_mirror,k. Held components have a given displacement: those that a wall fixes, and nodes
// where bodies of prescribed motion make up at least held_share of the volume around.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/communication/communication.hpp"
#include "core/implicit/brick_fields.hpp"
#include "core/model.hpp"
#include "core/step/node_update.hpp"
#include "core/step/shared_nodes.hpp"

namespace mpm::core {

class NodeUnknowns {
 public:
  /// Least support of an active node; and the part of the volume around a node that bodies of prescribed
  /// motion have where they hold it.
  static constexpr double least_support = 1e-6;
  static constexpr double held_share = 0.125;

  /// `fields` outlive the unknowns.
  NodeUnknowns(Model& model, Communication& communication, const BrickFields& fields);

  /// Exchanges these fields of the contributions to the first array. Collective.
  void exchange(NodeFields fields);
  /// Numbers the active nodes, once mapped::implicit_start has been exchanged, and returns their sums,
  /// node_doubles per own node. Collective.
  std::vector<double> number();
  /// Holds what the walls fix.
  void hold_walls();
  /// Holds nodes for bodies of prescribed motion, from the sums of mapped::implicit_motion, for `dt`.
  void hold_moved(double dt);

  int nodes() const { return shared_.nodes(); }
  /// A field's sums of the last exchange, records of node_doubles.
  void sums(const BrickField& field, double* to) const {
    if (field.component == all_components)
      sum_contributions<NodeArray::first>(*model_.grid, shared_, field.slot, to);
    else
      sum_contributions<NodeArray::first>(*model_.grid, shared_, field.slot, field.component, to);
  }
  /// f(own node, its record of the exchanged sums).
  template <class F>
  void for_each_own(F f) {
    const double* sum = nullptr;
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (i == 0 || own_[i].field != own_[i - 1].field) sum = sums(own_[i].field);
      f(i, sum + node_doubles * own_[i].node);
    }
  }

  /// Of the nodes of a brick: the unknown that determines each, by its number in the brick (itself but for
  /// nodes beyond walls), its number of all ranks, its signs, and its held components as bits.
  struct Node {
    std::int64_t number = -1;
    std::int16_t from = 0;
    std::int8_t sign[3] = {1, 1, 1};
    std::uint8_t held = 0;
  };
  const Node* of(const BrickField& field) const { return nodes_.data() + field.index * per_brick(); }

  std::size_t own() const { return own_.size(); }
  std::int64_t first() const { return first_; }
  std::int64_t all() const { return all_; }
  std::span<const double> coordinates() const { return coordinates_; }
  /// Three per own node: its place in the lattice of the grid's nodes.
  std::span<const std::int32_t> lattice() const { return lattice_; }
  /// The component of each own node; all_components where there is one field.
  std::span<const std::int32_t> components() const { return components_; }
  /// Three bits and three displacements per own node.
  std::span<const std::uint8_t> held() const { return held_; }
  std::span<const double> held_displacements() const { return held_to_; }
  /// Per own node: the components that bodies of prescribed motion hold, as bits, and the volume that they
  /// fill around it. Empty without such bodies.
  std::span<const std::uint8_t> moved() const { return moved_; }
  std::span<const double> moved_volume() const { return moved_volume_; }

  /// Values of the own unknowns, three per node, to the records of all bricks' nodes: components 0..2 and
  /// 4..6 (velocity and strain velocity of a MotionRecord). Collective.
  void distribute(std::span<const double> u, AlignedDoubles& records);

  /// A node of a field in an owned or ghost brick.
  struct Copy {
    Slot slot = no_slot;
    std::int32_t field = 0, node = 0;
  };
  /// Where an own node is: in the brick that owns it.
  Copy own_copy(std::size_t i) const {
    const BrickField& field = fields_.all()[own_[i].field];
    return {field.slot, field.number, own_[i].node};
  }
  /// The copy in the brick that owns a component's unknown at a node of an owned brick, whatever its rank;
  /// its slot is no_slot where no brick has the component.
  Copy owner(Slot s, std::int32_t node, std::int32_t component) const;
  /// value_of_own(number of the own node, record) sets records of node_doubles, zeros before; then shared()
  /// has those of all owners, until contributions change. Collective.
  template <class F>
  void share(F value_of_own) {
    send(value_of_own, mapped::implicit_start);
  }
  /// Valid after distribute(), with three values, and after share().
  const double* shared(const Copy& at) const {
    return model_.grid->contributions(NodeArray::first, at.slot, at.field) + node_doubles * at.node;
  }

 private:
  /// Where an own unknown's node is.
  struct Own {
    std::size_t field;
    std::int32_t node;
  };
  /// A field's sums of the last exchange(); records of node_doubles.
  const double* sums(std::size_t field) {
    sums(fields_.all()[field], buffer_.data());
    return buffer_.data();
  }
  BrickGrid& grid() { return *model_.grid; }
  double* contributions(const BrickField& field) {
    return grid().contributions(NodeArray::first, field.slot, field.number);
  }
  std::size_t per_brick() const { return static_cast<std::size_t>(shared_.nodes()); }
  bool has(Slot s, std::int32_t component) const {
    return s != no_slot && (component == all_components || model_.grid->field_of(s, component) >= 0);
  }
  bool owns(const BrickField& field, std::span<const SharedNodes::Share> shares) const;
  template <class F>
  void send(F value_of_own, NodeFields what);

  Model& model_;
  Reductions& ranks_;
  NodeHalo& halo_;
  const BrickFields& fields_;
  SharedNodes shared_;
  std::vector<std::span<const SharedNodes::Share>> shares_;  ///< by node
  std::vector<Node> nodes_;
  std::vector<Own> own_;
  std::int64_t first_ = 0, all_ = 0;
  std::vector<double> coordinates_, held_to_;
  std::vector<std::int32_t> lattice_, components_;
  std::vector<std::uint8_t> held_, moved_;
  std::vector<double> moved_volume_;
  AlignedDoubles buffer_;
};

template <class F>
void NodeUnknowns::send(F value_of_own, NodeFields what) {
  for (const BrickField& field : fields_.all())
    std::fill_n(contributions(field), node_doubles * per_brick(), 0.0);
  for (std::size_t i = 0; i < own_.size(); ++i)
    value_of_own(i, contributions(fields_.all()[own_[i].field]) + node_doubles * own_[i].node);
  exchange(what);
}

}  // namespace mpm::core
