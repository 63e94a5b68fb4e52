// Rows to columns of small matrices held in vectors, in shuffles alone.
#pragma once

#include "core/simd/lanes.hpp"

namespace mpm::core {

/// Rows to columns of an 8 x 8 matrix.
[[gnu::always_inline]] inline void transpose(Lanes<8> r[8]) {
  using V = Lanes<8>::vector;
  V a[8], b[8];
  for (int i = 0; i < 4; ++i) {
    a[2 * i] = __builtin_shufflevector(r[2 * i].v, r[2 * i + 1].v, 0, 8, 2, 10, 4, 12, 6, 14);
    a[2 * i + 1] = __builtin_shufflevector(r[2 * i].v, r[2 * i + 1].v, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int h = 0; h < 2; ++h) {
    for (int i = 0; i < 2; ++i) {
      b[4 * h + i] = __builtin_shufflevector(a[4 * h + i], a[4 * h + 2 + i], 0, 1, 8, 9, 4, 5, 12, 13);
      b[4 * h + 2 + i] = __builtin_shufflevector(a[4 * h + i], a[4 * h + 2 + i], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int i = 0; i < 4; ++i) {
    r[i].v = __builtin_shufflevector(b[i], b[4 + i], 0, 1, 2, 3, 8, 9, 10, 11);
    r[4 + i].v = __builtin_shufflevector(b[i], b[4 + i], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// The same for the first four rows: pairs of columns, 0 and 1 in r[0], 2 and 3 in r[1] ...
[[gnu::always_inline]] inline void transpose_half(Lanes<8> r[4]) {
  using V = Lanes<8>::vector;
  const V xy0 = __builtin_shufflevector(r[0].v, r[1].v, 0, 8, 2, 10, 4, 12, 6, 14);
  const V xy1 = __builtin_shufflevector(r[0].v, r[1].v, 1, 9, 3, 11, 5, 13, 7, 15);
  const V zm0 = __builtin_shufflevector(r[2].v, r[3].v, 0, 8, 2, 10, 4, 12, 6, 14);
  const V zm1 = __builtin_shufflevector(r[2].v, r[3].v, 1, 9, 3, 11, 5, 13, 7, 15);
  const V a = __builtin_shufflevector(xy0, zm0, 0, 1, 8, 9, 4, 5, 12, 13);    // columns 0, 4
  const V b = __builtin_shufflevector(xy1, zm1, 0, 1, 8, 9, 4, 5, 12, 13);    // 1, 5
  const V c = __builtin_shufflevector(xy0, zm0, 2, 3, 10, 11, 6, 7, 14, 15);  // 2, 6
  const V d = __builtin_shufflevector(xy1, zm1, 2, 3, 10, 11, 6, 7, 14, 15);  // 3, 7
  r[0].v = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
  r[1].v = __builtin_shufflevector(c, d, 0, 1, 2, 3, 8, 9, 10, 11);
  r[2].v = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
  r[3].v = __builtin_shufflevector(c, d, 4, 5, 6, 7, 12, 13, 14, 15);
}
/// Lanes 0..3 or 4..7.
[[gnu::always_inline]] inline Lanes<4> half_of(const Lanes<8>& r, int upper) {
  return upper == 0 ? Lanes<4>(__builtin_shufflevector(r.v, r.v, 0, 1, 2, 3))
                    : Lanes<4>(__builtin_shufflevector(r.v, r.v, 4, 5, 6, 7));
}

/// Eight rows of four to four columns of eight: the inverse of transpose_half and its pairs.
[[gnu::always_inline]] inline void transpose_rows(const Lanes<4> rows[8], Lanes<8> columns[4]) {
  using V = Lanes<8>::vector;
  const auto join = [&](int a, int b) {
    return __builtin_shufflevector(rows[a].v, rows[b].v, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  const V r04 = join(0, 4), r15 = join(1, 5), r26 = join(2, 6), r37 = join(3, 7);
  const V x01 = __builtin_shufflevector(r04, r15, 0, 8, 2, 10, 4, 12, 6, 14);  // x0 x1 z0 z1 x4 x5 z4 z5
  const V y01 = __builtin_shufflevector(r04, r15, 1, 9, 3, 11, 5, 13, 7, 15);
  const V x23 = __builtin_shufflevector(r26, r37, 0, 8, 2, 10, 4, 12, 6, 14);
  const V y23 = __builtin_shufflevector(r26, r37, 1, 9, 3, 11, 5, 13, 7, 15);
  columns[0].v = __builtin_shufflevector(x01, x23, 0, 1, 8, 9, 4, 5, 12, 13);
  columns[1].v = __builtin_shufflevector(y01, y23, 0, 1, 8, 9, 4, 5, 12, 13);
  columns[2].v = __builtin_shufflevector(x01, x23, 2, 3, 10, 11, 6, 7, 14, 15);
  columns[3].v = __builtin_shufflevector(y01, y23, 2, 3, 10, 11, 6, 7, 14, 15);
}

}  // namespace mpm::core
