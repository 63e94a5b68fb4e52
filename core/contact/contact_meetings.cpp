// Where the fields of a brick meet, and the normals and gaps of their pairs there.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "core/contact/contact.hpp"
#include "core/contact/widest_gap.hpp"

namespace mpm::core {

namespace {

/// The unit normal of a plane from its unit normal where lengths count in cells.
Vec3<double> in_space(const Vec3<double>& n, const Vec3<double>& inverse_cell) {
  if (inverse_cell.x == inverse_cell.y && inverse_cell.x == inverse_cell.z) return n;
  const Vec3<double> g{n.x * inverse_cell.x, n.y * inverse_cell.y, n.z * inverse_cell.z};
  return (1 / std::sqrt(dot(g, g))) * g;
}

/// Whether one of two surfaces gives the normal and has none here, as in the middle of a thin plate. That of
/// the other one would tilt at its edges.
bool leaves_open(const ContactSurface& first, const ContactSurface& second) {
  const ContactSurface* s = deciding(first, second);
  return s != nullptr && !has_direction(*s, uneven_slope);
}

}  // namespace

double Contact::half_edge(double volume) const { return to_faces_ ? 0.5 * std::cbrt(volume) : 0.0; }

void Contact::collect_points(NodeHalo& halo) {
  if (!regresses_) return;
  points_.collect(
      model_, halo, [this](Slot s) { return meets(s); },
      [this](Slot s, std::int32_t component) {
        return zone(s, component).wider(PointsByCell::layers, model_.grid->geometry().cell);
      });
}

/// Sums the surfaces of the fields that a brick sees, their motion aside; they are taken as perpendicular to
/// constrained faces.
void Contact::take_surfaces(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                            std::vector<FieldNodes>& fields) const {
  const BoundaryFaces faces(grid, s);
  const std::span<const std::int32_t> components = seen(s);
  fields.resize(components.size());
  for (std::size_t k = 0; k < components.size(); ++k) {
    FieldNodes& field = fields[k];
    field.component = components[k];
    field.surface.resize(static_cast<std::size_t>(node_doubles * shared.nodes()));
    sum_contributions<NodeArray::fourth>(grid, shared, s, field.component, field.surface.data());
    faces.for_each_node(field.surface.data(), [](int axis, int, Boundary, double* at) { at[axis] = 0; });
  }
}

ContactSurface Contact::surface(const FieldNodes& field, int node) const {
  const double* g = field.surface.data() + node_doubles * node;
  const auto c = static_cast<std::size_t>(field.component);
  const Vec3<double> gradient{g[0], g[1], g[2]};
  return {gradient, weight_[c], has_failed_[c],
          slope_of(gradient, g[node_field::surface_mass.first], model_.grid->geometry().cell)};
}

/// A free rigid body and one of prescribed motion.
bool Contact::are_rigid_and_meet(std::int32_t a, std::int32_t b) const {
  return rigid(a) >= 0 && rigid(b) >= 0 && rigid_->is_free(rigid(a)) != rigid_->is_free(rigid(b));
}

/// Whether the particles of two components give their normal wherever they meet: always those of two rigid
/// bodies. The gradient of a rigid body tilts at its edges as any other's: it decides where it has been given
/// the larger weight, and where gaps are not measured. Contact then acts at nodes up to two cells away, and
/// upright normals beyond an edge would make the body wider.
bool Contact::by_regression(std::int32_t a, std::int32_t b) const {
  if (are_rigid_and_meet(a, b)) return true;
  if (normal_ != ContactInput::Normal::automatic) return normal_ == ContactInput::Normal::regression;
  const auto first = static_cast<std::size_t>(a), second = static_cast<std::size_t>(b);
  if (has_failed_[first] != has_failed_[second]) return false;
  const bool rigid_first = rigid(a) >= 0, rigid_second = rigid(b) >= 0;
  if (!rigid_first && !rigid_second) return weight_[first] == weight_[second];
  if (rigid_first && rigid_second) return true;
  if (!largest_gap_) return false;
  if (model_.scene->contact.automatic_weights) return false;
  const double given = model_.scene->components[rigid_first ? first : second].normal_weight;
  return given <= weight_[rigid_first ? second : first];
}

void Contact::find_meetings(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                            std::vector<FieldNodes>& fields, RegressionScratch& scratch) {
  take_surfaces(grid, shared, s, fields);
  find_nodes(grid, shared, s, fields);
  find_normals(grid, s, fields, scratch);
  if (!regresses_) complete(s, fields);
}

/// Drops the pairs without a normal, and finds the outward ones.
void Contact::complete(Slot s, std::span<const FieldNodes> fields) {
  MeetingNodes& at = meetings_[static_cast<std::size_t>(s)];
  at.filter([](std::size_t, const MeetingNodes::Pair& pair) { return pair.normal != Vec3<double>{}; });
  if (!measures_gaps()) return;
  const int count = static_cast<int>(seen(s).size());
  for (const MeetingNodes::Node& node : at.nodes) {
    for (int f = 0; f < count; ++f)
      at.outward.push_back(regresses_ ? outward(f, at.pairs_of(node))
                                      : outward(fields, f, node.number, at.pairs_of(node)));
  }
}

/// The nodes at which several fields have mass, with these fields' pairs.
void Contact::find_nodes(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                         std::span<const FieldNodes> fields) {
  const Brick& brick = grid.brick(s);
  MeetingNodes& at = meetings_[static_cast<std::size_t>(s)];
  at.clear();
  std::vector<int> present;
  shared.for_each_node([&](int node, auto shares) {
    present.clear();
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (fields[f].surface[static_cast<std::size_t>(node_doubles * node + node_field::surface_mass.first)] >
          0)
        present.push_back(static_cast<int>(f));
    }
    if (present.size() < 2) return;
    const bool counts = std::ranges::none_of(shares, [&](const SharedNodes::Share& share) {
      return share.neighbour > self_index &&
             brick.neighbour[static_cast<std::size_t>(share.neighbour)] != no_slot;
    });
    if (counts && !full_mass_.empty()) find_overlap(grid, s, node, fields, present);
    const std::size_t first = at.pairs.size();
    for (std::size_t a = 0; a < present.size(); ++a)
      for (std::size_t b = a + 1; b < present.size(); ++b) at.pairs.push_back({present[a], present[b], {}});
    const auto finder = std::ranges::find_if(shares, [&](const SharedNodes::Share& share) {
      const Slot there = brick.neighbour[static_cast<std::size_t>(share.neighbour)];
      return there != no_slot && there < grid.owned();
    });
    at.nodes.push_back({node, counts, brick.neighbour[static_cast<std::size_t>(finder->neighbour)],
                        finder->node, first, at.pairs.size()});
  });
}

std::int64_t Contact::number_in_grid(const BrickGrid& grid, Slot s, const std::array<int, 3>& in_brick) {
  const BrickCoord brick = grid.brick(s).coord;
  const std::int64_t number[3] = {brick_cells * std::int64_t{brick.x} + in_brick[0],
                                  brick_cells * std::int64_t{brick.y} + in_brick[1],
                                  brick_cells * std::int64_t{brick.z} + in_brick[2]};
  const auto& cells = grid.geometry().cells;
  return (number[2] * (cells[1] + 1) + number[1]) * (cells[0] + 1) + number[0];
}

/// Contact does not part two driven rigid bodies, nor two free ones. Those that touch fill a node's cell
/// together, whatever surface they share, but for the particles' steps in it; those that have entered each
/// other fill it more than once.
void Contact::find_overlap(const BrickGrid& grid, Slot s, int node, std::span<const FieldNodes> fields,
                           std::span<const int> present) {
  constexpr double least = 0.3;  // of a cell
  const std::array<int, 3> in_brick = grid.shape().node(node);
  const BrickCoord coord = grid.brick(s).coord;
  const Vec3<double> place = grid.geometry().node_place(coord, in_brick);
  double cell = 1;  // the part of a cell around the node that is inside the grid: half of it at a face
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t brick[3] = {coord.x, coord.y, coord.z};
    const std::int64_t i = brick_cells * brick[a] + in_brick[a];
    if (i == 0 || i == grid.geometry().cells[a]) cell *= 0.5;
  }
  const auto filled = [&](int f) {
    const FieldNodes& field = fields[static_cast<std::size_t>(f)];
    const double
        full = full_mass_[static_cast<std::size_t>(field.component)],
        mass = field.surface[static_cast<std::size_t>(node_doubles * node + node_field::surface_mass.first)];
    return full > 0 ? mass / (cell * full) : 0.0;
  };
  const auto velocity = [&](int f) {
    return velocity_at(rigid_->state(rigid(fields[static_cast<std::size_t>(f)].component)), place);
  };
  for (std::size_t a = 0; a < present.size(); ++a) {
    for (std::size_t b = a + 1; b < present.size(); ++b) {
      const int of_first = rigid(fields[static_cast<std::size_t>(present[a])].component),
                of_second = rigid(fields[static_cast<std::size_t>(present[b])].component);
      if (of_first < 0 || of_second < 0 || rigid_->is_free(of_first) != rigid_->is_free(of_second)) continue;
      const double first = filled(present[a]), second = filled(present[b]);
      if (first + second - 1 < least || std::min(first, second) < least) continue;
      if (velocity(present[a]) == velocity(present[b])) continue;  // they have been placed so
      const auto name = [&](std::size_t k) {
        const std::int32_t component = fields[static_cast<std::size_t>(present[k])].component;
        return std::ranges::find(model_.bodies, component, &Body::component)->name;
      };
      const auto order = static_cast<double>(number_in_grid(grid, s, in_brick));
      meetings_[static_cast<std::size_t>(s)].overlap.offer(order, [&] {
        return fmt::format(
            "the rigid bodies '{}' and '{}', both {}, have met and overlap near ({:.6g}, {:.6g}, {:.6g}): "
            "contact acts on a free one and a driven one, or a deformable one. {}",
            name(a), name(b), rigid_->is_free(of_first) ? "moving freely" : "of prescribed motion", place.x,
            place.y, place.z,
            rigid_->is_free(of_first) ? "Give one of them a prescribed motion or a deformable material"
                                      : "Stop one of them before, or let it move freely");
      });
    }
  }
}

OffendingParticle Contact::first_overlap() const {
  OffendingParticle first;
  if (full_mass_.empty()) return first;
  for (const MeetingNodes& at : meetings_)
    if (!at.overlap.empty()) first.offer(at.overlap.identity, [&] { return at.overlap.words; });
  return first;
}

/// Keeps the pairs for which `keep(number in the list of their node, pair)`, and the nodes that have some.
template <class F>
void MeetingNodes::filter(F keep) {
  std::size_t kept_pairs = 0, kept_nodes = 0;
  const std::size_t fields = nodes.empty() ? 0 : outward.size() / nodes.size();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Node node = nodes[n];
    const std::size_t first = kept_pairs;
    for (std::size_t p = node.first_pair; p < node.last_pair; ++p)
      if (keep(n, pairs[p])) pairs[kept_pairs++] = pairs[p];
    if (kept_pairs == first) continue;
    node.first_pair = first, node.last_pair = kept_pairs;
    std::copy_n(outward.begin() + static_cast<std::ptrdiff_t>(fields * n), fields,
                outward.begin() + static_cast<std::ptrdiff_t>(fields * kept_nodes));
    nodes[kept_nodes++] = node;
  }
  nodes.resize(kept_nodes), pairs.resize(kept_pairs), outward.resize(fields * kept_nodes);
}

void Contact::find_normals(const BrickGrid& grid, Slot s, std::span<const FieldNodes> fields,
                           RegressionScratch& scratch) {
  MeetingNodes& at = meetings_[static_cast<std::size_t>(s)];
  const NodeBlockShape shape = grid.shape();
  const auto field = [&](int f) -> const FieldNodes& { return fields[static_cast<std::size_t>(f)]; };
  const auto asks_particles = [&](const MeetingNodes::Node& node, const MeetingNodes::Pair& pair) {
    const FieldNodes &first = field(pair.first), &second = field(pair.second);
    return by_regression(first.component, second.component) ||
           leaves_open(surface(first, node.number), surface(second, node.number));
  };
  if (regresses_) {
    PointsByCell::Range range;
    std::ranges::fill(range.lowest, shape.highest()), std::ranges::fill(range.highest, shape.lowest());
    for (const MeetingNodes::Node& node : at.nodes) {
      const auto asks = [&](const MeetingNodes::Pair& pair) { return asks_particles(node, pair); };
      if (node.finder != s || std::ranges::none_of(at.pairs_of(node), asks)) continue;
      for (std::size_t a = 0; a < 3; ++a) {
        range.lowest[a] = std::min(range.lowest[a], shape.node(node.number)[a]);
        range.highest[a] = std::max(range.highest[a], shape.node(node.number)[a]);
      }
    }
    if (range.lowest[0] <= range.highest[0]) scratch.by_cell.take(grid, points_, s, range);
  }
  for (const MeetingNodes::Node& node : at.nodes) {
    if (regresses_ && node.finder != s) continue;
    for (std::size_t p = node.first_pair; p < node.last_pair; ++p) {
      MeetingNodes::Pair& pair = at.pairs[p];
      const FieldNodes &first = field(pair.first), &second = field(pair.second);
      std::optional<Vec3<double>> normal;
      if (asks_particles(node, pair)) {
        scratch.by_cell.around(grid, s, shape.node(node.number), first.component, second.component,
                               scratch.points);
        if (are_rigid_and_meet(first.component, second.component)) normal = widest_gap_normal(scratch.points);
        if (!normal) normal = separating_normal(scratch.points, scratch.near);
        if (normal) normal = in_space(*normal, grid.geometry().inverse_cell);
      }
      if (!normal) normal = contact_normal(surface(first, node.number), surface(second, node.number));
      pair.normal = normal.value_or(Vec3<double>{});
    }
  }
}

void Contact::take_normals(Slot s) {
  MeetingNodes& mine = meetings_[static_cast<std::size_t>(s)];
  for (const MeetingNodes::Node& node : mine.nodes) {
    if (node.finder == s) continue;
    const MeetingNodes& theirs = meetings(node.finder);
    const auto there = std::ranges::find(theirs.nodes, node.number_there, &MeetingNodes::Node::number);
    if (there == theirs.nodes.end()) throw std::logic_error("a copy of a node does not see who meets there");
    // Both lists have the pairs of the same components in the same order.
    for (std::size_t p = 0; p < node.last_pair - node.first_pair; ++p)
      mine.pairs[node.first_pair + p].normal = theirs.pairs[there->first_pair + p].normal;
  }
}

/// With regression: of the pair that the field is in, or the mean of its pairs; zero without.
Vec3<double> Contact::outward(int field, std::span<const MeetingNodes::Pair> pairs) {
  Vec3<double> sum{};
  int count = 0;
  for (const MeetingNodes::Pair& pair : pairs) {
    if (pair.first != field && pair.second != field) continue;
    sum = pair.first == field ? sum + pair.normal : sum - pair.normal;
    ++count;
  }
  if (count < 2) return sum;
  const double length = std::sqrt(dot(sum, sum));
  return length >= least_slope ? (1 / length) * sum : Vec3<double>{};
}

/// By gradients alone: of two fields that of the pair, of more its own. Zero where it has no surface.
Vec3<double> Contact::outward(std::span<const FieldNodes> fields, int field, int node,
                              std::span<const MeetingNodes::Pair> pairs) const {
  const auto of = [&](int f) { return surface(fields[static_cast<std::size_t>(f)], node); };
  const ContactSurface mine = of(field);
  const auto is_here = [](const ContactSurface& s) {
    return s.mass_gradient != Vec3<double>{} || std::isfinite(s.slope);
  };
  if (!is_here(mine)) return {};
  int other = -1, others = 0;
  for (int k = 0; k < static_cast<int>(fields.size()); ++k) {
    if (k == field || !is_here(of(k))) continue;
    other = k;
    ++others;
  }
  if (others == 0) return {};
  if (others > 1) return contact_normal(mine, {}).value_or(Vec3<double>{});
  for (const MeetingNodes::Pair& pair : pairs) {
    if (pair.first == field && pair.second == other) return pair.normal;
    if (pair.first == other && pair.second == field) return -1.0 * pair.normal;
  }
  // The other one has a slope here, but no mass.
  const auto normal = field < other ? contact_normal(mine, of(other)) : contact_normal(of(other), mine);
  return normal ? (field < other ? 1.0 : -1.0) * *normal : Vec3<double>{};
}

void Contact::drop_distant_pairs(const BrickGrid& grid, const SharedNodes& shared, Slot s) {
  MeetingNodes& at = meetings_[static_cast<std::size_t>(s)];
  if (at.nodes.empty()) return;
  constexpr int width = record_doubles(mapped::reach.array);
  const std::span<const std::int32_t> components = seen(s);
  // By field: the contributions of the neighbourhood.
  std::vector<std::array<const double*, neighbourhood>> of_brick(components.size());
  for (std::size_t f = 0; f < components.size(); ++f) {
    for (std::size_t n = 0; n < neighbourhood; ++n) {
      const Slot neighbour = grid.brick(s).neighbour[n];
      const int number = neighbour == no_slot ? -1 : grid.field_of(neighbour, components[f]);
      of_brick[f][n] = number < 0 ? nullptr : grid.contributions(mapped::reach.array, neighbour, number);
    }
  }
  // By meeting node, then field.
  std::vector<double> reach;
  reach.reserve(at.nodes.size() * components.size());
  shared.for_each_node([&](int node, auto shares) {
    const std::size_t listed = reach.size() / components.size();
    if (listed == at.nodes.size() || at.nodes[listed].number != node) return;
    for (const auto& bricks : of_brick) {
      double farthest = no_reach;
      for (const SharedNodes::Share& share : shares) {
        if (const double* there = bricks[static_cast<std::size_t>(share.neighbour)])
          farthest = std::max(farthest, there[width * share.node]);
      }
      reach.push_back(farthest);
    }
  });
  // A rigid body stops all of another one's motion at a node. Nodes farther above its surface than a linear
  // shape function reaches from its particles are left to the other body: wide shape functions would hold a
  // layer of it that cannot be strained. Gradients of mass need those: behind the middle of a thin plate they
  // point to its other side.
  constexpr double highest_held = 0.7;  // in cells
  const double lowest_reach = -highest_held * grid.geometry().smallest_cell();
  const auto held = [&](int field, const double* of_node) {
    return rigid(components[static_cast<std::size_t>(field)]) < 0 || of_node[field] >= lowest_reach;
  };
  // Material that sticks to the nodes which a body holds yields in the next layer of cells, on average half a
  // cell above the highest of them. So the friction of a rough surface acts at the nodes inside the body
  // alone, the highest of which are on average half a cell below it. It has no bound there, so that nothing
  // is missing where the nodes above have none.
  constexpr double round_off = 1e-9;
  const auto above_rough = [&](const MeetingNodes::Pair& pair, const double* of_node) {
    const std::int32_t first = components[static_cast<std::size_t>(pair.first)],
                       second = components[static_cast<std::size_t>(pair.second)];
    const bool is_first = rigid(first) >= 0;
    return to_faces_ && friction(first, second).rough && is_first != (rigid(second) >= 0) &&
           of_node[is_first ? pair.first : pair.second] < -round_off * grid.geometry().smallest_cell();
  };
  const auto reach_at = [&](std::size_t n) { return reach.data() + n * components.size(); };
  for (std::size_t n = 0; n < at.nodes.size(); ++n)
    for (std::size_t p = at.nodes[n].first_pair; p < at.nodes[n].last_pair; ++p)
      at.pairs[p].shears = above_rough(at.pairs[p], reach_at(n));
  at.filter([&](std::size_t n, const MeetingNodes::Pair& pair) {
    const double* of_node = reach_at(n);
    const bool holds = held(pair.first, of_node) && held(pair.second, of_node);
    if (!holds && by_regression(components[static_cast<std::size_t>(pair.first)],
                                components[static_cast<std::size_t>(pair.second)]))
      return false;
    return -(of_node[pair.first] + of_node[pair.second]) <= *largest_gap_;
  });
}

}  // namespace mpm::core
