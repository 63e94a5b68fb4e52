// Iteration over a batch in the stages of the update: one vector of particles at a time, T = double or Lanes.
#pragma once

#include "core/material/batch.hpp"
#include "core/simd/dual.hpp"

namespace mpm::physics {

/// Distribution of an update's work over its stages.
inline constexpr int parts_of_kinematics = 1, parts_of_strength = 8, parts_of_pressure = 7;
static_assert(parts_of_kinematics + parts_of_strength + parts_of_pressure == core::parts_of_update);

/// f(block, row): the vector's values of a column are at `block + layout.offset(column)`, `row` is its index
/// in the rows of the batch. `parts`: the stage's share of the update's work.
template <class T, int parts = 0, class B, class F>
inline void for_each_vector(B& batch, F f) {
  for (int b = 0; b < batch.blocks; ++b) {
    if constexpr (parts > 0) batch.begin_parts(b, parts);
    for (int lane = 0; lane < core::block_lanes; lane += core::LaneTraits<T>::width) {
      f(batch.block[b] + lane, core::block_lanes * b + lane);
    }
  }
}

/// Lanes of `mask` with particles, for a vector at `row` of a batch with `particles`.
template <class T>
[[gnu::noinline, gnu::cold]] long count(core::MaskOf<T> mask, int row, int particles) {
  if constexpr (core::LaneTraits<T>::width == 1) {
    return mask && row < particles ? 1 : 0;
  } else {
    long n = 0;
    for (int i = 0; i < core::LaneTraits<T>::width && row + i < particles; ++i) n += mask[i] ? 1 : 0;
    return n;
  }
}

/// The same lanes as bits of a batch.
template <class T>
[[gnu::noinline, gnu::cold]] std::uint64_t lanes_of(core::MaskOf<T> mask, int row, int particles) {
  std::uint64_t lanes = 0;
  for (int i = 0; i < core::LaneTraits<T>::width && row + i < particles; ++i) {
    bool set;
    if constexpr (core::LaneTraits<T>::width == 1)
      set = mask;
    else
      set = mask[i];
    if (set) lanes |= std::uint64_t{1} << (row + i);
  }
  return lanes;
}

template <class T>
inline core::Sym3<T> load_deviator(const double* block, const core::ColumnLayout& layout) {
  using core::Column;
  const auto get = [&](Column c) { return core::load<T>(block + layout.offset(c)); };
  return {get(Column::s_xx), get(Column::s_yy), get(Column::s_zz),
          get(Column::s_xy), get(Column::s_yz), get(Column::s_xz)};
}

template <class T>
inline void store_deviator(double* block, const core::ColumnLayout& layout, const core::Sym3<T>& s) {
  using core::Column;
  const auto put = [&](Column c, const T& value) { core::store(block + layout.offset(c), value); };
  put(Column::s_xx, s.xx), put(Column::s_yy, s.yy), put(Column::s_zz, s.zz);
  put(Column::s_xy, s.xy), put(Column::s_yz, s.yz), put(Column::s_xz, s.xz);
}

}  // namespace mpm::physics
