#include "parallel/particle_messages.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace mpm::parallel {

using core::MigrationBuffer;

namespace {

constexpr std::size_t head_doubles = sizeof(MigrationBuffer::Head) / sizeof(double);
static_assert(head_doubles * sizeof(double) == sizeof(MigrationBuffer::Head));

std::size_t columns(std::span<const int> columns_of, std::int32_t body) {
  if (body < 0 || static_cast<std::size_t>(body) >= columns_of.size()) {
    throw std::logic_error("a migrating particle has the body number " + std::to_string(body) +
                           ", which does not exist");
  }
  return static_cast<std::size_t>(columns_of[static_cast<std::size_t>(body)]);
}

}  // namespace

ParticleMessages pack(const MigrationBuffer& particles, std::span<const std::uint32_t> destination,
                      std::size_t destinations, std::span<const int> columns_of) {
  ParticleMessages messages;
  messages.begin.resize(destinations + 1);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (destination[i] == destinations) continue;
    messages.begin[destination[i] + 1] += head_doubles + columns(columns_of, particles.heads[i].body);
  }
  for (std::size_t d = 0; d < destinations; ++d) messages.begin[d + 1] += messages.begin[d];
  messages.data.resize(messages.begin.back());

  std::vector<std::size_t> next(messages.begin.begin(), messages.begin.end() - 1);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (destination[i] == destinations) continue;
    double* to = messages.data.data() + next[destination[i]];
    const std::size_t n = columns(columns_of, particles.heads[i].body);
    std::memcpy(to, &particles.heads[i], sizeof(MigrationBuffer::Head));
    std::copy_n(particles.columns.data() + particles.offsets[i], n, to + head_doubles);
    next[destination[i]] += head_doubles + n;
  }
  return messages;
}

void drop_packed(MigrationBuffer& particles, std::span<const std::uint32_t> destination,
                 std::size_t destinations) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (destination[i] != destinations) continue;
    particles.heads[kept] = particles.heads[i];
    particles.offsets[kept] = particles.offsets[i];
    ++kept;
  }
  particles.heads.resize(kept);
  particles.offsets.resize(kept);
}

void unpack(MigrationBuffer& particles, std::size_t begin, std::span<const int> columns_of) {
  const std::vector<double>& data = particles.columns;
  for (std::size_t at = begin; at < data.size();) {
    MigrationBuffer::Head head;
    const bool has_head = at + head_doubles <= data.size();
    if (has_head) std::memcpy(static_cast<void*>(&head), data.data() + at, sizeof head);
    const std::size_t end = at + head_doubles + (has_head ? columns(columns_of, head.body) : 0);
    if (end > data.size()) throw std::logic_error("a message of migrating particles ends within a particle");
    particles.heads.push_back(head);
    particles.offsets.push_back(at + head_doubles);
    at = end;
  }
}

}  // namespace mpm::parallel
