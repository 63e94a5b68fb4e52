// A scene written in the input language with all defaults: what `--dry-run` shows, and
// what a user compares when two inputs should be the same. Reading it again gives the same scene.
#pragma once

#include <string>

#include "core/scene/scene.hpp"

namespace mpm::io {

std::string to_text(const core::Scene& scene);

}  // namespace mpm::io
