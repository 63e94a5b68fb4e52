// The plane between two bodies near a node, by regression on their particles: its normal is the one that
// contact uses with contact_normal="regression" (Nairn, Hammerquist and Smith, CMAME 362 (2020) 112859, for
// the idea and the equal weights of particles).
//
// Particles at x (in cells from the node) of the first body have the label c = -1, of the second c = +1. A
// linear regression of the labels, c ~ n.x + b, gives a first plane. It tilts at the edge of a body on a
// wider one, because particles far from the plane pull it as if they lay on the wrong side. So the
// regression is repeated, each time with the particles alone that are on the wrong side of their own label,
// c (n.x + b) < 1, until these stay the same. This is Newton's method for the minimum of
//   F(n, b) = lambda/2 n.n + 1/2 sum max(0, 1 - c (n.x + b))^2
// which is convex, with steps halved where F would grow (Mangasarian, Optim. Methods Softw. 17 (2002) 913).
// For clouds with a gap it is, but for lambda, the plane as far as possible from both, and only the layers
// that face each other count. A logistic regression minimises sum log(1 + exp(-c (n.x + b))) and a penalty
// instead; docs/contact.md compares the two.
//
// lambda > 0 makes the minimum unique for any clouds: of one particle each, the normal is along the line
// between them, and of particles in a plane in that plane.
#pragma once

#include <optional>
#include <vector>

#include "core/simd/lanes.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// Particles of two bodies near a node, in cells from it.
class LabelledPoints {
 public:
  static constexpr int lanes = 8;
  using Row = Lanes<lanes>;

  void clear() { blocks_.clear(); }
  /// labels: -1 for the first body, +1 for the second, 0 in lanes without a particle.
  void add(const Row& x, const Row& y, const Row& z, const Row& labels) {
    blocks_.push_back({{x, y, z, labels}});
  }
  void add(const LabelledPoints& other, std::size_t block) { blocks_.push_back(other.blocks_[block]); }
  std::size_t blocks() const { return blocks_.size(); }
  /// `row` 0..2: coordinates; 3: labels.
  const Row& row(std::size_t block, int row) const { return blocks_[block].row[row]; }

 private:
  struct Block {
    Row row[4];
  };
  std::vector<Block> blocks_;
};

/// Unit vector from the first body to the second. None without particles of both, or where nothing tells
/// them apart. `near`: scratch memory.
std::optional<Vec3<double>> separating_normal(const LabelledPoints& points, LabelledPoints& near);

}  // namespace mpm::core
