#include "core/communication/solo.hpp"

#include <algorithm>

#include "core/counts.hpp"

namespace mpm::core {

namespace {
std::vector<BrickCoord> owned_bricks(const BrickGrid& grid) {
  std::vector<BrickCoord> owned;
  for (const Brick& b : grid.bricks()) owned.push_back(b.coord);
  return owned;
}
}  // namespace

void check_decomposition(const DecompositionInput& how, int ranks) {
  if (!how.dimensions) return;
  const auto [x, y, z] = *how.dimensions;
  const std::optional<std::int64_t> parts = product_of({x, y, z});
  if (parts == ranks && x > 0 && y > 0 && z > 0) return;
  throw InputErrors(
      how.source, "DomainDecomposition",
      "dimension0 * dimension1 * dimension2 = " + (parts ? std::to_string(*parts) : "more than 2^63") +
          " must equal the number of ranks, which is " + std::to_string(ranks) +
          "; start that many ranks, change the dimensions, or remove the element");
}

void SoloDirectory::partition(BrickGrid& grid, std::span<const BrickCount> counts,
                              const DecompositionInput& how) {
  check_decomposition(how, 1);
  std::vector<BrickCoord> owned;
  for (const BrickCount& c : counts) owned.push_back(c.brick);
  std::sort(owned.begin(), owned.end());
  owned.erase(std::unique(owned.begin(), owned.end()), owned.end());
  grid.reset(std::move(owned), {});
}

void SoloDirectory::activate(BrickGrid& grid, std::span<const BrickCoord> wanted) {
  std::vector<BrickCoord> owned = owned_bricks(grid);
  const std::size_t before = owned.size();
  for (BrickCoord b : wanted) {
    if (grid.find(b) == no_slot) owned.push_back(b);
  }
  std::sort(owned.begin(), owned.end());
  owned.erase(std::unique(owned.begin(), owned.end()), owned.end());
  if (owned.size() != before) grid.reset(std::move(owned), {});
}

void SoloDirectory::deactivate(BrickGrid& grid, std::span<const BrickCoord> empty) {
  if (empty.empty()) return;
  std::vector<BrickCoord> owned = owned_bricks(grid);
  std::vector<BrickCoord> sorted(empty.begin(), empty.end());
  std::sort(sorted.begin(), sorted.end());
  std::erase_if(owned, [&](BrickCoord b) { return std::binary_search(sorted.begin(), sorted.end(), b); });
  grid.reset(std::move(owned), {});
}

}  // namespace mpm::core
