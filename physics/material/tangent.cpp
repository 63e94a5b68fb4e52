// The tangent of a material, by an update with dual numbers in place of its vectors.
//
// The stages of an update pass values to each other through the rows of the batch and the columns of the
// blocks. Block by block, the input is copied to a batch whose memory is followed by that of its derivatives
// (core/simd/dual.hpp); those of the gradient's rows are d(L)/d(dt L), those of the columns zero.

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>

#include "physics/material/material.hpp"

namespace mpm::physics {

using core::Column;
using core::ColumnLayout;
using core::ColumnSet;

namespace {

constexpr int lanes = core::block_lanes, directions = directions_per_sweep;
constexpr std::array stress_columns{Column::s_xx, Column::s_yy, Column::s_zz,
                                    Column::s_xy, Column::s_yz, Column::s_xz};

/// Memory for one block and its derivatives, one per thread.
class DualBlock {
 public:
  DualBlock() : values_(new (memory_) Values{}) {
    std::memset(memory_ + sizeof(Values), 0, sizeof memory_ - sizeof(Values));
    values_->batch.blocks = 1;
    values_->batch.block[0] = values_->columns;
  }
  DualBlock(const DualBlock&) = delete;
  DualBlock& operator=(const DualBlock&) = delete;

  core::Batch& batch() { return values_->batch; }

  /// The block's particles before the step; `layout` holds the columns that the update needs.
  void take(const core::Batch& from, int b, const ColumnLayout& layout) {
    core::Batch& to = batch();
    to.layout = &layout;
    to.particles = std::min(from.particles - lanes * b, lanes);
    to.time = from.time, to.dt = from.dt, to.cell_size = from.cell_size;
    for (int i = 0; i < 9; ++i) std::copy_n(from.gradient[i] + lanes * b, lanes, to.gradient[i]);
    std::copy_n(from.cell_volumetric_strain + lanes * b, lanes, to.cell_volumetric_strain);
    for (int c = 0; c < core::column_count; ++c) {
      const int at = layout.offset(static_cast<Column>(c));
      if (at < 0) continue;
      std::copy_n(from.block[b] + from.layout->offset(static_cast<Column>(c)), lanes, values_->columns + at);
    }
  }
  /// The derivatives before the step with respect to the components of h from `first` on.
  void differentiate(int first) {
    core::Batch& b = batch();
    for (int k = 0; k < directions; ++k) {
      std::fill_n(derivative(values_->columns, k), b.layout->block_doubles(), 0.0);
      for (int i = 0; i < 9; ++i)
        std::fill_n(derivative(b.gradient[i], k), lanes, i == first + k ? 1 / b.dt : 0.0);
    }
  }
  /// Derivative k of the stress after the step to `result`, whose rows are for the derivatives with respect
  /// to the k-th component from `first` on; `lane`: of the block's first particle in the rows.
  void give(core::StressTangent& result, int first, int lane) {
    for (int k = 0; k < directions; ++k) {
      const double* const p = column_derivative(Column::pressure, k);
      const double* const q = column_derivative(Column::viscous_pressure, k);
      for (std::size_t i = 0; i < stress_columns.size(); ++i) {
        const double* const s = column_derivative(stress_columns[i], k);
        double* const d = result.d[i][first + k] + lane;
        const double isotropic = i < 3 ? 1 : 0;
        for (int n = 0; n < lanes; ++n) d[n] = s[n] - isotropic * (p[n] + q[n]);
      }
    }
  }

 private:
  struct Values {
    alignas(64) core::Batch batch;
    alignas(64) double columns[core::column_count * lanes];
  };
  static constexpr std::size_t stride = sizeof(double) * core::shadow_distance;
  static_assert(sizeof(Values) <= stride, "enlarge core::shadow_distance, to an odd number of cache lines");

  static double* derivative(double* value, int k) { return value + (k + 1) * core::shadow_distance; }
  const double* column_derivative(Column c, int k) { return derivative(batch().column(c, 0), k); }

  alignas(64) std::byte memory_[(directions + 1) * stride];
  Values* values_;
};

DualBlock& dual_block() {
  thread_local const std::unique_ptr<DualBlock> block = std::make_unique<DualBlock>();
  return *block;
}

}  // namespace

std::string Material::tangent_fault() const {
  const auto has = [](const std::string& what) { return "has " + what + ", for which there is no tangent"; };
  if (!strength_traits_.has_tangent) return has("the StrengthModel " + std::string(strength_traits_.name));
  const EosTraits eos = laws_.eos->traits();
  if (!eos.has_tangent) return has("the EquationOfState " + std::string(eos.name));
  if (!laws_.failures.empty()) return has("a FailureModel, or damage that makes it fail");
  if (fails_) return has("a limit of tension");
  if (laws_.common.conductivity > 0) return has("heat conduction");
  if (expands_) return has("thermal expansion");
  if (viscous_) return has("shear viscosity");
  return {};
}

void Material::tangent(const core::Batch& batch, const core::UpdateOptions& options,
                       core::StressTangent& result) const {
  const std::string fault = tangent_fault();
  if (!fault.empty()) throw std::logic_error(name() + " " + fault);
  ColumnSet needed{Column::mass, Column::volume, Column::pressure, Column::viscous_pressure,
                   Column::internal_energy};
  for (const Column c : stress_columns) needed.add(c);
  needed.add(columns(options));
  const ColumnLayout layout(needed);
  DualBlock& block = dual_block();
  for (int b = 0; b < batch.blocks; ++b) {
    for (int first = 0; first < 9; first += directions) {
      block.take(batch, b, layout);
      block.differentiate(first);
      differentiate_update(block.batch(), options);
      block.give(result, first, lanes * b);
    }
  }
}

}  // namespace mpm::physics
