#pragma once
// The background grid from the input.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/scene/errors.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// Boundary condition of a grid face on its nodes. Values are the input's.
enum class Boundary {
  free = 0,
  fixed = 1,
  symmetry = 2,  ///< no velocity along the normal
  nonreflecting = 3,
  rigid_wall = 4,  ///< no penetration, free to leave
};

/// Whether the face holds nodes; the material does not go on beyond it.
constexpr bool is_constrained(Boundary b) { return b != Boundary::free && b != Boundary::nonreflecting; }

enum class ShapeFunction {
  linear,
  uniform_gimp,
  contiguous_particle_gimp,
  cpdi,
  cpdi2,
  quadratic_bspline,
  cubic_bspline,
  ddmp,
  sgmp,
};

/// A segment of cells along one axis of a nonuniform grid, from the end of the previous one.
struct GridSegment {
  double end = 0;         ///< coordinate
  std::size_t cells = 0;  ///< > 0
  double ratio = 1;       ///< last cell's length over the first one's
};

/// One axis of the grid; [min, max] are the physical walls, without the extra cells of the shape functions.
struct GridAxis {
  double min = 0;
  double max = 0;
  Boundary lower = Boundary::free;
  Boundary upper = Boundary::free;
  double cell_size = 0;
  /// Cells along the axis. A wall at max coincides with a cell face; a free face may be inside the last cell.
  std::size_t cells = 0;
  std::vector<GridSegment> segments;  ///< nonuniform grids only; empty: uniform
};

/// The grid follows the particles with a constant number of cells.
struct MovingGridInput {
  bool enable = false;
  bool consider_failed_particles = false;
  double time_step_factor = 0.8;
  /// Infinite where the motion is not bounded.
  Vec3<double> min{-infinity, -infinity, -infinity};
  Vec3<double> max{infinity, infinity, infinity};

  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

/// Storage only of cells with particles. Always on here; the settings are kept for reference.
struct DynamicCellInput {
  bool enable = false;
  int clear_steps = 10;
};

struct GridInput {
  /// Nodes lighter than mass_cutoff * mean reference density * cell volume are ignored.
  double mass_cutoff = 2.220446049250313e-16;
  ShapeFunction shape = ShapeFunction::linear;
  bool nonuniform = false;
  std::array<GridAxis, 3> axes{};
  MovingGridInput moving;
  DynamicCellInput dynamic_cell;
  SourceLocation source;

  bool has_face(Boundary of) const {
    return std::ranges::any_of(axes, [&](const GridAxis& a) { return a.lower == of || a.upper == of; });
  }
  double smallest_cell() const { return std::ranges::min(axes, {}, &GridAxis::cell_size).cell_size; }
};

}  // namespace mpm::core
