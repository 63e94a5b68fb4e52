#include "tests/support/reference_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/support/reference_gradients.hpp"

namespace mpm::tests {
namespace {

[[noreturn]] void report_outside(const Vector& x) {
  throw std::runtime_error("a particle left the grid at " + std::to_string(x[0]) + " " +
                           std::to_string(x[1]) + " " + std::to_string(x[2]));
}

/// The domains that follow the velocity gradient.
void deform_domain(ReferenceShape shape, double dt, const Matrix& L, ReferenceParticle& particle) {
  if (shape == ReferenceShape::cpgimp)
    for (std::size_t a = 0; a < 3; ++a) particle.half_size[a] *= 1 + dt * L[a][a];
  if (shape != ReferenceShape::cpdi) return;
  for (Vector& corner : particle.corner) {
    const Vector old = corner;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) corner[a] += dt * L[a][b] * old[b];
  }
}

}  // namespace

ReferenceStepper::ReferenceStepper(ReferenceCase setup) : case_(std::move(setup)) {
  geometry_ = {.shape = case_.shape,
               .origin = case_.origin,
               .cell = case_.cell,
               .cells = case_.cells,
               .boundary = case_.boundary};
  for (auto& particle : case_.particles) {
    particle.half_size = case_.gimp_half_size;
    particle.corner = box(case_.gimp_half_size);
  }
  next_corner_.resize(case_.particles.size());
  layer_ = case_.shape == ReferenceShape::linear ? 0 : 1;
  for (std::size_t a = 0; a < 3; ++a) {
    nodes_[a] = static_cast<std::size_t>(case_.cells[a]) + 1 + 2 * layer_;
    inverse_cell_[a] = 1 / case_.cell[a];
  }
  length_ = std::min({case_.cell[0], case_.cell[1], case_.cell[2]});
  node_mass_unit_ = case_.material.density * case_.cell[0] * case_.cell[1] * case_.cell[2];
  grid_.resize(nodes_[0] * nodes_[1] * nodes_[2]);
  next_x_.resize(case_.particles.size());
  for (auto& particle : case_.particles) particle.c = wave_speed(case_.material, particle);
}

double ReferenceStepper::dt() const {
  double critical = std::numeric_limits<double>::infinity();
  for (const auto& particle : case_.particles) {
    const double Q =
        particle.D < 0 ? case_.material.bq2 * particle.c - case_.material.bq1 * length_ * particle.D : 0.0;
    const auto& v = particle.v;
    const double speed = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const double wave = (Q + std::sqrt(Q * Q + particle.c * particle.c)) / case_.wave_limit;
    critical = std::min(critical, length_ / (wave + speed));
  }
  return case_.dt_factor * critical;
}

void ReferenceStepper::step() {
  if (case_.shape == ReferenceShape::linear)
    step_with<CellSupport>();
  else
    step_with<AnySupport>();
}

template <class Support>
void ReferenceStepper::step_with() {
  const double dt = this->dt();
  const bool one_length = case_.scheme == ReferenceScheme::usf || steps_ == 0;
  const double velocity_dt = one_length ? dt : 0.5 * (last_dt_ + dt);
  if (!(dt > 0) || std::isinf(dt)) throw std::runtime_error("the time step is " + std::to_string(dt));
  if (case_.shape == ReferenceShape::ddmp) find_cells_in_use();
  if (has_light()) find_inset();
  find_supports<Support>();
  particles_to_grid<Support>();
  const bool averages = case_.scheme == ReferenceScheme::usavg;
  if (strains_first() && !(averages && strain_lag_ == 0)) {
    const bool holds = case_.wall_reaction && std::ranges::count(case_.boundary, 4) > 0;
    if (holds) add_forces<Support>();
    initial_velocities(holds ? velocity_dt : 0);
    for (Node& node : grid_) node.f = {};
    if (case_.consistent) {
      solve_mass<Support>(&Node::w, &Node::w);
      stop_at_walls(&Node::w);
      for (Node& node : grid_) node.u = node.w;
    }
    update_stresses<Support>(averages ? strain_lag_ : dt, true);
  }
  if (strains_first()) add_forces<Support>();
  integrate_momentum(velocity_dt);
  if (corrects()) add_orders<Support>();
  if (case_.consistent) solve_motion<Support>(velocity_dt);
  grid_to_particles<Support>(dt, velocity_dt);
  if (case_.scheme != ReferenceScheme::usf) {
    final_velocities();
    if (moves_last()) {
      solve_mass<Support>(&Node::w, &Node::w);
      stop_at_walls(&Node::w);
      move_particles<Support>(dt);
    }
    update_stresses<Support>(averages ? 0.5 * dt : dt, false);
    for (std::size_t p = 0; p < case_.particles.size(); ++p)
      deform_domain(case_.shape, dt, gradients_[p], case_.particles[p]);
  }
  for (std::size_t n = 0; n < next_x_.size(); ++n) case_.particles[n].x = next_x_[n];
  if (case_.shape == ReferenceShape::cpdi2)
    for (std::size_t n = 0; n < next_x_.size(); ++n) case_.particles[n].corner = next_corner_[n];
  time_ += dt;
  last_dt_ = dt;
  strain_lag_ = averages ? 0.5 * dt : 0;
  impulse_time_ += velocity_dt;
  ++steps_;
}

template <>
ReferenceStepper::CellSupport ReferenceStepper::find_support(const ReferenceParticle& particle) const {
  const Vector x = acting_point(particle);
  std::array<std::size_t, 3> first{};
  double N[3][2], dN[3][2];
  for (std::size_t a = 0; a < 3; ++a) {
    const double scaled = (x[a] - case_.origin[a]) * inverse_cell_[a];
    const double cells = case_.cells[a];
    if (!(scaled >= 0 && scaled <= cells)) report_outside(x);
    const double below = std::min(std::floor(scaled), cells - 1);  // the upper face belongs to the last cell
    first[a] = static_cast<std::size_t>(below);
    N[a][1] = scaled - below;
    N[a][0] = 1 - N[a][1];
    dN[a][1] = inverse_cell_[a];
    dN[a][0] = -dN[a][1];
  }
  CellSupport result;
  std::size_t n = 0;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t i = 0; i < 2; ++i, ++n) {
        result.node[n] = first[0] + i + nodes_[0] * (first[1] + j + nodes_[1] * (first[2] + k));
        result.S[n] = N[0][i] * N[1][j] * N[2][k];
        result.G[n] = {dN[0][i] * N[1][j] * N[2][k], N[0][i] * dN[1][j] * N[2][k],
                       N[0][i] * N[1][j] * dN[2][k]};
      }
  return result;
}

template <>
ReferenceStepper::AnySupport ReferenceStepper::find_support(const ReferenceParticle& particle) const {
  const Vector& x = particle.x;
  for (std::size_t a = 0; a < 3; ++a) {
    const double position = (x[a] - case_.origin[a]) / case_.cell[a];
    if (!(position >= 0 && position <= case_.cells[a])) report_outside(x);
  }
  AnySupport result;
  result.wide = case_.shape == ReferenceShape::ddmp
                    ? wide_support(geometry_, acting_point(particle))  // no copy of its tables
                    : wide_support(grid_of(particle), x);
  result.count = result.wide.count;
  for (std::size_t n = 0; n < result.count; ++n) result.node[n] = number(result.wide.entry[n].node);
  return result;
}

template <class Support>
void ReferenceStepper::find_supports() {
  auto& supports = std::get<std::vector<Support>>(supports_);
  supports.clear();
  for (const ReferenceParticle& particle : case_.particles)
    supports.push_back(find_support<Support>(particle));
}

/// What the faces of the grid do to component `axis` of a velocity at node (i, j, k).
ReferenceStepper::Stop ReferenceStepper::stop(const Index& node, std::size_t axis, double velocity) const {
  Stop result = Stop::none;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t side = 0; side < 2; ++side) {
      if (node[a] != (side == 0 ? layer_ : nodes_[a] - 1 - layer_)) continue;
      const int kind = case_.boundary[2 * a + side];
      if (kind == 1 || (kind == 2 && a == axis)) return Stop::held;
      if (kind == 4 && a == axis && (side == 0 ? velocity < 0 : velocity > 0)) result = Stop::wall;
    }
  return result;
}

/// 2-31, 2-32; the forces at once unless the stress is yet to be updated.
template <class Support>
void ReferenceStepper::particles_to_grid() {
  std::fill(grid_.begin(), grid_.end(), Node{});
  const std::vector<double> pressures = acting_pressures();
  for (std::size_t p = 0; p < case_.particles.size(); ++p) {
    const ReferenceParticle& particle = case_.particles[p];
    const Support& at = support<Support>(particle);
    for (std::size_t n = 0; n < at.count; ++n) {
      Node& node = grid_[at.node[n]];
      node.m += particle.m * at.mass(n);
      for (std::size_t a = 0; a < 3; ++a) node.p[a] += particle.m * particle.v[a] * at.value(n, a);
    }
    if (!strains_first()) add_force(particle, pressures[p], at);
  }
  const double cutoff = case_.mass_cutoff * node_mass_unit_;
  for (Node& node : grid_) node.active = node.m > cutoff;
}

/// 2-38 to 2-40.
template <class Support>
void ReferenceStepper::add_force(const ReferenceParticle& particle, double pressure, const Support& at) {
  Matrix sigma = particle.s;
  for (std::size_t a = 0; a < 3; ++a) sigma[a][a] -= pressure;
  for (std::size_t n = 0; n < at.count; ++n) {
    Node& node = grid_[at.node[n]];
    for (std::size_t a = 0; a < 3; ++a) {
      const Vector& G = at.slope(n, a);
      const double weight = case_.nodal_gravity ? at.mass(n) : at.value(n, a);
      node.f[a] += particle.m * weight * case_.gravity[a] -
                   particle.V * (sigma[a][0] * G[0] + sigma[a][1] * G[1] + sigma[a][2] * G[2]);
    }
  }
}

/// 2-33. Nodes that a rigid wall would stop in a step of dt with the forces so far strain nothing either.
void ReferenceStepper::initial_velocities(double dt) {
  for_active_nodes([&](const Index& index, Node& node) {
    for (std::size_t a = 0; a < 3; ++a) {
      node.w[a] = node.p[a] / node.m;
      const bool stops = stop(index, a, node.p[a] + dt * node.f[a]) == Stop::wall;
      if (stops || stop(index, a, node.w[a]) != Stop::none) node.w[a] = 0;
    }
  });
}

/// 2-41 with the boundary conditions. USL: 2-44 too, with a remedy for its singularity 2-49: the internal
/// force on light nodes is divided by m_floor instead of m. Not the external one: a body that falls freely
/// stays unstrained.
void ReferenceStepper::integrate_momentum(double dt) {
  const double lightest = has_light() ? 1e-3 : 1;
  const double floor =
      case_.scheme == ReferenceScheme::usl ? case_.usl_mass_floor * lightest * node_mass_unit_ : 0.0;
  for_active_nodes([&](const Index& index, Node& node) {
    double full = 1;  // share of the node's surroundings inside the walls
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t side = 0; side < 2; ++side)
        if (case_.boundary[2 * a + side] != 0 && index[a] == (side == 0 ? layer_ : nodes_[a] - 1 - layer_))
          full /= 2;
    const double left_out = node.m < full * floor ? 1 - node.m / (full * floor) : 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double p_old = node.p[a];
      node.start[a] = p_old / node.m;
      node.p[a] += node.f[a] * dt;
      const double f_internal = node.f[a] - node.m * case_.gravity[a];
      node.w[a] = (node.p[a] - left_out * f_internal * dt) / node.m;
      const Stop kind = stop(index, a, node.p[a]);
      if (kind != Stop::none) {
        const bool leaves = kind == Stop::wall && stop(index, a, p_old) == Stop::none;
        const bool presses = stop(index, a, node.f[a]) != Stop::none;
        if (kind != Stop::wall || !case_.wall_reaction || (!leaves && presses))
          node.f[a] = 0;
        else if (leaves)
          node.f[a] = p_old * p_old / (dt * dt * node.f[a]);
        node.p[a] = node.w[a] = 0;
        node.held[a] = true;
      }
      node.v[a] = node.p[a] / node.m;
      node.a[a] = node.f[a] / node.m;
      if (maps_back()) node.w[a] = 0;  // a sum to come
    }
  });
}

template <class Support>
void ReferenceStepper::move_particles(double dt) {
  for (std::size_t index = 0; index < case_.particles.size(); ++index) {
    const Support& at = support<Support>(case_.particles[index]);
    next_x_[index] = case_.particles[index].x;
    for (std::size_t n = 0; n < at.count; ++n) {
      const Node& node = grid_[at.node[n]];
      if (!node.active) continue;
      for (std::size_t a = 0; a < 3; ++a) next_x_[index][a] += dt * at.value(n, a) * moving(node)[a];
    }
    if (case_.shape == ReferenceShape::cpdi2) move_corners(index, dt);
  }
}

/// 2-42, 2-43, and the sum of 2-45.
template <class Support>
void ReferenceStepper::grid_to_particles(double dt, double velocity_dt) {
  if (!moves_last()) move_particles<Support>(dt);
  for (auto& particle : case_.particles) {
    const Support& at = support<Support>(particle);
    if (corrects()) particle.v = {};
    for (std::size_t n = 0; n < at.count; ++n) {
      const Node& node = grid_[at.node[n]];
      if (!node.active) continue;
      for (std::size_t a = 0; a < 3; ++a)
        particle.v[a] += at.value(n, a) * (corrects() ? node.u[a] : velocity_dt * node.a[a]);
    }
    if (case_.scheme == ReferenceScheme::usf) {
      Matrix L{};
      for (std::size_t n = 0; n < at.count; ++n)
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t b = 0; b < 3; ++b)
            if (grid_[at.node[n]].active) L[a][b] += moving(grid_[at.node[n]])[a] * at.slope(n, a)[b];
      deform_domain(case_.shape, dt, L, particle);
    }
    if (!maps_back()) continue;
    for (std::size_t n = 0; n < at.count; ++n)
      for (std::size_t a = 0; a < 3; ++a)
        grid_[at.node[n]].w[a] += particle.m * particle.v[a] * at.value(n, a);
  }
}

/// The rest of 2-45, and the boundary conditions on the velocity of the strain rate.
void ReferenceStepper::final_velocities() {
  for_active_nodes([&](const Index& index, Node& node) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (maps_back()) node.w[a] /= node.m;
      // This stress update knows the nodes by the velocity with which they move.
      const bool by_motion = maps_back() && !case_.consistent;
      const Vector& known = by_motion ? moving(node) : node.v;
      const bool held = case_.wall_reaction && known[a] == 0 &&
                        (stop(index, a, 1) == Stop::wall || stop(index, a, -1) == Stop::wall);
      if (held || stop(index, a, node.w[a]) != Stop::none) node.w[a] = 0;
    }
  });
}

template <class Support>
void ReferenceStepper::update_stresses(double dt, bool at_start) {
  std::vector<Matrix>& gradients = gradients_;
  gradients.clear();
  for (const auto& particle : case_.particles) {
    const Support& at = support<Support>(particle);
    Matrix L{};
    for (std::size_t n = 0; n < at.count; ++n) {
      const Node& node = grid_[at.node[n]];
      if (!node.active) continue;
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) L[a][b] += node.w[a] * at.slope(n, a)[b];
    }
    if (case_.scheme == ReferenceScheme::usf && case_.shape == ReferenceShape::linear && !case_.average) {
      std::vector<KickedNode> nodes;
      for (std::size_t n = 0; n < at.count; ++n) {
        const Node& node = grid_[at.node[n]];
        if (node.active) nodes.push_back({at.value(n, 0), at.slope(n, 0), node.w, node.m});
      }
      add_own_kick(particle, nodes, case_.cell, dt, L);
    }
    const double rate = L[0][0] + L[1][1] + L[2][2];
    if (at_start) {
      L = relative_to_old_positions(L, dt);
      // V (1 + dt tr L) has to grow by dt times the rate of the new volume.
      const double more = (rate / (1 - dt * rate) - (L[0][0] + L[1][1] + L[2][2])) / 3;
      for (std::size_t a = 0; a < 3; ++a) L[a][a] += more;
    }
    gradients.push_back(L);
  }
  const auto trace = [](const Matrix& L) { return L[0][0] + L[1][1] + L[2][2]; };
  std::vector<double> changes;
  for (const Matrix& L : gradients) changes.push_back(trace(L));
  if (case_.average) average(changes);
  if (case_.relaxation > 0) relax_pressures(dt, changes);
  for (std::size_t p = 0; p < case_.particles.size(); ++p) {
    ReferenceParticle& particle = case_.particles[p];
    Matrix L = gradients[p];
    for (std::size_t a = 0; a < 3; ++a) L[a][a] += (changes[p] - trace(gradients[p])) / 3;
    const double new_viscosity = case_.scheme != ReferenceScheme::usavg ? 1 : at_start ? 2 : 0;
    update_stress(case_.material, length_, dt, L, particle, new_viscosity);
    if (!(particle.V > 0)) throw std::runtime_error("a particle's volume is " + std::to_string(particle.V));
  }
}

template <class Support>
void ReferenceStepper::add_forces() {
  const std::vector<double> pressures = acting_pressures();
  for (std::size_t p = 0; p < case_.particles.size(); ++p)
    add_force(case_.particles[p], pressures[p], support<Support>(case_.particles[p]));
}

ReferenceEnergy ReferenceStepper::energy() const {
  ReferenceEnergy sum;
  for (const auto& particle : case_.particles) {
    sum.internal += particle.E * particle.m / case_.material.density;
    for (std::size_t a = 0; a < 3; ++a) {
      sum.kinetic += 0.5 * particle.m * particle.v[a] * particle.v[a];
      sum.potential -= particle.m * case_.gravity[a] * particle.x[a];
    }
  }
  return sum;
}

Vector ReferenceStepper::momentum() const {
  Vector sum{};
  for (const auto& particle : case_.particles)
    for (std::size_t a = 0; a < 3; ++a) sum[a] += particle.m * particle.v[a];
  return sum;
}

}  // namespace mpm::tests
