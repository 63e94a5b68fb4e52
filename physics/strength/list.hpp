// The strength models. To add one: a file beside these, and its name here.
#pragma once

#include "physics/laws.hpp"
#include "physics/strength/cauchy_elastic.hpp"
#include "physics/strength/corotated.hpp"
#include "physics/strength/deshpande_fleck.hpp"
#include "physics/strength/drucker_prager.hpp"
#include "physics/strength/ela_plastic.hpp"
#include "physics/strength/gurson.hpp"
#include "physics/strength/high_exp_burn.hpp"
#include "physics/strength/holmquist_johnson_cook.hpp"
#include "physics/strength/iso_elastic.hpp"
#include "physics/strength/iso_harden.hpp"
#include "physics/strength/jh2.hpp"
#include "physics/strength/johnson_cook.hpp"
#include "physics/strength/mooney_rivlin.hpp"
#include "physics/strength/neo_hookean.hpp"
#include "physics/strength/null.hpp"
#include "physics/strength/rht.hpp"
#include "physics/strength/rigid.hpp"
#include "physics/strength/sim_johnson_cook.hpp"
#include "physics/strength/uniaxial.hpp"
#include "physics/strength/voce.hpp"

namespace mpm::physics {

using StrengthModels =
    LawList<IsoElastic, CauchyElastic, Elastic1D, ElaPlastic, IsoHarden, Voce, LinHarElaPlastic1D,
            JohnsonCook, SimJohnsonCook, Null, HighExpBurn, HolmquistJohnsonCook, MooneyRivlin, Rigid, RHT,
            JH2, DruckerPrager, DFFoam, Gurson, NeoHookean, Corotated>;

}  // namespace mpm::physics
