#include "tests/physics/samples.hpp"

#include <cmath>
#include <stdexcept>

#include "physics/catalogue.hpp"

namespace mpm::tests {

namespace {

using core::LawInput;
using core::MaterialInput;
using Values = core::ParameterValues;

const Values elastic{{"Young", 124e9}, {"Poisson", 0.34}};

Values with(Values values, const Values& more) {
  for (const auto& [name, value] : more) values.insert_or_assign(name, value);
  return values;
}

// Johnson-Cook constants of OFHC copper: manual, tables 6.2 and 6.3.
const Values johnson_cook{{"Yield0", 90e6}, {"B", 292e6}, {"n", 0.31}, {"C", 0.025}, {"epso", 1.0}};
const Values heat{{"m", 1.09}, {"melt", 1356.0}, {"roomt", 293.0}, {"SpecHeat", 383.0}};
const Values damage{{"D1", 0.54}, {"D2", 4.89}, {"D3", -3.03}, {"D4", 0.014}, {"D5", 1.12}};

// Soil: Young, Poisson and the angle of friction of the thesis' table 6.1; cohesion and dilation for the
// tests.
const Values soil{{"Young", 70e6}, {"Poisson", 0.3}};

// q1, q2, fc, ff and nucleation: Tvergaard and Needleman, Acta Metallurgica 32 (1984) 157.
const Values voids{{"Yield0", 200e6}, {"q1", 1.5}, {"q2", 1.0}, {"f0", 0.02}, {"fc", 0.15}, {"ff", 0.25}};
const Values nucleation{{"fN", 0.04}, {"sN", 0.1}, {"eN", 0.3}};

bool solids_are_not(const std::string& type) {
  return type == "Elastic_1D" || type == "LinHarElaPlastic_1D" || type == "Rigid";
}

/// Strength laws that compute the pressure themselves: no equation of state beside them.
bool own_pressure(const std::string& type) {
  return type == "CauchyElastic" || type == "DruckerPrager" || type == "DFFoam" || type == "Gurson" ||
         type == "MooneyRivlin" || type == "NeoHookean" || type == "Corotated" || solids_are_not(type);
}

/// Strength laws: label, type, parameters, path strain.
struct Strength {
  std::string label, type;
  Values values;
  double strain;
};
const std::vector<Strength> strengths{
    {"IsoElastic", "IsoElastic", elastic, 0.02},
    {"CauchyElastic", "CauchyElastic", elastic, 0.02},
    {"ElaPlastic", "ElaPlastic", with(elastic, {{"Yield0", 200e6}}), 0.02},
    {"IsoHarden", "IsoHarden", with(elastic, {{"Yield0", 200e6}, {"TangMod", 3e9}}), 0.02},
    {"IsoHarden heated", "IsoHarden",
     with(elastic, {{"Yield0", 200e6}, {"TangMod", 3e9}, {"SpecHeat", 383.0}}), 0.02},
    {"IsoHarden expanding", "IsoHarden",
     with(elastic,
          {{"Yield0", 200e6}, {"TangMod", 3e9}, {"SpecHeat", 383.0}, {"TemperatureCoefficient", 17e-6}}),
     0.02},
    {"Voce", "Voce", with(elastic, {{"Yield0", 200e6}, {"Q", 120e6}, {"b", 100.0}, {"H", 1e9}}), 0.02},
    {"SimJohnsonCook", "SimJohnsonCook", with(elastic, johnson_cook), 0.02},
    {"JohnsonCook", "JohnsonCook", with(with(elastic, johnson_cook), heat), 0.02},
    {"JohnsonCook damaged", "JohnsonCook", with(with(with(elastic, johnson_cook), heat), damage), 0.02},
    {"Null", "Null", {}, 0.02},
    {"Null Newtonian", "Null", {{"mu", 20.0}}, 0.02},
    {"HighExpBurn", "HighExpBurn", {{"D", 6930.0}}, 0.02},
    {"HighExpBurn both", "HighExpBurn", {{"D", 6930.0}, {"beta", 0.0}, {"PCJ", 115e9}, {"mu", 20.0}}, 0.02},
    {"HighExpBurn by compression", "HighExpBurn", {{"D", 6930.0}, {"beta", 1.0}, {"PCJ", 115e9}}, 0.05},
    {"Null power law", "Null", {{"ck", 300.0}, {"nn", 0.6}}, 0.02},
    {"DruckerPrager", "DruckerPrager",
     with(soil, {{"qfai", 0.4}, {"kfai", 200e3}, {"qpsi", 0.1}, {"ten_f", 100e3}}), 0.02},
    {"DruckerPrager Mohr-Coulomb", "DruckerPrager",
     with(soil, {{"phi", 20.0}, {"c", 300e3}, {"psi", 0.0}, {"ten_f", 300e3}, {"match", 3.0}}), 0.02},
    {"DruckerPrager closing", "DruckerPrager",
     with(soil, {{"qfai", 0.4}, {"kfai", 200e3}, {"qpsi", 0.1}, {"ten_f", 100e3}, {"closes", 1.0}}), 0.02},
    {"DFFoam",
     "DFFoam",
     {{"Young", 1e9},
      {"Poisson", 0.1},
      {"Yield0", 5e6},
      {"alfa", 1.6},
      {"epsud", 0.4},  // beyond the largest steps of the checks: next to it round-off decides the stress
      {"alal", 4e6},
      {"gama", 1e6},
      {"bebe", 2.5},
      {"vole", 0.0}},
     0.02},
    {"DFFoam breaking",
     "DFFoam",
     {{"Young", 1e9},
      {"Poisson", 0.0},
      {"Yield0", 5e6},
      {"alfa", 2.1},
      {"epsud", 1.6},
      {"alal", 4e6},
      {"gama", 1e6},
      {"bebe", 2.5},
      {"vole", 0.5}},
     0.02},
    {"Gurson linear", "Gurson", with(with(elastic, voids), {{"TangMod", 3e9}}), 0.02},
    {"Gurson power", "Gurson",
     with(with(elastic, voids), {{"N_hard", 10.0}, {"fN", 0.04}, {"sN", 0.005}, {"eN", 0.01}}), 0.02},
    {"Gurson JohnsonCook", "Gurson",
     with(with(with(elastic, voids), nucleation), with(johnson_cook, {{"Yield0", 90e6}, {"epmax", 0.6}})),
     0.02},
    {"Gurson scattered", "Gurson",
     with(with(elastic, voids),
          {{"TangMod", 3e9}, {"Gauss_f0", 0.03}, {"Gauss_sn", 0.01}, {"SpecHeat", 383.0}}),
     0.02},
    {"MooneyRivlin", "MooneyRivlin", {{"Mr_A2", 0.4e6}, {"Mr_B2", 0.1e6}, {"Poisson", 0.49}}, 0.1},
    {"MooneyRivlin compressible",
     "MooneyRivlin",
     {{"Mr_A2", 0.4e6}, {"Mr_B2", -0.1e6}, {"Poisson", 0.3}},
     0.1},
    {"NeoHookean", "NeoHookean", {{"Young", 1e6}, {"Poisson", 0.3}}, 0.1},
    {"Corotated", "Corotated", {{"Young", 1e6}, {"Poisson", 0.3}}, 0.1},
    {"Elastic_1D", "Elastic_1D", elastic, 0.02},
    {"LinHarElaPlastic_1D",
     "LinHarElaPlastic_1D",
     {{"Young", 124e9}, {"Yield0", 200e6}, {"TangMod", 3e9}},
     0.02},
    {"Rigid", "Rigid", {}, 0.02},
};

/// One of each, with a threshold that the tests' path of some 2 % strain crosses on its way.
const std::vector<core::FailureInput> failures{
    {{"PlaStrain", {{"epmax", 0.01}}, {}}, false},
    {{"Pmin", {{"pmin", -20e6}}, {}}, true},
    {{"PriStress", {{"PriStressMax", 150e6}, {"PriStressMin", -900e6}, {"ShearStressMax", 0.0}}, {}}, false},
    {{"PriStrain", {{"PriStrainMax", 0.01}, {"PriStrainMin", 0.0}, {"ShearStrainMax", 0.02}}, {}}, false},
    {{"InstGeoStrain", {{"ErosionStrain", 0.01}}, {}}, true},
};

const std::map<std::string, LawInput> equations{
    {"Gruneisen", {"Gruneisen", {{"C0", 3940.0}, {"S1", 1.49}, {"gamma0", 1.96}}, {}}},
    {"Gruneisen simplified",
     {"Gruneisen", {{"C0", 3940.0}, {"S1", 1.49}, {"gamma0", 1.96}, {"simplified", 1.0}}, {}}},
    {"Polynomial solid",
     {"Polynomial",
      {{"c0", 0.0}, {"c1", 137e9}, {"c2", 175e9}, {"c3", 564e9}, {"c4", 1.96}, {"c5", 0.9}, {"c6", 0.3}},
      {}}},
    {"Polynomial gas",
     {"Polynomial",
      {{"c0", 0.0},
       {"c1", 0.0},
       {"c2", 0.0},
       {"c3", 0.0},
       {"c4", 0.4},
       {"c5", 0.4},
       {"c6", 0.0},
       {"E0", 250e6}},
      {}}},
    {"Polynomial2",
     {"Polynomial2",
      {{"A1", 137e9},
       {"A2", 175e9},
       {"A3", 564e9},
       {"B0", 1.96},
       {"B1", 0.9},
       {"T1", 137e9},
       {"T2", -30e9},
       {"E0", 250e6}},
      {}}},
    // TNT, manual, table 6.5.
    {"JWL",
     {"JWL", {{"A", 371.2e9}, {"B", 3.23e9}, {"R1", 4.15}, {"R2", 0.95}, {"w", 0.30}, {"E0", 7.0e9}}, {}}},
};

/// Lit long ago: all is burnt when a test begins.
const std::vector<core::DetonationItem> lit = [] {
  core::DetonationItem at_the_origin;
  at_the_origin.time = -1;
  return std::vector{at_the_origin};
}();

MaterialInput input_of(const Strength& strength, const LawInput* eos) {
  MaterialInput input;
  input.name = strength.label;
  input.reference_density = 8960;
  input.strength.type = strength.type;
  input.strength.values = strength.values;
  if (eos) input.eos = *eos;
  return input;
}

// Concrete of 48 MPa (manual, table 6.4; Poisson's ratio 0.2, so Young = 2.4 G), concrete of 35 MPa and
// silicon carbide (tables 6.8 and 6.7). Yield0 is asked for by the language, and not used.
const Values hjc{{"Young", 35.664e9}, {"Poisson", 0.2}, {"Yield0", 0.0}, {"A", 0.79},   {"B", 1.6},
                 {"N", 0.61},         {"C", 0.007},     {"fc", 48e6},    {"SMax", 7.0}, {"D1", 0.04},
                 {"D2", 1.0},         {"EFMin", 0.01},  {"T", 4e6},      {"epso", 1.0}};
const LawInput hjc_bulk{"HolmquistJohnsonCook",
                        {{"PCrush", 16e6},
                         {"MuCrush", 0.001},
                         {"K1", 85e9},
                         {"K2", -171e9},
                         {"K3", 208e9},
                         {"PLock", 0.8e9},
                         {"MuLock", 0.1},
                         {"Poisson", 0.2}},
                        {}};
const Values rht{{"Young", 40e9},  {"Poisson", 0.2}, {"Yield0", 0.0},   {"fc", 35e6},    {"ft_fc", 0.1},
                 {"fs_fc", 0.18},  {"A", 1.6},       {"N", 0.61},       {"Q20", 0.6805}, {"BQ", 0.0105},
                 {"PREFACT", 2.0}, {"TENSRAT", 0.7}, {"COMPRAT", 0.53}, {"B", 1.6},      {"M", 0.61},
                 {"alpha", 0.032}, {"delta", 0.036}, {"epso", 1.0},     {"D1", 0.04},    {"D2", 1.0},
                 {"EFMin", 0.01},  {"SHRATD", 0.13}};
const Values porous{{"Plock", 6e9}, {"Pcrush", 23.3e6}, {"n", 3.0}, {"rho0s", 2750.0}};
const LawInput p_alpha_polynomial2{"PAlpha",
                                   with(porous, {{"EOSID", 2.0},
                                                 {"A1", 35.27e9},
                                                 {"A2", 39.58e9},
                                                 {"A3", 9.04e9},
                                                 {"B0", 1.22},
                                                 {"B1", 1.22},
                                                 {"T1", 35.27e9},
                                                 {"T2", 0.0}}),
                                   {}};
// The sound speed of the porous solid is that of Young's modulus 40 GPa, roughly.
const LawInput p_alpha_polynomial{"PAlpha",
                                  with(porous, {{"EOSID", 1.0},
                                                {"C0", 3000.0},
                                                {"c0", 0.0},
                                                {"c1", 35.27e9},
                                                {"c2", 39.58e9},
                                                {"c3", 9.04e9},
                                                {"c4", 1.22},
                                                {"c5", 1.22},
                                                {"c6", 0.0}}),
                                  {}};
const LawInput p_alpha_gruneisen{
    "PAlpha", with(porous, {{"EOSID", 3.0}, {"C0", 3580.0}, {"S1", 1.3}, {"gamma0", 1.2}}), {}};
const Values jh2{{"Young", 423e9}, {"Poisson", 0.156}, {"Yield0", 0.0}, {"A", 0.96},   {"B", 0.35},
                 {"C", 0.009},     {"M", 1.0},         {"N", 0.65},     {"epso", 1.0}, {"T", 0.37e9},
                 {"SFMax", 0.8},   {"Shel", 13e9},     {"Phel", 5.9e9}, {"beta", 1.0}, {"D1", 0.48},
                 {"D2", 0.48},     {"K2", 361e9},      {"K3", 200e9}};

Sample brittle(const std::string& label, double density, const std::string& type, const Values& values,
               const LawInput* eos, double strain) {
  MaterialInput input = input_of({label, type, values, strain}, eos);
  input.reference_density = density;
  return {label, input, strain};
}

void add_brittle_samples(std::vector<Sample>& all) {
  const Values metal{{"Young", 35.664e9}, {"Poisson", 0.2}, {"Yield0", 40e6}, {"TangMod", 3e9}};
  const auto add = [&](const std::string& label, double density, const std::string& type,
                       const Values& values, const LawInput* eos,
                       double strain) { all.push_back(brittle(label, density, type, values, eos, strain)); };
  add("IsoHarden + HolmquistJohnsonCook", 2440, "IsoHarden", metal, &hjc_bulk, 0.05);
  add("IsoHarden + PAlpha over Polynomial", 2314, "IsoHarden", metal, &p_alpha_polynomial, 0.05);
  add("IsoHarden + PAlpha over Polynomial2", 2314, "IsoHarden", metal, &p_alpha_polynomial2, 0.05);
  add("IsoHarden + PAlpha over Gruneisen", 2314, "IsoHarden", metal, &p_alpha_gruneisen, 0.05);
  add("HolmquistJohnsonCook", 2440, "HolmquistJohnsonCook", hjc, nullptr, 0.01);
  add("HolmquistJohnsonCook both", 2440, "HolmquistJohnsonCook", hjc, &hjc_bulk, 0.02);
  add("RHT", 2314, "RHT", with(rht, {{"CapFlag", 0.0}}), nullptr, 0.01);
  add("RHT + PAlpha", 2314, "RHT", rht, &p_alpha_polynomial2, 0.02);
  add("JH2", 3163, "JH2", jh2, nullptr, 0.05);
}

std::vector<Sample> all_samples() {
  std::vector<Sample> all;
  for (const Strength& strength : strengths) {
    const bool explosive = strength.type == "HighExpBurn", fluid = strength.type == "Null" || explosive;
    const bool solid = !solids_are_not(strength.type);
    if (!fluid) all.push_back({strength.label, input_of(strength, nullptr), strength.strain, solid});
    for (const auto& [label, eos] : equations) {
      if (own_pressure(strength.type) || (explosive && label != "JWL")) continue;
      if (strength.values.count("TemperatureCoefficient") > 0)
        continue;  // these equations expand by themselves
      if (strength.label != "IsoHarden" && label != "Gruneisen" && !fluid) continue;
      all.push_back({strength.label + " + " + label, input_of(strength, &eos), strength.strain});
    }
  }
  for (const core::FailureInput& failure : failures) {
    MaterialInput input = copper("IsoHarden", true);
    input.failures.push_back(failure);
    all.push_back({"IsoHarden + Gruneisen + " + failure.type, input, 0.02});
    input.random_failure.enable = true;
    input.random_failure.distribution = core::RandomFailureInput::Distribution::gauss;
    if (failure.type == "PlaStrain") all.push_back({"RandomFailure", input, 0.02});
  }
  add_brittle_samples(all);
  return all;
}

}  // namespace

const std::vector<Sample>& samples() {
  static const std::vector<Sample> all = all_samples();
  return all;
}

const Sample& sample(const std::string& label) {
  for (const Sample& s : samples()) {
    if (s.label == label) return s;
  }
  throw std::logic_error("no sample is called " + label);
}

MaterialInput copper(const std::string& strength, bool with_gruneisen) {
  for (const Strength& s : strengths) {
    if (s.label == strength) return input_of(s, with_gruneisen ? &equations.at("Gruneisen") : nullptr);
  }
  throw std::logic_error("no strength law is called " + strength);
}

core::MaterialInput convert(const core::MaterialInput& input, const Units& units) {
  return physics::in_units(input, physics::catalogue(), units.length, units.mass, units.time);
}

physics::LawSample of(const Sample& sample) { return {sample.input, lit, sample.strain}; }

std::unique_ptr<physics::Material> make(const core::MaterialInput& input) {
  return physics::make_material(input, lit);
}

}  // namespace mpm::tests
