// Records of all ranks, on all ranks.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/communication/reductions.hpp"

namespace mpm::core {

/// Those of each rank in their order, in the order of ranks. Collective.
template <class T>
requires std::is_trivially_copyable_v<T> std::vector<T> gather_records(std::span<const T> mine,
                                                                       Reductions& ranks) {
  std::string bytes(mine.size_bytes(), 0);
  if (!mine.empty()) std::memcpy(bytes.data(), mine.data(), bytes.size());
  std::vector<T> all;
  for (const std::string& of_rank : ranks.gather(bytes)) {
    const std::size_t first = all.size();
    all.resize(first + of_rank.size() / sizeof(T));
    if (!of_rank.empty()) std::memcpy(all.data() + first, of_rank.data(), of_rank.size());
  }
  return all;
}

}  // namespace mpm::core
