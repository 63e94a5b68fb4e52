// drive() of point_driver.hpp, by the legs of path.hpp.

#include <cmath>

#include "physics/point/path.hpp"

namespace mpm::physics {

bool drive(PointDriver& point, const Path& path, const std::function<void(double)>& visit) {
  const auto leg_to = [&](double target) {
    switch (path.kind) {
      case PathKind::uniaxial_strain: return legs::uniaxial_strain(target);
      case PathKind::simple_shear: return legs::simple_shear(target);
      case PathKind::hydrostatic: return legs::hydrostatic(target);
      case PathKind::uniaxial_stress: return legs::uniaxial_stress(target);
      case PathKind::gradient: break;
    }
    return Leg{};
  };
  double strain = 0;
  bool reached = true;
  visit(strain);
  for (const double target : path.targets) {
    const double start = strain, length = target - start;
    if (length == 0) continue;
    Leg leg = leg_to(length);
    leg.from_zero = true;
    leg.steps = path.steps;
    leg.time = std::abs(length) / path.rate;
    int done = -1;  // the state before the first step was shown
    // A gradient need not strain at all (a rotation), so it drives by the number itself.
    if (path.kind == PathKind::gradient) {
      for (int i = 1; i <= path.steps; ++i) {
        point.step((length > 0 ? path.rate : -path.rate) * path.gradient, *leg.time / path.steps);
        visit(strain = start + length * i / path.steps);
      }
      continue;
    }
    reached = walk(point, {leg},
                   [&](const PathPoint&) {
                     if (++done > 0) visit(strain = start + length * done / path.steps);
                   })
                  .reached &&
              reached;
    strain = target;
  }
  return reached;
}

}  // namespace mpm::physics
