// Notes on bodies that meet, in scenes that are valid, but may not do what is wanted.
#pragma once

#include <vector>

#include "core/scene/scene.hpp"
#include "io/input/diagnostics.hpp"
#include "io/input/node.hpp"

namespace mpm::io {

/// With contact.
void note_contact(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes);
/// Consequences of several components without contact.
void note_no_contact(const core::Scene& scene, std::vector<core::Diagnostic>& notes);

}  // namespace mpm::io
