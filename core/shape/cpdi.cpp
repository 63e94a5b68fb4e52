#include "core/shape/cpdi.hpp"

namespace mpm::core {

namespace {

using R = Lanes<8>;

unsigned wide_lanes(const BrickFrame& frame, const R (&x)[3][corners]) {
  return cpdi::wide_lanes(frame, [&](int a) { return HexahedronDomain::reach_of(x[a]); });
}

/// Corners about the middle with these half edges.
void set_corners(const ColumnLayout& layout, double* block, int lane, const double (&middle)[3],
                 const double (&edge)[3][3]) {
  double* corner = HexahedronDomain::of(layout, block) + lane;
  for (int a = 0; a < 3; ++a) {
    double to[corners];
    parallelepiped_corners(middle[a], edge[0][a], edge[1][a], edge[2][a], to);
    for (int c = 0; c < corners; ++c) corner[block_lanes * (3 * c + a)] = to[c];
  }
}
/// A cube about the particle.
void set_cube(const ColumnLayout& layout, double* block, int lane) {
  const double half = cpdi::half_of_cube(layout, block, lane);
  set_corners(layout, block, lane, {0, 0, 0}, {{half, 0, 0}, {0, half, 0}, {0, 0, half}});
}

/// The parallelepiped of the hexahedron's mean edges about its mean corner, or a cube about the particle.
void replace_domain(const ColumnLayout& layout, double* block, int lane) {
  const double* corner = HexahedronDomain::of(layout, block) + lane;
  double x[3][corners];
  for (int c = 0; c < corners; ++c)
    for (int a = 0; a < 3; ++a) x[a][c] = corner[block_lanes * (3 * c + a)];
  const Hexahedron<double> old(x);
  if (!(dot(old.a[0], cross(old.a[1], old.a[2])) > 0)) return set_cube(layout, block, lane);
  double edge[3][3], middle[3];
  for (int a = 0; a < 3; ++a) {
    middle[a] = old.middle[a];
    for (int k = 0; k < 3; ++k) edge[k][a] = old.a[k][a];
  }
  set_corners(layout, block, lane, middle, edge);
}

}  // namespace

void Cpdi::replace_wide(const BrickFrame& frame, const ColumnLayout& layout, double* block) {
  Vec3<R> r[3];
  Parallelepiped::load_edges(layout, block, r);
  for (unsigned left = Parallelepiped::wide_lanes(frame, r); left != 0; left &= left - 1)
    Parallelepiped::set_cube(layout, block, __builtin_ctz(left));
}

void Cpdi2::replace_wide(const BrickFrame& frame, const ColumnLayout& layout, double* block) {
  R x[3][corners];
  HexahedronDomain::load_corners(layout, block, x);
  for (unsigned left = wide_lanes(frame, x); left != 0; left &= left - 1)
    set_cube(layout, block, __builtin_ctz(left));
}

DomainCounts Cpdi2::settle(const BrickFrame& frame, const ColumnLayout& layout, bool free, double* block,
                           int used) {
  double* corner = HexahedronDomain::of(layout, block);
  R x[3][corners];
  HexahedronDomain::load_corners(layout, block, x);
  Hexahedron<R> domain(x);
  const unsigned tangled = bits(!(R(0.0) < smallest_jacobian(x, domain.mean_jacobian))) & ((1u << used) - 1);
  if (tangled != 0) {
    for (unsigned left = tangled; left != 0; left &= left - 1)
      replace_domain(layout, block, __builtin_ctz(left));
    HexahedronDomain::load_corners(layout, block, x);
    domain = Hexahedron<R>(x);
  }
  const Vec3<R> centroid = domain.centroid();
  for (int a = 0; a < 3; ++a) {
    for (int c = 0; c < corners; ++c) {
      x[a][c] -= centroid[a];
      store(corner + block_lanes * (3 * c + a), x[a][c]);
    }
    if (!free) continue;
    double* position = block + layout.offset(next(Column::position_x, a));
    store(position, load<R>(position) + centroid[a]);
  }
  return {cpdi::count(wide_lanes(frame, x) & ~tangled, used), cpdi::count(tangled, used)};
}

}  // namespace mpm::core
