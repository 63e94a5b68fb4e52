// The oracle's shape functions, straight from their definitions on an unbounded uniform grid, and what walls
// make of them. r = (x - x_i)/h; hat(r) = max(0, 1 - |r|); S_i, G_i value and derivative times h along an
// axis.
//   linear            S = hat(r)                                                  2 nodes along an axis
//   quadratic_bspline S = hat * box, the box one cell wide                                       3
//   cubic_bspline     S = hat * hat                                                              4
//   ugimp             S = mean of hat over the particle's domain r - l .. r + l,  l <= 1/2       3
//   cpgimp            the same; l follows the stretch along each axis
//                     (Bardenhagen and Kober, CMES 5 (2004) 477; the domain keeps its initial size)
//   cpdi, cpdi2       through the eight corners x_c of the particle's domain, a hexahedron x = sum M_c x_c of
//                     volume V with the trilinear functions M_c,
//                       S = sum_c s_c prod hat(x_c),  s_c = mean of M_c over it
//                       grad S = sum_c w_c prod hat(x_c),  w_c = mean of grad M_c over it
//                     cpdi: the domain deforms by the particle's F; cpdi2: the corners move with the grid
//                     (Sadeghirad et al., IJNME 86 (2011) 1435 and 95 (2013) 928)
//   sgmp              S = sum of hat(x - x_c)/2 over the two cell centres c beside the node,     3
//                     G = sum of +-hat(x - x_c), + for the centre below (Liang et al., CMAME 352 (2019) 85)
//   ddmp              S = hat(r); grad w_i = alpha grad S_i + (1 - alpha) sum_j S_j <grad S_i>_j,
//                     alpha = product of 4 f (1 - f), f the position in the cell, and <>_j the mean, weighted
//                     with S_j, over the cells in use around node j
//                     (Zhang, Ma and Giguere, J. Comput. Phys. 230 (2011) 6379)
// S and G of a node are products over the axes, but for cpdi, cpdi2 and ddmp. All S are positive, add up to 1
// and reproduce linear fields.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace mpm::tests {

using Vector = std::array<double, 3>;
/// [row][column]; a velocity gradient has dv_row/dx_column.
using Matrix = std::array<std::array<double, 3>, 3>;

enum class ReferenceShape {
  linear,
  sgmp,
  ddmp,
  quadratic_bspline,
  cubic_bspline,
  ugimp,
  cpgimp,
  cpdi,
  cpdi2
};
constexpr bool has_corners(ReferenceShape s) {
  return s == ReferenceShape::cpdi || s == ReferenceShape::cpdi2;
}

struct ShapeOnAxis {
  double value, slope;
};
/// S and G of a node r cells below the particle; `half_size` is l, in cells, of ugimp.
ShapeOnAxis shape_on_axis(ReferenceShape shape, double r, double half_size);

/// Corners of a hexahedron, i + 2 j + 4 k.
using DomainCorners = std::array<Vector, 8>;
/// A box of these half-sizes about the origin.
DomainCorners box(const Vector& half_size);

/// Means over a hexahedron of its trilinear functions and of their gradients, by Gauss quadrature with four
/// points along each axis (polynomials of degree 3 in each coordinate of the reference cube: two would do).
struct HexahedronMeans {
  double volume = 0;
  std::array<double, 8> value{};
  std::array<Vector, 8> slope{};
  Vector centroid{};
};
HexahedronMeans means_over(const DomainCorners& corner);
/// The smallest determinant of three edges that meet at a corner.
double smallest_corner(const DomainCorners& corner);
/// Coordinates on an axis where corners are more than a cell from the origin are scaled back to a cell.
DomainCorners scaled_back(DomainCorners corner, const Vector& cell);

struct ReferenceGrid {
  ReferenceShape shape = ReferenceShape::linear;
  Vector origin{};
  Vector cell{};
  std::array<int, 3> cells{};
  std::array<int, 6> boundary{};  ///< as ReferenceCase's
  Vector half_size{};             ///< ugimp, length
  DomainCorners corner{};         ///< cpdi and cpdi2, from the particle; at most a cell from it on each axis
  /// ddmp: weights of the cells, i + cells[0] (j + cells[1] k), in means; 0 where they hold no particles, and
  /// beyond free faces. Empty: all weigh 1, those beyond the faces, too.
  std::vector<double> weight{};
  /// ddmp: of every node j, <grad S_i>_j of the nodes i around it; found when needed where this is empty.
  std::vector<std::array<Vector, 27>> averaged{};
};

/// A particle's shape functions of any width, with the walls in them. Nodes have indices -1 .. cells + 1
/// along an axis: one layer outside the grid, whose nodes beyond a free face are nodes like others. Beyond a
/// wall there are none: the velocity u_o there is a linear function of the velocities of the wall's node w
/// and the mirror image m inside (below, per component c), so that node o's share of any interpolation is one
/// of w's and m's,
///   sum_i S_i u_i = ... + S_o u_o = ... + S_m' u_m + S_w' u_w,
///   symmetry    S_mc' = S_m + S_o (-S_o for the component normal to the wall)
///   fixed       S_mc' = S_m - S_o
///   rigid wall  S_mc' = S_m - S_o,  S_wc' = S_w + 2 S_o
/// and G likewise. Momentum sum_p m v_c S_ic' and force -sum_p V sigma_cb G_icb' are then the transpose of
/// the same matrix: what a particle would map to o arrives at m and w times the same coefficients. So is the
/// power of the forces on the nodes that of the stresses in the particles, whichever way the nodes are
/// stored. Mass takes the coefficients of a component that is not reversed; at a rigid wall these are those
/// above. The rules of two axes act on different factors of the products, so their order is of no concern.
struct WideSupport {
  struct Entry {
    std::array<int, 3> node;
    double mass;   ///< weight of the particle's mass
    Vector value;  ///< by component of velocity, momentum and force
    Matrix slope;  ///< [component][axis]: gradient
  };
  std::array<Entry, 64> entry;
  std::size_t count = 0;
};
/// Sets ReferenceGrid::averaged.
void average_gradients(ReferenceGrid& grid);
/// The cell, along each axis, that holds x; on a face the upper one, but the last one on the grid's.
std::array<int, 3> cell_at(const ReferenceGrid& grid, const Vector& x);
/// x lies in the grid; for linear functions, at most a cell outside.
WideSupport wide_support(const ReferenceGrid& grid, const Vector& x);

}  // namespace mpm::tests
