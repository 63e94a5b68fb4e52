// The parameter tables of every law in the lists, as the input reader and the keyword reference want them;
// with a user's laws besides: physics/registry.hpp.
#pragma once

#include "core/scene/catalogue.hpp"

namespace mpm::physics {

core::Catalogue catalogue();

}  // namespace mpm::physics
