// The parameter tables of every law in the lists, as the input reader and the keyword reference want them.
#pragma once

#include "core/scene/catalogue.hpp"

namespace mpm::physics {

core::Catalogue catalogue();

}  // namespace mpm::physics
