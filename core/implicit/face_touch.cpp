#include "core/implicit/face_touch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/shape/bspline.hpp"

namespace mpm::core {

namespace {

/// The functions whose gradients particles feel, along an axis.
struct Along {
  int nodes;
  int first;  ///< number of the first, from the brick's
  double weight[4];
};

int nodes_per_axis(ShapeFunction shape) {
  switch (shape) {
    case ShapeFunction::cubic_bspline: return 4;
    case ShapeFunction::quadratic_bspline:
    case ShapeFunction::sgmp: return 3;
    default: return 2;
  }
}

/// At x, in cells from the brick's first node. Gradients of SGMP, of the means over cells, are linear between
/// the centres of cells: along their own axis those of the quadratic spline, across it means of the linear
/// functions.
Along along(ShapeFunction shape, bool normal, double x) {
  Along at{nodes_per_axis(shape), 0, {}};
  double* const w = at.weight;
  double slopes[4];
  if (at.nodes == 3) {
    const double node = std::floor(x + 0.5), r = x - node;
    at.first = static_cast<int>(node) - 1;
    if (shape == ShapeFunction::sgmp && !normal)
      w[0] = 0.5 * (0.5 - r), w[1] = 0.5, w[2] = 0.5 * (0.5 + r);
    else
      QuadraticAlong::evaluate(r + 0.5, w, slopes);
    return at;
  }
  const double cell = std::floor(x);
  at.first = static_cast<int>(cell);
  if (at.nodes == 4) {
    CubicAlong::evaluate(x - cell, w, slopes);
    --at.first;
    return at;
  }
  w[1] = x - cell;
  w[0] = 1 - w[1];
  return at;
}

/// Least volume around a point over its growth along the normal over a cell: with splines that of a face at a
/// distance of about 0.3 cells. Where the face is at the point it is 0.83, 0.89 and 1.03 (medians) with
/// functions of two, three and four nodes along an axis, with two between 0.5 and 1.1.
double least_volume(int nodes_per_axis) {
  return nodes_per_axis == 2 ? 0.3 : nodes_per_axis == 3 ? 0.65 : 0.8;
}
constexpr double of_known = 0.5;

}  // namespace

int axis_of(const Vec3<double>& direction) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(direction[a]) > std::abs(direction[axis])) axis = a;
  return axis;
}

std::int64_t nearest_node(const GridGeometry& g, const Vec3<double>& x, int axis) {
  return std::llround(GridGeometry::scaled(x[axis], g.origin[axis], g.inverse_cell[axis]));
}

MaterialAtFaces::MaterialAtFaces(Model& model, const BrickFields& fields, NodeUnknowns& unknowns)
    : grid_(*model.grid), fields_(fields), unknowns_(unknowns), shape_(model.scene->grid.shape) {}

void MaterialAtFaces::take_sums(std::vector<double>& to) const {
  const auto doubles = static_cast<std::size_t>(node_doubles * unknowns_.nodes());
  to.resize(doubles * fields_.count());
  for (const BrickField& field : fields_.all()) unknowns_.sums(field, to.data() + doubles * field.index);
}

std::optional<FaceTouch> MaterialAtFaces::touch(const BrickField& field, const FacePoint& point,
                                                const Vec3<double>& place, bool is_known) const {
  const GridGeometry& g = grid_.geometry();
  const NodeBlockShape shape = grid_.shape();
  const BrickCoord brick = grid_.brick(field.slot).coord;
  const std::int32_t corner[3] = {brick_cells * brick.x, brick_cells * brick.y, brick_cells * brick.z};
  const int normal_axis = axis_of(point.normal);
  Along in[3];
  std::int64_t nearest[3];
  for (int a = 0; a < 3; ++a) {
    const double x = GridGeometry::scaled(place[a], g.origin[a], g.inverse_cell[a]);
    in[a] = along(shape_, a == normal_axis, x - corner[a]);
    nearest[a] = nearest_node(g, place, a) - corner[a];
  }
  const NodeUnknowns::Node* nodes = unknowns_.of(field);
  const std::size_t first_sum = static_cast<std::size_t>(node_doubles * shape.nodes()) * field.index;
  const double *surface = surface_.data() + first_sum, *moduli = moduli_.data() + first_sum;
  FaceTouch found;
  constexpr unsigned all_axes = 7;
  bool is_beside_nodes = false;
  found.held = all_axes;
  double stiff = 0, of_stiff = 0;           // sums of volumes times moduli, and of volumes
  double active = 0, volume = 0, room = 0;  // room: of cells around the nodes, inside the grid
  Vec3<double> gradient{};
  for (int k = 0; k < in[2].nodes; ++k)
    for (int j = 0; j < in[1].nodes; ++j)
      for (int i = 0; i < in[0].nodes; ++i) {
        const double weight = in[0].weight[i] * in[1].weight[j] * in[2].weight[k];
        const int at[3] = {in[0].first + i, in[1].first + j, in[2].first + k};
        if (weight == 0 ||
            std::ranges::any_of(at, [&](int n) { return n < shape.lowest() || n > shape.highest(); }))
          continue;
        const int node = shape.index(at[0], at[1], at[2]);
        if (nodes[node].number < 0) continue;
        active += weight;
        found.weights.push_back({node, weight});
        if (nodes[node].from != node) continue;
        bool is_nearest = true;  // along the face
        for (int a = 0; a < 3; ++a) is_nearest &= a == normal_axis || at[a] == nearest[a];
        if (is_nearest) found.held &= nodes[node].held, is_beside_nodes = true;
        const double* sum = surface + node_doubles * node;
        stiff += weight * moduli[node_doubles * node + node_field::modulus.first];
        of_stiff += weight * moduli[node_doubles * node + node_field::volume.first];
        double part = 1;
        for (int a = 0; a < 3; ++a) {
          // A wall continues what is behind it.
          const std::int64_t n = corner[a] + at[a];
          const bool on_wall = n == 0 || n == g.cells[static_cast<std::size_t>(a)];
          if (on_wall) part *= 0.5;
          if (!on_wall) gradient[a] += weight * sum[a];
        }
        room += weight * part * g.cell_volume();
        volume += weight * sum[node_field::mass.first];
      }
  constexpr double least_active = 0.25, least_cosine = 0.4, beside = 0.1;
  if (!(active > least_active && volume > beside * room)) return {};
  // The sums of V grad S point out of the other body, whose volume thus grows along the normal.
  const double growth = -dot(gradient, point.normal), length = std::sqrt(dot(gradient, gradient));
  double cell_along = 0;
  for (int a = 0; a < 3; ++a) cell_along += std::abs(point.normal[a]) * g.cell[a];
  const double least = (is_known ? of_known : 1.0) * least_volume(in[0].nodes) * cell_along * growth;
  if (growth < least_cosine * length || volume < least) return {};
  for (auto& [node, weight] : found.weights) weight /= active;
  if (!is_beside_nodes) found.held = 0;
  found.modulus = stiff / of_stiff;
  found.field = field.index;
  found.place = place;
  return found;
}

/// Whether a node of the field's brick is on the material's side of the point.
bool MaterialAtFaces::is_inside(const FaceTouch& touch, std::int32_t node, const Vec3<double>& normal) const {
  const BrickCoord brick = grid_.brick(fields_.all()[touch.field].slot).coord;
  return dot(grid_.geometry().node_place(brick, grid_.shape().node(node)) - touch.place, normal) > 0;
}

void MaterialAtFaces::fit(std::span<FaceTouch> touches, std::span<const FacePoint> points) {
  const auto doubles = static_cast<std::size_t>(node_doubles * unknowns_.nodes());
  for (const BrickField& field : fields_.all())
    std::fill_n(grid_.contributions(NodeArray::first, field.slot, field.number), doubles, 0.0);
  for (const FaceTouch& touch : touches) {
    const BrickField& field = fields_.all()[touch.field];
    const NodeUnknowns::Node* nodes = unknowns_.of(field);
    double* to = grid_.contributions(NodeArray::first, field.slot, field.number);
    const FacePoint& point = points[touch.point];
    for (const auto& [node, weight] : touch.weights) {
      double* record = to + node_doubles * nodes[node].from;
      for (int a = 0; a < 3; ++a) record[a] += nodes[node].sign[a] * weight * point.area * point.normal[a];
      record[node_field::mass.first] += weight * point.area;
    }
  }
  unknowns_.exchange(mapped::implicit_surface);
  std::vector<double> faces;
  take_sums(faces);
  constexpr double opposite = 0.5, least = 0.25;
  // Particles of uGIMP keep their size: compressed ones reach into the body, and inner nodes say too little.
  const bool keeps_size = shape_ == ShapeFunction::uniform_gimp;
  for (FaceTouch& touch : touches) {
    const NodeUnknowns::Node* nodes = unknowns_.of(fields_.all()[touch.field]);
    const FacePoint& point = points[touch.point];
    std::vector<std::pair<std::int32_t, double>> fitted = touch.weights;
    double sum = 0;
    for (auto& [node, weight] : fitted) {
      if (keeps_size && is_inside(touch, node, point.normal)) {
        sum += weight;
        continue;
      }
      const std::size_t at =
          doubles * touch.field + static_cast<std::size_t>(node_doubles * nodes[node].from);
      double of_material = 0, of_faces = 0;
      for (int a = 0; a < 3; ++a) {
        const double n = nodes[node].sign[a] * point.normal[a];
        of_material -= n * surface_[at + static_cast<std::size_t>(a)];
        of_faces += n * faces[at + static_cast<std::size_t>(a)];
      }
      // Opposite faces at one node, as of a thin layer, say nothing.
      if (of_faces > opposite * faces[at + node_field::mass.first])
        weight *= std::clamp(of_material / of_faces, 0.0, 1.0);
      sum += weight;
    }
    if (!(sum > least)) continue;
    for (auto& [node, weight] : fitted) weight /= sum;
    touch.weights = std::move(fitted);
  }
}

}  // namespace mpm::core
