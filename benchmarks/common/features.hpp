// Optional features of a scene, each as the same bar without and with it. Values are chosen so that a feature
// is active at every particle without changing the motion: a bound that is never reached, a negligible load.
// Features not implemented yet are omitted with the message of the program.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/common/bar.hpp"

namespace mpm::benchmarks {

struct Feature {
  std::string family, name, against;
  BarInput without{}, with{};
};

namespace detail {

inline std::string iso_harden_and(const std::string& attributes) {
  return fmt::format(
      R"(<StrengthModel type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="157" TangMod="423.461758" {}/>)",
      attributes);
}
inline std::string showing(const std::string& variables) {
  return fmt::format(R"(<PostProcessing time_interval="0.08" h5part="1" var="{}"/>)", variables);
}

}  // namespace detail

inline std::vector<Feature> features() {
  using detail::iso_harden_and, detail::showing;
  std::vector<Feature> all;
  const BarInput bar{};
  const auto add = [&](const std::string& family, const std::string& name, const std::string& against,
                       const BarInput& without, const BarInput& with) {
    all.push_back({family, name, against, without, with});
  };
  BarInput at_rest{};
  at_rest.velocity.clear();

  add("none", "the same scene twice", "itself", bar, bar);
  for (const char* scheme : {"USAVG", "USF", "USL"}) add("scheme", scheme, "MUSL", bar, {.scheme = scheme});

  const std::string cold = iso_harden_and(""), still = iso_harden_and(R"(bq1="0" bq2="0")");
  add("material", "heating (SpecHeat)", "none", {.strength = cold},
      {.strength = iso_harden_and(R"(SpecHeat="383")")});
  add("material", "artificial viscosity", "bq1 = bq2 = 0", {.strength = still}, {.strength = cold});
  add("material", "artificial viscosity in shocks only", "in all compression", {.strength = cold},
      {.strength = iso_harden_and(R"(limiter="shock")")});
  add("material", "first sound speed kept", "new each step", {.strength = cold},
      {.strength = iso_harden_and(R"(VarSoundspeed="1")")});
  const std::string never = R"(<FailureModel type="PlaStrain" epmax="1e9" Erosion="{}"/>)";
  add("failure", "PlaStrain, never reached", "none", bar, {.failure = fmt::format(fmt::runtime(never), 0)});
  add("failure", "PlaStrain with erosion, never reached", "without erosion",
      {.failure = fmt::format(fmt::runtime(never), 0)}, {.failure = fmt::format(fmt::runtime(never), 1)});

  for (const char* how :
       {"1, as the cell", "2, exponential", "3, deformation gradient", "4, accumulated strain"})
    add("volume", fmt::format("update {}", how), "update 0, rate", bar,
        {.solution = fmt::format(R"(<Volume update_type="{}"/>)", how[0])});
  add("volume", "averaged over cells", "none", bar, {.solution = R"(<Volumetric averaging="cell"/>)"});
  add("volume", "the same, with relaxation", "none", bar,
      {.solution = R"(<Volumetric averaging="cell" relaxation="0.5"/>)"});
  for (const char* shape : {"SGMP", "QuadraticBSpline"}) {
    const std::string with = fmt::format(R"(shape="{}")", shape);
    add("volume", fmt::format("averaged over sites, {}", shape), fmt::format("none, {}", shape),
        {.grid_attributes = with},
        {.solution = R"(<Volumetric averaging="cell"/>)", .grid_attributes = with});
  }
  add("volume", "bounds, never reached", "none", bar,
      {.solution = R"(<Volume update_type="0" min="1e-6" max="1e6"/>)"});
  add("volume", "erosion, never reached", "none", bar,
      {.solution = R"(<Volume update_type="0" erode="1e-30"/>)"});

  add("step", "LimitVelocity, never reached", "none", bar, {.solution = R"(<LimitVelocity max="1e9"/>)"});
  add("step", "Gravity", "none", bar, {.solution = R"(<Gravity ax="0" ay="0" az="-9.81e-6"/>)"});
  add("step", "damping", "none", bar, {.solution = R"(<DynamicRelax damping="1e-6"/>)"});
  add("step", "first time step kept", "new each step", bar,
      {.time_step = R"(<TimeStep factor="0.4" const="1"/>)"});
  add("step", "viscosity not in the time step", "in it", bar,
      {.time_step = R"(<TimeStep factor="0.4" NotConsiderVisForCp="1"/>)"});
  add("step", "prescribed velocity", "none, at rest", at_rest,
      {.body = R"(<PrescribedVelocity vx="0" vy="0" vz="0"/>)", .velocity = ""});
  add("expressions", "body force, numbers", "none", bar, {.body = R"(<BodyForce bz="-9.81e-6"/>)"});
  add("expressions", "body force of t", "none", bar, {.body = R"(<BodyForce bz='-9.81e-6*cos(t)'/>)"});
  add("expressions", "body force of x and t", "none", bar,
      {.body = R"(<BodyForce bz='-9.81e-6*cos(x + t)'/>)"});
  add("expressions", "body force of X and t", "none", bar,
      {.body = R"(<BodyForce bz='-9.81e-6*cos(X + t)'/>)"});
  add("expressions", "prescribed velocity of x and t", "prescribed numbers",
      {.body = R"(<PrescribedVelocity vx="0" vy="0" vz="0"/>)", .velocity = ""},
      {.body = R"(<PrescribedVelocity vx="0" vy="0" vz='1e-9*sin(x + t)'/>)", .velocity = ""});

  for (const char* transfer : {"PIC", "XPIC", "FMPM"})
    add("transfer", transfer, "FLIP", bar,
        {.solution_attributes = fmt::format(R"(transfer="{}")", transfer)});
  for (const int order : {1, 3, 5})
    add("transfer", fmt::format("FMPM of order {}", order), "FLIP", bar,
        {.solution_attributes = fmt::format(R"(transfer="FMPM" xpic_order="{}")", order)});
  add("transfer", "FMPM every 10th step", "FLIP", bar,
      {.solution_attributes = R"(transfer="FMPM" xpic_interval="10")"});
  add("transfer", "95 % FLIP", "FLIP", bar, {.solution_attributes = R"(flip_fraction="0.95")"});
  const std::string consistent = R"(mass="consistent")";
  add("transfer", "FLIP, consistent mass", "FLIP", bar, {.solution_attributes = consistent});
  const std::string quadratic = R"(shape="QuadraticBSpline")";
  for (const char* transfer : {"PIC", "APIC", "TPIC", "AFLIP", "XPIC", "FMPM"})
    add("transfer", fmt::format("{}, quadratic", transfer), "FLIP, quadratic", {.grid_attributes = quadratic},
        {.grid_attributes = quadratic, .solution_attributes = fmt::format(R"(transfer="{}")", transfer)});
  add("transfer", "FLIP, consistent mass, quadratic", "FLIP, quadratic", {.grid_attributes = quadratic},
      {.grid_attributes = quadratic, .solution_attributes = consistent});
  for (const char* shape :
       {"uGIMP", "cpGIMP", "CPDI", "CPDI2", "QuadraticBSpline", "CubicBSpline", "DDMP", "SGMP"})
    add("shape", shape, "linear", bar, {.grid_attributes = fmt::format(R"(shape="{}")", shape)});

  BarInput free = at_rest;
  free.foot = 0;
  for (const char* type : {"1, fixed", "2, symmetry", "3, non-reflecting", "4, rigid wall"}) {
    BarInput stands = at_rest;
    stands.foot = type[0] - '0';
    add("boundary", fmt::format("foot on type {}", type), "type 0, free", free, stands);
  }
  for (const int n : {2, 8}) add("bodies", fmt::format("{} bodies", n), "one body", bar, {.bodies = n});

  const BarInput slices{.bodies = 2, .components = true};
  add("contact", "two components without contact", "one component", {.bodies = 2}, slices);
  const std::pair<const char*, const char*> kinds[] = {
      {"two components in contact", ""},
      {"the same, with gaps", R"(distance_type="2" min_distance="0.05")"},
      {"the same, normals by regression",
       R"(distance_type="2" min_distance="0.05" contact_normal="regression")"}};
  for (const auto& [name, attributes] : kinds)
    add("contact", name, "without contact", slices,
        {.more = fmt::format(R"(<Contact enable="1" {}/>)", attributes), .bodies = 2, .components = true});

  add("output", "sound speed shown (cp)", "not", {.output = showing("pres")}, {.output = showing("pres|cp")});
  add("output", "yield stress shown (sigy)", "not", {.output = showing("pres")},
      {.output = showing("pres|sigy")});
  add("output", "strains shown (exx)", "not", {.output = showing("pres")}, {.output = showing("pres|exx")});
  return all;
}

/// Elements and attributes without effect: the state must be bitwise identical and of the same size.
inline std::vector<Feature> spelled_out() {
  using detail::iso_harden_and, detail::showing;
  const BarInput bar{};
  const auto off = [&](const std::string& name, const BarInput& with) {
    return Feature{"off", name, "unsaid", bar, with};
  };
  return {
      off("Gravity 0", {.solution = R"(<Gravity ax="0" ay="0" az="0"/>)"}),
      off("DynamicRelax 0", {.solution = R"(<DynamicRelax damping="0"/>)"}),
      off("Volume update_type 0, erode 0", {.solution = R"(<Volume update_type="0" erode="0"/>)"}),
      off("Volumetric averaging none", {.solution = R"(<Volumetric averaging="none"/>)"}),
      off("Warn", {.solution = R"(<Warn type="ie|vol|grid" level="0"/>)"}),
      off("TimeStep at its defaults",
          {.time_step = R"(<TimeStep factor="0.4" const="0" specified="0" NotConsiderVisForCp="0"/>)"}),
      off("transfer FLIP", {.solution_attributes = R"(transfer="FLIP" flip_fraction="1" mass="lumped")"}),
      off("xpic_order and xpic_interval with FLIP",
          {.solution_attributes = R"(xpic_order="5" xpic_interval="3")"}),
      off("initial velocity by an expression",
          {.velocity = R"(<InitialVelocity vx="0" vy="0*pi" vz='if(x &lt; 1e9, -190, y)'/>)"}),
      off("shape linear", {.grid_attributes = R"(shape="linear" gimp="0")"}),
      off("FailureModel none", {.failure = R"(<FailureModel type="none"/>)"}),
      off("RandomFailure 0", {.failure = R"(<RandomFailure enable="0"/>)"}),
      off("material attributes at their defaults",
          {.strength = iso_harden_and(R"(FailedType="0" FailViscosity="0" VarSoundspeed="0" )"
                                      R"(TemperatureCoefficient="0" bq1="1.5" bq2="0.06" limiter="none")")}),
      off("Contact 0", {.more = R"(<Contact enable="0"/>)"}),
      off("DomainDecomposition", {.more = R"(<DomainDecomposition method="metis"/>)"}),
      off("outputs that need no column", {.output = showing("pres|epef|seqv|SigmaX|velocity_0")}),
  };
}

}  // namespace mpm::benchmarks
