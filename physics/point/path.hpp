// Loading paths for one particle: a sequence of legs, each of which prescribes some components of the strain
// and some of the stress, as in a laboratory. Tested by tests/physics/path_test.cpp.
#pragma once

#include <functional>
#include <vector>

#include "core/tensor/tensor.hpp"
#include "physics/point/leg.hpp"
#include "physics/point/point_driver.hpp"

namespace mpm::physics {

/// State along the path, for output.
struct PathPoint {
  int leg = 0;
  double strain = 0;                ///< of the leg's measure
  core::Sym3<double> total_strain;  ///< integral of the rate of deformation
};

/// Result of a path. If a stress could not be reached, the state is that of the last converged step.
struct PathEnd {
  bool reached = true;
  int leg = 0;
  double wanted = 0;  ///< the driving stress of the leg, or else the one to be held
  double found = 0;   ///< the closest value reached
};

/// Follows the legs; `visit` is called before the first and after every step.
PathEnd walk(PointDriver& point, const std::vector<Leg>& legs,
             const std::function<void(const PathPoint&)>& visit);

}  // namespace mpm::physics
