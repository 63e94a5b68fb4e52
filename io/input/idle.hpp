// Reports input settings without effect, because the feature that uses them is off or absent: one note for
// each kind. mpm_check prints the notes, and the log of a run contains them.
#pragma once

#include <vector>

#include "core/scene/scene.hpp"
#include "io/input/node.hpp"

namespace mpm::io {

/// `scene` was built from `root` without faults.
std::vector<core::Diagnostic> idle_settings(const Node& root, const core::Scene& scene);

}  // namespace mpm::io
