// The output variables of `var` (manual, table 3.1) and their values for a particle.
//
// To add one: a name in Variable, a row in variable_table and a line in evaluate(). pres is the pressure p of
// the equation of state, positive in compression and without the artificial viscosity; stresses are the whole
// Cauchy stress s - (p + q) I. tria is -p over the Mises stress. Numbers of bodies and materials count
// from 0 in the order of the input, those of components from 1. Tested by tests/io/output/variables_test.cpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model.hpp"
#include "core/particles/particle_view.hpp"

namespace mpm::io {

enum class Variable : int {
  seqv,
  epef,
  pres,
  density,
  tria,
  fail,
  engk,
  engi,
  cp,
  sigy,
  damg,
  body,
  com,
  mat,
  kelv,
  velocity_0,
  velocity_1,
  velocity_2,
  exx,
  eyy,
  ezz,
  posx,
  posy,
  posz,
  sigma_x,
  sigma_y,
  sigma_z,
  sigma_xy,
  sigma_yz,
  sigma_xz,
  count
};

struct VariableInfo {
  std::string_view name;
  std::string_view dimension;  ///< as in core::ColumnInfo, or "energy"
  std::string_view meaning;
  bool integer = false;
};

/// Indexed by Variable.
inline constexpr std::array<VariableInfo, static_cast<std::size_t>(Variable::count)> variable_table{{
    {"seqv", "stress", "Mises stress"},
    {"epef", "1", "effective plastic strain"},
    {"pres", "stress", "pressure, positive in compression, without artificial viscosity"},
    {"density", "density", "mass over volume"},
    {"tria", "1",
     "stress triaxiality, -pres/seqv, without artificial viscosity; 0 without deviatoric stress"},
    {"fail", "1", "1 where failed", true},
    {"engk", "energy", "kinetic energy of the particle, not per mass"},
    {"engi", "energy", "internal energy of the particle, not per mass"},
    {"cp", "velocity", "sound speed, of longitudinal waves"},
    {"sigy", "stress", "yield stress"},
    {"damg", "1", "damage"},
    {"body", "1", "number of the body, from 0", true},
    {"com", "1", "number of the component, from 1; 0: the failed particles, where they form one", true},
    {"mat", "1", "number of the material, from 0", true},
    {"kelv", "temperature", "temperature"},
    {"velocity_0", "velocity", "velocity along x"},
    {"velocity_1", "velocity", "velocity along y"},
    {"velocity_2", "velocity", "velocity along z"},
    {"exx", "1", "strain xx, the sum of its increments: logarithmic, 0 at the start whatever the density"},
    {"eyy", "1", "strain yy, as exx"},
    {"ezz", "1", "strain zz, as exx"},
    {"posx", "length", "position x"},
    {"posy", "length", "position y"},
    {"posz", "length", "position z"},
    {"SigmaX", "stress", "stress xx, positive in tension, including artificial viscosity"},
    {"SigmaY", "stress", "stress yy, as SigmaX"},
    {"SigmaZ", "stress", "stress zz, as SigmaX"},
    {"SigmaXY", "stress", "stress xy"},
    {"SigmaYZ", "stress", "stress yz"},
    {"SigmaXZ", "stress", "stress xz"},
}};

constexpr const VariableInfo& info_of(Variable v) { return variable_table[static_cast<std::size_t>(v)]; }

/// Nullopt for a name that is not in table 3.1.
std::optional<Variable> variable_of(std::string_view word);
/// Each once, in the given order. Throws std::logic_error for an unknown name, since the input was checked.
std::vector<Variable> variables_of(const std::vector<std::string>& words);

/// The column beyond ColumnSet::mechanics() that the variable is read from, if any.
std::optional<core::Column> column_of(Variable v);

/// Columns that bodies have only for output: sound speed, yield stress, accumulated strain. State that a law
/// reads back, such as damage, is requested by the law.
core::ColumnSet shown_only();
/// Those of shown_only() that these variables need. The others are 0 where a body does not have them.
core::ColumnSet columns_for(const std::vector<Variable>& variables);
/// Columns of every variable that the scene writes or records.
core::ColumnSet columns_for(const core::OutputInput& output);

/// Variables that a body of this layout cannot provide; they are written as 0.
std::vector<Variable> absent_variables(const std::vector<Variable>& variables,
                                       const core::ColumnLayout& layout);
/// One line per body that cannot provide some of the variables, for the log.
std::vector<std::string> absence_notices(const std::vector<Variable>& variables, const core::Model& model);

/// Data of a body that its variables need.
struct BodyFacts {
  int body = 0;
  int component = 1;  ///< from 1
  int material = 0;
  double reference_density = 1;
  std::optional<core::FailedComponentRule> failed{};  ///< where failed particles form component 0
};
BodyFacts facts_of(const core::Model& model, std::size_t body);

/// The variable for the particle in `lane` of a block, in the units of the scene.
double evaluate(Variable v, const core::ConstParticle& p, const BodyFacts& facts);

}  // namespace mpm::io
