// Defaults of the method that do not suit the scene, and motions that the method does not bring about as a
// user may expect.
#pragma once

#include <vector>

#include "core/scene/scene.hpp"
#include "io/input/node.hpp"

namespace mpm::io {

/// Explicit scenes in which bodies move towards each other or a wall by a cell or more, or a detonation runs,
/// where the input does not choose the shape functions.
void note_linear_functions(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes);

/// Combinations of scheme, transfer and shape functions that have no stable step, or lose it in long runs.
void note_scheme(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes);

/// Deformable bodies of prescribed velocity beside other bodies, in explicit steps.
void note_soft_drivers(const core::Scene& scene, std::vector<core::Diagnostic>& notes);

/// Axes along which nothing holds the bodies of a quasi-static scene.
void note_free_axes(const core::Scene& scene, std::vector<core::Diagnostic>& notes);

}  // namespace mpm::io
