// The equations of state of the input. To add one: a file beside these, and its name here.
#pragma once

#include "physics/eos/gruneisen.hpp"
#include "physics/eos/holmquist_johnson_cook.hpp"
#include "physics/eos/jwl.hpp"
#include "physics/eos/p_alpha.hpp"
#include "physics/eos/polynomial.hpp"
#include "physics/eos/polynomial2.hpp"
#include "physics/laws.hpp"

namespace mpm::physics {

template <>
inline constexpr int solid_number<Polynomial> = 1;
template <>
inline constexpr int solid_number<Polynomial2> = 2;
template <>
inline constexpr int solid_number<Gruneisen> = 3;

using EquationsOfState = LawList<Polynomial, Polynomial2, Jwl, Gruneisen, PAlpha<Polynomial>,
                                 PAlpha<Polynomial2>, PAlpha<Gruneisen>, HolmquistJohnsonCookBulk>;

}  // namespace mpm::physics
