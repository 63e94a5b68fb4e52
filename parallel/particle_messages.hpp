// Messages of migrating particles: those for one rank are stored consecutively, each as its head, in two
// doubles, and its columns. Messages are received at the end of a
// buffer's columns and read in place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/communication/particle_transport.hpp"

namespace mpm::parallel {

struct ParticleMessages {
  std::vector<double> data;
  std::vector<std::size_t> begin;  ///< [begin[d], begin[d + 1]) of `data` is for destination d
  std::span<const double> of(std::size_t destination) const {
    return std::span(data).subspan(begin[destination], begin[destination + 1] - begin[destination]);
  }
};

/// `destination[i]` is the destination of particle i; particles with `destinations` stay and are left out.
ParticleMessages pack(const core::MigrationBuffer& particles, std::span<const std::uint32_t> destination,
                      std::size_t destinations, std::span<const int> columns_of);

/// Removes the particles that pack() has taken; the others' columns remain where they are.
void drop_packed(core::MigrationBuffer& particles, std::span<const std::uint32_t> destination,
                 std::size_t destinations);

/// Adds the particles in the messages that `columns` holds from `begin` on. Throws std::logic_error where
/// pack() cannot have made them.
void unpack(core::MigrationBuffer& particles, std::size_t begin, std::span<const int> columns_of);

}  // namespace mpm::parallel
