#include "core/contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/failed_component.hpp"

namespace mpm::core {

namespace {

/// Automatic weight of the normals of a material (manual 3.9): the stiffer body decides.
double stiffness(const MaterialInput& material) {
  constexpr double unknown = -32767;
  if (material.strength.type == "MooneyRivlin") return std::numeric_limits<double>::infinity();
  return material.strength.value_or("Young", unknown);
}

}  // namespace

/// The fields at a node that have mass there, and their pairs that may touch.
struct Contact::Node {
  Vec3<double> place{};
  std::vector<ContactField> fields;
  std::vector<int> rigid;  ///< numbers of the rigid bodies; -1: deformable
  std::vector<Motion> records;
  std::vector<std::size_t> number;  ///< of the fields, among those that the brick sees
  std::vector<ContactPair> pairs;
  std::vector<int> recorded;  ///< numbers of the pairs in the record; -1: not recorded

  void clear() {
    fields.clear(), rigid.clear(), records.clear(), number.clear(), pairs.clear(), recorded.clear();
  }
};

Contact::Contact(const Model& model, const RigidBodies* rigid)
    : model_(model), rigid_(rigid), method_(model.scene->contact.method) {
  const Scene& scene = *model.scene;
  const ContactInput& input = scene.contact;
  if (input.measures_gaps()) largest_gap_ = input.min_distance * model.grid->geometry().smallest_cell();
  to_faces_ = input.distance == ContactInput::Distance::surfaces;
  limits_time_step_ = input.limits_time_step;
  pairs_ = ContactPairs(component_count(scene));

  material_.assign(scene.components.size(), -1);
  weight_.assign(scene.components.size(), -std::numeric_limits<double>::infinity());
  for (const Body& body : model.bodies) {
    const auto c = static_cast<std::size_t>(body.component);
    material_[c] = body.material;
    // The surface of a rigid body is exact (thesis 5-10).
    if (body.rigid) {
      weight_[c] = std::numeric_limits<double>::infinity();
      continue;
    }
    weight_[c] =
        input.automatic_weights
            ? std::max(weight_[c], stiffness(scene.materials[static_cast<std::size_t>(body.material)]))
            : scene.components[c].normal_weight;
  }
  if (has_failed_component(scene)) {
    material_.push_back(-1);  // no friction
    weight_.push_back(failed_normal_weight);
  }
  has_failed_.resize(weight_.size());
  const std::size_t materials = model.materials.size();
  friction_.assign(materials * materials, 0.0);
  for (const FrictionPair& pair : scene.frictions) {
    friction_[pair.first_material * materials + pair.second_material] = pair.coefficient;
    friction_[pair.second_material * materials + pair.first_material] = pair.coefficient;
  }
}

void Contact::find_fields(BrickGrid& grid, NodeHalo& halo, Reductions& ranks) {
  if (model_.scene->contact.ignore_failed_normals) find_failed(grid, ranks);
  const auto insert = [](std::vector<std::int32_t>& list, std::int32_t component) {
    const auto at = std::lower_bound(list.begin(), list.end(), component);
    if (at == list.end() || *at != component) list.insert(at, component);
  };
  std::vector<std::vector<std::int32_t>> of_slot(static_cast<std::size_t>(grid.owned() + grid.ghosts()));
  for (Slot s = 0; s < grid.owned(); ++s) {
    for (const ParticleTile& tile : grid.brick(s).tiles)
      insert(of_slot[static_cast<std::size_t>(s)], tile.component);
  }
  halo.exchange_components(grid, of_slot);
  grid.set_components(of_slot);

  seen_begin_.assign(1, 0);
  seen_.clear();
  std::vector<std::int32_t> seen;
  for (Slot s = 0; s < grid.owned(); ++s) {
    seen.clear();
    for (const Slot neighbour : grid.brick(s).neighbour) {
      if (neighbour == no_slot) continue;
      for (const std::int32_t component : grid.components(neighbour)) insert(seen, component);
    }
    if (seen.empty()) seen.push_back(0);  // a brick without particles near it: one field, at rest
    seen_.insert(seen_.end(), seen.begin(), seen.end());
    seen_begin_.push_back(seen_.size());
  }
}

/// Components with failed particles anywhere (manual 3.9, normal_vector_excluding_failure_particle).
void Contact::find_failed(const BrickGrid& grid, Reductions& ranks) {
  std::vector<std::int64_t> failed(has_failed_.size());
  for (Slot s = 0; s < grid.owned(); ++s) {
    for (const ParticleTile& tile : grid.brick(s).tiles) {
      std::int64_t& count = failed[static_cast<std::size_t>(tile.component)];
      const BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
      if (count > 0 || !pool.layout().has(Column::failed)) continue;
      for (std::size_t b = 0; b < tile.blocks.size() && count == 0; ++b) {
        const double* column = pool.block(tile.blocks[b]) + pool.layout().offset(Column::failed);
        if (std::any_of(column, column + tile.used_lanes(b), [](double f) { return f != 0; })) count = 1;
      }
    }
  }
  ranks.sum(std::span<std::int64_t>(failed));
  for (std::size_t c = 0; c < failed.size(); ++c) has_failed_[c] = failed[c] > 0;
}

// --- surfaces ---------------------------------------------------------------------------------------------

double Contact::half_edge(double volume) const { return to_faces_ ? 0.5 * std::cbrt(volume) : 0.0; }

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

void Contact::take_reach(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                         std::vector<FieldNodes>& fields) const {
  const Brick& brick = grid.brick(s);
  constexpr int width = record_doubles(mapped::reach.array);
  for (FieldNodes& field : fields) {
    field.reach.assign(static_cast<std::size_t>(shared.nodes()), no_reach);
    const double* of_brick[neighbourhood] = {};
    for (int n = 0; n < neighbourhood; ++n) {
      const Slot neighbour = brick.neighbour[static_cast<std::size_t>(n)];
      if (neighbour == no_slot) continue;
      const int number = grid.field_of(neighbour, field.component);
      if (number >= 0) of_brick[n] = grid.contributions(mapped::reach.array, neighbour, number);
    }
    shared.for_each_node([&](int node, auto shares) {
      double& farthest = field.reach[static_cast<std::size_t>(node)];
      for (const SharedNodes::Share& share : shares) {
        if (const double* at = of_brick[share.neighbour])
          farthest = std::max(farthest, at[width * share.node]);
      }
    });
  }
}

ContactSurface Contact::surface(const FieldNodes& field, int node) const {
  const double* g = field.surface.data() + node_doubles * node;
  const auto c = static_cast<std::size_t>(field.component);
  return {{g[0], g[1], g[2]}, weight_[c], has_failed_[c]};
}

std::optional<Vec3<double>> Contact::outward(std::span<const FieldNodes> fields, std::size_t field,
                                             int node) const {
  const ContactSurface mine = surface(fields[field], node);
  if (mine.mass_gradient == Vec3<double>{}) return std::nullopt;
  std::optional<std::size_t> other;
  int others = 0;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (k == field || surface(fields[k], node).mass_gradient == Vec3<double>{}) continue;
    other = k;
    ++others;
  }
  if (others == 0) return std::nullopt;
  if (others > 1) return contact_normal(mine, {});
  // The normal of a pair does not depend on which is the first, but for its sign.
  if (field < *other) return contact_normal(mine, surface(fields[*other], node));
  const auto normal = contact_normal(surface(fields[*other], node), mine);
  if (!normal) return normal;
  return -1.0 * *normal;
}

// --- impulses ---------------------------------------------------------------------------------------------

double Contact::friction(std::int32_t a, std::int32_t b) const {
  const int first = material_[static_cast<std::size_t>(a)], second = material_[static_cast<std::size_t>(b)];
  if (first < 0 || second < 0) return 0;
  return friction_[static_cast<std::size_t>(first) * model_.materials.size() +
                   static_cast<std::size_t>(second)];
}

bool Contact::find_pairs(std::span<const FieldNodes> fields, int node, Node& at) const {
  for (std::size_t a = 0; a < at.fields.size(); ++a) {
    for (std::size_t b = a + 1; b < at.fields.size(); ++b) {
      const bool any_rigid = at.rigid[a] >= 0 || at.rigid[b] >= 0;
      const double ratio = at.fields[a].mass / at.fields[b].mass;
      if (!any_rigid && (ratio > contact_mass_ratio || ratio * contact_mass_ratio < 1)) continue;
      if (std::isinf(at.fields[a].mass) && std::isinf(at.fields[b].mass)) continue;  // both are driven
      const FieldNodes &first = fields[at.number[a]], &second = fields[at.number[b]];
      if (largest_gap_) {
        const auto n = static_cast<std::size_t>(node);
        if (!(-(first.reach[n] + second.reach[n]) <= *largest_gap_)) continue;
      }
      const std::optional<Vec3<double>> normal = contact_normal(surface(first, node), surface(second, node));
      if (!normal) continue;
      at.pairs.push_back(
          {static_cast<int>(a), static_cast<int>(b), *normal, friction(first.component, second.component)});
      at.recorded.push_back(pairs_.number(first.component, second.component));
    }
  }
  return !at.pairs.empty();
}

/// An impulse of this step has done its work where the end of the step finds two fields at rest against each
/// other. The strain must then not part them: that would be work without a source.
void Contact::hold_pairs(Node& at) const {
  constexpr double round_off = 1e-10;
  const auto of_end = [&](std::size_t f) {
    const double* v = at.records[f].velocity();
    return at.rigid[f] < 0 ? Vec3<double>{v[0], v[1], v[2]} : at.fields[f].velocity;
  };
  for (ContactPair& pair : at.pairs) {
    const Vec3<double> a = of_end(static_cast<std::size_t>(pair.first)),
                       b = of_end(static_cast<std::size_t>(pair.second)), relative = a - b;
    const double most = round_off * std::sqrt(std::max(dot(a, a), dot(b, b)));
    if (!(std::abs(dot(relative, pair.normal)) <= most)) continue;
    const bool sticks = std::sqrt(dot(relative, relative)) <= most;
    pair.holds = sticks ? ContactPair::Holds::all : ContactPair::Holds::normal;
  }
}

/// Velocities at the end of the step, and what the particles get.
void Contact::resolve_end(Node& at, ContactSums& sums, bool counts) const {
  const std::size_t count = at.fields.size();
  const auto increment = [&](std::size_t f) {
    const double* d = at.records[f].increment();
    return at.rigid[f] < 0 ? Vec3<double>{d[0], d[1], d[2]} : Vec3<double>{};
  };
  const bool corrects_start = method_ != ContactInput::Method::bardenhagen;
  std::vector<Vec3<double>> taken(count);  // velocity before the impulses that the particles get
  std::vector<Vec3<double>> start(count);  // velocity at the start of the step, as the particles have it
  for (std::size_t f = 0; f < count; ++f)
    taken[f] = at.fields[f].velocity, start[f] = taken[f] - increment(f);
  std::vector<Vec3<double>> nodal_start = start;  // with Pan's first impulses
  std::vector<Vec3<double>> first_impulse(at.pairs.size());
  if (corrects_start) {
    for (std::size_t f = 0; f < count; ++f) at.fields[f].velocity = start[f];
    resolve_contacts(at.fields, at.pairs);
    for (std::size_t f = 0; f < count; ++f) nodal_start[f] = at.fields[f].velocity;
    for (std::size_t p = 0; p < at.pairs.size(); ++p) first_impulse[p] = at.pairs[p].impulse;
    for (std::size_t f = 0; f < count; ++f) at.fields[f].velocity = at.fields[f].velocity + increment(f);
    if (method_ == ContactInput::Method::pan)
      for (std::size_t f = 0; f < count; ++f) taken[f] = at.fields[f].velocity;
  }
  for (const ContactPair& pair : at.pairs) {
    const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
    sums.fastest = std::max(sums.fastest, dot(taken[a] - taken[b], pair.normal));
  }
  resolve_contacts(at.fields, at.pairs);
  for (std::size_t f = 0; f < count; ++f) {
    if (at.rigid[f] >= 0) continue;
    for (int a = 0; a < 3; ++a) {
      at.records[f].increment()[a] += at.fields[f].velocity[a] - taken[f][a];
      at.records[f].velocity()[a] = at.fields[f].velocity[a];
    }
  }
  if (!counts) return;
  const auto given = [&](std::size_t f) {
    return at.rigid[f] < 0 ? increment(f) : at.fields[f].velocity - taken[f];
  };
  for (std::size_t p = 0; p < at.pairs.size(); ++p) {
    const ContactPair& pair = at.pairs[p];
    const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
    const Vec3<double> impulse = method_ == ContactInput::Method::improved_bardenhagen
                                     ? pair.impulse + first_impulse[p]
                                     : pair.impulse;
    // Of the kinetic energy that a step changes, an impulse P takes P.(u + u')/2, where the relative velocity
    // of the fields is u at its start and u' with all increments that the particles get.
    const Vec3<double> half = 0.5 * (given(a) - given(b)), mean = start[a] - start[b] + half;
    // Pan's first impulses stop the approach of the nodes without stopping that of the particles, and the
    // strain follows the nodes: their approach counts.
    const Vec3<double> approach =
        method_ == ContactInput::Method::pan ? nodal_start[a] - nodal_start[b] + half : mean;
    const double pressing = dot(impulse, pair.normal);
    const double heat = dot(impulse, mean) - pressing * dot(mean, pair.normal);
    sums.record.dissipated.add(pressing * dot(approach, pair.normal) + heat);
    sums.record.friction_heat.add(heat);
    if (at.recorded[p] >= 0) sums.record.add_impulse(at.recorded[p], impulse);
    const auto on = [&](std::size_t f, const Vec3<double>& on_it) {
      if (at.rigid[f] < 0 || on_it == Vec3<double>{}) return;
      const double work = 0.5 * dot(on_it, taken[f] + at.fields[f].velocity);
      sums.rigid[static_cast<std::size_t>(at.rigid[f])].add(
          on_it, at.place - rigid_->state(at.rigid[f]).centre, work);
    };
    on(a, -1.0 * impulse);
    on(b, impulse);
  }
}

void Contact::resolve(const BrickGrid& grid, const SharedNodes& shared, Slot s, Velocity which,
                      std::span<FieldNodes> fields, ContactSums& sums) const {
  const BoundaryFaces faces(grid, s);
  const Brick& brick = grid.brick(s);
  sums.record.impulses.resize(3 * pairs_.size());
  if (rigid_ != nullptr) sums.rigid.resize(rigid_->count());
  Node at;
  const NodeBlockShape shape = grid.shape();
  const auto place = [&](int node) {
    const int side = shape.side(), low = shape.lowest();
    return grid.geometry().node_place(brick.coord, node % side + low, node / side % side + low,
                                      node / (side * side) + low);
  };
  shared.for_each_node([&](int node, auto shares) {
    at.clear();
    at.place = place(node);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const Motion record{fields[f].motion.data() + node_doubles * node};
      if (!(record.mass() > 0)) continue;
      const double* v = which == Velocity::of_end ? record.velocity() : record.strain_velocity();
      const int number = rigid(fields[f].component);
      at.rigid.push_back(number);
      if (number >= 0)
        at.fields.push_back({rigid_->mass_at_node(number), velocity_at(rigid_->state(number), at.place)});
      else
        at.fields.push_back({record.mass(), {v[0], v[1], v[2]}});
      at.records.push_back(record);
      at.number.push_back(f);
    }
    if (at.fields.size() < 2 || !find_pairs(fields, node, at)) return;
    if (which != Velocity::of_end) {
      if (which == Velocity::of_strain_after_end) hold_pairs(at);
      resolve_contacts(at.fields, at.pairs);
      for (std::size_t f = 0; f < at.records.size(); ++f)
        for (int a = 0; at.rigid[f] < 0 && a < 3; ++a)
          at.records[f].strain_velocity()[a] = at.fields[f].velocity[a];
      return;
    }
    const bool counts = std::ranges::none_of(shares, [&](const SharedNodes::Share& share) {
      return share.neighbour > self_index &&
             brick.neighbour[static_cast<std::size_t>(share.neighbour)] != no_slot;
    });
    resolve_end(at, sums, counts);
  });
  for (FieldNodes& field : fields) faces.fill(field.motion.data());
}

}  // namespace mpm::core
