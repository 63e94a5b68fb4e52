// The strength models. To add one: a file beside these, and its name here.
#pragma once

#include <variant>

#include "physics/strength/iso_harden.hpp"

namespace mpm::physics {

using StrengthModel = std::variant<IsoHarden>;

}  // namespace mpm::physics
