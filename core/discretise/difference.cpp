#include "core/discretise/difference.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mpm::core {

DifferenceSource::DifferenceSource(std::unique_ptr<SeedSource> minuend, InsideTest subtrahend,
                                   const Frame& frame)
    : minuend_(std::move(minuend)), subtrahend_(std::move(subtrahend)), frame_(frame) {}

void DifferenceSource::generate(std::uint64_t first_unit, std::uint64_t last_unit,
                                std::vector<Seed>& out) const {
  const auto before = static_cast<std::ptrdiff_t>(out.size());
  minuend_->generate(first_unit, last_unit, out);
  const auto removed = std::remove_if(out.begin() + before, out.end(), [&](const Seed& seed) {
    return subtrahend_(seed.position, std::cbrt(seed.volume));
  });
  out.erase(removed, out.end());
  std::for_each(out.begin() + before, out.end(),
                [&](Seed& seed) { seed.position = frame_.to_global(seed.position); });
}

}  // namespace mpm::core
