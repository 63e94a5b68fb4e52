// The columns that a particle may carry. Each body carries only those that its laws, scheme or outputs need.
//
// To add one: a name here and a row in `column_table`. No other code depends on their number.
#pragma once

#include <array>
#include <bitset>
#include <initializer_list>
#include <string_view>

#include "core/simd/lanes.hpp"

namespace mpm::core {

enum class Column : int {
  position_x,
  position_y,
  position_z,
  velocity_x,
  velocity_y,
  velocity_z,
  mass,
  volume,
  // Cauchy stress = s - (p + q) I, in the global frame.
  s_xx,
  s_yy,
  s_zz,
  s_xy,
  s_yz,
  s_xz,
  pressure,
  viscous_pressure,
  internal_energy,
  identity,
  // The following exist only where a law, a scheme or an output needs them.
  effective_plastic_strain,
  yield_stress,
  damage,
  temperature,
  failed,
  void_volume,  ///< between the fragments of a failed particle: not part of its volume
  threshold_factor,
  porosity,
  max_compression,
  burn_fraction,
  lighting_time,
  plastic_volumetric_strain,
  strain_xx,
  strain_yy,
  strain_zz,
  strain_xy,
  strain_yz,
  strain_xz,
  f_xx,
  f_xy,
  f_xz,
  f_yx,
  f_yy,
  f_yz,
  f_zx,
  f_zy,
  f_zz,
  thermal_strain,
  bulking_pressure,
  sound_speed,
  // Of the particle's domain along the axes (core/shape/gimp.hpp).
  half_size_x,
  half_size_y,
  half_size_z,
  // Half edges r_1, r_2, r_3 of a parallelepiped, and corners of a hexahedron, from the particle
  // (core/shape/cpdi.hpp).
  edge_1x,
  edge_1y,
  edge_1z,
  edge_2x,
  edge_2y,
  edge_2z,
  edge_3x,
  edge_3y,
  edge_3z,
  corner_0x,
  corner_0y,
  corner_0z,
  corner_1x,
  corner_1y,
  corner_1z,
  corner_2x,
  corner_2y,
  corner_2z,
  corner_3x,
  corner_3y,
  corner_3z,
  corner_4x,
  corner_4y,
  corner_4z,
  corner_5x,
  corner_5y,
  corner_5z,
  corner_6x,
  corner_6y,
  corner_6z,
  corner_7x,
  corner_7y,
  corner_7z,
  first_x,
  first_y,
  first_z,
  // C of affine transfers (core/transfer/affine.hpp), in the order of Mat3.
  affine_xx,
  affine_xy,
  affine_xz,
  affine_yx,
  affine_yy,
  affine_yz,
  affine_zx,
  affine_zy,
  affine_zz,
  // Of generalised alpha (core/implicit/time_rule.hpp).
  acceleration_lag_x,
  acceleration_lag_y,
  acceleration_lag_z,
  // Of the limited artificial viscosity (physics/material/viscosity_limiter.hpp).
  viscosity_factor,
  velocity_divergence,  ///< of the last step
  history_0,
  history_1,
  history_2,
  history_3,
  history_4,
  history_5,
  history_6,
  history_7,
  count
};

inline constexpr int column_count = static_cast<int>(Column::count);

struct ColumnInfo {
  std::string_view name;
  std::string_view dimension;  ///< as in ParameterInfo: "length", "stress", "1", ...
};

/// Indexed by Column.
inline constexpr std::array<ColumnInfo, column_count> column_table{{
    {"position_x", "length"},
    {"position_y", "length"},
    {"position_z", "length"},
    {"velocity_x", "velocity"},
    {"velocity_y", "velocity"},
    {"velocity_z", "velocity"},
    {"mass", "mass"},
    {"volume", "volume"},
    {"s_xx", "stress"},
    {"s_yy", "stress"},
    {"s_zz", "stress"},
    {"s_xy", "stress"},
    {"s_yz", "stress"},
    {"s_xz", "stress"},
    {"pressure", "stress"},
    {"viscous_pressure", "stress"},
    {"internal_energy", "stress"},  // E of the manual: per unit initial volume
    {"identity", "1"},
    {"effective_plastic_strain", "1"},
    {"yield_stress", "stress"},
    {"damage", "1"},
    {"temperature", "temperature"},
    {"failed", "1"},
    {"void_volume", "volume"},
    {"threshold_factor", "1"},
    {"porosity", "1"},
    {"max_compression", "1"},
    {"burn_fraction", "1"},
    {"lighting_time", "time"},
    {"plastic_volumetric_strain", "1"},
    {"strain_xx", "1"},
    {"strain_yy", "1"},
    {"strain_zz", "1"},
    {"strain_xy", "1"},
    {"strain_yz", "1"},
    {"strain_xz", "1"},
    {"f_xx", "1"},
    {"f_xy", "1"},
    {"f_xz", "1"},
    {"f_yx", "1"},
    {"f_yy", "1"},
    {"f_yz", "1"},
    {"f_zx", "1"},
    {"f_zy", "1"},
    {"f_zz", "1"},
    {"thermal_strain", "1"},  // volumetric; the part already included in the pressure
    {"bulking_pressure", "stress"},
    {"sound_speed", "velocity"},
    {"half_size_x", "length"},
    {"half_size_y", "length"},
    {"half_size_z", "length"},
    {"edge_1x", "length"},
    {"edge_1y", "length"},
    {"edge_1z", "length"},
    {"edge_2x", "length"},
    {"edge_2y", "length"},
    {"edge_2z", "length"},
    {"edge_3x", "length"},
    {"edge_3y", "length"},
    {"edge_3z", "length"},
    {"corner_0x", "length"},
    {"corner_0y", "length"},
    {"corner_0z", "length"},
    {"corner_1x", "length"},
    {"corner_1y", "length"},
    {"corner_1z", "length"},
    {"corner_2x", "length"},
    {"corner_2y", "length"},
    {"corner_2z", "length"},
    {"corner_3x", "length"},
    {"corner_3y", "length"},
    {"corner_3z", "length"},
    {"corner_4x", "length"},
    {"corner_4y", "length"},
    {"corner_4z", "length"},
    {"corner_5x", "length"},
    {"corner_5y", "length"},
    {"corner_5z", "length"},
    {"corner_6x", "length"},
    {"corner_6y", "length"},
    {"corner_6z", "length"},
    {"corner_7x", "length"},
    {"corner_7y", "length"},
    {"corner_7z", "length"},
    {"first_x", "length"},  // the place at creation, for expressions
    {"first_y", "length"},
    {"first_z", "length"},
    {"affine_xx", "1/time"},
    {"affine_xy", "1/time"},
    {"affine_xz", "1/time"},
    {"affine_yx", "1/time"},
    {"affine_yy", "1/time"},
    {"affine_yz", "1/time"},
    {"affine_zx", "1/time"},
    {"affine_zy", "1/time"},
    {"affine_zz", "1/time"},
    {"acceleration_lag_x", "length/time^3"},
    {"acceleration_lag_y", "length/time^3"},
    {"acceleration_lag_z", "length/time^3"},
    {"viscosity_factor", "1"},
    {"velocity_divergence", "1/time"},
    {"history_0", "1"},
    {"history_1", "1"},
    {"history_2", "1"},
    {"history_3", "1"},
    {"history_4", "1"},
    {"history_5", "1"},
    {"history_6", "1"},
    {"history_7", "1"},
}};

constexpr std::string_view name_of(Column c) { return column_table[static_cast<std::size_t>(c)].name; }
constexpr Column next(Column c, int n) { return static_cast<Column>(static_cast<int>(c) + n); }

/// F in the order of Mat3. Starts as the unit tensor.
inline constexpr std::array deformation_gradient_columns{Column::f_xx, Column::f_xy, Column::f_xz,
                                                         Column::f_yx, Column::f_yy, Column::f_yz,
                                                         Column::f_zx, Column::f_zy, Column::f_zz};

class ColumnSet {
 public:
  ColumnSet() = default;
  ColumnSet(std::initializer_list<Column> columns) {
    for (Column c : columns) add(c);
  }
  void add(Column c) { bits_.set(static_cast<std::size_t>(c)); }
  void add(const ColumnSet& other) { bits_ |= other.bits_; }
  /// `n` columns from `first` on, such as the components of a vector or tensor.
  void add_range(Column first, int n) {
    for (int i = 0; i < n; ++i) add(next(first, i));
  }
  bool has(Column c) const { return bits_.test(static_cast<std::size_t>(c)); }
  int size() const { return static_cast<int>(bits_.count()); }
  bool operator==(const ColumnSet&) const = default;

  /// Position to identity: the columns of every particle.
  static ColumnSet mechanics() {
    ColumnSet set;
    set.add_range(Column::position_x, static_cast<int>(Column::identity) + 1);
    return set;
  }

 private:
  std::bitset<column_count> bits_;
};

/// Position of each column of a set within a block: offset in doubles, or absent.
class ColumnLayout {
 public:
  ColumnLayout() : ColumnLayout(ColumnSet::mechanics()) {}
  explicit ColumnLayout(const ColumnSet& set) : set_(set) {
    int n = 0;
    for (int c = 0; c < column_count; ++c) {
      offset_[static_cast<std::size_t>(c)] = set.has(static_cast<Column>(c)) ? block_lanes * n++ : -1;
    }
    columns_ = n;
  }
  /// Doubles from the start of a block to the column's eight values; -1 if absent.
  int offset(Column c) const { return offset_[static_cast<std::size_t>(c)]; }
  /// Index among a particle's columns when stored consecutively.
  std::size_t index(Column c) const { return static_cast<std::size_t>(offset(c) / block_lanes); }
  bool has(Column c) const { return offset(c) >= 0; }
  int columns() const { return columns_; }
  int block_doubles() const { return block_lanes * columns_; }
  int bytes_per_particle() const { return static_cast<int>(sizeof(double)) * columns_; }
  const ColumnSet& set() const { return set_; }

 private:
  ColumnSet set_;
  std::array<int, column_count> offset_{};
  int columns_ = 0;
};

}  // namespace mpm::core
