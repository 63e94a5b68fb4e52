#pragma once
// Whether a place lies within a body's solid: what Bool bodies subtract. Surfaces count as inside.

#include <functional>

#include "core/discretise/frame.hpp"

namespace mpm::core {

/// Global position; spacing: edge of the cube with the asking particle's volume.
using InsideTest = std::function<bool(const Position& position, double spacing)>;

/// The solid that the input states, not the lattice in it. For Point bodies, which state none: the places
/// within half the asking particle's spacing of a point (this one keeps all points of the body in memory, on
/// every rank). Throws InputErrors like make_seed_source.
InsideTest make_inside_test(const Scene& scene, const BodyInput& body);

/// Body number `index`, counted through all components. Throws std::out_of_range.
const BodyInput& body_number(const Scene& scene, std::size_t index);

}  // namespace mpm::core
