// What the run as a whole holds: mass, momentum, energy and extent, per body and in all.
//
// Energies and momenta are summed over each block of eight particles in the order of its lanes and over
// blocks exactly, so they are the same bits on any ranks, threads and partition. Angular momentum is about
// the origin. Shown by tests/core/step/totals_test.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// What can be added up. Kinetic m v^2 / 2; internal E m / rho0.
struct Quantities {
  double mass = 0;
  double kinetic = 0;
  double internal = 0;
  Vec3<double> momentum{};
  Vec3<double> angular_momentum{};
};

struct BodyTotals : Quantities {
  std::int64_t particles = 0;  ///< present
  std::int64_t failed = 0;     ///< present and failed
  std::int64_t eroded = 0;     ///< deleted since time zero
  std::int64_t left_grid = 0;  ///< since time zero
  Vec3<double> velocity{};     ///< of the centre of mass; zero without particles
  /// Centre of mass, and the box of particle centres; not-a-number without particles.
  Vec3<double> centre{}, lower{}, upper{};
  /// 0 where the body does not carry the column.
  double max_effective_plastic_strain = 0;
  double max_temperature = 0;
};

struct Totals : Quantities {
  std::vector<BodyTotals> bodies;  ///< as Model::bodies
  std::int64_t particles = 0;
  std::int64_t failed = 0;
  // The ledger, over all ranks.
  double external_work = 0;
  double removed_mass = 0;
  double removed_kinetic = 0;
  double removed_internal = 0;
  std::int64_t eroded = 0;
  std::int64_t left_grid = 0;
  std::int64_t velocity_limited = 0;
};

/// The state of all particles. Collective.
Totals compute_totals(const Model& model, Reductions& ranks);

struct Energies {
  double kinetic = 0;
  double internal = 0;
};

/// The energies of compute_totals alone, cheap enough for every step. Collective.
Energies compute_energies(const Model& model, Reductions& ranks);

/// What energy_balance() asks of compute_totals, to the last bit, and nothing else. Collective.
Totals compute_energy_totals(const Model& model, Reductions& ranks);

struct EnergyBalance {
  double total = 0;  ///< kinetic + internal of the particles present
  /// What is there and what has left, less what has come in, less the initial energy; over the largest of
  /// these.
  double relative_drift = 0;
};
EnergyBalance energy_balance(const Totals& totals, double initial_energy);

/// Cells with at least one particle. Collective.
std::int64_t occupied_cells(const Model& model, Reductions& ranks);

}  // namespace mpm::core
