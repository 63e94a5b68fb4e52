// Totals of a run: mass, momentum, energy and extent, per body and overall.
//
// Energies and momenta are summed over each block of eight particles in lane order and over blocks exactly,
// so they are bitwise identical for any ranks, threads and partition. Angular momentum is about the origin.
// Shown by tests/core/step/totals_test.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Additive quantities. Kinetic m v^2 / 2; internal E m / rho0.
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
  /// Centre of mass, and the bounding box of the particle centres; NaN without particles.
  Vec3<double> centre{}, lower{}, upper{};
  /// 0 where the body does not carry the column.
  double max_effective_plastic_strain = 0;
  double max_temperature = 0;
};

struct Totals : Quantities {
  std::vector<BodyTotals> bodies;  ///< in the order of Model::bodies
  std::int64_t particles = 0;
  std::int64_t failed = 0;
  // The ledger, over all ranks.
  double external_work = 0;
  double dissipated_by_contact = 0;  ///< energy
  double friction_heat = 0;          ///< the part of it that friction took
  double removed_mass = 0;
  double removed_kinetic = 0;
  double removed_internal = 0;
  double internal_lead = 0;  ///< of the current state
  std::int64_t eroded = 0;
  std::int64_t left_grid = 0;
  std::int64_t velocity_limited = 0;
};

/// Totals over all particles. Collective.
Totals compute_totals(const Model& model, Reductions& ranks);

struct Energies {
  double kinetic = 0;
  double internal = 0;
};

/// The energies of compute_totals alone, cheap enough for every step. Collective.
Energies compute_energies(const Model& model, Reductions& ranks);

/// Only what energy_balance() needs of compute_totals, bitwise identical. Collective.
Totals compute_energy_totals(const Model& model, Reductions& ranks);

struct EnergyBalance {
  double total = 0;  ///< kinetic + internal of the particles present
  /// Present and removed energy, that of the particles at one instant (Ledger::internal_lead), and what
  /// contact has dissipated, less external work and initial energy; relative to the largest of these.
  double relative_drift = 0;
  double initial_share = 0;  ///< initial energy, relative to the same
  double scale = 0;          ///< that energy
};
EnergyBalance energy_balance(const Totals& totals, double initial_energy);

/// What contact has done between two components since time zero.
struct ContactPairTotals {
  Vec3<double> impulse{};  ///< on the second
  double friction_heat = 0;
};
/// By ContactPairs::number; empty without contact. Collective.
std::vector<ContactPairTotals> contact_pair_totals(const Model& model, Reductions& ranks);

/// Cells with at least one particle. Collective.
std::int64_t occupied_cells(const Model& model, Reductions& ranks);

}  // namespace mpm::core
