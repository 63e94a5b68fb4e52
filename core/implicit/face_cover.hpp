// Which points on the faces of rigid bodies have material below them.
//
// The volume at the nodes does not tell where material ends within a cell (face_touch.hpp). Its particles do:
// one covers the points of a face next to it, within its own extent along the face, and half a cell across.
#pragma once

#include <span>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/contact/axis_box.hpp"
#include "core/implicit/face_points.hpp"
#include "core/implicit/place_boxes.hpp"
#include "core/model.hpp"

namespace mpm::core {

class FaceCover {
 public:
  /// `points` outlive it.
  FaceCover(const Model& model, Reductions& ranks, std::span<const FacePoint> points);

  /// By point; bodies have moved by `moved`, the same on all ranks. Collective.
  std::vector<bool> find(std::span<const Vec3<double>> moved) const;

 private:
  struct OfBody {
    int body;
    AxisBox within;  ///< where particles may cover its points
    PlaceBoxes boxes;
  };
  const Model& model_;
  Reductions& ranks_;
  std::span<const FacePoint> points_;
  double across_;  ///< to the edge of a particle
  std::vector<OfBody> bodies_;
};

}  // namespace mpm::core
