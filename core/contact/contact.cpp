#include "core/contact/contact.hpp"

#include <algorithm>
#include <optional>

#include "core/contact/node_contact.hpp"

namespace mpm::core {

Contact::Contact(const Model& model) : model_(model) {
  const Scene& scene = *model.scene;
  const std::size_t components = scene.components.size();
  for (const ComponentInput& component : scene.components) weight_.push_back(component.normal_weight);
  std::vector<int> material(components, -1);
  for (const Body& body : model.bodies) material[static_cast<std::size_t>(body.component)] = body.material;
  friction_.assign(components * components, 0.0);
  for (std::size_t a = 0; a < components; ++a) {
    for (std::size_t b = 0; b < components; ++b) {
      for (const FrictionPair& pair : scene.frictions) {
        const int first = static_cast<int>(pair.first_material),
                  second = static_cast<int>(pair.second_material);
        if ((first == material[a] && second == material[b]) ||
            (first == material[b] && second == material[a]))
          friction_[a * components + b] = pair.coefficient;
      }
    }
  }
}

void Contact::find_fields(BrickGrid& grid, NodeHalo& halo) {
  const auto insert = [](std::vector<std::int32_t>& list, std::int32_t component) {
    const auto at = std::lower_bound(list.begin(), list.end(), component);
    if (at == list.end() || *at != component) list.insert(at, component);
  };
  std::vector<std::vector<std::int32_t>> of_slot(static_cast<std::size_t>(grid.owned() + grid.ghosts()));
  for (Slot s = 0; s < grid.owned(); ++s) {
    for (const ParticleTile& tile : grid.brick(s).tiles)
      insert(of_slot[static_cast<std::size_t>(s)],
             model_.bodies[static_cast<std::size_t>(tile.body)].component);
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

void Contact::resolve(const BrickGrid& grid, const SharedNodes& shared, Slot s, Velocity which,
                      std::span<FieldNodes> fields, ContactSums& sums) const {
  const BoundaryFaces faces(grid, s);
  for (FieldNodes& field : fields) {
    faces.for_each_node(field.surface.data(), [](int axis, int, Boundary, double* at) { at[axis] = 0; });
  }
  const Brick& brick = grid.brick(s);
  std::vector<ContactField> at_node;
  std::vector<Motion> records;
  std::vector<std::size_t> field_of;
  std::vector<ContactPair> pairs;
  const auto velocity = [&](const Motion& record) {
    double* v = which == Velocity::of_end ? record.velocity() : record.strain_velocity();
    return Vec3<double>{v[0], v[1], v[2]};
  };
  shared.for_each_node([&](int node, auto shares) {
    at_node.clear(), records.clear(), field_of.clear(), pairs.clear();
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const Motion record{fields[f].motion.data() + node_doubles * node};
      if (!(record.mass() > 0)) continue;
      at_node.push_back({record.mass(), velocity(record)});
      records.push_back(record);
      field_of.push_back(f);
    }
    if (at_node.size() < 2) return;
    const auto surface = [&](std::size_t f) {
      const double* g = fields[field_of[f]].surface.data() + node_doubles * node;
      return ContactSurface{{g[0], g[1], g[2]},
                            weight_[static_cast<std::size_t>(fields[field_of[f]].component)]};
    };
    for (std::size_t a = 0; a < at_node.size(); ++a) {
      for (std::size_t b = a + 1; b < at_node.size(); ++b) {
        const double ratio = at_node[a].mass / at_node[b].mass;
        if (ratio > contact_mass_ratio || ratio * contact_mass_ratio < 1) continue;
        const std::optional<Vec3<double>> normal = contact_normal(surface(a), surface(b));
        if (!normal) continue;
        pairs.push_back({static_cast<int>(a), static_cast<int>(b), *normal,
                         friction(fields[field_of[a]].component, fields[field_of[b]].component)});
      }
    }
    if (pairs.empty()) return;
    double lost = 0;
    for (const ContactField& f : at_node) lost += 0.5 * f.mass * dot(f.velocity, f.velocity);
    resolve_contacts(at_node, pairs);
    for (const ContactField& f : at_node) lost -= 0.5 * f.mass * dot(f.velocity, f.velocity);
    for (std::size_t f = 0; f < records.size(); ++f) {
      for (int a = 0; a < 3; ++a) {
        if (which == Velocity::of_strain) {
          records[f].strain_velocity()[a] = at_node[f].velocity[a];
        } else {
          records[f].increment()[a] += at_node[f].velocity[a] - records[f].velocity()[a];
          records[f].velocity()[a] = at_node[f].velocity[a];
        }
      }
    }
    const bool counts = std::ranges::none_of(shares, [&](const SharedNodes::Share& share) {
      return share.neighbour > self_index &&
             brick.neighbour[static_cast<std::size_t>(share.neighbour)] != no_slot;
    });
    if (which != Velocity::of_end || !counts) return;
    sums.dissipated.add(lost);
    for (const ContactPair& pair : pairs) {
      if (fields[field_of[static_cast<std::size_t>(pair.first)]].component != 0 ||
          fields[field_of[static_cast<std::size_t>(pair.second)]].component != 1)
        continue;
      for (int a = 0; a < 3; ++a) sums.impulse[a].add(pair.impulse[a]);
    }
  });
  for (FieldNodes& field : fields) faces.fill(field.motion.data());
}

}  // namespace mpm::core
