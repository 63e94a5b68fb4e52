// Rows of the parameter tables that several laws share, each with its own member.
#pragma once

#include <string_view>

#include "physics/parameter.hpp"

namespace mpm::physics {

inline constexpr core::ParameterInfo young_row{.name = "Young",
                                               .required = true,
                                               .min = 0,
                                               .min_open = true,
                                               .dimension = "stress",
                                               .meaning = "Young's modulus"};
constexpr core::ParameterInfo poisson_row(std::string_view meaning = "Poisson's ratio") {
  return {.name = "Poisson",
          .required = true,
          .min = -1,
          .max = 0.5,
          .min_open = true,
          .max_open = true,
          .meaning = meaning};
}

inline constexpr core::ParameterInfo yield0_row{.name = "Yield0",
                                                .required = true,
                                                .min = 0,
                                                .min_open = true,
                                                .dimension = "stress",
                                                .meaning = "initial yield stress"};
inline constexpr core::ParameterInfo tangent_modulus_row{
    .name = "TangMod",
    .required = true,
    .min = 0,
    .dimension = "stress",
    .meaning = "tangent modulus d(stress)/d(strain), < Young"};
inline constexpr core::ParameterInfo plastic_work_row{
    .name = "PlasticWorkCoefficient",
    .default_value = 0.9,
    .min = 0,
    .max = 1,
    .meaning = "fraction of the plastic work that is converted to heat"};

}  // namespace mpm::physics
