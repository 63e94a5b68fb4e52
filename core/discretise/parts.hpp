#pragma once
// The bodies from which a body is made: itself and, for a Bool body, its operands and theirs.

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/scene/scene.hpp"

namespace mpm::core {

class Parts {
 public:
  /// Limit on the shapes of a body, each counted as often as it is used. Bounds the depth of a Bool body and
  /// the work per particle.
  static constexpr double most_shapes = 1000;

  Parts(const Scene& scene, const BodyInput& body);

  /// Each body once, the body itself first; not all of them unless whole().
  const std::vector<const BodyInput*>& bodies() const { return bodies_; }
  /// Number of shapes in the expression of the body, each counted as often as it is used.
  double shapes() const { return shapes_; }
  bool too_many() const { return shapes_ > most_shapes || cut_; }
  /// The names on the path from the body through its operands back to itself; empty if there is none.
  const std::vector<std::string>& circle() const { return circle_; }
  /// Whether the path starts with the subtracted body.
  bool circle_by_subtrahend() const { return circle_by_subtrahend_; }
  /// True if no operand is missing, no body is made of itself, and there are not too many shapes.
  bool whole() const { return !missing_ && !circular_ && !too_many(); }

 private:
  double shapes_of(const BodyInput& part);

  const Scene& scene_;
  std::vector<const BodyInput*> bodies_;
  std::unordered_map<const BodyInput*, double> seen_;  ///< shapes; 0 while being counted
  std::vector<const BodyInput*> path_;
  std::vector<std::string> circle_;
  double shapes_ = 0;
  bool by_subtrahend_ = false, circle_by_subtrahend_ = false;
  bool missing_ = false, circular_ = false, cut_ = false;
};

}  // namespace mpm::core
