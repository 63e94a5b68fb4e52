#pragma once
// Block: particles at the centres of cubes of edge dp, starting at the corner (x0, y0, z0).
// Along each axis there are round(l/dp) particles, at least one; where l is no multiple of dp the spacing
// stays dp, and the filled block is longer or shorter than l by up to half a spacing.

#include <array>
#include <cstdint>
#include <vector>

#include "core/discretise/frame.hpp"
#include "core/discretise/rows.hpp"

namespace mpm::core {

class BlockSource final : public RowSource {
 public:
  BlockSource(const BlockGeometry& block, const Frame& frame, double density);

  double expected_particles() const override { return counts_[0] * counts_[1] * counts_[2]; }
  Box bounds() const override;
  double solid_volume() const override { return block_.size[0] * block_.size[1] * block_.size[2]; }

 private:
  void append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                  std::vector<Seed>& out) const override;

  BlockGeometry block_;
  Frame frame_;
  double density_;
  Position counts_;  ///< particles along each axis, whole numbers
};

}  // namespace mpm::core
