// Stiffness of the empty part of partly filled cells, so that nodes that hardly any particle feels do not
// spoil the system: at a node whose weights are of size e the particles' force is of order e, their stiffness
// of order e^2, and nothing bounds its displacement, of order 1/e.
//
// Every cell whose eight nodes are active gets a soft elastic material in its empty part (the alpha method of
// finite cells: Parvizian, Duester and Rank, Comput. Mech. 41 (2007) 121):
//   f = - alpha (1 - fill) M  integral of B^T (sym grad u),    M: the longitudinal modulus of the material
//   around, at most four times its shear modulus; of several materials the harmonic mean, as a share of the
//   stiffest one's would carry more than a soft matrix does
// The displacement is that of the step and the grid is new in each, so this material never stores stress: it
// changes a stiffness by the share alpha (Implicit@stabilisation). Other remedies: ghost penalties on the
// faces of such cells (Coombs, IJNME 124 (2023) 4841), which couple nodes two cells apart.
//
// Cells with inactive nodes, and those beyond a free face of the grid, have no such filling. There a node
// with less than hardly_any of a cell's volume around it is tied to the fullest node of the cell by a spring
// of a thousandth of alpha times the material's stiffness: it acts on the difference of two displacements, so
// that it carries no weight, however far a step moves both.
//
// Where components are in contact each is stabilised by itself: a cell that two share is partly empty for
// both.
//
// Shape functions through cell centres (SGMP, DDMP) do not see a checkerboard of displacements even where
// cells are full: there all cells count as empty.
#pragma once

#include <array>
#include <vector>

#include "core/implicit/newton_solver.hpp"
#include "core/implicit/node_unknowns.hpp"

namespace mpm::core {

/// Stiffness of a cell with these edges: integral of B^T (sym grad u) for modulus 1. Rows and columns 3 n +
/// axis of corner n = i + 2 j + 4 k; in length.
using CellMatrix = std::array<std::array<double, 24>, 24>;
CellMatrix cell_matrix(const Vec3<double>& cell);

class CellStabilisation {
 public:
  /// Part of a cell's volume below which a node is tied.
  static constexpr double hardly_any = 0.05;

  CellStabilisation(Model& model, const BrickFields& fields);

  /// Finds the cells, once the nodes are numbered and mapped::implicit_motion has been summed.
  void find_cells(const NodeUnknowns& unknowns);
  /// Adds forces to the contributions, in the components of node_field::force.
  void add_forces(const AlignedDoubles& displacements);
  /// Adds the derivative of minus these forces; its structure alone without `values`.
  void add_tangent(const NodeUnknowns& unknowns, bool values, BlockMatrix& matrix) const;

 private:
  struct Cell {
    std::int32_t lowest;  ///< node of the brick
    double stiffness;     ///< alpha (1 - fill) M
  };
  struct Tie {
    std::int32_t node, fullest;  ///< of the brick
    double stiffness;
  };
  void find_ties(const BrickField& field, int lowest, const double* sums, const NodeUnknowns::Node* nodes);
  bool handles(const BrickField& field, const int (&at)[3]) const;

  Model& model_;
  const BrickFields& fields_;
  bool centred_;   ///< shape functions through cell centres
  double alpha_;   ///< Implicit@stabilisation
  double spring_;  ///< of a tie, over the material's stiffness
  CellMatrix matrix_;
  int corner_[8];                         ///< nodes of a cell relative to its lowest
  std::vector<std::vector<Cell>> cells_;  ///< by field
  std::vector<std::vector<Tie>> ties_;    ///< by field
};

}  // namespace mpm::core
