#include "parallel/mpi_transport.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "parallel/particle_messages.hpp"

namespace mpm::parallel {

using core::BrickCoord;
using core::BrickGrid;
using core::MigrationBuffer;

namespace {

constexpr int tag_migrate = 3;

[[noreturn]] void throw_lost(const MigrationBuffer::Head& head, const std::string& why) {
  const BrickCoord to = head.to;
  throw std::logic_error("a particle of body " + std::to_string(head.body) + " migrates to brick (" +
                         std::to_string(to.x) + ", " + std::to_string(to.y) + ", " + std::to_string(to.z) +
                         "), which " + why);
}

std::int32_t existing(std::int32_t owner, const MigrationBuffer::Head& head) {
  if (owner == core::BrickDirectory::no_owner) throw_lost(head, "does not exist");
  return owner;
}

}  // namespace

void MpiTransport::migrate(const BrickGrid& grid, MigrationBuffer& particles,
                           std::span<const int> columns_of) {
  const std::vector<HaloPartner>& partners = halo_.partners(grid);
  const auto stays = static_cast<std::ptrdiff_t>(partners.size());
  std::vector<std::uint32_t> destination;
  destination.reserve(particles.size());
  for (const MigrationBuffer::Head& head : particles.heads) {
    const std::int32_t owner = existing(bricks_.owner_nearby(head.to), head);
    const auto p = std::lower_bound(partners.begin(), partners.end(), owner,
                                    [](const HaloPartner& h, std::int32_t r) { return h.rank < r; });
    const bool is_partner = p != partners.end() && p->rank == owner;
    if (owner != comm_.rank() && !is_partner) {
      throw_lost(head, "belongs to rank " + std::to_string(owner) +
                           ", but no brick of that rank is next to one of rank " +
                           std::to_string(comm_.rank()));
    }
    destination.push_back(static_cast<std::uint32_t>(is_partner ? p - partners.begin() : stays));
  }

  const ParticleMessages messages = pack(particles, destination, partners.size(), columns_of);
  Requests requests;
  for (std::size_t p = 0; p < partners.size(); ++p) {
    requests.send_unannounced(comm_, messages.of(p).data(), messages.of(p).size_bytes(), partners[p].rank,
                              tag_migrate);
  }
  drop_packed(particles, destination, partners.size());
  const std::size_t arrivals = particles.columns.size();
  for (const HaloPartner& p : partners) comm_.receive_onto(particles.columns, p.rank, tag_migrate);
  requests.wait_all();
  unpack(particles, arrivals, columns_of);
}

void MpiTransport::scatter(MigrationBuffer& particles, std::span<const int> columns_of) {
  std::vector<BrickCoord> bricks;
  for (const MigrationBuffer::Head& head : particles.heads) bricks.push_back(head.to);
  const std::vector<std::int32_t> owners = bricks_.owners(bricks);
  std::vector<std::uint32_t> destination;
  destination.reserve(particles.size());
  for (std::size_t i = 0; i < owners.size(); ++i)
    destination.push_back(static_cast<std::uint32_t>(existing(owners[i], particles.heads[i])));
  const ParticleMessages messages =
      pack(particles, destination, static_cast<std::size_t>(comm_.size()), columns_of);
  particles = {};  // at most twice the particles at any time
  particles.columns = comm_.all_to_all(std::span<const double>(messages.data), messages.begin);
  unpack(particles, 0, columns_of);
}

}  // namespace mpm::parallel
