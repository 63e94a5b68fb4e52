// The part of the passes (passes_with.hpp) that contact needs: velocity fields by component where components
// meet, the surfaces that they map, and rigid bodies.
#pragma once

#include "core/step/passes_with.hpp"

namespace mpm::core {

/// The box of the particles that some nodes may reach: a particle is among its nodes, so that those in
/// question are no farther away than these are wide.
struct NearNodes : AxisBox {
  /// A node of a brick's block; its place.
  Vec3<double> add(const BrickGrid& grid, Slot s, int node, int nodes_per_axis) {
    const Vec3<double> x = grid.geometry().node_place(grid.brick(s).coord, grid.shape().node(node));
    AxisBox::add(AxisBox{x, x}.wider(nodes_per_axis - 1, grid.geometry().cell));
    return x;
  }
};

// --- velocity fields --------------------------------------------------------------------------------------

/// f(component) for the velocity fields of a brick's particles: every component where there is one field.
template <ShapePolicy S, TransferPolicy T>
template <class F>
[[gnu::always_inline]] inline void PassesWith<S, T>::for_each_own_field(Slot s, F f) {
  std::span<const std::int32_t> fields(&all_components, 1);
  if (contact_ && model_.grid->velocity_fields(s) > 1) fields = model_.grid->components(s);
  for (const std::int32_t component : fields) f(component);
}

/// f(component, k) for the velocity fields that a brick sees, k their number; one for all components where
/// none meet.
template <ShapePolicy S, TransferPolicy T>
template <class F>
[[gnu::always_inline]] inline void PassesWith<S, T>::for_each_seen_field(Slot s, F f) {
  if (!contact_ || !contact_->meets(s)) return f(all_components, std::size_t{0});
  for (std::size_t k = 0; k < contact_->seen(s).size(); ++k) f(contact_->seen(s)[k], k);
}

/// The component of a field of a brick with particles; in contact.
template <ShapePolicy S, TransferPolicy T>
std::int32_t PassesWith<S, T>::own_component(Slot s, std::int32_t component) const {
  return component == all_components ? model_.grid->components(s).front() : component;
}

/// The number of a field of a brick's particles among those that the brick sees.
template <ShapePolicy S, TransferPolicy T>
std::size_t PassesWith<S, T>::seen_number(Slot s, std::int32_t component) const {
  if (!contact_ || !contact_->meets(s) || model_.grid->components(s).empty()) return 0;
  const std::span<const std::int32_t> seen = contact_->seen(s);
  return static_cast<std::size_t>(std::ranges::find(seen, own_component(s, component)) - seen.begin());
}

/// For the velocity fields that a brick sees: update(component, k) brings the motion of the field number k
/// into at.nodes; where fields meet, their velocities are then resolved; f(component, k) uses at.nodes, for
/// the fields in which the brick has particles.
template <ShapePolicy S, TransferPolicy T>
template <class Update, class F>
[[gnu::always_inline]] inline void PassesWith<S, T>::for_each_field(Slot s, Scratch& at,
                                                                    Contact::Velocity which, Update update,
                                                                    F f) {
  if (!contact_ || !contact_->meets(s)) {
    update(all_components, 0);
    f(all_components, 0);
    return;
  }
  const std::span<const std::int32_t> seen = contact_->seen(s);
  const bool resolves = has_meetings(s);
  if (resolves) meet(s, at, which, update);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (model_.grid->field_of(s, seen[k]) < 0) continue;
    if (resolves)
      std::copy(at.fields[k].motion.begin(), at.fields[k].motion.end(), at.nodes.data());
    else
      update(seen[k], k);
    f(seen[k], k);
  }
  // A brick without particles still clears its contributions, which its neighbours may sum.
  if (model_.grid->components(s).empty()) f(all_components, 0);
}

/// The motion of the fields that a brick sees, into at.fields.
template <ShapePolicy S, TransferPolicy T>
template <class Update>
void PassesWith<S, T>::take_fields(Slot s, Scratch& at, Update update) {
  const std::span<const std::int32_t> seen = contact_->seen(s);
  at.fields.resize(seen.size());
  for (std::size_t k = 0; k < seen.size(); ++k) {
    at.fields[k].component = seen[k];
    update(seen[k], k);
    at.fields[k].motion.assign(at.nodes.data(), at.nodes.data() + at.nodes.size());
  }
}

/// The same at the end of the step, without contact.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_free_fields(Slot s, Scratch& at) {
  take_fields(s, at, [&](std::int32_t component, std::size_t) { sum_and_update_nodes(s, component, at); });
}

/// The fields that a brick sees at the end of the step, with contact. What contact does there is booked when
/// the particles take it.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_fields_of_end(Slot s, Scratch& at) {
  ContactSums unbooked;
  take_free_fields(s, at);
  contact_->resolve(*model_.grid, s, Contact::Velocity::of_end, at.fields, unbooked);
}

/// Resolves the velocities of the fields that a brick sees, in at.fields.
template <ShapePolicy S, TransferPolicy T>
template <class Update>
[[gnu::noinline]] void PassesWith<S, T>::meet(Slot s, Scratch& at, Contact::Velocity which, Update update) {
  take_fields(s, at, update);
  contact_->resolve(*model_.grid, s, which, at.fields, at.contact);
  if (which != Contact::Velocity::of_end) return;
  if (correcting_) return meet_corrected(s, at);
  if constexpr (Traits::solves) meet_solved(s, at);
  for (const FieldNodes& field : at.fields)
    if (model_.grid->field_of(s, field.component) >= 0 && !contact_->is_rigid(field.component))
      book_blows(s, field, at);
}

/// The kinetic energy that a field's particles get from blows (contact_impulses.cpp). The nodes' velocities c
/// by them change it by sum m_i c_i.v_i + sum m_p (sum S c)^2/2. The last term is about half of the nodes'
/// sum m_i c_i^2/2, since c ends at the surface: what is struck loses more energy than its nodes.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::book_blows(Slot s, const FieldNodes& field, Scratch& at) {
  const BrickFrame frame = this->frame(s, field.component);
  const auto blow = [&](int node) {
    const double* c = field.blow.data() + node_doubles * node + Motion::velocity_at;
    return Vec3<double>{c[0], c[1], c[2]};
  };
  NearNodes near;
  for (int n = 0; n < model_.grid->shape().nodes(); ++n)
    if (blow(n) != Vec3<double>{}) near.add(*model_.grid, s, n, S::nodes_per_axis);
  for_each_block(s, field.component, columns_to_mass,
                 [&](std::size_t, std::size_t, int, const ColumnLayout& layout, double* block, int used) {
                   const unsigned wanted = near.lanes(layout, block, used);
                   if (wanted == 0) return;
                   const Place place(frame, layout, block, used);
                   const double* mass = block + layout.offset(Column::mass);
                   for (int l = 0; l < used; ++l) {
                     if ((wanted >> l & 1u) == 0) continue;
                     Vec3<double> c{};
                     for_each_weight<S>(place, l, frame.inverse_cell,
                                        [&](int node, double weight) { c = c + weight * blow(node); });
                     at.contact.record.dissipated.add(-0.5 * mass[l] * dot(c, c));
                   }
                 });
}

/// MUSL: keeps the motion of the fields that meet a brick's own ones.
template <ShapePolicy S, TransferPolicy T>
[[gnu::noinline]] void PassesWith<S, T>::keep_motion_of_others(Slot s, const Scratch& at) {
  if (contact_->meetings(s).nodes.empty()) return;
  for (std::size_t k = 0; k < at.fields.size(); ++k) {
    if (model_.grid->field_of(s, at.fields[k].component) >= 0) continue;
    const double* of_end = moves_corrected() ? corrected_nodes(s, k) : at.fields[k].motion.data();
    keep_motion(moving_shared_.summed(), of_end, motion(s, k));
  }
}

// --- surfaces ---------------------------------------------------------------------------------------------

/// Maps m grad S (thesis 4-31) and m S of a component's particles, where they may meet others.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::map_surface(Slot s, std::int32_t component) {
  constexpr NodeFields what = mapped::surface;
  constexpr int width = record_doubles(what.array);
  BrickGrid& grid = *model_.grid;
  const BrickFrame frame = this->frame(s, component);
  double* contributions = grid.contributions(what.array, s, field_of(s, component));
  std::fill_n(contributions, width * grid.shape().nodes(), 0.0);
  if (grid.components(s).empty()) return;
  const AxisBox near =
      contact_->zone(s, own_component(s, component)).wider(S::nodes_per_axis - 1, grid.geometry().cell);
  for_each_block(
      s, component, columns_to_mass,
      [&](std::size_t, std::size_t, int, const ColumnLayout& layout, double* block, int used) {
        const unsigned wanted = near.lanes(layout, block, used);
        if (wanted == 0) return;
        const Place place(frame, layout, block, used);
        const double* mass = block + layout.offset(Column::mass);
        for (int l = 0; l < used; ++l) {
          if ((wanted >> l & 1u) == 0) continue;
          S::for_each_node(
              place, l, frame.inverse_cell, [&](int node, double shape, const Vec3<double>& gradient) {
                using Record = Lanes<width>;
                double* at = contributions + width * node;
                const Record more = typename Record::vector{gradient[0], gradient[1], gradient[2], shape};
                store(at, load<Record>(at) + Record(mass[l]) * more);
              });
        }
      });
  const BoundaryFaces walls = faces(s);
  if (S::node_block != NodeBlockShape{} && !walls.none()) walls.fold(what, contributions);
}

/// Maps how far a component's particles reach from each node along the outward normal of their field.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::map_reach(Slot s, std::int32_t component) {
  constexpr int width = record_doubles(mapped::reach.array);
  BrickGrid& grid = *model_.grid;
  const NodeBlockShape shape = grid.shape();
  const BrickFrame frame = this->frame(s, component);
  double* reach = grid.contributions(mapped::reach.array, s, field_of(s, component));
  std::fill_n(reach, width * shape.nodes(), no_reach);
  const MeetingNodes& meetings = contact_->meetings(s);
  if (meetings.nodes.empty() || grid.components(s).empty()) return;
  const std::size_t fields = contact_->seen(s).size(), field = seen_number(s, component);
  // At each node its place and the field's normal; none where the field is alone.
  struct At {
    Vec3<double> node, normal;
    bool meets = false;
  };
  std::vector<At> at(static_cast<std::size_t>(shape.nodes()));
  NearNodes near;
  for (std::size_t n = 0; n < meetings.nodes.size(); ++n) {
    const Vec3<double>& normal = meetings.outward[n * fields + field];
    if (normal == Vec3<double>{}) continue;
    const int node = meetings.nodes[n].number;
    at[static_cast<std::size_t>(node)] = {near.add(grid, s, node, S::nodes_per_axis), normal, true};
  }
  for_each_block(s, component, columns_to_mass + 1,
                 [&](std::size_t, std::size_t, int, const ColumnLayout& layout, double* block, int used) {
                   const unsigned wanted = near.lanes(layout, block, used);
                   if (wanted == 0) return;
                   const double* x = block + layout.offset(Column::position_x);
                   const Place place(frame, layout, block, used);
                   const double* volume = block + layout.offset(Column::volume);
                   for (int l = 0; l < used; ++l) {
                     if ((wanted >> l & 1u) == 0) continue;
                     const Vec3<double> centre{x[l], x[block_lanes + l], x[2 * block_lanes + l]};
                     const double half = contact_->half_edge(volume[l]);
                     for_each_weight<S>(place, l, frame.inverse_cell, [&](int node, double) {
                       const At& there = at[static_cast<std::size_t>(node)];
                       if (!there.meets) return;
                       double& farthest = reach[width * node];
                       farthest = std::max(farthest, dot(centre - there.node, there.normal) + half);
                     });
                   }
                 });
}

// --- the passes -------------------------------------------------------------------------------------------

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::map_surfaces() {
  map_bricks<mapped::surface>([this](Slot s, Scratch&) {
    if (contact_->meets(s)) for_each_own_field(s, [&](std::int32_t component) { map_surface(s, component); });
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::find_meetings() {
  contact_->collect_points(halo_);
  const auto over_bricks = [&](auto work) {
    for_bricks(0, model_.grid->owned(), [&](Slot s, Scratch& at) {
      if (contact_->meets(s)) work(s, at);
    });
  };
  over_bricks([this](Slot s, Scratch& at) {
    contact_->find_meetings(*model_.grid, shared_, s, at.fields, at.regression);
  });
  if (!contact_->shares_normals()) return;
  over_bricks([this](Slot s, Scratch&) { contact_->take_normals(s); });
  over_bricks([this](Slot s, Scratch&) { contact_->complete_meetings(s); });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::map_reach() {
  map_bricks<mapped::reach>([this](Slot s, Scratch&) {
    if (contact_->meets(s)) for_each_own_field(s, [&](std::int32_t component) { map_reach(s, component); });
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::drop_distant_pairs() {
  for_bricks(0, model_.grid->owned(), [this](Slot s, Scratch&) {
    if (contact_->meets(s)) contact_->drop_distant_pairs(*model_.grid, shared_, s);
  });
}

/// take_nodes(s, at): the fields of a brick, without the contact of this stage.
template <ShapePolicy S, TransferPolicy T>
template <class F>
void PassesWith<S, T>::find_rigid_motion(RigidStage stage, F take_nodes) {
  for (Scratch& w : scratch_) w.rigid_nodes.clear();
  for_bricks(0, model_.grid->owned(), [&](Slot s, Scratch& at) {
    if (!has_meetings(s) || !contact_->sees_free_body(s)) return;
    contact_->find_rigid_nodes(*model_.grid, s, stage, take_nodes(s, at), at.rigid_nodes);
  });
  std::vector<RigidContact> contacts;
  for (const Scratch& w : scratch_)
    for (const RigidNode& node : w.rigid_nodes)
      contacts.insert(contacts.end(), node.contacts.begin(), node.contacts.end());
  rigid_->find_motion(stage, contacts, [&](std::span<RigidResponse> responses) {
    for (const Scratch& w : scratch_)
      for (const RigidNode& node : w.rigid_nodes) contact_->respond(node, stage, responses);
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::find_rigid_motion() {
  find_rigid_motion(RigidStage::end, [this](Slot s, Scratch& at) {
    take_free_fields(s, at);
    return std::span(at.fields);
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::move_rigid_bodies() {
  std::vector<RigidImpulse> impulses(rigid_->count());
  for (Scratch& w : scratch_) {
    for (std::size_t r = 0; r < w.contact.rigid.size(); ++r) impulses[r] += w.contact.rigid[r];
    w.contact.rigid.clear();
  }
  rigid_->end_step(impulses, scratch_[0].statistics.work, scratch_[0].contact.record);
  rigid_->set_velocities();
}

}  // namespace mpm::core
