#include "parallel/parcels.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace mpm::parallel {

using core::Travellers;

namespace {

constexpr std::size_t head_doubles = sizeof(Travellers::Head) / sizeof(double);
static_assert(head_doubles * sizeof(double) == sizeof(Travellers::Head));

std::size_t columns(std::span<const int> columns_of, std::int32_t body) {
  if (body < 0 || static_cast<std::size_t>(body) >= columns_of.size()) {
    throw std::logic_error("a particle travels whose body number " + std::to_string(body) +
                           " does not exist");
  }
  return static_cast<std::size_t>(columns_of[static_cast<std::size_t>(body)]);
}

}  // namespace

Parcels pack(const Travellers& travellers, std::span<const std::uint32_t> destination,
             std::size_t destinations, std::span<const int> columns_of) {
  Parcels parcels;
  parcels.begin.resize(destinations + 1);
  for (std::size_t i = 0; i < travellers.size(); ++i) {
    parcels.begin[destination[i] + 1] += head_doubles + columns(columns_of, travellers.heads[i].body);
  }
  for (std::size_t d = 0; d < destinations; ++d) parcels.begin[d + 1] += parcels.begin[d];
  parcels.data.resize(parcels.begin.back());

  std::vector<std::size_t> next(parcels.begin.begin(), parcels.begin.end() - 1);
  for (std::size_t i = 0; i < travellers.size(); ++i) {
    double* to = parcels.data.data() + next[destination[i]];
    const std::size_t n = columns(columns_of, travellers.heads[i].body);
    std::memcpy(to, &travellers.heads[i], sizeof(Travellers::Head));
    std::copy_n(travellers.columns.data() + travellers.offsets[i], n, to + head_doubles);
    next[destination[i]] += head_doubles + n;
  }
  return parcels;
}

Travellers unpack(std::vector<double> data, std::span<const int> columns_of) {
  Travellers travellers;
  for (std::size_t at = 0; at < data.size();) {
    Travellers::Head head;
    const bool has_head = at + head_doubles <= data.size();
    if (has_head) std::memcpy(static_cast<void*>(&head), data.data() + at, sizeof head);
    const std::size_t end = at + head_doubles + (has_head ? columns(columns_of, head.body) : 0);
    if (end > data.size()) throw std::logic_error("a message of travelling particles ends within a particle");
    travellers.heads.push_back(head);
    travellers.offsets.push_back(at + head_doubles);
    at = end;
  }
  travellers.columns = std::move(data);
  return travellers;
}

}  // namespace mpm::parallel
