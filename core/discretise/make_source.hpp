#pragma once

#include <memory>

#include "core/discretise/seeds.hpp"

namespace mpm::core {

/// make_seed_source without its checks: for bodies whose shape has no faults (shape_check.hpp).
std::unique_ptr<SeedSource> make_unchecked_source(const Scene& scene, const BodyInput& body);

/// Whether a source has no particle; false for one with so many units that checking takes long.
bool is_surely_empty(const SeedSource& source);

}  // namespace mpm::core
