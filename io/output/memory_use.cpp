#include "io/output/memory_use.hpp"

#include <sys/resource.h>

namespace mpm::io {

MemoryUse peak_memory(core::Reductions& ranks) {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  std::int64_t bytes = 1024 * std::int64_t{usage.ru_maxrss};
  double least = -static_cast<double>(bytes);
  ranks.minimum(std::span(&least, 1));
  ranks.sum(std::span(&bytes, 1));
  return {static_cast<std::int64_t>(-least), bytes};
}

}  // namespace mpm::io
