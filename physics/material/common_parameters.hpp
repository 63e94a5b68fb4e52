// Parameters of every material beside its laws: artificial viscosity, behaviour after failure, heat (manual
// 3.2.1), and the common part of an equation of state (manual 3.2.2).
#pragma once

#include <array>

#include "physics/parameter.hpp"

namespace mpm::physics {

struct CommonParameters {
  double bq1 = 1.5;
  double bq2 = 0.06;
  double failed_type = 0;
  double tensile_cutoff = 0;        ///< stress
  double fail_viscosity = 0;        ///< stress time
  double constant_sound_speed = 0;  ///< VarSoundspeed
  double failure_damage_threshold = 1;
  double young = 0;  ///< stress; 0: not given
  double poisson = 0;
  double temperature_coefficient = 0;
  double room_temperature = 293;
  double conductivity = 0;
  double specific_heat = 0;  ///< 0: not given

  static constexpr auto parameters() {
    using P = CommonParameters;
    return std::array<Parameter<P>, 13>{{
        {&P::bq1,
         {.name = "bq1",
          .default_value = 1.5,
          .min = 0,
          .meaning = "artificial bulk viscosity, quadratic term"}},
        {&P::bq2,
         {.name = "bq2",
          .default_value = 0.06,
          .min = 0,
          .meaning = "artificial bulk viscosity, linear term"}},
        {&P::failed_type,
         {.name = "FailedType",
          .default_value = 0,
          .min = 0,
          .max = 2,
          .integer = true,
          .meaning = "pressure of a failed particle: 0 no tension, 1 none, 2 tension down to "
                     "TensileCutoff"}},
        {&P::tensile_cutoff,
         {.name = "TensileCutoff",
          .default_value = 0,
          .max = 0,
          .dimension = "stress",
          .meaning = "with FailedType 2: a failed particle's pressure below it becomes 0"}},
        {&P::fail_viscosity,
         {.name = "FailViscosity",
          .default_value = 0,
          .min = 0,
          .dimension = "stress time",
          .meaning = "shear viscosity of a failed particle"}},
        {&P::constant_sound_speed,
         {.name = "VarSoundspeed",
          .default_value = 0,
          .min = 0,
          .max = 1,
          .integer = true,
          .meaning = "1: the critical time step keeps the initial sound speed"}},
        {&P::failure_damage_threshold,
         {.name = "FailureDamageThreshold",
          .default_value = 1,
          .min = 0,
          .meaning = "damage from which a particle joins the failed component"}},
        {&P::young,
         {.name = "Young", .min = 0, .min_open = true, .dimension = "stress", .meaning = "Young's modulus"}},
        {&P::poisson,
         {.name = "Poisson",
          .min = -1,
          .max = 0.5,
          .min_open = true,
          .max_open = true,
          .meaning = "Poisson's ratio"}},
        {&P::temperature_coefficient,
         {.name = "TemperatureCoefficient",
          .default_value = 0,
          .dimension = "1/temperature",
          .meaning = "linear thermal expansion"}},
        {&P::room_temperature,
         {.name = "roomt",
          .default_value = 293,
          .min = 0,
          .dimension = "temperature",
          .meaning = "temperature at the start"}},
        {&P::conductivity,
         {.name = "CoefficientOfThermalConductivity",
          .default_value = 0,
          .min = 0,
          .dimension = "power/(length temperature)",
          .meaning = "heat conductivity; 0: adiabatic"}},
        {&P::specific_heat,
         {.name = "SpecHeat",
          .min = 0,
          .min_open = true,
          .dimension = "energy/(mass temperature)",
          .meaning = "specific heat; plastic work heats the particle where it is given"}},
    }};
  }
};

struct CommonEosParameters {
  double c0 = 0;  ///< bulk sound speed at rest; 0: from the equation
  double e0 = 0;  ///< stress

  static constexpr auto parameters() {
    using P = CommonEosParameters;
    return std::array<Parameter<P>, 2>{{
        {&P::c0,
         {.name = "C0",
          .min = 0,
          .min_open = true,
          .dimension = "velocity",
          .meaning = "sound speed at rest; computed from the equation when absent"}},
        {&P::e0,
         {.name = "E0",
          .default_value = 0,
          .dimension = "stress",
          .meaning = "initial internal energy per initial volume"}},
    }};
  }
};

}  // namespace mpm::physics
