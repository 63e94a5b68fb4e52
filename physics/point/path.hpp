// Loading paths for one particle: legs one after the other, each of which prescribes some components of the
// strain and some of the stress, as a laboratory does. Shown by tests/physics/path_test.cpp.
#pragma once

#include <functional>
#include <vector>

#include "core/tensor/tensor.hpp"
#include "physics/point/leg.hpp"
#include "physics/point/point_driver.hpp"

namespace mpm::physics {

/// Where the walk stands; for output.
struct PathPoint {
  int leg = 0;
  double strain = 0;                ///< of the leg's measure
  core::Sym3<double> total_strain;  ///< integral of the rate of deformation
};

/// How a walk ended. Where a stress could not be reached the state is that of the last good step.
struct PathEnd {
  bool reached = true;
  int leg = 0;
  double wanted = 0;  ///< the stress that drives the leg, else the one that is to stay
  double found = 0;   ///< how near the walk came
};

/// Walks the legs; `visit` is called before the first and after every step.
PathEnd walk(PointDriver& point, const std::vector<Leg>& legs,
             const std::function<void(const PathPoint&)>& visit);

}  // namespace mpm::physics
