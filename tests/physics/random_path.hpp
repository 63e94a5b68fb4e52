// The path that the tests of the laws take.
#pragma once

#include "physics/checks/random_path.hpp"

namespace mpm::tests {
using physics::RandomPath;
}  // namespace mpm::tests
