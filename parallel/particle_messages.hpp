// Messages of migrating particles: those for one rank are stored consecutively, each as its head, in two
// doubles, and its columns. Received messages are read in place: the message becomes the buffer's columns.
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

/// `destination[i]`, below `destinations`, is the destination of particle i.
ParticleMessages pack(const core::MigrationBuffer& particles, std::span<const std::uint32_t> destination,
                      std::size_t destinations, std::span<const int> columns_of);

/// The particles in `data`. Throws std::logic_error where pack() cannot have made `data`.
core::MigrationBuffer unpack(std::vector<double> data, std::span<const int> columns_of);

}  // namespace mpm::parallel
