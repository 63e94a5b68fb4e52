#include "core/implicit/cell_stabilisation.hpp"

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"

namespace mpm::core {

namespace {

/// Cells with less of it empty have enough stiffness of their own.
constexpr double hardly_empty = 0.01;
/// Stiffness of a tie over that of the filling.
constexpr double tie_stiffness = 1e-3;

}  // namespace

CellStabilisation::CellStabilisation(Model& model, const BrickFields& fields)
    : model_(model),
      fields_(fields),
      centred_(model.scene->grid.shape == ShapeFunction::sgmp ||
               model.scene->grid.shape == ShapeFunction::ddmp),
      alpha_(model.scene->solution.implicit.value_or(ImplicitInput{}).stabilisation),
      spring_(tie_stiffness * alpha_),
      matrix_(cell_matrix(model.grid->geometry().cell)) {
  const NodeBlockShape shape = model.grid->shape();
  for (int n = 0; n < 8; ++n) corner_[n] = shape.index(n & 1, n >> 1 & 1, n >> 2) - shape.index(0, 0, 0);
}

// By 2 x 2 x 2 Gauss points.
CellMatrix cell_matrix(const Vec3<double>& cell) {
  CellMatrix m{};
  const double gauss = 0.5 / std::sqrt(3.0), weight = cell.x * cell.y * cell.z / 8;
  for (int point = 0; point < 8; ++point) {
    double slope[8][3];
    for (int n = 0; n < 8; ++n) {
      for (int a = 0; a < 3; ++a) {
        slope[n][a] = 1 / cell[a];
        for (int b = 0; b < 3; ++b) {
          const bool upper = (n >> b & 1) != 0;
          const double x = 0.5 + ((point >> b & 1) != 0 ? gauss : -gauss);
          slope[n][a] *= a == b ? (upper ? 1 : -1) : (upper ? x : 1 - x);
        }
      }
    }
    for (int p = 0; p < 8; ++p) {
      for (int q = 0; q < 8; ++q) {
        const double along =
            slope[p][0] * slope[q][0] + slope[p][1] * slope[q][1] + slope[p][2] * slope[q][2];
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k)
            m[static_cast<std::size_t>(3 * p + i)][static_cast<std::size_t>(3 * q + k)] +=
                weight * 0.5 * ((i == k ? along : 0) + slope[p][k] * slope[q][i]);
      }
    }
  }
  return m;
}

/// Whether this brick is the first in summation order of those that have the field and hold all nodes of the
/// cell whose lowest node is (i, j, k).
bool CellStabilisation::handles(const BrickField& field, const int (&at)[3]) const {
  const Brick& brick = model_.grid->brick(field.slot);
  const NodeBlockShape shape = model_.grid->shape();
  for (int n = 0; n < neighbourhood; ++n) {
    const Slot other = brick.neighbour[static_cast<std::size_t>(n)];
    if (other == no_slot) continue;
    if (field.component != all_components && model_.grid->field_of(other, field.component) < 0) continue;
    const BrickCoord offset = neighbour_offset(n);
    const int shift[3] = {offset.x, offset.y, offset.z};
    bool holds = true;
    for (int a = 0; a < 3; ++a) {
      const int there = at[a] - brick_cells * shift[a];
      holds = holds && there >= shape.lowest() && there < shape.highest();
    }
    if (holds) return n == self_index;
  }
  return false;
}

/// Ties in a cell without filling, whose nodes are no mirror images.
void CellStabilisation::find_ties(const BrickField& field, int lowest, const double* sums,
                                  const NodeUnknowns::Node* nodes) {
  const GridGeometry& g = model_.grid->geometry();
  const auto volume_of = [&](int node) { return sums[node_doubles * node + node_field::volume.first]; };
  int fullest = -1;
  for (const int corner : corner_) {
    const int node = lowest + corner;
    if (nodes[node].number >= 0 && (fullest < 0 || volume_of(node) > volume_of(fullest))) fullest = node;
  }
  if (fullest < 0) return;
  for (const int corner : corner_) {
    const int node = lowest + corner;
    const double volume = volume_of(node), part = volume / g.cell_volume();
    if (node == fullest || nodes[node].number < 0 || !(part > 0 && part < hardly_any)) continue;
    const double modulus = sums[node_doubles * node + node_field::modulus.first] / volume;
    ties_[field.index].push_back(
        {node, fullest, spring_ * (1 - part / hardly_any) * modulus * g.smallest_cell()});
  }
}

void CellStabilisation::find_cells(const NodeUnknowns& unknowns) {
  const BrickGrid& grid = *model_.grid;
  const GridGeometry& g = grid.geometry();
  const NodeBlockShape shape = grid.shape();
  cells_.resize(fields_.count());
  ties_.resize(fields_.count());
  if (alpha_ == 0) return;
  const double cell_volume = g.cell_volume();
  for_each_by_threads(0, static_cast<int>(fields_.count()), 4, [&](int f) {
    const BrickField& field = fields_.all()[static_cast<std::size_t>(f)];
    std::vector<Cell>& cells = cells_[field.index];
    cells.clear();
    ties_[field.index].clear();
    std::vector<double> sums(static_cast<std::size_t>(node_doubles * shape.nodes()));
    unknowns.sums(field, sums.data());
    const NodeUnknowns::Node* const nodes = unknowns.of(field);
    const BrickCoord coord = grid.brick(field.slot).coord;
    const std::int64_t first[3] = {brick_cells * std::int64_t{coord.x}, brick_cells * std::int64_t{coord.y},
                                   brick_cells * std::int64_t{coord.z}};
    int at[3];
    for (at[2] = shape.lowest(); at[2] < shape.highest(); ++at[2]) {
      for (at[1] = shape.lowest(); at[1] < shape.highest(); ++at[1]) {
        for (at[0] = shape.lowest(); at[0] < shape.highest(); ++at[0]) {
          bool inside = true;
          for (int a = 0; a < 3; ++a)
            inside =
                inside && first[a] + at[a] >= 0 && first[a] + at[a] < g.cells[static_cast<std::size_t>(a)];
          const int lowest = shape.index(at[0], at[1], at[2]);
          double fill = 0, volume = 0, modulus = 0, compliance = 0;
          bool active = true;
          bool mirrored = false;
          for (const int corner : corner_) mirrored |= nodes[lowest + corner].from != lowest + corner;
          if (mirrored) continue;
          for (int n = 0; n < 8 && active && inside; ++n) {
            const int node = lowest + corner_[n];
            active = nodes[node].number >= 0;
            const double* sum = sums.data() + node_doubles * node;
            // A node on a wall has the cells on one side alone.
            double sides = 1;
            for (std::size_t a = 0; a < 3; ++a) {
              const std::int64_t i = first[a] + at[a] + (n >> a & 1);
              if ((i == 0 && is_constrained(g.boundary[2 * a])) ||
                  (i == g.cells[a] && is_constrained(g.boundary[2 * a + 1])))
                sides *= 2;
            }
            fill += std::min(1.0, sides * sum[node_field::volume.first] / cell_volume) / 8;
            volume += sum[node_field::volume.first];
            modulus += sum[node_field::modulus.first];
            compliance += sum[node_field::compliance.first];
          }
          if (!active || !inside) {
            if (handles(field, at)) find_ties(field, lowest, sums.data(), nodes);
            continue;
          }
          if (!(compliance > 0)) continue;
          // A rigid body has a volume and neither modulus nor compliance: the smaller mean counts it as soft.
          const double empty = centred_ ? 1 : 1 - fill;
          if (empty > hardly_empty && handles(field, at))
            cells.push_back({lowest, alpha_ * empty * std::min(modulus / volume, volume / compliance)});
        }
      }
    }
  });
}

void CellStabilisation::add_forces(const AlignedDoubles& displacements) {
  BrickGrid& grid = *model_.grid;
  const auto doubles = static_cast<std::size_t>(node_doubles * grid.shape().nodes());
  for_each_by_threads(0, static_cast<int>(fields_.count()), 4, [&](int f) {
    const BrickField& field = fields_.all()[static_cast<std::size_t>(f)];
    const double* const record = displacements.data() + doubles * field.index;
    double* const contributions = grid.contributions(NodeArray::first, field.slot, field.number);
    for (const Cell& cell : cells_[field.index]) {
      double u[24];
      for (int n = 0; n < 8; ++n)
        for (int a = 0; a < 3; ++a) u[3 * n + a] = record[node_doubles * (cell.lowest + corner_[n]) + a];
      for (int n = 0; n < 8; ++n) {
        double* const force =
            contributions + node_doubles * (cell.lowest + corner_[n]) + node_field::force.first;
        for (int a = 0; a < 3; ++a) {
          double sum = 0;
          for (int q = 0; q < 24; ++q)
            sum += matrix_[static_cast<std::size_t>(3 * n + a)][static_cast<std::size_t>(q)] * u[q];
          force[a] -= cell.stiffness * sum;
        }
      }
    }
    for (const Tie& tie : ties_[field.index]) {
      for (int a = 0; a < 3; ++a) {
        const double pull =
            tie.stiffness * (record[node_doubles * tie.node + a] - record[node_doubles * tie.fullest + a]);
        contributions[node_doubles * tie.node + node_field::force.first + a] -= pull;
        contributions[node_doubles * tie.fullest + node_field::force.first + a] += pull;
      }
    }
  });
}

void CellStabilisation::add_tangent(const NodeUnknowns& unknowns, bool values, BlockMatrix& matrix) const {
  std::array<double, 24 * 24> sum;
  std::array<std::int64_t, 8> numbers;
  for (const BrickField& field : fields_.all()) {
    const NodeUnknowns::Node* const nodes = unknowns.of(field);
    for (const Cell& cell : cells_[field.index]) {
      std::uint32_t held = 0;
      for (int n = 0; n < 8; ++n) {
        const NodeUnknowns::Node& node = nodes[cell.lowest + corner_[n]];
        numbers[static_cast<std::size_t>(n)] = node.number;
        held |= std::uint32_t{node.held} << 3 * n;
      }
      for (std::size_t p = 0; p < 24; ++p)
        for (std::size_t q = 0; q < 24; ++q)
          sum[24 * p + q] = ((held >> p | held >> q) & 1) != 0 ? 0 : cell.stiffness * matrix_[p][q];
      matrix.add(numbers, values ? sum.data() : nullptr);
    }
    for (const Tie& tie : ties_[field.index]) {
      const NodeUnknowns::Node* const ends[2] = {nodes + tie.node, nodes + tie.fullest};
      const std::uint32_t held = ends[0]->held | std::uint32_t{ends[1]->held} << 3;
      for (std::size_t p = 0; p < 6; ++p)
        for (std::size_t q = 0; q < 6; ++q)
          sum[6 * p + q] = ((held >> p | held >> q) & 1) != 0 || p % 3 != q % 3 ? 0
                           : p == q                                             ? tie.stiffness
                                                                                : -tie.stiffness;
      numbers = {ends[0]->number, ends[1]->number};
      matrix.add(std::span(numbers).first(2), values ? sum.data() : nullptr);
    }
  }
}

}  // namespace mpm::core
