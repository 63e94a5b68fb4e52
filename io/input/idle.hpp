// What an input states that makes no difference to the run, because the feature that would use it is off or
// absent: one note for each kind, so that nobody waits for an effect. mpm_check prints the notes, a run's log
// holds them.
#pragma once

#include <vector>

#include "core/scene/scene.hpp"
#include "io/input/node.hpp"

namespace mpm::io {

/// `scene` is what `root` became, without fault.
std::vector<core::Diagnostic> idle_settings(const Node& root, const core::Scene& scene);

}  // namespace mpm::io
