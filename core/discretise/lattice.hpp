#pragma once
// Round shapes cut out of orthogonal lattices: layers along local Z, each a square lattice of its own spacing
// with points at the odd multiples of half the spacing from the axis. A point (2i + 1, 2j + 1) of a layer
// belongs to the shape when its sum of squares is between two integers; so nothing depends on round-off, and
// mirrored points have exactly mirrored coordinates. A particle's volume is spacing^3.

#include <array>
#include <cstdint>
#include <vector>

#include "core/discretise/frame.hpp"
#include "core/discretise/rows.hpp"
#include "core/discretise/sweep.hpp"

namespace mpm::core {

/// One layer of a round shape: inner <= (2i + 1)^2 + (2j + 1)^2 <= outer.
struct Layer {
  double z = 0;  ///< local frame
  double spacing = 0;
  std::int64_t inner = 0;
  std::int64_t outer = 0;
};

class LayeredLattice : public RowSource {
 protected:
  /// centre: of all layers, local frame. Spans of layers follow with set_layers.
  LayeredLattice(const Position& centre, double angle, const Frame& frame, double density);

  /// layers, half_columns: integers of any size; half_columns: points from the axis to the rim of the widest
  /// layer.
  void set_layers(double layers, double half_columns);

  const Position& centre() const { return centre_; }
  const Sweep& sweep() const { return sweep_; }
  Box to_global(const Box& box) const { return frame_.to_global(box); }
  /// box about the axis, moved to the centre, in the global frame
  Box placed(Box box) const;

 private:
  virtual Layer layer(std::uint64_t k) const = 0;
  /// Columns of a layer's row that belong to the shape: left and right of the axis.
  std::array<Span, 2> columns(const Layer& layer, std::int64_t row) const;
  void append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                  std::vector<Seed>& out) const final;

  Position centre_;
  Sweep sweep_;
  Frame frame_;
  double density_;
  std::int64_t first_row_ = 0;     ///< lattice index j of row 0 of a layer
  std::int64_t first_column_ = 0;  ///< lattice index i of column 0
  std::uint64_t layer_rows_ = 1;
};

/// Sphere or spherical shell: a point is inside when inner radius <= distance <= outer radius.
class BallLattice final : public LayeredLattice {
 public:
  BallLattice(const SphereGeometry& ball, const Frame& frame, double density);

  double expected_particles() const override;
  Box bounds() const override;
  double solid_volume() const override;

 private:
  Layer layer(std::uint64_t k) const override;

  SphereGeometry ball_;
  std::int64_t inner_ = 0;  ///< smallest and largest sum of three squares that is inside
  std::int64_t outer_ = 0;
  std::int64_t first_layer_ = 0;
};

/// Largest and smallest sum of squares of odd multiples of half the spacing within a radius.
std::int64_t outer_limit(double radius, double spacing);
std::int64_t inner_limit(double radius, double spacing);

/// Volume of a sphere's part.
double ball_volume(const SphereGeometry& ball);
/// Box around a sphere's part, about its centre.
Box ball_box(const SphereGeometry& ball);

}  // namespace mpm::core
