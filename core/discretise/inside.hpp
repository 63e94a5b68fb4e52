#pragma once
// Whether a position is inside a body's solid, for Bool bodies. Surfaces count as inside.

#include <functional>

#include "core/discretise/frame.hpp"

namespace mpm::core {

/// Global position; spacing: edge of the cube with the querying particle's volume.
using InsideTest = std::function<bool(const Position& position, double spacing)>;

/// The solid of the input, not its lattice. For Point bodies, which define no solid: the positions within
/// half the querying particle's spacing of a point (this test stores all points of the body, on every rank).
/// The body must have no faults (shape_check.hpp).
InsideTest make_inside_test(const Scene& scene, const BodyInput& body);

}  // namespace mpm::core
