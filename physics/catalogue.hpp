// The parameter tables of every law in the lists, for the input reader and the keyword reference;
// physics/registry.hpp adds a user's laws.
#pragma once

#include "core/scene/catalogue.hpp"

namespace mpm::physics {

core::Catalogue catalogue();

}  // namespace mpm::physics
