// Output of mpm_point: a table of the response and a plot.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/units.hpp"
#include "physics/point/path.hpp"

namespace mpm::apps {

/// Comma-separated: a line of names, a line of units, then a line per state. Units are names if the input
/// gives them ("MPa"), else dimensions ("stress").
class PointTable {
 public:
  PointTable(const physics::PointDriver& point, const std::optional<core::UnitSystem>& units);

  /// Both lines, each with a newline.
  std::string heading() const;
  std::string row(const physics::PathPoint& at) const;

  std::string unit(std::string_view dimension) const;

 private:
  struct Column;
  std::vector<Column> columns() const;

  const physics::PointDriver& point_;
  std::optional<core::UnitSystem> units_;
};

/// One state, for the plot and for the comparison with measurements.
struct PointSample {
  core::Sym3<double> strain, stress;
  double pressure = 0;  ///< minus the mean stress
  double mises = 0;
  double volume_ratio = 1;
};
PointSample sample(const physics::PointDriver& point, const physics::PathPoint& at);

/// Measured strain and stress.
struct Measurement {
  double strain = 0, stress = 0;
};
/// The columns that a heading names `strain` and `stress` (or `stress_xx`, as in a table of mpm_point), else
/// the first two. Lines that do not begin with a number are headings. Throws std::runtime_error.
std::vector<Measurement> read_measurements(const std::string& file);

/// The components that the plot and the comparison show: axial or, if larger, shear (gamma).
struct Curve {
  bool shear = false;
  std::vector<Measurement> points;
};
Curve stress_strain(const std::vector<PointSample>& samples);

/// Root mean square difference between the measured stress and the first pass of the curve through the
/// strains.
struct Misfit {
  double rms = 0;
  double largest = 0;  ///< measured stress
  int points = 0;      ///< points within reach of the curve
};
Misfit misfit(const Curve& curve, const std::vector<Measurement>& measured);

/// Stress over strain, von Mises stress over pressure, pressure over volume, as an SVG document.
std::string plot(std::string_view title, const std::vector<PointSample>& samples,
                 const std::vector<Measurement>& measured, const std::string& stress_unit);

}  // namespace mpm::apps
