#pragma once
// Settings of the time integration from the input.

#include <optional>
#include <vector>

#include "core/scene/body.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// When a step updates the stress: first, last, last with the nodal velocity re-mapped from the particles, or
/// half first and half last with that velocity.
enum class Scheme { usf, usl, musl, usavg };
/// Whether a step begins with an update of the stresses; whether it maps the new velocities to the grid.
constexpr bool strains_first(Scheme s) { return s == Scheme::usf || s == Scheme::usavg; }
constexpr bool maps_back(Scheme s) { return s == Scheme::musl || s == Scheme::usavg; }

enum class Integration { explicit_dynamics, implicit };

enum class Transfer { flip, pic, apic, tpic, aflip, xpic, fmpm };
/// Particles carry an affine velocity (core/transfer/affine.hpp).
constexpr bool is_affine(Transfer t) {
  return t == Transfer::apic || t == Transfer::tpic || t == Transfer::aflip;
}
/// What PIC loses is mapped again (core/transfer/corrected.hpp).
constexpr bool is_corrected(Transfer t) { return t == Transfer::xpic || t == Transfer::fmpm; }

/// Mass matrix of the nodes' equation of motion.
enum class MassMatrix { lumped, consistent };

struct TimeStepInput {
  double factor = 0.9;            ///< of the critical step, (0, 1]
  bool constant = false;          ///< keep the first critical step
  double specified = 0;           ///< time; 0: not specified
  bool ignore_viscosity = false;  ///< the artificial viscosity does not shorten the critical step
};

/// Manual, 3.10.5; the input offers 0 to 4.
enum class VolumeUpdate {
  rate = 0,                  ///< V (1 + d eps)
  cell = 1,                  ///< as the particle's cell
  exponential = 2,           ///< V exp(d eps)
  deformation_gradient = 3,  ///< V det(dF)
  accumulated_strain = 4,    ///< V0 (1 + e11)(1 + e22)(1 + e33)
  mid_point = 5,             ///< V det(I + dt L/2)/det(I - dt L/2): as the deformation gradient of the laws
};

struct VolumeInput {
  VolumeUpdate update = VolumeUpdate::rate;
  std::optional<double> erode;  ///< particles with less volume are deleted; volume
  std::optional<double> min;    ///< lower bound of volume over initial volume
  std::optional<double> max;    ///< upper bound of volume over initial volume
};

/// Over which particles the volume change is averaged, against volumetric locking.
enum class VolumeAveraging { none, cell };

/// Conditions that are checked for, and the reaction to them.
struct WarnInput {
  enum class Level {
    per_step = 0,      ///< one warning per step
    per_particle = 1,  ///< one warning when a particle first meets the condition
    stop = 2,
  };
  bool negative_internal_energy = false;
  bool negative_volume = false;
  bool outside_grid = false;
  Level level = Level::per_step;
};

/// What an implicit step solves: the equation of motion, equilibrium, or the equation of motion linearised at
/// the start of the step, once.
enum class ImplicitType { dynamic, quasistatic, semi };

/// Time integration of dynamic implicit steps.
enum class ImplicitRule { newmark, backward_euler, generalised_alpha };

/// Read when the integration is implicit.
struct ImplicitInput {
  ImplicitType type = ImplicitType::dynamic;
  ImplicitRule rule = ImplicitRule::newmark;
  double newmark_beta = 0.25;
  double newmark_gamma = 0.5;
  double spectral_radius = 0.8;  ///< of generalised alpha: what a long step leaves of an oscillation
  std::optional<double> time_step;
  std::optional<double> min_step;
  std::optional<double> max_step;
  double relative_tolerance = 1e-6;
  std::optional<double> absolute_tolerance;
  int max_newton = 20;
  double gravity_ramp = 0;  ///< time over which gravity grows from zero
  bool matrix_free = false;
  bool difference_tangent = false;  ///< derivatives of the stress by differences
  double stabilisation = 1e-3;      ///< stiffness of the empty part of a cell, over the material's

  bool quasistatic() const { return type == ImplicitType::quasistatic; }
  bool linearised() const { return type == ImplicitType::semi; }
};

struct FemInput {
  struct RigidWall {
    int axis = 0;
    bool positive_normal = true;
    double coordinate = 0;
  };
  struct Hourglass {
    int method = 1;  ///< 1 standard, 2 Flanagan-Belytschko
    double coefficient = 0;
  };
  bool couple_with_particles = false;
  bool contact = false;
  std::vector<RigidWall> rigid_walls;
  std::optional<Hourglass> hourglass;
  std::vector<FixedLayer> fixed_layers;
};

struct SolutionInput {
  Scheme scheme = Scheme::musl;
  bool automatic_scheme = true;  ///< MUSL may give way to USAVG (core/step/scheme_change.hpp)
  Transfer transfer = Transfer::flip;
  double flip_fraction = 1;  ///< 1 FLIP ... 0 PIC
  int xpic_order = 2;        ///< of XPIC and FMPM
  int xpic_interval = 1;     ///< steps from one correction by XPIC or FMPM to the next; FLIP in between
  MassMatrix mass = MassMatrix::lumped;  ///< consistent with FLIP alone
  double mass_tolerance = 1e-2;          ///< of its inverse (core/transfer/consistent.hpp); no input sets it
  Integration integration = Integration::explicit_dynamics;
  bool near_boundary_stop =
      false;            ///< write a restart file and leave when a particle nears the grid's bounds
  double end_time = 0;  ///< > 0
  TimeStepInput time_step;
  std::optional<double> limit_velocity;  ///< largest particle speed
  VolumeInput volume;
  VolumeAveraging averaging = VolumeAveraging::none;
  /// With averages: share of the differences of pressure inside a site that goes while sound crosses a cell.
  double pressure_relaxation = 0;
  WarnInput warn;
  std::optional<double> energy_fraction;  ///< stop when the relative error of the total energy exceeds this
  double damping = 0;                     ///< dynamic relaxation: force per mass and velocity, 1/time
  Vec3<double> gravity{};
  std::optional<ImplicitInput> implicit;
  std::optional<FemInput> fem;
  std::optional<int> threads;  ///< OpenMP threads per rank
  SourceLocation source;
};

/// Contact between components.
struct ContactInput {
  enum class Distance { shared_node = 0, nearest_particles = 1, surfaces = 2 };
  enum class Method { pan = 0, bardenhagen = 1, improved_bardenhagen = 2 };

  bool enable = false;
  bool failed_to_component = false;  ///< failed particles form a component of their own
  bool automatic_weights = false;    ///< weight of normals from the stiffness
  bool ignore_failed_normals = false;
  Distance distance = Distance::shared_node;
  double min_distance = 0;  ///< in cells
  bool limits_time_step = false;
  Method method = Method::pan;
  /// Normals by the gradient of mass of the component with the larger weight, the mean of both with equal
  /// ones; by a regression on the particles of both (separating_plane.hpp); or, automatic, by regression
  /// where the weights are equal.
  enum class Normal { automatic, mass_gradient, regression };
  Normal normal = Normal::automatic;
  bool record_force = false;

  /// Whether the gap between two bodies decides about their contact.
  bool measures_gaps() const { return enable && distance != Distance::shared_node && min_distance > 0; }
};

}  // namespace mpm::core
