// The equations of state. To add one: a file beside these, and its name here.
#pragma once

#include <variant>

#include "physics/eos/elastic_bulk.hpp"
#include "physics/eos/gruneisen.hpp"
#include "physics/eos/jwl.hpp"
#include "physics/eos/polynomial.hpp"
#include "physics/eos/polynomial2.hpp"

namespace mpm::physics {

/// The first is what a material without EquationOfState has.
using EquationOfState = std::variant<ElasticBulk, Gruneisen, Polynomial, Polynomial2, Jwl>;

}  // namespace mpm::physics
