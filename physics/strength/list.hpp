// The strength models. To add one: a file beside these, and its name here.
#pragma once

#include <variant>

#include "physics/strength/cauchy_elastic.hpp"
#include "physics/strength/ela_plastic.hpp"
#include "physics/strength/high_exp_burn.hpp"
#include "physics/strength/holmquist_johnson_cook.hpp"
#include "physics/strength/iso_elastic.hpp"
#include "physics/strength/iso_harden.hpp"
#include "physics/strength/jh2.hpp"
#include "physics/strength/johnson_cook.hpp"
#include "physics/strength/null.hpp"
#include "physics/strength/rht.hpp"
#include "physics/strength/sim_johnson_cook.hpp"

namespace mpm::physics {

using StrengthModel = std::variant<IsoElastic, CauchyElastic, ElaPlastic, IsoHarden, SimJohnsonCook,
                                   JohnsonCook, Null, HighExpBurn, HolmquistJohnsonCook, RHT, JH2>;

}  // namespace mpm::physics
