// Contents of a restart file except the particles' rows: read and written by one rank.
//
//   /                attributes: provenance, clock, initial energy, next identity
//   /scene           attributes path, job; dataset `text`: the bytes of the .xmp
//   /grid            datasets origin, cell, cells
//   /books           exact sums as limbs (datasets), counts (attributes)
//   /cohorts       n x 4: brick key, body, particles, checksum of their rows
//   /bodies/<n>      attributes; dataset `particles`: particles x columns, in the order of /cohorts
//   /extra           datasets tracked, names (lines)
//   /extra/marks     marks of the run's other files: a dataset of bytes for each of the names
#pragma once

#include <string>
#include <vector>

#include "core/model.hpp"
#include "io/output/hdf5.hpp"
#include "io/output/particle_order.hpp"
#include "io/restart/guard.hpp"
#include "io/restart/restart.hpp"

namespace mpm::io {

struct BodyRecord {
  std::string name;
  std::string component;  ///< name
  std::string material;   ///< name
  int component_number = 0;
  int material_number = 0;
  double reference_density = 0;  ///< of the material
  bool no_output = false;
  std::vector<core::Column> columns;  ///< of a row, in order
  std::int64_t particles = 0;
  std::int64_t eroded = 0;
  std::int64_t left = 0;
  std::optional<core::RigidState> rigid;       ///< of rigid bodies in contact
  std::optional<core::ReactionSums> reaction;  ///< of all ranks
  std::vector<double> face_forces;             ///< of rigid bodies in implicit steps
};

struct RestartContents {
  core::Provenance provenance;
  core::HeaderInput header;
  core::GridGeometry grid;  ///< without boundaries and mass cutoff
  core::Clock clock;
  core::Ledger ledger;  ///< of all ranks; counts per body are in `bodies`
  double initial_energy = 0;
  std::uint64_t next_identity = 0;
  std::vector<BodyRecord> bodies;
  std::vector<TileRecord> tiles;
  RestartExtra extra;
};

/// The contents from `model` and the sums of its ledger over the ranks. Collective.
RestartContents contents_of(const core::Model& model, const RestartExtra& extra, const ParticleOrder& order,
                            core::Reductions& ranks);

/// Creates the file with space for the particles' rows. Returns their offsets. On this rank only.
std::vector<Extent> write_contents(const std::string& path, const RestartContents& contents,
                                   const core::Scene& scene);

/// Throws FileError. On this rank only.
RestartContents read_contents(const std::string& path);

/// The dataset of a body's rows, below the file.
std::string rows_name(std::size_t body);

/// Upper bound of the file's size.
std::uint64_t expected_bytes(const RestartContents& contents);

}  // namespace mpm::io
