// Loading paths for one particle: legs one after the other, each of which prescribes some components of the
// strain and some of the stress, as a laboratory does. Where stress is prescribed, the strain rates that give
// it are found step by step through the material's own update, which is a black box here: Newton's method on
// trial steps, each from the saved state, with the derivatives from differences of trial steps. Shown by
// tests/physics/path_test.cpp.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/tensor/tensor.hpp"
#include "physics/point/point_driver.hpp"

namespace mpm::physics {

/// The sum of weight times component over xx, yy, zz, xy, yz, xz; so (0, 0, 0, 2, 0, 0) of a strain is
/// gamma_xy.
double weighted(const core::Sym3<double>& weights, const core::Sym3<double>& tensor);

/// A stress that is prescribed, and the rate of deformation that is free to reach it.
struct StressControl {
  core::Mat3<double> mode;    ///< velocity gradient per unit of the unknown rate
  core::Sym3<double> weight;  ///< of the Cauchy stress
  double target = 0;
  bool ramp =
      false;  ///< linear from what it is at the beginning of the leg; else the target from the first step
};

struct DeformationRow {
  double time = 0;
  core::Mat3<double> gradient;  ///< F
};

struct Leg {
  std::string kind;
  core::Mat3<double> direction{};  ///< velocity gradient per unit rate of the measure
  core::Sym3<double> measure{};    ///< which strain the leg counts, by weights of the accumulated strain
  bool from_zero = false;          ///< the measure is counted from the beginning of this leg on
  std::optional<double> strain;  ///< value of the measure at the end; without: stress alone drives, or a hold
  std::optional<double> time;    ///< duration; without: from the rate
  bool whole = false;            ///< direction is the strain of the whole leg, not per unit of the measure
  double rate = 1;               ///< of the measure, or of the first ramp's stress; > 0
  int steps = 100;
  std::vector<StressControl> controls;
  std::vector<DeformationRow> table;  ///< F over time, linear between its rows, each in `steps` steps
};

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

/// The legs of the usual tests; x is the axis. Each counts from where the run of legs of its kind began.
namespace legs {
Leg uniaxial_strain(double strain);
Leg uniaxial_stress(double strain);
/// Axial strain under a constant lateral pressure (positive in compression).
Leg triaxial(double strain, double confining_pressure);
/// Plane strain: z is held, y carries the confining pressure.
Leg biaxial(double strain, double confining_pressure);
/// x and y are strained alike, z is free.
Leg equibiaxial(double strain);
Leg simple_shear(double gamma);
/// Volumetric strain, equal in all directions.
Leg hydrostatic(double strain);
/// To a pressure, by equal strains.
Leg pressure(double pressure, double time);
Leg hold(double time);
}  // namespace legs

}  // namespace mpm::physics
