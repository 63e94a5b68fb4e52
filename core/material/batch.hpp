// A batch: up to 64 particles of one body, the unit in which the step and mpm_point call a material.
//
// State is in the particles' own blocks (columns of eight doubles); intermediate values between the stages of
// the update are in scratch rows here, which stay in the first-level cache.
#pragma once

#include <cstdint>

#include "core/particles/columns.hpp"
#include "core/prefetch.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::core {

inline constexpr int batch_blocks = 8;
inline constexpr int batch_particles = batch_blocks * block_lanes;

using Row = double[batch_particles];

/// A material's contribution to the counts of a step. Summed over batches, so integers.
struct MaterialEvents {
  long failed = 0;           ///< particles that failed in this step
  long negative_energy = 0;  ///< internal energy below zero (Warn ie)
  long negative_volume = 0;  ///< volume that would have become <= 0 (Warn vol)
  long volume_limited = 0;   ///< volumes limited by Volume min/max
  long not_finite = 0;       ///< stress, energy or volume that is not finite
  long undefined_root = 0;   ///< negative squares of the sound speed, and the like
  long unresolved = 0;       ///< steps too large for a strength law to reach its yield surface
  MaterialEvents& operator+=(const MaterialEvents& o) {
    failed += o.failed;
    negative_energy += o.negative_energy;
    negative_volume += o.negative_volume;
    volume_limited += o.volume_limited;
    not_finite += o.not_finite;
    undefined_root += o.undefined_root;
    unresolved += o.unresolved;
    return *this;
  }
};

struct GridGeometry;

/// The work of all stages of a material's update on a block is divided into this many parts.
inline constexpr int parts_of_update = 16;

/// The part of a step's strain that an update makes: all of it or, with USAVG, the half at the end of the
/// step or the half that is left to the start of the next one.
enum class StrainPart { all, first_half, second_half };

struct Batch {
  // --- set by the caller ---
  const ColumnLayout* layout = nullptr;
  int blocks = 0;                    ///< blocks in use
  int particles = 0;                 ///< lanes in use; the rest of the last block repeats lane 0's kinematics
  double* block[batch_blocks] = {};  ///< start of each block
  double time = 0;                   ///< at the end of the step
  double dt = 0;
  StrainPart part = StrainPart::all;
  double cell_size = 0;                ///< characteristic length of the artificial viscosity
  const GridGeometry* grid = nullptr;  ///< for `initialise`; null: a point without a grid, all is one cell
  /// Velocity gradient, row i column j = d v_i / d x_j, in the order of Mat3.
  alignas(64) Row gradient[9];
  /// Volumetric strain increment of the particle's cell; read for volume update 1 only.
  alignas(64) Row cell_volumetric_strain;

  /// Memory that the caller prefetches while the update processes each block.
  PrefetchLines background[batch_blocks] = {};
  /// Called by the stages of the update at each block: `parts` of the parts_of_update follow. Requests one
  /// prefetch cache line for each.
  [[gnu::always_inline]] void begin_parts(int b, int parts) { background[b].request(parts); }

  // --- passed between the stages of the material update ---
  alignas(64) Row volumetric_strain;  ///< trace of the strain increment
  alignas(64) Row old_volume;         ///< V^n; the column holds V^{n+1} after the kinematic stage
  alignas(64) Row deviatoric_work;    ///< 1/2 (s^n + s^{n+1}) : strain increment, per current volume
  alignas(64) Row shear_modulus;      ///< for the wave speed, of the updated state
  alignas(64) Row shear_viscosity;    ///< for the critical step, s = 2 viscosity D'
  alignas(64) Row lowest_pressure;    ///< largest tension of a strength model that limits it, as a pressure
  alignas(64) Row law_pressure;       ///< the strength law's, where it computes the pressure itself
  alignas(64) Row bulk_modulus;       ///< the same, for the wave speed
  // --- results other than the columns ---
  alignas(64) Row sound_speed;     ///< longitudinal wave speed c; filled where the layout has that column
  alignas(64) Row critical_speed;  ///< Q + sqrt(Q^2 + c^2) (thesis 2-74), or c when viscosity is ignored
  MaterialEvents events;
  /// Lanes counted in events.negative_volume and events.negative_energy, one bit each.
  std::uint64_t vanishing = 0, negative = 0;

  /// What the new artificial viscosity counts, twice, in the mean that does the work; 2 less it, the old one.
  /// The one that acts in a step of USAVG, the new one of the second half, does the work of the halves
  /// around.
  double new_viscosity() const {
    return part == StrainPart::all ? 1 : part == StrainPart::first_half ? 0 : 2;
  }
  double* column(Column c, int b) { return block[b] + layout->offset(c); }
};

}  // namespace mpm::core
