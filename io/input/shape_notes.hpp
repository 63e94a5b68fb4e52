// What a body's shape becomes that the input does not say.
#pragma once

#include <vector>

#include "core/scene/scene.hpp"

namespace mpm::io {

/// The blocks whose particles, of whole number along each edge, have another volume than the input says.
void note_blocks(const core::Scene& scene, std::vector<core::Diagnostic>& notes);

/// Bodies whose particles are farther apart than the smallest cell is long.
void note_wide_spacings(const core::Scene& scene, std::vector<core::Diagnostic>& notes);

/// The first deformable body with one particle in a cell where the shape functions are those that do not go
/// with it; null without.
const core::BodyInput* body_of_single_particles(const core::Scene& scene);
/// Deformable bodies with one particle in a cell, where the method gains energy from such.
void note_single_particles(const core::Scene& scene, std::vector<core::Diagnostic>& notes);

/// A scene none of whose bodies takes part in the run.
void note_no_bodies(const core::Scene& scene, std::vector<core::Diagnostic>& notes);

}  // namespace mpm::io
