#include "core/discretise/block.hpp"

#include "core/discretise/line.hpp"

namespace mpm::core {

BlockSource::BlockSource(const BlockGeometry& block, const Frame& frame, double density)
    : block_(block), frame_(frame), density_(density) {
  for (std::size_t d = 0; d < 3; ++d) counts_[d] = whole_count(block.size[d], block.spacing);
  set_extent(counts_[1] * counts_[2], counts_[0]);
}

void BlockSource::append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                             std::vector<Seed>& out) const {
  const double h = block_.spacing;
  const auto ny = static_cast<std::uint64_t>(counts_[1]);
  const LatticeLine x(block_.origin[0], h);
  const double y = LatticeLine(block_.origin[1], h).at(odd(row % ny));
  const double z = LatticeLine(block_.origin[2], h).at(odd(row / ny));
  const double volume = h * h * h;
  for (std::uint64_t i = first; i < last; ++i)
    out.push_back(
        {frame_.to_global(Position{x.at(odd(i)), y, z}), density_ * volume, volume, row * width() + i});
}

Box BlockSource::bounds() const {
  Box box;
  for (std::size_t d = 0; d < 3; ++d) {
    const LatticeLine line(block_.origin[d], block_.spacing);
    box[0][d] = line.at(1);
    box[1][d] = line.at(2 * counts_[d] - 1);
  }
  return frame_.to_global(box);
}

}  // namespace mpm::core
