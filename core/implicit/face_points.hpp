// Points on the faces of rigid bodies: the middle of each side of a particle on which the body ends.
//
// A body ends where its lattice does: where no other of its particles lies in the direction of an axis of
// its frame. The normals of a block are those axes. A lattice steps along a curved face: there the normal is
// the mean of those around a point, and sides that face away from it have none. Particles that lie in rings,
// in layers of other spacings or as an input gives them have no lattice, which shows in the sides that do not
// enclose their volume: such bodies have no points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"

namespace mpm::core {

struct FacePoint {
  int body = 0;
  Vec3<double> place{};
  Vec3<double> normal{};  ///< outward, of length 1
  double area = 0;
};

/// Of those of these bodies that have a lattice, by body and particle; the same on all ranks. Collective.
std::vector<FacePoint> find_face_points(const Model& model, std::span<const int> bodies, Reductions& ranks);

}  // namespace mpm::core
