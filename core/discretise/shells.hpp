#pragma once
// Particles of spheres in spherical shells: round((outer - inner)/dp) shells of equal thickness; each
// hemisphere of a shell is cut into bands of equal polar angle, each band into arcs of about dp. A particle
// is at its cell's centroid along each of r, cos(polar angle) and azimuth, and has its cell's volume; all
// cells together are the solid, to round-off. Hemispheres and quadrants are bitwise mirror images.

#include <cstdint>
#include <vector>

#include "core/discretise/frame.hpp"
#include "core/discretise/rows.hpp"
#include "core/discretise/sweep.hpp"

namespace mpm::core {

class ShellSource final : public RowSource {
 public:
  ShellSource(const SphereGeometry& ball, const Frame& frame, double density);

  double expected_particles() const override;
  Box bounds() const override;
  double solid_volume() const override;

 private:
  void append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                  std::vector<Seed>& out) const override;

  SphereGeometry ball_;
  Sweep sweep_;
  Frame frame_;
  double density_;
  double shells_;
  std::uint64_t most_bands_ = 1;  ///< per hemisphere
  std::uint64_t shell_rows_ = 1;
};

}  // namespace mpm::core
