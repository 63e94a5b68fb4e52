// The equations of state. To add one: a file beside these, and its name here.
#pragma once

#include <variant>

#include "physics/eos/ceramic_bulk.hpp"
#include "physics/eos/elastic_bulk.hpp"
#include "physics/eos/gruneisen.hpp"
#include "physics/eos/holmquist_johnson_cook.hpp"
#include "physics/eos/jwl.hpp"
#include "physics/eos/p_alpha.hpp"
#include "physics/eos/polynomial.hpp"
#include "physics/eos/polynomial2.hpp"
#include "physics/eos/strength_pressure.hpp"

namespace mpm::physics {

template <>
inline constexpr int solid_number<Polynomial> = 1;
template <>
inline constexpr int solid_number<Polynomial2> = 2;
template <>
inline constexpr int solid_number<Gruneisen> = 3;

/// The first is what a material without EquationOfState has, the last what one has whose strength law
/// computes the pressure.
using EquationOfState =
    std::variant<ElasticBulk, Gruneisen, Polynomial, Polynomial2, Jwl, CeramicBulk, HolmquistJohnsonCookBulk,
                 PAlpha<Polynomial>, PAlpha<Polynomial2>, PAlpha<Gruneisen>, StrengthPressure>;

}  // namespace mpm::physics
