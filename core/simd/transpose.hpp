// Transposition of small matrices held in vectors, by shuffles alone.
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
/// Four components of eight points: of points i and i + 4 in r[i], then component i of all of them.
[[gnu::always_inline]] inline void transpose_pairs(Lanes<8> r[4]) {
  using V = Lanes<8>::vector;
  const V xz0 = __builtin_shufflevector(r[0].v, r[1].v, 0, 8, 2, 10, 4, 12, 6, 14);
  const V yw0 = __builtin_shufflevector(r[0].v, r[1].v, 1, 9, 3, 11, 5, 13, 7, 15);
  const V xz2 = __builtin_shufflevector(r[2].v, r[3].v, 0, 8, 2, 10, 4, 12, 6, 14);
  const V yw2 = __builtin_shufflevector(r[2].v, r[3].v, 1, 9, 3, 11, 5, 13, 7, 15);
  r[0].v = __builtin_shufflevector(xz0, xz2, 0, 1, 8, 9, 4, 5, 12, 13);
  r[1].v = __builtin_shufflevector(yw0, yw2, 0, 1, 8, 9, 4, 5, 12, 13);
  r[2].v = __builtin_shufflevector(xz0, xz2, 2, 3, 10, 11, 6, 7, 14, 15);
  r[3].v = __builtin_shufflevector(yw0, yw2, 2, 3, 10, 11, 6, 7, 14, 15);
}
/// Sums over the lanes of each of four vectors.
[[gnu::always_inline]] inline Lanes<4> sums_over_lanes(const Lanes<8> (&r)[4]) {
  using V = Lanes<8>::vector;
  V pair[2];
  for (int i = 0; i < 2; ++i)
    pair[i] = __builtin_shufflevector(r[2 * i].v, r[2 * i + 1].v, 0, 8, 2, 10, 4, 12, 6, 14) +
              __builtin_shufflevector(r[2 * i].v, r[2 * i + 1].v, 1, 9, 3, 11, 5, 13, 7, 15);
  const V half = __builtin_shufflevector(pair[0], pair[1], 0, 1, 2, 3, 8, 9, 10, 11) +
                 __builtin_shufflevector(pair[0], pair[1], 4, 5, 6, 7, 12, 13, 14, 15);
  return __builtin_shufflevector(half, half, 0, 1, 4, 5) + __builtin_shufflevector(half, half, 2, 3, 6, 7);
}
/// Joins two halves.
[[gnu::always_inline]] inline Lanes<8> join(Lanes<4> low, Lanes<4> high) {
  return __builtin_shufflevector(low.v, high.v, 0, 1, 2, 3, 4, 5, 6, 7);
}
/// Lanes 0..3 or 4..7.
[[gnu::always_inline]] inline Lanes<4> half_of(const Lanes<8>& r, int upper) {
  return upper == 0 ? Lanes<4>(__builtin_shufflevector(r.v, r.v, 0, 1, 2, 3))
                    : Lanes<4>(__builtin_shufflevector(r.v, r.v, 4, 5, 6, 7));
}

}  // namespace mpm::core
