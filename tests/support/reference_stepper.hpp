// The oracle: a naive, textbook material point method, one struct per particle and one dense grid, in plain
// double. Steps of thesis 2.2.2 (USF, USL, MUSL), transfers FLIP, XPIC and FMPM, lumped and consistent mass
// (a dense matrix, factorised), trilinear shape functions (2-17) or those of reference_shape.hpp, stress
// update 2.4.1, J2 return 2.4.3, Mie-Grueneisen 2-130, bulk viscosity 2-69. It shares no code with the
// production kernels. Limits: one material, one rank, uniform grid, no contact, no failure. Shown by
// tests/core/reference.
//
// Symbols: S_ip, G_ip shape function and gradient; m_i, p_i, f_i mass, momentum, force of a node; index p a
// particle. Units are the user's; the Taylor bar uses mm, g, ms, hence MPa.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "tests/support/reference_material.hpp"

namespace mpm::tests {

enum class ReferenceScheme { usf, usl, musl, usavg };
enum class ReferenceTransfer { flip, xpic, fmpm };

struct ReferenceCase {
  Vector origin{};
  Vector cell{};
  std::array<int, 3> cells{};
  /// Lower and upper face of x, y, z: 0 free, 1 fixed, 2 symmetry, 4 rigid wall (free to leave).
  std::array<int, 6> boundary{};
  /// In the thesis a component that a constraint stops has no force, so particles beside a wall keep part of
  /// their speed towards it and a rigid wall hardly lets go of them. With this, the force at a rigid wall is
  /// tension, or p^2/(dt^2 f) where f stops a node that leaves with p.
  bool wall_reaction = false;
  ReferenceShape shape = ReferenceShape::linear;
  Vector gimp_half_size{};  ///< of a particle's first domain, length, for shapes with domains
  Vector gravity{};
  /// Gravity as an acceleration of the nodes, hence a force m_i g. Otherwise particles map m_p g as they map
  /// their momentum, so that its power is that of the particles' weight; the two differ where particles reach
  /// beyond a fixed or symmetry face. The remedy of USL below takes m_i g for gravity's part in both.
  bool nodal_gravity = false;
  ReferenceScheme scheme = ReferenceScheme::musl;
  ReferenceTransfer transfer = ReferenceTransfer::flip;
  int order = 2;     ///< of XPIC and FMPM; 1 is PIC
  int interval = 1;  ///< steps; FLIP in between
  /// With FLIP: nodes have the mass matrix (1 - mass_blend) M + mass_blend diag(m_i), M_ij = sum_p m_p S_i
  /// S_j. With MUSL particles then move with the velocity of the strain rate.
  bool consistent = false;
  double mass_blend = 0.2;
  /// ddmp: means over cells weighted with the largest of a cell's densities, each the least of a tenth of the
  /// material's and four times the particle's.
  bool weigh_cells = false;
  /// linear and ddmp: particles from this one on are of a thousandth of the material's density; they share
  /// its law. Particles in cells whose densest ones are more than ten times as dense as the thinnest ones of
  /// the 27 cells around act from `inset` of an edge or more from the cell's faces; densities are those of
  /// reference.
  std::size_t light_from = std::numeric_limits<std::size_t>::max();
  double inset = 0.15;
  /// The critical step, in units of a wave's crossing time of a cell.
  double wave_limit = 1;
  bool average = false;    ///< volume changes and pressures over the particles of a site
  double relaxation = 0;   ///< with averages: of the pressures' differences, per crossing time of sound
  double dt_factor = 0.5;  ///< of the critical step
  double mass_cutoff = std::numeric_limits<double>::epsilon();  ///< times rho_0 * cell volume
  /// USL only: for the strain rate a node's internal force is divided by at least this times rho_0 * cell
  /// volume, rho_0 that of the lightest material. On the Taylor bar 0.02 diverges and 0.05 is marginal;
  /// towards 1 it becomes an unstable Euler.
  double usl_mass_floor = 0.2;
  ReferenceMaterial material;
  std::vector<ReferenceParticle> particles;
};

struct ReferenceEnergy {
  double kinetic = 0;
  double internal = 0;
  double potential = 0;  ///< of gravity, zero at x = 0
  double total() const { return kinetic + internal + potential; }
};

class ReferenceStepper {
 public:
  explicit ReferenceStepper(ReferenceCase setup);

  /// Throws std::runtime_error when a particle leaves the grid, a volume is not positive or dt is not a
  /// number.
  void step();
  /// Of the steps from now on. Not away from USAVG, which leaves half a step of strain behind.
  void set_scheme(ReferenceScheme scheme) { case_.scheme = scheme; }

  std::span<const ReferenceParticle> particles() const { return case_.particles; }
  double time() const { return time_; }
  /// For which velocities have been advanced.
  double impulse_time() const { return impulse_time_; }
  /// Of the next step: dt_factor times the critical step of the present state, 2-51 and 2-74.
  double dt() const;
  ReferenceEnergy energy() const;
  Vector momentum() const;

 private:
  using Index = std::array<std::size_t, 3>;
  enum class Stop { none, held, wall };
  struct Node {
    double m = 0;
    Vector p{}, f{};  ///< momentum and force
    Vector v{}, a{};  ///< p^{k+1}/m and f/m
    Vector w{};       ///< velocity of the strain rate
    Vector start{};   ///< velocity at the start of the step
    /// XPIC, FMPM: sum of the orders so far, and the latest of them. Consistent mass: velocity at the start
    /// (USF), then at the end (USF), and increment.
    Vector u{}, du{};
    Vector q{};                  ///< momentum of the particles' share of du
    std::array<bool, 3> held{};  ///< by a wall
    bool active = false;         ///< heavier than the cutoff
  };
  /// The eight nodes of a cell.
  struct CellSupport {
    static constexpr std::size_t count = 8;
    std::array<std::size_t, count> node;
    std::array<double, count> S;
    std::array<Vector, count> G;
    double mass(std::size_t n) const { return S[n]; }
    double value(std::size_t n, std::size_t) const { return S[n]; }
    const Vector& slope(std::size_t n, std::size_t) const { return G[n]; }
  };
  /// Any shape, with its weights per component.
  struct AnySupport {
    WideSupport wide;
    std::array<std::size_t, 64> node;
    std::size_t count;
    double mass(std::size_t n) const { return wide.entry[n].mass; }
    double value(std::size_t n, std::size_t component) const { return wide.entry[n].value[component]; }
    const Vector& slope(std::size_t n, std::size_t component) const { return wide.entry[n].slope[component]; }
  };

  template <class Support>
  Support find_support(const ReferenceParticle& particle) const;
  template <class Support>
  void find_supports();
  /// At the start of the step.
  template <class Support>
  const Support& support(const ReferenceParticle& particle) const {
    return std::get<std::vector<Support>>(supports_)[index_of(particle)];
  }
  /// By their particles at the start of the step.
  void find_cells_in_use();
  void find_inset();
  Vector acting_point(const ReferenceParticle& particle) const;
  double density_of(const ReferenceParticle& particle) const;
  std::size_t index_of(const ReferenceParticle& particle) const {
    return static_cast<std::size_t>(&particle - case_.particles.data());
  }
  bool has_light() const { return case_.light_from < case_.particles.size(); }
  ReferenceGrid grid_of(const ReferenceParticle& particle) const;
  std::size_t number(const std::array<int, 3>& node) const;
  Stop stop(const Index& node, std::size_t axis, double velocity) const;
  template <class Operation>
  void for_active_nodes(Operation&& operation) {
    std::size_t n = 0;
    for (std::size_t k = 0; k < nodes_[2]; ++k)
      for (std::size_t j = 0; j < nodes_[1]; ++j)
        for (std::size_t i = 0; i < nodes_[0]; ++i, ++n)
          if (grid_[n].active) operation(Index{i, j, k}, grid_[n]);
  }

  template <class Support>
  void step_with();
  template <class Support>
  void particles_to_grid();
  template <class Support>
  void add_force(const ReferenceParticle& particle, double pressure, const Support& at);
  /// p + q of every particle, or its mean over the particle's site.
  std::vector<double> acting_pressures() const;
  /// Whether stresses are updated at the start of the step, and forces follow; whether the new velocities are
  /// mapped to the grid, for an update at the end.
  bool strains_first() const {
    return case_.scheme == ReferenceScheme::usf || case_.scheme == ReferenceScheme::usavg;
  }
  bool maps_back() const {
    return case_.scheme == ReferenceScheme::musl || case_.scheme == ReferenceScheme::usavg;
  }
  void initial_velocities(double dt);
  void integrate_momentum(double dt);
  /// Whether this step is one of XPIC or FMPM.
  bool corrects() const {
    return case_.transfer != ReferenceTransfer::flip && (steps_ + 1) % case_.interval == 0;
  }
  template <class Support>
  void add_orders();
  /// Solves for the velocities `of` the nodes, which hold those of lumped mass, with the consistent mass.
  /// `stopped`: what a rigid wall has stopped is zero there.
  template <class Support>
  void solve_mass(Vector Node::*of, Vector Node::*stopped);
  bool at_rigid_wall(const Index& node, std::size_t axis) const {
    return stop(node, axis, 1) == Stop::wall || stop(node, axis, -1) == Stop::wall;
  }
  /// No velocity `of` a node leads through a rigid wall.
  void stop_at_walls(Vector Node::*of);
  template <class Support>
  void solve_motion(double dt);
  /// The velocity with which particles move.
  const Vector& moving(const Node& node) const {
    if (case_.consistent) return maps_back() ? node.w : node.u;
    return corrects() && case_.transfer == ReferenceTransfer::fmpm ? node.u : node.v;
  }
  template <class Support>
  void grid_to_particles(double dt, double velocity_dt);
  template <class Support>
  void move_particles(double dt);
  bool moves_last() const { return case_.consistent && maps_back(); }
  void move_corners(std::size_t index, double dt);
  void final_velocities();
  template <class Support>
  void add_forces();
  /// `at_start`: with the velocity gradient at the places to which the velocities led.
  template <class Support>
  void update_stresses(double dt, bool at_start);
  /// Replaces values of the particles by their means over sites, weighted by volume.
  void average(std::vector<double>& values) const;
  /// Adds to the particles' rates of volume change what lets pressures inside a site become equal.
  void relax_pressures(double dt, std::vector<double>& changes) const;

  ReferenceCase case_;
  std::vector<Matrix> gradients_;  ///< of the velocity, by particle, of the last update of stresses
  Index nodes_{};                  ///< along each axis
  std::size_t layer_ = 0;          ///< layers of nodes outside the grid
  ReferenceGrid geometry_;
  Vector inverse_cell_{};
  double length_ = 0;          ///< smallest cell edge
  double node_mass_unit_ = 0;  ///< rho_0 * cell volume
  std::vector<Node> grid_;
  std::tuple<std::vector<CellSupport>, std::vector<AnySupport>> supports_;  ///< one of them is empty
  std::vector<bool> inset_;     ///< by particle, whether it acts from inside its cell; or empty
  std::vector<Vector> next_x_;  ///< positions at the end of the step; shape functions stay those of its start
  std::vector<DomainCorners> next_corner_;  ///< for cpdi2
  double time_ = 0, last_dt_ = 0, impulse_time_ = 0;
  double strain_lag_ = 0;  ///< of USAVG: what the first half of the last step has left
  int steps_ = 0;          ///< completed
};

template <>
ReferenceStepper::CellSupport ReferenceStepper::find_support(const ReferenceParticle& particle) const;
template <>
ReferenceStepper::AnySupport ReferenceStepper::find_support(const ReferenceParticle& particle) const;

/// The copper Taylor bar of thesis 3.5.1 and 5.3.3: a full cylinder, 25.4 long and 7.6 across, at 190 mm/ms
/// onto the symmetry plane z = 0; particles on a lattice of spacing dp (along z: nearest that divides the
/// length), cells 2 dp.
ReferenceCase taylor_bar(double dp);

struct BarShape {
  double length = 0;         ///< highest particle and its initial distance from the free end
  double foot_diameter = 0;  ///< largest; the surface stretches as the outermost particle does
  double diameter = 0;  ///< a fifth of the length, 5.08, above the foot; of a circle of that cross-section
};

/// Measured so that the initial bar has its nominal length and foot diameter at any spacing.
BarShape bar_shape(const ReferenceCase& initial, std::span<const ReferenceParticle> particles);

/// The naive baseline: MUSL on a Taylor bar of about that many particles.
/// Returns CPU time of the stepping loop per particle and step, in ns.
double run_reference(int particles_target, int steps);

}  // namespace mpm::tests
