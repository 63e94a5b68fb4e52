#include "core/contact/rigid_bodies.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/particle_range.hpp"
#include "core/step/stepper.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

/// Whether others have no influence on the rigid body with this number.
bool is_driven(const Model& model, std::size_t body) {
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  return model.bodies[body].prescribed_velocity ||
         (body < inputs.size() && inputs[body]->constrain_rigid_position);
}

}  // namespace

void RigidImpulse::add(const Vec3<double>& p, const Vec3<double>& arm, double given) {
  const Vec3<double> h = cross(arm, p);
  for (int a = 0; a < 3; ++a) {
    impulse[a].add(p[a]);
    moment[a].add(h[a]);
  }
  energy.add(given);
}

RigidImpulse& RigidImpulse::operator+=(const RigidImpulse& other) {
  for (int a = 0; a < 3; ++a) {
    impulse[a] += other.impulse[a];
    moment[a] += other.moment[a];
  }
  energy += other.energy;
  contacts += other.contacts;
  return *this;
}

RigidBodies::RigidBodies(Model& model, Reductions& ranks) : model_(model), ranks_(ranks) {
  by_component_.assign(component_count(*model.scene), -1);
  by_body_.assign(model.bodies.size(), -1);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (!body.rigid) continue;
    const int number = static_cast<int>(bodies_.size());
    by_component_[static_cast<std::size_t>(body.component)] = by_body_[b] = number;
    bodies_.push_back({.body = static_cast<int>(b), .driven = is_driven(model, b)});
  }
  for (Reaction& reaction : model.reactions)
    if (reaction.by_contact)
      bodies_[static_cast<std::size_t>(of_body(reaction.body))].reaction = &reaction.since_start;
  node_mass_.resize(bodies_.size());
  find_states(ranks);
  find_densities(ranks);
}

void RigidBodies::find_states(Reductions& ranks) {
  const bool known = std::ranges::all_of(bodies_, [&](const Rigid& r) {
    return model_.bodies[static_cast<std::size_t>(r.body)].rigid_state.has_value();
  });
  if (known) return;  // all of them: the sums are collective
  // First mass, centre and momentum, then inertia and angular momentum about the centre.
  constexpr std::size_t first_sums = 7, second_sums = 9;
  std::vector<ExactSum> sums(first_sums * bodies_.size());
  const auto over_particles = [&](auto f) {
    for (const ConstParticleBlock& block : blocks_of(std::as_const(model_))) {
      const int number = of_body(block.body);
      if (number < 0) continue;
      for (const ConstParticle p : block)
        f(static_cast<std::size_t>(number), p[Column::mass], p.vector(Column::position_x),
          p.vector(Column::velocity_x));
    }
  };
  over_particles([&](std::size_t r, double m, const Vec3<double>& x, const Vec3<double>& v) {
    ExactSum* s = &sums[first_sums * r];
    s[0].add(m);
    for (int a = 0; a < 3; ++a) {
      s[1 + a].add(m * x[a]);
      s[4 + a].add(m * v[a]);
    }
  });
  ranks.sum(std::span<ExactSum>(sums));
  std::vector<RigidState> found(bodies_.size());
  for (std::size_t r = 0; r < bodies_.size(); ++r) {
    const ExactSum* s = &sums[first_sums * r];
    RigidState& state = found[r];
    state.mass = s[0].value();
    if (!(state.mass > 0)) continue;
    for (int a = 0; a < 3; ++a) {
      state.centre[a] = s[1 + a].value() / state.mass;
      state.velocity[a] = s[4 + a].value() / state.mass;
    }
  }
  sums.assign(second_sums * bodies_.size(), {});
  over_particles([&](std::size_t r, double m, const Vec3<double>& x, const Vec3<double>& v) {
    ExactSum* s = &sums[second_sums * r];
    const Vec3<double> d = x - found[r].centre, l = cross(d, v - found[r].velocity);
    const double values[second_sums] = {d.y * d.y + d.z * d.z,
                                        d.x * d.x + d.z * d.z,
                                        d.x * d.x + d.y * d.y,
                                        -d.x * d.y,
                                        -d.y * d.z,
                                        -d.x * d.z,
                                        l.x,
                                        l.y,
                                        l.z};
    for (std::size_t i = 0; i < second_sums; ++i) s[i].add(m * values[i]);
  });
  ranks.sum(std::span<ExactSum>(sums));
  for (std::size_t r = 0; r < bodies_.size(); ++r) {
    std::optional<RigidState>& of_model =
        model_.bodies[static_cast<std::size_t>(bodies_[r].body)].rigid_state;
    if (of_model) continue;  // a restart may add bodies
    const ExactSum* s = &sums[second_sums * r];
    RigidState& state = found[r];
    state.inertia = {s[0].value(), s[1].value(), s[2].value(), s[3].value(), s[4].value(), s[5].value()};
    state.cut = symmetry_planes_at(static_cast<int>(r));
    state.spin = spin_with(state, {s[6].value(), s[7].value(), s[8].value()});
    if (!bodies_[r].driven) keep_symmetry(state);
    const BodyInput& input = *active_bodies(*model_.scene)[static_cast<std::size_t>(bodies_[r].body)];
    if (input.rigid_inertia) {
      state.mass = input.rigid_inertia->mass;
      state.inertia = input.rigid_inertia->tensor.value_or(state.inertia);
    }
    of_model = state;
  }
}

void RigidBodies::find_densities(Reductions& ranks) {
  std::vector<ExactSum> sums(2 * bodies_.size());  // mass and volume
  for (const ConstParticleBlock& block : blocks_of(std::as_const(model_))) {
    const int number = of_body(block.body);
    if (number < 0) continue;
    ExactSum* s = &sums[2 * static_cast<std::size_t>(number)];
    for (const ConstParticle p : block) s[0].add(p[Column::mass]), s[1].add(p[Column::volume]);
  }
  ranks.sum(std::span<ExactSum>(sums));
  for (std::size_t r = 0; r < bodies_.size(); ++r) {
    const double volume = sums[2 * r + 1].value();
    density_.push_back(volume > 0 ? sums[2 * r].value() / volume : 0);
  }
}

Vec3<double> RigidBodies::symmetry_planes_at(int number) {
  const GridGeometry& grid = model_.grid->geometry();
  double nearest[6];  // in edges of a particle
  std::ranges::fill(nearest, std::numeric_limits<double>::infinity());
  for (const ConstParticleBlock& block : blocks_of(std::as_const(model_))) {
    if (of_body(block.body) != number) continue;
    for (const ConstParticle p : block) {
      const Vec3<double> x = p.vector(Column::position_x);
      const double edge = std::cbrt(p[Column::volume]);
      for (int a = 0; a < 3; ++a) {
        const double from_lower = x[a] - grid.origin[a],
                     length = static_cast<double>(grid.cells[static_cast<std::size_t>(a)]) * grid.cell[a];
        nearest[2 * a] = std::min(nearest[2 * a], from_lower / edge);
        nearest[2 * a + 1] = std::min(nearest[2 * a + 1], (length - from_lower) / edge);
      }
    }
  }
  ranks_.minimum(nearest);
  constexpr double at_plane = 0.6;  // half an edge up to round-off, or less
  Vec3<double> cut{};
  for (std::size_t face = 0; face < 6; ++face) {
    if (grid.boundary[face] == Boundary::symmetry && nearest[face] < at_plane)
      cut[static_cast<int>(face / 2)] = 1;
  }
  return cut;
}

const RigidState& RigidBodies::state(int number) const {
  return *model_.bodies[static_cast<std::size_t>(bodies_[static_cast<std::size_t>(number)].body)].rigid_state;
}

void RigidBodies::begin_step(const Loads& loads, const Vec3<double>& gravity, const StepLength& length) {
  for (Rigid& rigid : bodies_) {
    const RigidState& state = *model_.bodies[static_cast<std::size_t>(rigid.body)].rigid_state;
    rigid.energy_before = kinetic_energy(state);
    rigid.velocity_before = state.velocity;
    rigid.spin_before = state.spin;
  }
  move_without_contact(loads, gravity, length);
}

void RigidBodies::move_without_contact(const Loads& loads, const Vec3<double>& gravity,
                                       const StepLength& length) {
  length_ = length;
  const double dt = length.velocity_dt, kept = 1 - dt * model_.scene->solution.damping;
  for (std::size_t r = 0; r < bodies_.size(); ++r) {
    Rigid& rigid = bodies_[r];
    RigidState& state = *model_.bodies[static_cast<std::size_t>(rigid.body)].rigid_state;
    const BodyMotion& motion = loads.motion(rigid.body);
    state.velocity = motion.kind == BodyMotion::Kind::prescribed
                         ? motion.velocity.common
                         : kept * rigid.velocity_before + dt * (gravity + loads.acceleration(rigid.body));
    state.spin =
        (rigid.driven ? 1.0 : kept) * rigid.spin_before + dt * loads.angular_acceleration(rigid.body);
    if (!rigid.driven) keep_symmetry(state);
    rigid.end = rigid.corrected = {state.velocity, state.spin};
    rigid.slips = false;
    move_with(rigid, rigid.end);
    node_mass_[r] =
        rigid.driven ? std::numeric_limits<double>::infinity() : state.mass / std::max(state.contacts, 1.0);
  }
}

void RigidBodies::move_with(Rigid& rigid, const RigidVelocity& motion) {
  const RigidState& s = *model_.bodies[static_cast<std::size_t>(rigid.body)].rigid_state;
  rigid.moves = motion;
  rigid.turn = rigid.driven ? rotation(length_.dt * motion.spin) : turn_in_step(s, motion.spin, length_.dt);
}

void RigidBodies::move_corrected() {
  for (Rigid& rigid : bodies_)
    if (!rigid.driven) move_with(rigid, rigid.corrected);
}

double RigidBodies::longest_step(const Loads& loads) const {
  constexpr double part = 0.1;         // of a cell
  constexpr double least_steps = 100;  // in a run: loads and prescribed motions may begin at any time
  const SolutionInput& solution = model_.scene->solution;
  if (std::ranges::any_of(model_.bodies, [](const Body& body) { return !body.rigid; }))
    return std::numeric_limits<double>::infinity();
  const std::vector<const BodyInput*> inputs = active_bodies(*model_.scene);
  const double way = part * model_.grid->geometry().smallest_cell();
  double longest = solution.end_time / least_steps;
  for (std::size_t r = 0; r < bodies_.size(); ++r) {
    const auto body = static_cast<std::size_t>(bodies_[r].body);
    const RigidState& s = state(static_cast<int>(r));
    const auto size = [](const Vec3<double>& v) { return std::sqrt(dot(v, v)); };
    // The half diagonal of a brick with this mass and inertia.
    const double radius = std::sqrt(1.5 * trace(s.inertia) / s.mass);
    const double speed = size(s.velocity) + radius * size(s.spin);
    const double more =
        (bodies_[r].driven ? 0.0
                           : size(solution.gravity + acceleration_of(*inputs[body], model_.clock.time))) +
        radius * size(loads.angular_acceleration(bodies_[r].body));
    // speed t + more t^2 = way: the speed is that of the step's end.
    const double sum = speed + std::sqrt(speed * speed + 4 * more * way);
    if (sum > 0) longest = std::min(longest, 2 * way / sum);
  }
  return longest;
}

void RigidBodies::move(int number, const ColumnLayout& layout, double* block) const {
  const RigidState& s = state(number);
  const Rigid& rigid = bodies_[static_cast<std::size_t>(number)];
  const Vec3<double> centre = s.centre + length_.dt * rigid.moves.velocity;
  double* x = block + layout.offset(Column::position_x);
  for (int i = 0; i < block_lanes; ++i) {
    const Vec3<double> at =
        centre + rigid.turn * (Vec3<double>{x[i], x[block_lanes + i], x[2 * block_lanes + i]} - s.centre);
    for (int a = 0; a < 3; ++a) x[block_lanes * a + i] = at[a];
  }
  // The vectors of the particles' domains: edges, or corners from the particle.
  const auto turn = [&](Column first, int vectors) {
    if (!layout.has(first)) return;
    double* columns = block + layout.offset(first);
    for (int v = 0; v < vectors; ++v) {
      double* u = columns + 3 * block_lanes * v;
      for (int i = 0; i < block_lanes; ++i) {
        const Vec3<double> turned =
            rigid.turn * Vec3<double>{u[i], u[block_lanes + i], u[2 * block_lanes + i]};
        for (int a = 0; a < 3; ++a) u[block_lanes * a + i] = turned[a];
      }
    }
  };
  turn(Column::edge_1x, 3);
  turn(Column::corner_0x, 8);
}

std::uint32_t RigidBodies::faces_reached(const RigidState& s, const Vec3<double>& x, double edge) const {
  constexpr double near = 0.4;  // of a particle's edge: one that begins at a face is half an edge from it
  const GridGeometry& grid = model_.grid->geometry();
  std::uint32_t reached = 0;
  for (std::size_t face = 0; face < 6; ++face) {
    const auto axis = static_cast<int>(face / 2);
    if (!is_constrained(grid.boundary[face]) || s.cut[axis] != 0) continue;
    const double from_lower = x[axis] - grid.origin[axis],
                 length = static_cast<double>(grid.cells[face / 2]) * grid.cell[axis];
    if ((face % 2 == 0 ? from_lower : length - from_lower) < near * edge) reached |= 1u << face;
  }
  return reached;
}

void RigidBodies::set_velocities() {
  for_each_by_threads(0, model_.grid->owned(), 1, [&](int slot) {
    for (const ParticleTile& tile : model_.grid->brick(static_cast<Slot>(slot)).tiles) {
      const int number = of_body(tile.body);
      if (number < 0) continue;
      const RigidState& s = state(number);
      BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
      std::uint32_t reached = 0;
      for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
        double* const block = pool.block(tile.blocks[b]);
        const double* x = block + pool.layout().offset(Column::position_x);
        const double* volume = block + pool.layout().offset(Column::volume);
        double* v = block + pool.layout().offset(Column::velocity_x);
        for (int i = 0; i < tile.used_lanes(b); ++i) {
          const Vec3<double> place{x[i], x[block_lanes + i], x[2 * block_lanes + i]},
              at = velocity_at(s, place);
          for (int a = 0; a < 3; ++a) v[block_lanes * a + i] = at[a];
          if (is_free(number)) reached |= faces_reached(s, place, std::cbrt(volume[i]));
        }
      }
      if (reached != 0) std::atomic_ref(bodies_[static_cast<std::size_t>(number)].reached).fetch_or(reached);
    }
  });
}

void RigidBodies::require_inside() {
  constexpr std::size_t faces = 6;
  std::vector<std::int64_t> reached(faces * bodies_.size());
  for (std::size_t r = 0; r < bodies_.size(); ++r)
    for (std::size_t face = 0; face < faces; ++face)
      reached[faces * r + face] = bodies_[r].reached >> face & 1;
  ranks_.sum(std::span<std::int64_t>(reached));
  const auto first = std::ranges::find_if(reached, [](std::int64_t count) { return count > 0; });
  if (first == reached.end()) return;
  const auto at = static_cast<std::size_t>(first - reached.begin());
  throw NumericalFailure(fmt::format(
      "step {}, time {:.6g}: the rigid body '{}' has come to the grid's face {}{}, which holds other bodies "
      "but "
      "not those that are rigid and move freely. Place a fixed rigid body there, or leave it room",
      model_.clock.step + 1, model_.clock.time,
      model_.bodies[static_cast<std::size_t>(bodies_[at / faces].body)].name, "XYZ"[at % faces / 2],
      at % 2 == 0 ? "Min" : "Max"));
}

void RigidBodies::end_step(std::vector<RigidImpulse>& impulses, ExactSum& work, ContactRecord& contact) {
  if (any_free()) require_inside();
  constexpr std::size_t sums_of_body = 7;
  std::vector<ExactSum> sums(sums_of_body * bodies_.size());
  std::vector<std::int64_t> contacts(bodies_.size());
  for (std::size_t r = 0; r < std::min(impulses.size(), bodies_.size()); ++r) {
    ExactSum* s = &sums[sums_of_body * r];
    for (int a = 0; a < 3; ++a) {
      s[a] = impulses[r].impulse[a];
      s[3 + a] = impulses[r].moment[a];
    }
    s[6] = impulses[r].energy;
    contacts[r] = impulses[r].contacts;
  }
  ranks_.sum(std::span<ExactSum>(sums));
  ranks_.sum(std::span<std::int64_t>(contacts));
  for (std::size_t r = 0; r < bodies_.size(); ++r) {
    const Rigid& rigid = bodies_[r];
    RigidState& state = *model_.bodies[static_cast<std::size_t>(rigid.body)].rigid_state;
    const ExactSum* s = &sums[sums_of_body * r];
    const Vec3<double> impulse{s[0].value(), s[1].value(), s[2].value()},
        moment{s[3].value(), s[4].value(), s[5].value()};
    const double without_contact = kinetic_energy(state), given = s[6].value();
    core::end_step(state, length_, rigid.moves.velocity, rigid.turn, impulse, moment, rigid.driven);
    state.contacts = static_cast<double>(contacts[r]);
    if (ranks_.rank() != 0) continue;
    if (rigid.reaction != nullptr) {
      rigid.reaction->add(ReactionSums::impulse, impulse);
      rigid.reaction->add(ReactionSums::moment, moment);
    }
    work.add(without_contact - rigid.energy_before);
    if (rigid.driven)
      work.add(-given);
    else
      contact.dissipated.add(given - (kinetic_energy(state) - without_contact));
  }
}

std::vector<std::string> rigid_parts_in_words(const Model& model) {
  std::vector<std::string> words;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (!body.rigid_state || is_driven(model, b)) continue;
    std::string axes;
    for (int a = 0; a < 3; ++a) {
      if (body.rigid_state->cut[a] != 0) axes += fmt::format("{}{}", axes.empty() ? "" : " and ", "xyz"[a]);
    }
    if (!axes.empty())
      words.push_back(fmt::format(
          "rigid body '{}' begins at symmetry planes normal to {}: it moves as a part of the whole, "
          "along these planes",
          body.name, axes));
  }
  return words;
}

std::unique_ptr<RigidBodies> make_rigid_bodies(Model& model, Reductions& ranks) {
  const bool any = std::ranges::any_of(model.bodies, [](const Body& b) { return b.rigid; });
  if (!model.scene->contact.enable || !any) return nullptr;
  return std::make_unique<RigidBodies>(model, ranks);
}

}  // namespace mpm::core
