// Materials for the tests that hold for every law and for the benchmark of every law: at least one set of
// parameters per law of the lists, in SI, and the same in mm-g-ms, converted by the dimensions that the laws'
// own tables state.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/catalogue.hpp"
#include "core/scene/material.hpp"
#include "physics/checks/law_checks.hpp"
#include "physics/material/material.hpp"

namespace mpm::tests {

struct Sample {
  std::string label;  ///< for messages
  core::MaterialInput input;
  /// Strain that a test's path should reach: beyond yield where the law yields.
  double strain = 0.02;
  /// False for bars, whose axis is x, and rigid bodies: not for statements on tensors.
  bool solid = true;
};

/// Every strength law with the elastic bulk and with an equation of state, and every equation of state with a
/// strength law. A test demands one for every law of the catalogue.
const std::vector<Sample>& samples();
/// Throws std::logic_error where there is none; so do the others below for a name that nobody knows.
const Sample& sample(const std::string& label);

/// Factors from one system of units to another: value in the new unit = factor * value in the old.
struct Units {
  double length = 1, mass = 1, time = 1;
};
inline constexpr Units mm_g_ms{1e3, 1e3, 1e3};  // from m, kg, s

/// For the checks that hold for every law; lit long ago.
physics::LawSample of(const Sample& sample);

core::MaterialInput convert(const core::MaterialInput& input, const Units& units);

std::unique_ptr<physics::Material> make(const core::MaterialInput& input);

/// OFHC copper with the strength law given, in SI: the parameters that most tests use.
core::MaterialInput copper(const std::string& strength, bool with_gruneisen = false);

}  // namespace mpm::tests
