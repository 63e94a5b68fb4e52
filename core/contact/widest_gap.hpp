// The normal between two rigid bodies near a node: along the shortest distance between the convex hulls of
// their particles there. The plane across it is the one as far as possible from both bodies; between flat
// faces it is parallel to them whatever edges are near, to round-off, so that one slides on the other without
// any resistance. Regression (separating_plane.hpp) leaves a tilt of up to a degree, which would lift or stop
// a body that cannot strain.
//
// The shortest distance is the point of least norm in the hull of the differences y - x of both bodies'
// particles, by Wolfe's algorithm (Math. Program. 11 (1976) 128). Hulls that overlap have none.
// Shown by tests/core/contact/widest_gap_test.cpp.
#pragma once

#include <optional>

#include "core/contact/separating_plane.hpp"

namespace mpm::core {

/// Unit vector from the first body to the second. None without particles of both, or where their hulls meet.
std::optional<Vec3<double>> widest_gap_normal(const LabelledPoints& points);

}  // namespace mpm::core
