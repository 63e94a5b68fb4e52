// Writes a scene in the input language with all defaults, to inspect an input or to compare two. Reading it
// again gives the same scene.
#pragma once

#include <string>

#include "core/scene/scene.hpp"

namespace mpm::io {

std::string to_text(const core::Scene& scene);

}  // namespace mpm::io
