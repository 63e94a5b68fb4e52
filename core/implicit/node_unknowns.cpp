#include "core/implicit/node_unknowns.hpp"

#include <algorithm>

#include "core/threads.hpp"

namespace mpm::core {

NodeUnknowns::NodeUnknowns(Model& model, Communication& communication, const BrickFields& fields)
    : model_(model),
      ranks_(communication.reductions),
      halo_(communication.halo),
      fields_(fields),
      shared_(model.grid->shape()) {
  shared_.for_each_node([&](int, auto shares) { shares_.push_back(shares); });
  buffer_.resize(static_cast<std::size_t>(node_doubles * shared_.nodes()));
}

void NodeUnknowns::exchange(NodeFields fields) {
  halo_.begin(grid(), fields);
  halo_.end(grid());
}

/// The first brick in summation order that has the field owns a shared node.
bool NodeUnknowns::owns(const BrickField& field, std::span<const SharedNodes::Share> shares) const {
  const Brick& brick = model_.grid->brick(field.slot);
  for (const SharedNodes::Share& share : shares)
    if (has(brick.neighbour[static_cast<std::size_t>(share.neighbour)], field.component))
      return share.neighbour == self_index;
  return false;
}

NodeUnknowns::Copy NodeUnknowns::owner(Slot s, std::int32_t node, std::int32_t component) const {
  for (const SharedNodes::Share& share : shares_[static_cast<std::size_t>(node)]) {
    const Slot there = model_.grid->brick(s).neighbour[static_cast<std::size_t>(share.neighbour)];
    if (has(there, component)) return {there, model_.grid->field_of(there, component), share.node};
  }
  return {};
}

std::vector<double> NodeUnknowns::number() {
  const NodeBlockShape shape = grid().shape();
  nodes_.assign(fields_.count() * per_brick(), {});
  own_.clear();
  coordinates_.clear();
  lattice_.clear();
  components_.clear();
  std::vector<double> start;
  for (const BrickField& field : fields_.all()) {
    const Slot s = field.slot;
    const double* sum = sums(field.index);
    std::vector<std::uint8_t> mine(per_brick());
    shared_.for_each_node([&](int node, auto shares) {
      mine[static_cast<std::size_t>(node)] =
          sum[node_doubles * node + node_field::support.first] >= least_support && owns(field, shares);
    });
    Node* const of = nodes_.data() + field.index * per_brick();
    for (int n = 0; n < nodes(); ++n) of[n].from = static_cast<std::int16_t>(n);
    BoundaryFaces(grid(), s).for_each_tie([&](int outer, int inner, const bool(&reverses)[3]) {
      of[outer].from = of[inner].from;
      for (int a = 0; a < 3; ++a)
        of[outer].sign[a] = static_cast<std::int8_t>(reverses[a] ? -of[inner].sign[a] : of[inner].sign[a]);
    });
    for (int k = shape.lowest(); k <= shape.highest(); ++k) {
      for (int j = shape.lowest(); j <= shape.highest(); ++j) {
        for (int i = shape.lowest(); i <= shape.highest(); ++i) {
          const int n = shape.index(i, j, k);
          if (!mine[static_cast<std::size_t>(n)] || of[n].from != n) continue;
          own_.push_back({field.index, n});
          components_.push_back(field.component);
          start.insert(start.end(), sum + node_doubles * n, sum + node_doubles * (n + 1));
          const Vec3<double> x = grid().geometry().node_place(grid().brick(s).coord, {i, j, k});
          coordinates_.insert(coordinates_.end(), {x.x, x.y, x.z});
          const BrickCoord b = grid().brick(s).coord;
          lattice_.insert(lattice_.end(),
                          {brick_cells * b.x + i, brick_cells * b.y + j, brick_cells * b.z + k});
        }
      }
    }
  }
  std::vector<std::int64_t> count(static_cast<std::size_t>(ranks_.size()));
  count[static_cast<std::size_t>(ranks_.rank())] = static_cast<std::int64_t>(own_.size());
  ranks_.sum(std::span(count));
  first_ = all_ = 0;
  for (int r = 0; r < ranks_.size(); ++r) {
    if (r < ranks_.rank()) first_ += count[static_cast<std::size_t>(r)];
    all_ += count[static_cast<std::size_t>(r)];
  }
  // A double holds node numbers up to 2^53 exactly.
  send([&](std::size_t i,
           double* record) { record[0] = static_cast<double>(first_ + static_cast<std::int64_t>(i) + 1); },
       node_field::momentum);
  for (const BrickField& field : fields_.all()) {
    const double* sum = sums(field.index);
    Node* const of = nodes_.data() + field.index * per_brick();
    for (int n = 0; n < nodes(); ++n)
      of[n].number = static_cast<std::int64_t>(sum[node_doubles * of[n].from]) - 1;
  }
  held_.assign(own_.size(), 0);
  held_to_.assign(3 * own_.size(), 0.0);
  return start;
}

void NodeUnknowns::hold_walls() {
  const double* const base = buffer_.data();
  for (const BrickField& field : fields_.all()) {
    Node* const of = nodes_.data() + field.index * per_brick();
    BoundaryFaces(grid(), field.slot)
        .for_each_node(buffer_.data(), [&](int axis, int, Boundary boundary, double* at) {
          const auto bits = boundary == Boundary::fixed ? 7 : 1 << axis;
          of[(at - base) / node_doubles].held |= static_cast<std::uint8_t>(bits);
        });
  }
  for (std::size_t i = 0; i < own_.size(); ++i)
    held_[i] = of(fields_.all()[own_[i].field])[own_[i].node].held;
}

void NodeUnknowns::hold_moved(double dt) {
  const auto is_moved = [](const double* record) {
    const double all = record[node_field::volume.first];
    return all > 0 && record[node_field::moved_volume.first] >= held_share * all;
  };
  for (const BrickField& field : fields_.all()) {
    const double* sum = sums(field.index);
    Node* const of = nodes_.data() + field.index * per_brick();
    for (int n = 0; n < nodes(); ++n)
      if (is_moved(sum + node_doubles * n)) of[n].held = 7;
  }
  moved_.assign(own_.size(), 0);
  moved_volume_.assign(own_.size(), 0.0);
  for_each_own([&](std::size_t i, const double* record) {
    if (!is_moved(record)) return;
    moved_[i] = static_cast<std::uint8_t>(7 & ~held_[i]);
    moved_volume_[i] = record[node_field::moved_volume.first];
    for (int a = 0; a < 3; ++a) {
      // A wall that fixes a component goes before.
      if ((held_[i] >> a & 1) == 0)
        held_to_[3 * i + static_cast<std::size_t>(a)] =
            dt * record[a] / record[node_field::moved_volume.first];
    }
    held_[i] = 7;
  });
}

void NodeUnknowns::distribute(std::span<const double> u, AlignedDoubles& records) {
  send(
      [&](std::size_t i, double* record) {
        for (std::size_t a = 0; a < 3; ++a) record[a] = u[3 * i + a];
      },
      node_field::momentum);
  const std::size_t doubles = static_cast<std::size_t>(node_doubles) * per_brick();
  records.resize(fields_.count() * doubles);
  for_each_by_threads(0, static_cast<int>(fields_.count()), 8, [&](int f) {
    const BrickField& field = fields_.all()[static_cast<std::size_t>(f)];
    double* const record = records.data() + field.index * doubles;
    sums(field, record);
    for (int n = 0; n < nodes(); ++n) {
      double* const at = record + node_doubles * n;
      for (int a = 0; a < 3; ++a) at[4 + a] = at[a];
      at[3] = at[7] = 0;
    }
    BoundaryFaces(grid(), field.slot).fill(record);
  });
}

}  // namespace mpm::core
