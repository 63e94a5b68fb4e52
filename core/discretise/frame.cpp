#include "core/discretise/frame.hpp"

#include <algorithm>
#include <limits>

namespace mpm::core {

Frame::Frame(const WorkPlane& plane)
    : origin_(plane.origin), axes_{plane.x_axis, plane.y_axis, plane.z_axis} {}

Frame::Frame(const Scene& scene, const BodyInput& body)
    : Frame(body.work_plane ? Frame(scene.work_planes.at(*body.work_plane)) : Frame()) {}

Position Frame::to_global(const Position& local) const {
  Position global;
  // Products with 0 and 1 and sums with 0 are exact, so aligned axes only permute and change signs.
  for (std::size_t d = 0; d < 3; ++d)
    global[d] = origin_[d] + (axes_[0][d] * local[0] + axes_[1][d] * local[1] + axes_[2][d] * local[2]);
  return global;
}

Position Frame::to_local(const Position& global) const {
  Position local;
  for (std::size_t a = 0; a < 3; ++a) {
    local[a] = 0;
    for (std::size_t d = 0; d < 3; ++d) local[a] += axes_[a][d] * (global[d] - origin_[d]);
  }
  return local;
}

Box Frame::to_global(const Box& local) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}}};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Position p =
        to_global(Position{local[corner & 1][0], local[corner >> 1 & 1][1], local[corner >> 2][2]});
    for (std::size_t d = 0; d < 3; ++d) {
      box[0][d] = std::min(box[0][d], p[d]);
      box[1][d] = std::max(box[1][d], p[d]);
    }
  }
  return box;
}

}  // namespace mpm::core
