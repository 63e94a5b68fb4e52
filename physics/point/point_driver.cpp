#include "physics/point/point_driver.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace mpm::physics {

using core::Column;
using core::Mat3;

PointDriver::PointDriver(const core::ConstitutiveModel& model, const Options& options)
    : PointDriver(model, options, [&model](core::Batch& batch, const core::UpdateOptions& update_options) {
        model.update(batch, update_options);
      }) {}

PointDriver::PointDriver(const core::ConstitutiveModel& model, const Options& options, Update update)
    : model_(model), options_(options.update), update_(std::move(update)) {
  core::ColumnSet set = core::ColumnSet::mechanics();
  set.add(model.columns(options.update));
  set.add(Column::sound_speed);
  set.add(options.extra_columns);
  layout_ = core::ColumnLayout(set);
  block_.assign(static_cast<std::size_t>(layout_.block_doubles()), 0.0);
  const double density = options.density > 0 ? options.density : model.reference_density();
  this->set(Column::mass, density);
  this->set(Column::volume, 1.0);
  if (options.temperature > 0) this->set(Column::temperature, options.temperature);

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

void PointDriver::prepare(const Mat3<double>& l, double dt) {
  const double components[9] = {l.xx, l.xy, l.xz, l.yx, l.yy, l.yz, l.zx, l.zy, l.zz};
  for (int i = 0; i < 9; ++i) std::fill_n(batch_.gradient[i], core::block_lanes, components[i]);
  std::fill_n(batch_.cell_volumetric_strain, core::block_lanes, dt * (l.xx + l.yy + l.zz));
  batch_.dt = dt;
}

void PointDriver::step(const Mat3<double>& l, double dt) {
  prepare(l, dt);
  batch_.time += dt;
  update_(batch_, options_);
}

PointDriver::Tangent PointDriver::tangent(const Mat3<double>& l, double dt) {
  prepare(l, dt);
  core::Batch batch = batch_;
  batch.time += dt;
  const auto rows = std::make_unique<core::StressTangent>();
  model_.tangent(batch, options_, *rows);
  Tangent tangent;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 9; ++k) tangent[i][k] = rows->d[i][k][0];
  }
  return tangent;
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

}  // namespace mpm::physics
