#include "core/shape/cpdi.hpp"

namespace mpm::core {

namespace {

/// The parallelepiped of the hexahedron's mean edges about its mean corner, or a cube about the particle.
void replace_domain(const ColumnLayout& layout, double* block, int lane) {
  double* corner = HexahedronDomain::of(layout, block) + lane;
  double x[3][corners];
  for (int c = 0; c < corners; ++c)
    for (int a = 0; a < 3; ++a) x[a][c] = corner[block_lanes * (3 * c + a)];
  const Hexahedron<double> old(x);
  const bool sound = dot(old.a[0], cross(old.a[1], old.a[2])) > 0;
  const double half = cpdi::half_of_cube(layout, block, lane);
  for (int a = 0; a < 3; ++a) {
    double edge[3] = {}, middle = 0;
    for (int k = 0; k < 3; ++k) edge[k] = sound ? old.a[k][a] : (k == a ? half : 0);
    if (sound) middle = old.middle[a];
    double to[corners];
    parallelepiped_corners(middle, edge[0], edge[1], edge[2], to);
    for (int c = 0; c < corners; ++c) corner[block_lanes * (3 * c + a)] = to[c];
  }
}

}  // namespace

DomainCounts Cpdi2::settle(const BrickFrame& frame, const ColumnLayout& layout, bool free, double* block,
                           int used) {
  using R = Lanes<8>;
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
  unsigned wide = 0;
  for (int a = 0; a < 3; ++a) {
    for (int c = 0; c < corners; ++c) {
      x[a][c] -= centroid[a];
      store(corner + block_lanes * (3 * c + a), x[a][c]);
    }
    wide |= bits(R(cpdi::farthest) < HexahedronDomain::reach_of(x[a]) * R(frame.inverse_cell[a]));
    if (!free) continue;
    double* position = block + layout.offset(next(Column::position_x, a));
    store(position, load<R>(position) + centroid[a]);
  }
  return {cpdi::count(wide & ~tangled, used), cpdi::count(tangled, used)};
}

}  // namespace mpm::core
