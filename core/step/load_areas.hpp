// The areas on which surface loads act (loads.hpp), summed over the particles as the steps sum the forces.
// The gradients of the shape functions of a particle sum to zero, so the force of a load with constant T is
//   sum V T grad phi = T a,   a = sum V grad phi
// and by Gauss's theorem a is the sum of the outward area vectors of the body's surface in the box. The part
// of it at a lower face of the box is the cross-section of the body there; a face outside of the body adds
// nothing, and one with less than half a ramp between it and a surface adds a part of it.
// Shown by tests/system/physics_loads.py.
#pragma once

#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"

namespace mpm::core {

struct LoadArea {
  const SurfaceLoad* load = nullptr;
  std::size_t body = 0;    ///< its number in the model
  std::size_t number = 0;  ///< of the load in its body, from 1
  Vec3<double> lower{};    ///< of the cross-sections at the box's lower faces
  Vec3<double> upper{};    ///< at its upper faces
  bool reached = false;    ///< some particle is in the box or on its ramps
  bool crossed = false;    ///< along the normal, some particle is beyond the box or on its ramps

  /// Force over stress; along the axis of a traction, positive where its normal is that axis.
  Vec3<double> net() const { return lower - upper; }
};

/// Of all surface loads, at the present places of the particles. Collective.
std::vector<LoadArea> load_areas(const Model& model, Reductions& ranks);

}  // namespace mpm::core
