#pragma once
// Transformation between a body's work plane and the global frame. With axes along the global ones the only
// round-off is that of adding the origin.

#include <array>

#include "core/scene/scene.hpp"

namespace mpm::core {

using Position = Vec3<double>;
using Box = std::array<Position, 2>;  ///< smallest and largest coordinates

class Frame {
 public:
  Frame() = default;
  explicit Frame(const WorkPlane& plane);
  Frame(const Scene& scene, const BodyInput& body);

  Position to_global(const Position& local) const;
  Position to_local(const Position& global) const;
  /// The global box around a local one.
  Box to_global(const Box& local) const;

 private:
  Position origin_{};
  std::array<Position, 3> axes_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

}  // namespace mpm::core
