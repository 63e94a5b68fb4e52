#pragma once
// Particles of cylinders, cones, frustums and ogives: graded layers along local Z (grading.hpp), the radii of
// a layer taken at its middle. Orthogonal: each layer is a square lattice of the layer's own thickness
// (lattice.hpp). Polar: the layers are stretched evenly to fill the height; in each the wall is cut into
// rings of equal thickness close to the layer's, each ring into arcs of about the same length. A particle is
// at half the layer's height and at its arc's middle, at the radius of the cell's centroid, and has the
// cell's volume; all cells together are the solid, to round-off.

#include <cstdint>
#include <vector>

#include "core/discretise/grading.hpp"
#include "core/discretise/lattice.hpp"
#include "core/discretise/profile.hpp"

namespace mpm::core {

class RevolvedLattice final : public LayeredLattice {
 public:
  RevolvedLattice(const Revolved& solid, const Frame& frame, double density);

  double expected_particles() const override;
  Box bounds() const override;
  double solid_volume() const override;

 private:
  Layer layer(std::uint64_t k) const override;

  Revolved solid_;
  Grading grading_;
};

class RingSource final : public RowSource {
 public:
  RingSource(const Revolved& solid, const Frame& frame, double density);

  double expected_particles() const override;
  Box bounds() const override;
  double solid_volume() const override;

 private:
  void append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                  std::vector<Seed>& out) const override;

  Revolved solid_;
  Grading grading_;
  double stretch_;  ///< of the layers, to fill the height
  Sweep sweep_;
  Frame frame_;
  double density_;
  std::uint64_t layer_rings_ = 1;  ///< rows per layer, maximum over the layers
};

}  // namespace mpm::core
