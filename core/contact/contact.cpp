#include "core/contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/component_contact.hpp"
#include "core/contact/failed_component.hpp"

namespace mpm::core {

Contact::Contact(const Model& model, const RigidBodies* rigid)
    : model_(model),
      rigid_(rigid),
      method_(model.scene->contact.method),
      normal_(model.scene->contact.normal) {
  const Scene& scene = *model.scene;
  const ContactInput& input = scene.contact;
  if (input.measures_gaps()) largest_gap_ = input.min_distance * model.grid->geometry().smallest_cell();
  to_faces_ = input.distance == ContactInput::Distance::surfaces;
  limits_time_step_ = input.limits_time_step;
  pairs_ = ContactPairs(component_count(scene));

  material_.assign(scene.components.size(), -1);
  weight_.assign(scene.components.size(), -std::numeric_limits<double>::infinity());
  wave_.assign(scene.components.size(), 0.0);
  for (const Body& body : model.bodies) {
    const auto c = static_cast<std::size_t>(body.component);
    material_[c] = body.material;
    // The surface of a rigid body is exact (thesis 5-10).
    if (body.rigid) {
      weight_[c] = std::numeric_limits<double>::infinity();
      continue;
    }
    wave_[c] = std::max(wave_[c], body.model->initial_sound_speed());
    // Of several bodies the largest: given, they all have the component's.
    weight_[c] = std::max(weight_[c], normal_weight(scene, c, static_cast<std::size_t>(body.material)));
  }
  if (rigid != nullptr) {
    full_mass_.assign(scene.components.size(), 0.0);
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      if (const int number = rigid->of_body(static_cast<int>(b)); number >= 0)
        full_mass_[static_cast<std::size_t>(model.bodies[b].component)] =
            rigid->density(number) * model.grid->geometry().cell_volume();
    if (std::ranges::count_if(full_mass_, [](double m) { return m > 0; }) < 2) full_mass_.clear();
    if (!full_mass_.empty() && has_failed_component(scene)) full_mass_.push_back(0);
  }
  if (has_failed_component(scene)) {
    material_.push_back(-1);  // no friction
    weight_.push_back(failed_normal_weight);
    wave_.push_back(0);
  }
  has_failed_.resize(weight_.size());
  // Where one component decides, at the nodes at which its gradient does not tell.
  for (std::size_t a = 0; a < weight_.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      regresses_ = regresses_ || input.ignore_failed_normals || weight_[a] != weight_[b] ||
                   by_regression(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
  const std::size_t materials = model.materials.size();
  friction_.assign(materials * materials, {});
  for (std::size_t a = 0; a < materials; ++a)
    for (std::size_t b = 0; b < materials; ++b) friction_[a * materials + b] = friction_of(scene, a, b);
}

void Contact::find_fields(BrickGrid& grid, NodeHalo& halo, Reductions& ranks) {
  if (model_.scene->contact.ignore_failed_normals) find_failed(grid, ranks);
  const auto insert = [](std::vector<std::int32_t>& list, std::int32_t component) {
    const auto at = std::lower_bound(list.begin(), list.end(), component);
    if (at == list.end() || *at != component) list.insert(at, component);
  };
  grid.set_components(components_by_slot(grid, halo));

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
  meetings_.resize(static_cast<std::size_t>(grid.owned()));
}

/// What the particles of the neighbouring bricks, and of the brick itself, can reach.
AxisBox Contact::zone(Slot s, std::int32_t component) const {
  const BrickGrid& grid = *model_.grid;
  const int low = grid.shape().lowest(), high = grid.shape().highest();
  AxisBox zone;
  for (int n = 0; n < neighbourhood; ++n) {
    const Slot neighbour = grid.brick(s).neighbour[static_cast<std::size_t>(n)];
    if (neighbour == no_slot) continue;
    const auto others = [&](std::int32_t there) { return there != component; };
    if (std::ranges::none_of(grid.components(neighbour), others)) continue;
    const BrickCoord brick = grid.brick(s).coord + neighbour_offset(n);
    zone.add({grid.geometry().node_place(brick, {low, low, low}),
              grid.geometry().node_place(brick, {high, high, high})});
  }
  return zone;
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

}  // namespace mpm::core
