// A leg of a loading path: the components of strain and stress that it prescribes, and the legs of the usual
// laboratory tests.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/tensor/tensor.hpp"

namespace mpm::physics {

/// The sum of weight times component over xx, yy, zz, xy, yz, xz; so (0, 0, 0, 2, 0, 0) of a strain is
/// gamma_xy.
double weighted(const core::Sym3<double>& weights, const core::Sym3<double>& tensor);

/// A prescribed stress, and the free rate of deformation that achieves it.
struct StressControl {
  core::Mat3<double> mode;    ///< velocity gradient per unit of the unknown rate
  core::Sym3<double> weight;  ///< of the Cauchy stress
  double target = 0;
  bool ramp =
      false;  ///< linear from its value at the beginning of the leg; else the target from the first step
};

struct DeformationRow {
  double time = 0;
  core::Mat3<double> gradient;  ///< F
};

struct Leg {
  std::string kind;
  core::Mat3<double> direction{};  ///< velocity gradient per unit rate of the measure
  core::Sym3<double> measure{};    ///< the strain that the leg controls, by weights of the accumulated strain
  bool from_zero = false;          ///< the measure starts at zero with this leg
  std::optional<double>
      strain;  ///< value of the measure at the end; without it, stress alone drives the leg, or it is a hold
  std::optional<double> time;  ///< duration; without: from the rate
  bool whole = false;          ///< direction is the strain of the whole leg, not per unit of the measure
  double rate = 1;             ///< of the measure, or of the first ramp's stress; > 0
  int steps = 100;
  std::vector<StressControl> controls;
  std::vector<DeformationRow> table;  ///< F over time, linear between its rows, each in `steps` steps
};

/// The legs of the usual tests; x is the axis. Each is measured from the start of consecutive legs of its
/// kind.
namespace legs {
Leg uniaxial_strain(double strain);
Leg uniaxial_stress(double strain);
/// Axial strain under a constant lateral pressure (positive in compression).
Leg triaxial(double strain, double confining_pressure);
/// Plane strain: z is held, y carries the confining pressure.
Leg biaxial(double strain, double confining_pressure);
/// x and y are strained equally, z is free.
Leg equibiaxial(double strain);
Leg simple_shear(double gamma);
/// Volumetric strain, equal in all directions.
Leg hydrostatic(double strain);
/// To a pressure, by equal strains.
Leg pressure(double pressure, double time);
Leg hold(double time);
}  // namespace legs

}  // namespace mpm::physics
