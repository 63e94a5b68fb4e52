#pragma once
// Bool subtract: the particles of body A outside body B (inside.hpp defines inside). Identities and units are
// A's; density is the Bool body's, so that A's point masses are kept and their volumes follow. A and B are
// placed by their own work planes; a work plane of the Bool body moves the result.

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/discretise/inside.hpp"
#include "core/discretise/seeds.hpp"

namespace mpm::core {

class DifferenceSource final : public SeedSource {
 public:
  DifferenceSource(std::unique_ptr<SeedSource> minuend, InsideTest subtrahend, const Frame& frame);

  std::uint64_t units() const override { return minuend_->units(); }
  std::uint64_t identities() const override { return minuend_->identities(); }
  double expected_particles() const override { return minuend_->expected_particles(); }
  void generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const override;
  Box bounds() const override { return frame_.to_global(minuend_->bounds()); }
  double solid_volume() const override { return std::numeric_limits<double>::quiet_NaN(); }

 private:
  std::unique_ptr<SeedSource> minuend_;
  InsideTest subtrahend_;
  Frame frame_;
};

}  // namespace mpm::core
