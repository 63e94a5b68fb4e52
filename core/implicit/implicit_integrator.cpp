#include "core/implicit/implicit_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/contact_points.hpp"
#include "core/step/speeds.hpp"

namespace mpm::core {

namespace {

/// Nodes with less than CellStabilisation::hardly_any of the volume of a cell around them may belong to a
/// fragment that nothing holds. They get a stiffness of their own, of this part of the material's: so little
/// that it bears no weight over the way of a step, and enough for the matrix not to be singular.
constexpr double ground = 1e-10;

}  // namespace

ImplicitIntegrator::ImplicitIntegrator(Model& model, Communication& communication, NewtonSolver& solver)
    : model_(model),
      ranks_(communication.reductions),
      halo_(communication.halo),
      solver_(solver),
      input_(model.scene->solution.implicit.value_or(ImplicitInput{})),
      face_points_(acting_faces(model, communication.reductions)),
      with_faces_(bodies_of(face_points_)),
      cells_(make_cells_in_use(model, communication.halo, with_faces_)),
      rigid_(make_rigid_bodies(model, communication.reductions)),
      passes_(make_implicit_passes(model, rigid_.get(), with_faces_, fields_)),
      unknowns_(model, communication, fields_),
      stabilisation_(model, fields_),
      lags_(TimeRule::lags(input_)) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    moves_bodies_ |= passes_->loads().motion(b).kind == BodyMotion::Kind::prescribed &&
                     (!rigid_ || rigid_->of_body(b) < 0) &&
                     std::ranges::find(with_faces_, b) == with_faces_.end();
  const double h = model.grid->geometry().smallest_cell();
  for (const Body& body : model.bodies) {
    const double c = body.model->initial_sound_speed();
    held_diagonal_ = std::max(held_diagonal_, body.model->reference_density() * c * c * h);
  }
  if (!(held_diagonal_ > 0)) held_diagonal_ = 1;
  contact_ = make_implicit_contact(model, rigid_.get(), unknowns_);
  if (with_faces_.empty()) return;
  if (contact_)
    for (const int b : with_faces_) contact_->leave_to_faces(b);
  faces_ =
      std::make_unique<BodyFaces>(model, ranks_, fields_, unknowns_, std::move(face_points_), contact_.get());
}

std::vector<Phase> ImplicitIntegrator::phases() {
  std::vector<Phase> step;
  // First: every exchange sends what there is in each of these fields.
  if (contact_) step.push_back({"velocity fields of components", [this] { find_fields(); }});
  if (cells_) {
    step.push_back({"cells in use", [this] { cells_->find(); }});
    step.push_back({"exchange cells", [this] { cells_->finish_exchange(); }});
  }
  step.push_back({"particles to grid", [this] { prepare(); }});
  step.push_back({name_of_solution(), [this] { solve(); }});
  step.push_back({"grid to particles", [this] { move(); }});
  return step;
}

/// Components that may meet have fields of their own.
void ImplicitIntegrator::find_fields() {
  model_.grid->set_components(components_by_slot(*model_.grid, halo_));
}

void ImplicitIntegrator::find_contacts() {
  std::vector<double> mass;
  for (const NodeState& at : state_) mass.push_back(at.mass);
  contact_->find_nodes(*passes_, mass);
}

void ImplicitIntegrator::distribute(std::span<const double> u) {
  unknowns_.distribute(u, displacements_);
  if (contact_) contact_->take_displacements();
}

/// Masses, velocities, external forces and the forces at the start of the step.
void ImplicitIntegrator::prepare() {
  const double dt = model_.clock.dt;
  rule_ = TimeRule::of(input_, dt);
  fields_.find(*model_.grid);
  passes_->begin_step(dt, rule_.dynamic() ? 0.5 : 1.0);
  if (contact_) contact_->begin_step(passes_->loads(), dt);
  if (faces_) faces_->begin_step(passes_->loads(), dt);
  passes_->map_start();
  unknowns_.exchange(mapped::implicit_start);
  const std::vector<double> sums = unknowns_.number();
  unknowns_.hold_walls();
  state_.assign(unknowns_.own(), {});
  passes_->map_motion();
  unknowns_.exchange(mapped::implicit_motion);
  if (faces_) faces_->take_moduli();
  stabilisation_.find_cells(unknowns_);
  const GridGeometry& g = model_.grid->geometry();
  const double cell_volume = g.cell_volume();
  unknowns_.for_each_own([&](std::size_t i, const double* sum) {
    const double volume = sum[node_field::volume.first] / cell_volume;
    constexpr double hardly_any = CellStabilisation::hardly_any;
    if (!(volume > 0 && volume < hardly_any)) return;
    const double modulus = sum[node_field::modulus.first] / sum[node_field::volume.first];
    state_[i].ground = ground * (1 - volume / hardly_any) * modulus * g.smallest_cell();
  });
  if (moves_bodies_) unknowns_.hold_moved(dt);
  if (moves_bodies_ && rule_.dynamic()) {
    passes_->map_drive();
    unknowns_.exchange(mapped::implicit_lag);
    unknowns_.for_each_own([&](std::size_t i, const double* sum) {
      for (int a = 0; a < 3; ++a)
        if (moved(i, a)) state_[i].drive[a] = sum[a] / unknowns_.moved_volume()[i];
    });
  }
  const double cutoff = model_.grid->geometry().mass_cutoff;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    NodeState& at = state_[i];
    const double* sum = sums.data() + node_doubles * i;
    at.mass = sum[3];
    for (int a = 0; a < 3; ++a) {
      at.velocity[a] = at.mass > cutoff ? sum[a] / at.mass : 0;
      at.external[a] = sum[4 + a];
    }
    // Where the free motion is unknown, cells and ties alone hold the node.
    if (rule_.dynamic() && !(at.mass > cutoff)) at.ground = 0;
  }
  if (contact_) find_contacts();
  if (faces_) faces_->find_patches(*passes_);
  if (lags_) {
    passes_->map_lag();
    unknowns_.exchange(mapped::implicit_lag);
    unknowns_.for_each_own([&](std::size_t i, const double* sum) {
      NodeState& at = state_[i];
      for (int a = 0; a < 3; ++a) at.lag[a] = at.mass > cutoff ? sum[a] / at.mass : 0;
    });
  }
  const std::vector<double> at_rest(3 * state_.size(), 0.0);
  distribute(at_rest);
  passes_->map_forces(displacements_);
  if (faces_) faces_->add_start_forces();
  unknowns_.exchange(mapped::implicit_force);
  const double damping = model_.scene->solution.damping;
  unknowns_.for_each_own([&](std::size_t i, const double* sum) {
    NodeState& at = state_[i];
    for (int a = 0; a < 3; ++a)
      at.force[a] = at.external[a] + sum[4 + a] - damping * at.mass * at.velocity[a];
  });
}

bool ImplicitIntegrator::map_forces(std::span<const double> u) {
  distribute(u);
  const bool usable = passes_->map_forces(displacements_);
  stabilisation_.add_forces(displacements_);
  if (faces_) faces_->add_forces(displacements_);
  unknowns_.exchange(mapped::implicit_force);
  return usable;
}

double ImplicitIntegrator::look_ahead(std::span<const double> u) {
  // Of a cell: so small that the forces are linear, and large against rounding.
  constexpr double small = 1e-5, there = 1e-12;
  if (!moves_bodies_ || input_.matrix_free) return 0;
  const double h = model_.grid->geometry().smallest_cell();
  double farthest = 0;
  for (std::size_t i = 0; i < state_.size(); ++i)
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
      if (held(i, static_cast<int>(k - 3 * i)))
        farthest = std::max(farthest, std::abs(unknowns_.held_displacements()[k] - u[k]));
  farthest = ranks_.largest(farthest);
  if (!(farthest > there * h)) return 0;
  const double part = std::min(1.0, small * h / farthest);
  ahead_.assign(u.begin(), u.end());
  for (std::size_t i = 0; i < state_.size(); ++i)
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
      if (held(i, static_cast<int>(k - 3 * i)))
        ahead_[k] += part * (unknowns_.held_displacements()[k] - u[k]);
  return part;
}

bool ImplicitIntegrator::residual(std::span<const double> u, std::span<double> r) {
  const double part = look_ahead(u);
  if (part > 0) {
    map_forces(ahead_);
    find_contact_forces();
    unknowns_.for_each_own([&](std::size_t i, const double* sum) {
      for (int a = 0; a < 3; ++a)
        state_[i].ahead[a] = -(sum[4 + a] + (1 + rule_.carry) * state_[i].contact[a]) / part;
    });
  }
  const bool usable = map_forces(u);
  find_contact_forces();
  const double damping = model_.scene->solution.damping;
  ExactSum squares;
  unknowns_.for_each_own([&](std::size_t i, const double* sum) {
    NodeState& at = state_[i];
    double size = sum[7];
    for (int a = 0; a < 3; ++a) {
      const std::size_t k = 3 * i + static_cast<std::size_t>(a);
      const double inertia =
          at.mass * (rule_.inertia * u[k] - rule_.start * at.velocity[a] - rule_.recall * at.lag[a]);
      const double drag =
          damping * (at.mass * (rule_.gain * u[k] + rule_.keep * at.velocity[a] + rule_.push * at.lag[a]) +
                     rule_.push * at.force[a]);
      at.reaction[a] = inertia + drag + at.ground * (u[k] - free_motion(at, a)) - rule_.carry * at.force[a] -
                       at.external[a] - (1 + rule_.carry) * at.contact[a] - sum[4 + a];
      size += std::abs(inertia) + std::abs(at.external[a]) + std::abs(at.contact[a]);
      if (held(i, a)) {
        r[k] = held_diagonal_ * (u[k] - unknowns_.held_displacements()[k]);
        size += std::abs(r[k]);
        continue;
      }
      r[k] = at.reaction[a];
      if (!(part > 0)) continue;
      const double led = at.ahead[a] + (sum[4 + a] + (1 + rule_.carry) * at.contact[a]) / part;
      r[k] += led;
      size += std::abs(led);
    }
    squares.add(size * size);
  });
  ranks_.sum(std::span(&squares, 1));
  force_scale_ = std::sqrt(squares.value());
  return !ranks_.any(!usable);
}

void ImplicitIntegrator::find_contact_forces() {
  if (!contact_) return;
  for (NodeState& at : state_) {
    std::fill_n(at.contact, 3, 0.0);
    at.meets_rigid = false;
  }
  contact_->for_each_force([&](std::size_t i, const Vec3<double>& force, bool by_rigid) {
    for (int a = 0; a < 3; ++a) state_[i].contact[a] += force[a];
    state_[i].meets_rigid |= by_rigid;
  });
}

void ImplicitIntegrator::jacobian(std::span<const double> u, BlockMatrix& matrix) {
  distribute(u);
  passes_->add_tangent(&displacements_, unknowns_, matrix);
  stabilisation_.add_tangent(unknowns_, true, matrix);
  if (contact_) contact_->add_tangent(1 + rule_.carry, true, matrix);
  if (faces_) faces_->add_tangent(&displacements_, matrix);
  const double per_mass = rule_.inertia + model_.scene->solution.damping * rule_.gain;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    double diagonal[9] = {};
    for (int a = 0; a < 3; ++a)
      diagonal[4 * a] = held(i, a) ? held_diagonal_ : per_mass * state_[i].mass + state_[i].ground;
    const std::int64_t number = unknowns_.first() + static_cast<std::int64_t>(i);
    matrix.add(std::span(&number, 1), diagonal);
  }
}

/// The forces are those of the end of the step, or where it is dynamic the means over it; damping counts
/// among them.
void ImplicitIntegrator::find_reactions() {
  map_forces(solution_);
  find_contact_forces();
  const double dt = model_.clock.dt, damping = model_.scene->solution.damping;
  std::vector<double> impulses(solution_.size());
  unknowns_.for_each_own([&](std::size_t i, const double* sum) {
    NodeState& at = state_[i];
    for (int a = 0; a < 3; ++a) {
      if (!moves_bodies_ || !moved(i, a)) continue;
      const std::size_t k = 3 * i + static_cast<std::size_t>(a);
      const double at_end = at.external[a] + sum[4 + a];
      at.impulse[a] = -dt * (at_end + at.contact[a]);
      if (rule_.dynamic()) {
        const double drag = damping * at.mass * solution_[k] / dt,
                     force = (rule_.carry * at.force[a] + at_end - drag) / (1 + rule_.carry);
        at.impulse[a] = at.mass * at.drive[a] - dt * (force + at.contact[a]);
      }
      impulses[k] = at.impulse[a] / unknowns_.moved_volume()[i];
    }
  });
  AlignedDoubles records;
  unknowns_.distribute(impulses, records);
  passes_->add_reactions(records);
}

void ImplicitIntegrator::move() {
  if (moves_bodies_ || (faces_ && !contact_)) find_reactions();
  // The last residual of a line search need not be that of the solution.
  distribute(solution_);
  find_contact_forces();
  if (faces_) faces_->end_step(displacements_, of_nodes_);
  const double cutoff = model_.grid->geometry().mass_cutoff;
  const bool rubs = contact_ && contact_->rubs();
  std::vector<double> gained(solution_.size()), lag_gained(lags_ ? solution_.size() : 0);
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const NodeState& at = state_[i];
    const bool touches = at.contact[0] != 0 || at.contact[1] != 0 || at.contact[2] != 0;
    double work = 0;
    for (int a = 0; a < 3; ++a) {
      const std::size_t k = 3 * i + static_cast<std::size_t>(a);
      const double u = solution_[k], force = at.mass > cutoff ? (at.force[a] + at.contact[a]) / at.mass : 0;
      work += at.external[a] * u;
      if (rule_.dynamic()) {
        if (moved(i, a)) work += at.impulse[a] * u / model_.clock.dt;
      } else if (held(i, a) || !touches || (!at.meets_rigid && !rubs)) {
        // From equilibrium to equilibrium loads and reactions change in proportion: the work of their means.
        // What deformable components do to each other at the start cancels in the sum over both, but for
        // friction.
        work += 0.5 * ((held(i, a) ? at.reaction[a] : 0.0) - at.force[a]) * u;
      }
      const double v = held(i, a)
                           ? u / model_.clock.dt
                           : rule_.gain * u + rule_.keep * at.velocity[a] + rule_.push * (force + at.lag[a]);
      // As in explicit steps, a wall acts on the particles through their stress alone; so does a body of
      // prescribed motion, in whose frame it is a wall.
      const bool on_wall = held(i, a) && !moved(i, a);
      if (at.mass > cutoff && !on_wall) gained[k] = moved(i, a) ? at.drive[a] : v - at.velocity[a];
      if (lags_ && at.mass > cutoff && !on_wall) {
        const bool led = held(i, a) || touches;
        const double at_end = rule_.force_at_end(u, at.velocity[a], force, at.lag[a]);
        const double lag = led ? 0 : rule_.fresh * (at_end - force) - rule_.fade * at.lag[a];
        lag_gained[k] = (lag - at.lag[a]) / model_.clock.dt;
      }
      work -= 0.5 * model_.scene->solution.damping * at.mass * (at.velocity[a] + v) * u;
    }
    if (work != 0) of_nodes_.work.add(work);
  }
  if (contact_) stop_contacts(gained);
  if (rule_.dynamic()) unknowns_.distribute(gained, velocities_);
  if (lags_) unknowns_.distribute(lag_gained, lag_increments_);
  passes_->move_particles(displacements_, rule_.dynamic() ? &velocities_ : nullptr,
                          lags_ ? &lag_increments_ : nullptr);
  if (contact_) contact_->end_step(of_nodes_);
}

/// What contact does to the velocities at the end of the step; and the forces of the step.
void ImplicitIntegrator::stop_contacts(std::span<double> gained) {
  if (!rule_.dynamic()) {
    std::vector<Vec3<double>> start;
    for (const NodeState& at : state_) start.push_back({at.force[0], at.force[1], at.force[2]});
    return contact_->find_start(start);
  }
  std::vector<double> velocity(gained.begin(), gained.end());
  for (std::size_t i = 0; i < state_.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) velocity[3 * i + a] += state_[i].velocity[a];
  contact_->stop(velocity, model_.grid->geometry().mass_cutoff,
                 [&](std::size_t i, const Vec3<double>& change) {
                   for (int a = 0; a < 3; ++a) gained[3 * i + static_cast<std::size_t>(a)] += change[a];
                 });
}

double ImplicitIntegrator::stable_step(const StepStatistics& statistics) const {
  return critical_step(*model_.grid, statistics.fastest);
}

StepStatistics ImplicitIntegrator::take_statistics() {
  StepStatistics all = passes_->take_statistics();
  all.work += of_nodes_.work;
  all.contact += of_nodes_.contact;
  all.reactions.resize(std::max(all.reactions.size(), of_nodes_.reactions.size()));
  for (std::size_t r = 0; r < of_nodes_.reactions.size(); ++r) all.reactions[r] += of_nodes_.reactions[r];
  of_nodes_ = {};
  return all;
}

}  // namespace mpm::core
