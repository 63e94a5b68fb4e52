#pragma once
// Whether a place lies within a body's solid: what Bool bodies subtract. Surfaces count as inside.

#include <functional>

#include "core/discretise/frame.hpp"

namespace mpm::core {

/// Global position; spacing: edge of the cube with the asking particle's volume.
using InsideTest = std::function<bool(const Position& position, double spacing)>;

/// The solid that the input states, not the lattice in it. For Point bodies, which state none: the places
/// within half the asking particle's spacing of a point (this one keeps all points of the body in memory, on
/// every rank). The body must have no faults (shape_check.hpp).
InsideTest make_inside_test(const Scene& scene, const BodyInput& body);

}  // namespace mpm::core
