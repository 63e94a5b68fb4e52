// The background grid and its partition among ranks.

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "core/has_shape.hpp"
#include "core/scene/limits.hpp"
#include "io/input/build.hpp"

namespace mpm::io {

namespace {

constexpr double most_cells = 0x1p62;  // they are numbered with 64 bits

core::ShapeFunction shape_function(std::string_view word) {
  using enum core::ShapeFunction;
  if (word == "uGIMP") return uniform_gimp;
  if (word == "cpGIMP") return contiguous_particle_gimp;
  if (word == "CPDI") return cpdi;
  if (word == "CPDI2") return cpdi2;
  if (word == "QuadraticBSpline") return quadratic_bspline;
  if (word == "CubicBSpline") return cubic_bspline;
  if (word == "DDMP") return ddmp;
  if (word == "SGMP") return sgmp;
  return linear;
}

void require_built(const Node& node, std::string_view attribute, std::string_view shape,
                   const BuildContext& context) {
  const bool is_known = !shape.empty();  // else it has been reported
  if (!is_known || core::has_shape(shape)) return;
  node.report(context.diagnostics, attribute,
              fmt::format("this program was built without {}: expected {}, or a program built with the CMake "
                          "option -DMPM_SHAPES=all",
                          shape, fmt::join(core::built_shapes, ", ")));
}

void read_segments(core::GridAxis& axis, const Node& cell, char letter, const BuildContext& context) {
  const std::vector<Node> nodes = cell.children(fmt::format("{}Segment", letter));
  double begin = axis.min;
  std::size_t cells = 0;
  for (const Node& node : nodes) {
    axis.segments.push_back(
        {node.real("end"), static_cast<std::size_t>(node.integer("cells")), node.real("ratio")});
    const core::GridSegment& segment = axis.segments.back();
    if (segment.end <= begin)
      node.report(context.diagnostics, "end",
                  fmt::format("expected more than {}, where the segment begins", begin));
    begin = segment.end;
    cells += segment.cells;
  }
  if (nodes.empty()) return;
  axis.cells = cells;
  if (std::abs(begin - axis.max) > 1e-9 * (axis.max - axis.min))
    nodes.back().report(context.diagnostics, "end",
                        fmt::format("the last segment must end at {}Max, {}", letter, axis.max));
}

/// The number of cells between two walls: an integer up to round-off; at a free face the last cell may extend
/// beyond it.
void count_cells(core::GridAxis& axis, const Node& max, const Node& size, std::string_view attribute,
                 const BuildContext& context) {
  const double length = axis.max - axis.min;
  if (!(length > 0) || !(axis.cell_size > 0)) return;
  const double cells = length / axis.cell_size;
  if (cells > static_cast<double>(core::most_cells_per_axis))
    return size.report(
        context.diagnostics, attribute,
        fmt::format("this gives {:.7g} cells along the axis; at most {} are possible: use larger cells",
                    std::ceil(cells), core::most_cells_per_axis));
  constexpr double round_off = 1e-6;  // of a cell
  const double whole = std::round(cells);
  if (whole < 1 || (whole == 1 && cells < 1 - round_off))
    return size.report(context.diagnostics, attribute,
                       fmt::format("a cell is larger than the grid, which is {} long", length));
  if (std::abs(cells - whole) <= round_off * std::max(1., 1e-6 * whole)) {
    axis.cells = static_cast<std::size_t>(whole);
  } else if (axis.upper == core::Boundary::free) {
    axis.cells = static_cast<std::size_t>(std::ceil(cells));
  } else {
    max.report(
        context.diagnostics, "value",
        fmt::format(
            "a wall must coincide with a cell face: {} cells of {} do not fit between {} and {}; expected "
            "{} or {}",
            cells, axis.cell_size, axis.min, axis.max, axis.min + std::floor(cells) * axis.cell_size,
            axis.min + std::ceil(cells) * axis.cell_size));
  }
}

core::GridAxis build_axis(const Node& cell, std::size_t direction, const BuildContext& context) {
  const char letter = "XYZ"[direction];
  const std::string_view attribute = std::array{"dx", "dy", "dz"}[direction];
  core::GridAxis axis;
  const std::optional<Node> min = cell.child(fmt::format("{}Min", letter));
  const std::optional<Node> max = cell.child(fmt::format("{}Max", letter));
  const std::optional<Node> size = cell.child("DCell");
  if (!min || !max || !size) return axis;
  axis.min = min->real("value");
  axis.max = max->real("value");
  axis.lower = static_cast<core::Boundary>(min->small_integer("boundary"));
  axis.upper = static_cast<core::Boundary>(max->small_integer("boundary"));
  axis.cell_size = size->real(attribute);
  if (axis.max <= axis.min)
    max->report(context.diagnostics, "value", fmt::format("expected more than {}Min, {}", letter, axis.min));
  read_segments(axis, cell, letter, context);
  if (axis.segments.empty()) count_cells(axis, *max, *size, attribute, context);
  return axis;
}

core::MovingGridInput build_moving(const Node& node, const BuildContext& context) {
  core::MovingGridInput moving;
  moving.enable = node.boolean("enable");
  moving.consider_failed_particles = node.boolean("consider_failure_particle");
  moving.time_step_factor = node.real("time_step_factor");
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string low = fmt::format("{}_min", "xyz"[i]), high = fmt::format("{}_max", "xyz"[i]);
    moving.min[i] = node.given_real(low).value_or(-moving.infinity);
    moving.max[i] = node.given_real(high).value_or(moving.infinity);
    if (moving.max[i] <= moving.min[i])
      node.report(context.diagnostics, high, fmt::format("expected more than {}, {}", low, moving.min[i]));
  }
  return moving;
}

}  // namespace

core::GridInput build_grid(const Node& root, const BuildContext& context) {
  core::GridInput grid;
  const std::optional<Node> node = root.child("Grid");
  if (!node) return grid;
  grid.source = context.at(*node);
  grid.mass_cutoff = node->real("mass_cutoff");
  grid.shape = shape_function(node->word("shape"));
  require_built(*node, "shape", node->word("shape"), context);
  if (node->boolean("gimp")) {
    if (node->find("shape") && grid.shape != core::ShapeFunction::uniform_gimp)
      node->report(context.diagnostics, "gimp", "contradicts shape; remove one of the two");
    grid.shape = core::ShapeFunction::uniform_gimp;
    if (!node->find("shape")) require_built(*node, "gimp", "uGIMP", context);
  }
  if (const std::optional<Node> dynamic = node->child("DynamicCell"))
    grid.dynamic_cell = {dynamic->boolean("enable"), dynamic->small_integer("clear_steps")};
  const std::optional<Node> cell = node->child("Cell");
  if (!cell) return grid;
  grid.nonuniform = cell->type() == "nonuniform";
  double cells = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    grid.axes[i] = build_axis(*cell, i, context);
    cells *= static_cast<double>(grid.axes[i].cells);
  }
  if (cells > most_cells)
    cell->report(context.diagnostics,
                 fmt::format("{:.3g} cells cannot be numbered; expected fewer than 2^62", cells));
  if (const std::optional<Node> moving = cell->child("MovingGrid"))
    grid.moving = build_moving(*moving, context);
  return grid;
}

core::DecompositionInput build_decomposition(const Node& root, const BuildContext& context) {
  core::DecompositionInput decomposition;
  const std::optional<Node> node = root.child("DomainDecomposition");
  if (!node) return decomposition;
  decomposition.source = context.at(*node);
  const auto x = node->given_integer("dimension0");
  const auto y = node->given_integer("dimension1");
  const auto z = node->given_integer("dimension2");
  if (x && y && z)
    decomposition.dimensions = {static_cast<int>(*x), static_cast<int>(*y), static_cast<int>(*z)};
  const std::string method = node->word("method");
  if (method == "metis")
    decomposition.method = core::PartitionMethod::metis;
  else if (method == "uniform" || decomposition.dimensions)
    decomposition.method = core::PartitionMethod::uniform;
  if (const auto interval = node->given_integer("rebalance_interval"))
    decomposition.rebalance_interval = static_cast<int>(*interval);
  decomposition.imbalance_tolerance = node->real("imbalance_tolerance");
  return decomposition;
}

}  // namespace mpm::io
