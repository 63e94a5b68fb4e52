// Transfer of a law's state between the particle's columns and the point on which the law operates.
//
// A law lists its columns once, as `static constexpr std::array state`; each point type maps columns to
// members. Columns that a law does not list are neither loaded nor stored (tests/physics/laws_test.cpp).
#pragma once

#include <array>
#include <cstddef>

#include "core/particles/columns.hpp"
#include "core/simd/dual.hpp"

namespace mpm::physics {

/// Member of a point that holds a column. A point's table is `Point::columns()`.
template <class Point, class T>
struct ColumnMember {
  core::Column column;
  T Point::*member;
};

template <class Point>
consteval auto member_of(core::Column column) {
  for (const auto& entry : Point::columns()) {
    if (entry.column == column) return entry.member;
  }
  throw "this family of laws cannot use the column: add it to the table of the point";
}

/// Whether a law with these parameters uses a given column of its `state`; all by default.
template <class Law>
bool carries(const Law& law, core::Column column) {
  if constexpr (requires { law.carries(column); }) return law.carries(column);
  return true;
}

template <class Law>
core::ColumnSet columns_of(const Law& law) {
  core::ColumnSet set;
  for (core::Column column : Law::state) {
    if (carries(law, column)) set.add(column);
  }
  return set;
}

/// A law's state of one vector of particles: offsets into a block, found once per batch.
template <class Law, class Point>
class History {
 public:
  History(const Law& law, const core::ColumnLayout& layout) {
    for (std::size_t i = 0; i < count; ++i) {
      offset_[i] = carries(law, Law::state[i]) ? layout.offset(Law::state[i]) : -1;
    }
  }
  void load(const double* block, Point& point) const {
    each([&]<auto member>(int offset) {
      if (offset >= 0) point.*member = core::load<Value<member>>(block + offset);
    });
  }
  void store(double* block, const Point& point) const {
    each([&]<auto member>(int offset) {
      if (offset >= 0) core::store(block + offset, point.*member);
    });
  }
  /// Resets the lanes of `mask` to the state still in the columns.
  template <class Mask>
  void restore(const double* block, Point& point, Mask mask) const {
    each([&]<auto member>(int offset) {
      if (offset < 0) return;
      point.*member = core::select(mask, core::load<Value<member>>(block + offset), point.*member);
    });
  }

 private:
  static constexpr std::size_t count = Law::state.size();
  template <auto member>
  using Value = std::remove_reference_t<decltype(std::declval<Point&>().*member)>;

  template <class F>
  void each(F f) const {
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      (f.template operator()<member_of<Point>(Law::state[i])>(offset_[i]), ...);
    }
    (std::make_index_sequence<count>{});
  }
  std::array<int, count> offset_{};
};

}  // namespace mpm::physics
