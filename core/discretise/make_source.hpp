#pragma once

#include <memory>

#include "core/discretise/seeds.hpp"

namespace mpm::core {

/// make_seed_source without its checks: for bodies whose shape has no faults (shape_check.hpp).
std::unique_ptr<SeedSource> make_unchecked_source(const Scene& scene, const BodyInput& body);

/// Whether a source has no particle; false if it has too many units for a quick check.
bool is_surely_empty(const SeedSource& source);

}  // namespace mpm::core
