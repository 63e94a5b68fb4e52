#include "physics/point/point_driver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mpm::physics {

using core::Column;
using core::Mat3;

PointDriver::PointDriver(const core::ConstitutiveModel& model, const Options& options)
    : PointDriver(model, options, [&model](core::Batch& batch, const core::UpdateOptions& update_options) {
        model.update(batch, update_options);
      }) {}

PointDriver::PointDriver(const core::ConstitutiveModel& model, const Options& options, Update update)
    : options_(options.update), update_(std::move(update)) {
  core::ColumnSet set = core::ColumnSet::mechanics();
  set.add(model.columns(options.update));
  set.add(Column::sound_speed);
  set.add(options.extra_columns);
  layout_ = core::ColumnLayout(set);
  block_.assign(static_cast<std::size_t>(layout_.block_doubles()), 0.0);
  const double density = options.density > 0 ? options.density : model.reference_density();
  this->set(Column::mass, density);
  this->set(Column::volume, 1.0);

  batch_.layout = &layout_;
  batch_.blocks = 1;
  batch_.particles = 1;
  batch_.block[0] = block_.data();
  batch_.cell_size = options.cell_size;
  model.initialise(batch_, options_);
}

void PointDriver::set(Column column, double value) {
  std::fill_n(block_.begin() + layout_.offset(column), core::block_lanes, value);
}

void PointDriver::step(const Mat3<double>& l, double dt) {
  const double components[9] = {l.xx, l.xy, l.xz, l.yx, l.yy, l.yz, l.zx, l.zy, l.zz};
  for (int i = 0; i < 9; ++i) std::fill_n(batch_.gradient[i], core::block_lanes, components[i]);
  std::fill_n(batch_.cell_volumetric_strain, core::block_lanes, dt * (l.xx + l.yy + l.zz));
  batch_.dt = dt;
  batch_.time += dt;
  update_(batch_, options_);
}

core::Sym3<double> PointDriver::deviator() const {
  return {value(Column::s_xx), value(Column::s_yy), value(Column::s_zz),
          value(Column::s_xy), value(Column::s_yz), value(Column::s_xz)};
}

core::Sym3<double> PointDriver::stress() const {
  const double p = value(Column::pressure) + value(Column::viscous_pressure);
  return deviator() - core::Sym3<double>{p, p, p, 0, 0, 0};
}

void PointDriver::restore(const State& state) {
  std::copy(state.block.begin(), state.block.end(), block_.begin());
  batch_.time = state.time;
  batch_.events = state.events;
}

namespace {

Mat3<double> scaled(double k, const Mat3<double>& a) {
  return {k * a.xx, k * a.xy, k * a.xz, k * a.yx, k * a.yy, k * a.yz, k * a.zx, k * a.zy, k * a.zz};
}

/// One step of uniaxial stress. The lateral stress grows with the lateral rate, so its root is bracketed and
/// then found by the secant, with bisection as the safeguard. `ratio`, lateral over axial rate, starts from
/// the last step's and is returned in place.
bool step_without_lateral_stress(PointDriver& point, double axial_rate, double dt, double& ratio) {
  const PointDriver::State before = point.save();
  double scale = 0;
  const auto lateral_stress = [&](double r) {
    point.restore(before);
    point.step({axial_rate, 0, 0, 0, r * axial_rate, 0, 0, 0, r * axial_rate}, dt);
    const core::Sym3<double> stress = point.stress();
    scale = std::max({scale, std::abs(stress.xx), std::abs(stress.yy)});
    return axial_rate > 0 ? stress.yy : -stress.yy;  // grows with r either way
  };
  double low = ratio - 0.05, high = ratio + 0.05;
  double f_low = lateral_stress(low), f_high = lateral_stress(high);
  for (double width = 0.1; f_low > 0 && width < 1e3; width *= 2) f_low = lateral_stress(low -= width);
  for (double width = 0.1; f_high < 0 && width < 1e3; width *= 2) f_high = lateral_stress(high += width);
  if (f_low > 0 || f_high < 0) return scale == 0;
  for (int i = 0; i < 200; ++i) {
    double next = low - f_low * (high - low) / (f_high - f_low);
    // The secant creeps where one end stays: every third step halves the bracket.
    if (i % 3 == 2 || !(next > low && next < high)) next = 0.5 * (low + high);
    const double f = lateral_stress(ratio = next);
    if (std::abs(f) <= 1e-9 * scale || high - low <= 1e-15 * std::max(1.0, std::abs(next))) {
      return std::abs(f) <= 1e-6 * scale;
    }
    (f > 0 ? high : low) = next;
    (f > 0 ? f_high : f_low) = f;
  }
  return false;
}

}  // namespace

bool drive(PointDriver& point, const Path& path, const std::function<void(double)>& visit) {
  double strain = 0, ratio = -0.3;
  bool converged = true;
  visit(strain);
  for (const double target : path.targets) {
    const double start = strain, length = target - start;
    if (length == 0) continue;
    const double rate = length > 0 ? path.rate : -path.rate;
    const double dt = length / rate / path.steps;
    for (int i = 1; i <= path.steps; ++i) {
      switch (path.kind) {
        case PathKind::uniaxial_strain: point.step({rate, 0, 0, 0, 0, 0, 0, 0, 0}, dt); break;
        case PathKind::simple_shear: point.step({0, rate, 0, 0, 0, 0, 0, 0, 0}, dt); break;
        case PathKind::hydrostatic: point.step({rate / 3, 0, 0, 0, rate / 3, 0, 0, 0, rate / 3}, dt); break;
        case PathKind::gradient: point.step(scaled(rate, path.gradient), dt); break;
        case PathKind::uniaxial_stress:
          converged = step_without_lateral_stress(point, rate, dt, ratio) && converged;
          break;
      }
      strain = start + length * i / path.steps;
      visit(strain);
    }
  }
  return converged;
}

}  // namespace mpm::physics
