// Particles as they cross ranks: all that go to one rank lie one after the other, each its head, in two
// doubles, and its columns. What arrives is read in place: the message becomes the buffer's columns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/communication/particle_transport.hpp"

namespace mpm::parallel {

struct ParticleMessages {
  std::vector<double> data;
  std::vector<std::size_t> begin;  ///< destination d gets [begin[d], begin[d + 1]) of `data`
  std::span<const double> of(std::size_t destination) const {
    return std::span(data).subspan(begin[destination], begin[destination + 1] - begin[destination]);
  }
};

/// `destination[i]`, below `destinations`, is where particle i goes.
ParticleMessages pack(const core::MigrationBuffer& particles, std::span<const std::uint32_t> destination,
                      std::size_t destinations, std::span<const int> columns_of);

/// The particles in `data`. Throws std::logic_error where `data` is not what pack() makes.
core::MigrationBuffer unpack(std::vector<double> data, std::span<const int> columns_of);

}  // namespace mpm::parallel
