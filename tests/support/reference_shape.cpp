#include "tests/support/reference_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace mpm::tests {
namespace {

double hat(double r) { return std::max(0.0, 1 - std::abs(r)); }

/// Integral of the hat up to r.
double area_of_hat(double r) {
  if (r <= -1) return 0;
  if (r >= 1) return 1;
  return r < 0 ? 0.5 * (1 + r) * (1 + r) : 1 - 0.5 * (1 - r) * (1 - r);
}

/// The weights of one node along one axis, with the walls: for mass, and by component.
struct AxisEntry {
  int node = 0;
  double mass = 0;
  Vector value{}, slope{};
};
struct AxisSupport {
  std::array<AxisEntry, 4> entry;
  std::size_t count = 0;

  AxisEntry& at(int node) {
    for (std::size_t n = 0; n < count; ++n)
      if (entry[n].node == node) return entry[n];
    entry.at(count) = {.node = node};
    return entry[count++];
  }
};

/// Adds node `outer`, which is beyond the wall at node `wall`, to the nodes that determine its velocity.
void add_mirrored(AxisSupport& to, int outer, int wall, int boundary, std::size_t axis, ShapeOnAxis shape) {
  AxisEntry& inner = to.at(2 * wall - outer);
  const bool rigid = boundary == 4;
  inner.mass += rigid ? -shape.value : shape.value;
  for (std::size_t c = 0; c < 3; ++c) {
    const double sign = rigid || boundary == 1 || c == axis ? -1 : 1;
    inner.value[c] += sign * shape.value;
    inner.slope[c] += sign * shape.slope;
  }
  if (!rigid) return;
  AxisEntry& on_wall = to.at(wall);
  on_wall.mass += 2 * shape.value;
  for (std::size_t c = 0; c < 3; ++c) {
    on_wall.value[c] += 2 * shape.value;
    on_wall.slope[c] += 2 * shape.slope;
  }
}

AxisSupport axis_support(const ReferenceGrid& grid, double x, std::size_t axis) {
  const double position = (x - grid.origin[axis]) / grid.cell[axis];
  const int below = static_cast<int>(std::floor(position)), last = grid.cells[axis];
  AxisSupport result;
  for (int i = below - 1; i <= below + 2; ++i) {
    const ShapeOnAxis shape = shape_on_axis(grid.shape, position - i, grid.half_size[axis] / grid.cell[axis]);
    if (shape.value == 0 && shape.slope == 0) continue;
    const bool outside = i < 0 || i > last;
    const int boundary = grid.boundary[2 * axis + (i < 0 ? 0 : 1)];
    if (outside && boundary != 0) {
      add_mirrored(result, i, i < 0 ? 0 : last, boundary, axis, shape);
      continue;
    }
    AxisEntry& entry = result.at(i);
    entry.mass += shape.value;
    for (std::size_t c = 0; c < 3; ++c) {
      entry.value[c] += shape.value;
      entry.slope[c] += shape.slope;
    }
  }
  for (std::size_t n = 0; n < result.count; ++n)
    for (double& slope : result.entry[n].slope) slope /= grid.cell[axis];
  return result;
}

}  // namespace

ShapeOnAxis shape_on_axis(ReferenceShape shape, double r, double half_size) {
  const double d = std::abs(r), sign = r < 0 ? -1 : 1;
  switch (shape) {
    case ReferenceShape::linear:  // a particle on a face is in the cell above
      return {hat(r), r < -1 || r >= 1 ? 0.0 : -sign};
    case ReferenceShape::sgmp: return {0.5 * (hat(r - 0.5) + hat(r + 0.5)), hat(r + 0.5) - hat(r - 0.5)};
    case ReferenceShape::quadratic_bspline:
      if (d <= 0.5) return {0.75 - r * r, -2 * r};
      if (d < 1.5) return {0.5 * (1.5 - d) * (1.5 - d), -sign * (1.5 - d)};
      return {0, 0};
    case ReferenceShape::cubic_bspline:
      if (d <= 1) return {2.0 / 3 - r * r + 0.5 * d * d * d, r * (1.5 * d - 2)};
      if (d < 2) return {(2 - d) * (2 - d) * (2 - d) / 6, -0.5 * sign * (2 - d) * (2 - d)};
      return {0, 0};
    case ReferenceShape::ugimp:
    case ReferenceShape::cpgimp: {
      const double l = half_size;
      return {(area_of_hat(r + l) - area_of_hat(r - l)) / (2 * l), (hat(r + l) - hat(r - l)) / (2 * l)};
    }
    case ReferenceShape::ddmp:
    case ReferenceShape::cpdi:
    case ReferenceShape::cpdi2: break;  // no products
  }
  throw std::logic_error("a shape that is no product over the axes");
}

DomainCorners box(const Vector& half_size) {
  DomainCorners corner{};
  for (std::size_t c = 0; c < 8; ++c)
    for (std::size_t a = 0; a < 3; ++a) corner[c][a] = (c >> a & 1) != 0 ? half_size[a] : -half_size[a];
  return corner;
}

HexahedronMeans means_over(const DomainCorners& corner) {
  const double far = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2)),
               near = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2));
  const double point[4] = {-far, -near, near, far};
  const double light = (18 - std::sqrt(30.0)) / 36, heavy = (18 + std::sqrt(30.0)) / 36;
  const double weight[4] = {light, heavy, heavy, light};
  HexahedronMeans sum;
  for (std::size_t q = 0; q < 64; ++q) {
    const std::size_t at[3] = {q % 4, q / 4 % 4, q / 16};
    double M[8], dM[8][3], dx[3][3] = {};  // dx[i][k] = dx_i/dxi_k
    Vector x{};
    for (std::size_t c = 0; c < 8; ++c) {
      double factor[3], slope[3];
      for (std::size_t k = 0; k < 3; ++k) {
        slope[k] = (c >> k & 1) != 0 ? 0.5 : -0.5;
        factor[k] = 0.5 + slope[k] * point[at[k]];
      }
      M[c] = factor[0] * factor[1] * factor[2];
      dM[c][0] = slope[0] * factor[1] * factor[2];
      dM[c][1] = factor[0] * slope[1] * factor[2];
      dM[c][2] = factor[0] * factor[1] * slope[2];
      for (std::size_t i = 0; i < 3; ++i) {
        x[i] += M[c] * corner[c][i];
        for (std::size_t k = 0; k < 3; ++k) dx[i][k] += dM[c][k] * corner[c][i];
      }
    }
    // Cofactors: J times the transposed inverse.
    double cofactor[3][3], J = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        cofactor[i][k] = dx[i1][k1] * dx[i2][k2] - dx[i1][k2] * dx[i2][k1];
      }
    for (std::size_t k = 0; k < 3; ++k) J += dx[0][k] * cofactor[0][k];
    const double w = weight[at[0]] * weight[at[1]] * weight[at[2]];
    sum.volume += w * J;
    for (std::size_t c = 0; c < 8; ++c) {
      sum.value[c] += w * J * M[c];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) sum.slope[c][i] += w * cofactor[i][k] * dM[c][k];
    }
    for (std::size_t i = 0; i < 3; ++i) sum.centroid[i] += w * J * x[i];
  }
  for (double& value : sum.value) value /= sum.volume;
  for (Vector& slope : sum.slope)
    for (double& component : slope) component /= sum.volume;
  for (double& component : sum.centroid) component /= sum.volume;
  return sum;
}

double smallest_corner(const DomainCorners& corner) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < 8; ++c) {
    double e[3][3];
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i)
        e[k][i] = corner[c | (std::size_t{1} << k)][i] - corner[c & ~(std::size_t{1} << k)][i];
    smallest = std::min(smallest, e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
                                      e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
                                      e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]));
  }
  return smallest;
}

DomainCorners scaled_back(DomainCorners corner, const Vector& cell) {
  for (std::size_t a = 0; a < 3; ++a) {
    double reach = 0;
    for (const Vector& x : corner) reach = std::max(reach, std::abs(x[a]));
    if (reach > cell[a])
      for (Vector& x : corner) x[a] *= cell[a] / reach;
  }
  return corner;
}

namespace {

WideSupport corner_support(const ReferenceGrid& grid, const Vector& x) {
  ReferenceGrid linear = grid;
  linear.shape = ReferenceShape::linear;
  const HexahedronMeans means = means_over(grid.corner);
  WideSupport result;
  for (std::size_t c = 0; c < 8; ++c) {
    const Vector& d = grid.corner[c];
    const WideSupport at = wide_support(linear, {x[0] + d[0], x[1] + d[1], x[2] + d[2]});
    for (std::size_t n = 0; n < at.count; ++n) {
      const WideSupport::Entry& of = at.entry[n];
      if (of.mass == 0 && of.value == Vector{}) continue;
      const auto begin = result.entry.begin(), end = begin + static_cast<std::ptrdiff_t>(result.count);
      auto to = std::find_if(begin, end, [&](const auto& e) { return e.node == of.node; });
      if (to == end) {
        result.entry.at(result.count++) = {};
        to->node = of.node;
      }
      to->mass += means.value[c] * of.mass;
      for (std::size_t a = 0; a < 3; ++a) {
        to->value[a] += means.value[c] * of.value[a];
        for (std::size_t b = 0; b < 3; ++b) to->slope[a][b] += means.slope[c][b] * of.value[a];
      }
    }
  }
  return result;
}

/// Of a cell in the means of ddmp: beyond a wall, that of its mirror image.
double weight_of(const ReferenceGrid& grid, std::array<int, 3> cell) {
  if (grid.weight.empty()) return 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const int last = grid.cells[a] - 1;
    if (cell[a] < 0 && grid.boundary[2 * a] != 0) cell[a] = -1 - cell[a];
    if (cell[a] > last && grid.boundary[2 * a + 1] != 0) cell[a] = 2 * last + 1 - cell[a];
    if (cell[a] < 0 || cell[a] > last) return 0;
  }
  return grid.weight[static_cast<std::size_t>(cell[0] + grid.cells[0] * (cell[1] + grid.cells[1] * cell[2]))];
}

/// Trilinear function of node `i`, or its gradient, at x in `cell`.
double trilinear(const ReferenceGrid& grid, const std::array<int, 3>& i, const Vector& x, int derivative) {
  double product = 1;
  for (int a = 0; a < 3; ++a) {
    const auto b = static_cast<std::size_t>(a);
    const double r = (x[b] - grid.origin[b]) / grid.cell[b] - i[b];
    product *= a == derivative ? (r < 0 ? 1 : -1) / grid.cell[b] : hat(r);
  }
  return product;
}

/// Mean of grad S_i over the cells around node j, with their weights and S_j: products over the axes of the
/// integrals over a cell of hat_j hat_i (h/3 or h/6) and hat_j hat_i' (+-1/2).
Vector averaged_gradient(const ReferenceGrid& grid, const std::array<int, 3>& i,
                         const std::array<int, 3>& j) {
  Vector sum{};
  double weight = 0;
  for (int c = 0; c < 8; ++c) {
    const std::array<int, 3> cell = {j[0] - (c & 1), j[1] - (c >> 1 & 1), j[2] - (c >> 2)};
    const double of_cell = weight_of(grid, cell);
    weight += of_cell * grid.cell[0] * grid.cell[1] * grid.cell[2] / 8;
    bool corner = true;
    for (std::size_t a = 0; a < 3; ++a) corner = corner && (i[a] == cell[a] || i[a] == cell[a] + 1);
    if (!corner) continue;
    for (std::size_t b = 0; b < 3; ++b) {
      double integral = of_cell;
      for (std::size_t a = 0; a < 3; ++a)
        integral *= a == b ? (i[a] == cell[a] ? -0.5 : 0.5) : grid.cell[a] / (i[a] == j[a] ? 3 : 6);
      sum[b] += integral;
    }
  }
  for (double& component : sum) component = weight > 0 ? component / weight : 0;
  return sum;
}

/// Number of the node i next to node j, 0 to 26, or -1.
int next_to(const std::array<int, 3>& i, const std::array<int, 3>& j) {
  int number = 0;
  for (std::size_t a = 3; a-- > 0;) {
    if (std::abs(i[a] - j[a]) > 1) return -1;
    number = 3 * number + i[a] - j[a] + 1;
  }
  return number;
}

std::size_t number_of(const ReferenceGrid& grid, const std::array<int, 3>& node) {
  return static_cast<std::size_t>(node[0] + (grid.cells[0] + 1) * (node[1] + (grid.cells[1] + 1) * node[2]));
}

/// Nodes beyond walls give way to those that determine their velocities, one axis after the other.
WideSupport with_walls(const ReferenceGrid& grid, WideSupport support) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    WideSupport result;
    const auto at = [&](const std::array<int, 3>& node) -> WideSupport::Entry& {
      for (std::size_t n = 0; n < result.count; ++n)
        if (result.entry[n].node == node) return result.entry[n];
      result.entry.at(result.count) = {};
      result.entry[result.count].node = node;
      return result.entry[result.count++];
    };
    const auto add = [](WideSupport::Entry& to, const WideSupport::Entry& from, std::size_t c,
                        double factor) {
      to.value[c] += factor * from.value[c];
      for (std::size_t b = 0; b < 3; ++b) to.slope[c][b] += factor * from.slope[c][b];
    };
    for (std::size_t n = 0; n < support.count; ++n) {
      const WideSupport::Entry& from = support.entry[n];
      const int last = grid.cells[axis], place = from.node[axis];
      const int kind = grid.boundary[2 * axis + (place < 0 ? 0 : 1)];
      std::array<int, 3> wall = from.node, mirror = from.node;
      wall[axis] = place < 0 ? 0 : last;
      mirror[axis] = 2 * wall[axis] - place;
      if ((place >= 0 && place <= last) || kind == 0) mirror[axis] = place;
      const bool turns = mirror[axis] != place;
      at(mirror).mass += turns && kind == 4 ? -from.mass : from.mass;
      for (std::size_t c = 0; c < 3; ++c)
        add(at(mirror), from, c, turns && (kind != 2 || c == axis) ? -1 : 1);
      if (!turns || kind != 4) continue;
      at(wall).mass += 2 * from.mass;
      for (std::size_t c = 0; c < 3; ++c) add(at(wall), from, c, 2);
    }
    support = result;
  }
  return support;
}

WideSupport dual_domain_support(const ReferenceGrid& grid, const Vector& x) {
  const std::array<int, 3> cell = cell_at(grid, x);
  double alpha = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const double f = (x[a] - grid.origin[a]) / grid.cell[a] - cell[a];
    alpha *= 4 * f * (1 - f);
  }
  std::array<std::array<int, 3>, 8> corners;  // of the cell
  std::array<double, 8> value;
  for (std::size_t m = 0; m < 8; ++m) {
    const int number = static_cast<int>(m);
    corners[m] = {cell[0] + (number & 1), cell[1] + (number >> 1 & 1), cell[2] + (number >> 2)};
    value[m] = trilinear(grid, corners[m], x, -1);
  }
  WideSupport result;
  for (int n = 0; n < 64; ++n) {
    WideSupport::Entry& entry = result.entry[result.count++];
    entry = {};
    entry.node = {cell[0] - 1 + n % 4, cell[1] - 1 + n / 4 % 4, cell[2] - 1 + n / 16};
    const std::array<int, 3>& i = entry.node;
    bool corner = true;
    for (std::size_t a = 0; a < 3; ++a) corner = corner && (i[a] == cell[a] || i[a] == cell[a] + 1);
    Vector gradient{};
    if (corner) {
      entry.mass = trilinear(grid, i, x, -1);
      for (std::size_t a = 0; a < 3; ++a) {
        double slope = (i[a] == cell[a] ? -1 : 1) / grid.cell[a];
        for (std::size_t b = 0; b < 3; ++b)
          if (b != a) slope *= hat((x[b] - grid.origin[b]) / grid.cell[b] - i[b]);
        gradient[a] = alpha * slope;
      }
    }
    for (std::size_t m = 0; m < 8; ++m) {
      const std::array<int, 3>& j = corners[m];
      const int n_ij = next_to(i, j);
      if (n_ij < 0) continue;
      const Vector mean = grid.averaged.empty()
                              ? averaged_gradient(grid, i, j)
                              : grid.averaged[number_of(grid, j)][static_cast<std::size_t>(n_ij)];
      for (std::size_t a = 0; a < 3; ++a) gradient[a] += (1 - alpha) * value[m] * mean[a];
    }
    entry.value.fill(entry.mass);
    entry.slope.fill(gradient);
  }
  return with_walls(grid, result);
}

}  // namespace

std::array<int, 3> cell_at(const ReferenceGrid& grid, const Vector& x) {
  std::array<int, 3> cell{};
  for (std::size_t a = 0; a < 3; ++a)
    cell[a] = std::min(static_cast<int>(std::floor((x[a] - grid.origin[a]) * (1 / grid.cell[a]))),
                       grid.cells[a] - 1);
  return cell;
}

void average_gradients(ReferenceGrid& grid) {
  grid.averaged.assign(number_of(grid, grid.cells) + 1, {});
  for (int n = 0; n < static_cast<int>(grid.averaged.size()); ++n) {
    const int x = grid.cells[0] + 1, y = grid.cells[1] + 1;
    const std::array<int, 3> j = {n % x, n / x % y, n / (x * y)};
    for (int m = 0; m < 27; ++m)
      grid.averaged[static_cast<std::size_t>(n)][static_cast<std::size_t>(m)] =
          averaged_gradient(grid, {j[0] + m % 3 - 1, j[1] + m / 3 % 3 - 1, j[2] + m / 9 - 1}, j);
  }
}

WideSupport wide_support(const ReferenceGrid& grid, const Vector& x) {
  if (has_corners(grid.shape)) return corner_support(grid, x);
  if (grid.shape == ReferenceShape::ddmp) return dual_domain_support(grid, x);
  const AxisSupport along[3] = {axis_support(grid, x[0], 0), axis_support(grid, x[1], 1),
                                axis_support(grid, x[2], 2)};
  WideSupport result;
  for (std::size_t k = 0; k < along[2].count; ++k)
    for (std::size_t j = 0; j < along[1].count; ++j)
      for (std::size_t i = 0; i < along[0].count; ++i) {
        const AxisEntry* const on[3] = {&along[0].entry[i], &along[1].entry[j], &along[2].entry[k]};
        WideSupport::Entry& entry = result.entry[result.count++];
        entry.node = {on[0]->node, on[1]->node, on[2]->node};
        entry.mass = on[0]->mass * on[1]->mass * on[2]->mass;
        for (std::size_t c = 0; c < 3; ++c) {
          entry.value[c] = on[0]->value[c] * on[1]->value[c] * on[2]->value[c];
          for (std::size_t b = 0; b < 3; ++b) {
            entry.slope[c][b] = 1;
            for (std::size_t a = 0; a < 3; ++a)
              entry.slope[c][b] *= a == b ? on[a]->slope[c] : on[a]->value[c];
          }
        }
      }
  return result;
}

}  // namespace mpm::tests
