#include "io/output/variables.hpp"

#include <algorithm>
#include <stdexcept>

namespace mpm::io {

using core::Column;
using core::ColumnLayout;

std::optional<Variable> variable_of(std::string_view word) {
  for (std::size_t i = 0; i < variable_table.size(); ++i) {
    if (variable_table[i].name == word) return static_cast<Variable>(i);
  }
  return std::nullopt;
}

std::vector<Variable> variables_of(const std::vector<std::string>& words) {
  std::vector<Variable> variables;
  for (const std::string& word : words) {
    const auto v = variable_of(word);
    if (!v) throw std::logic_error("there is no variable '" + word + "'");
    if (std::find(variables.begin(), variables.end(), *v) == variables.end()) variables.push_back(*v);
  }
  return variables;
}

std::optional<Column> column_of(Variable v) {
  switch (v) {
    case Variable::epef: return Column::effective_plastic_strain;
    case Variable::fail: return Column::failed;
    case Variable::cp: return Column::sound_speed;
    case Variable::sigy: return Column::yield_stress;
    case Variable::damg: return Column::damage;
    case Variable::kelv: return Column::temperature;
    case Variable::exx: return Column::strain_xx;
    case Variable::eyy: return Column::strain_yy;
    case Variable::ezz: return Column::strain_zz;
    default: return std::nullopt;
  }
}

core::ColumnSet shown_only() {
  core::ColumnSet set{Column::sound_speed, Column::yield_stress};
  set.add_range(Column::strain_xx, 6);
  return set;
}

core::ColumnSet columns_for(const std::vector<Variable>& variables) {
  core::ColumnSet set;
  for (const Variable v : variables) {
    if (v == Variable::cp) set.add(Column::sound_speed);
    if (v == Variable::sigy) set.add(Column::yield_stress);
    // All six: a strain is accumulated and rotated as a whole.
    if (v == Variable::exx || v == Variable::eyy || v == Variable::ezz) set.add_range(Column::strain_xx, 6);
  }
  return set;
}

core::ColumnSet columns_for(const core::OutputInput& output) {
  core::ColumnSet set;
  if (output.post_processing) set.add(columns_for(variables_of(output.post_processing->variables)));
  for (const auto& history : output.histories) set.add(columns_for(variables_of(history.variables)));
  return set;
}

std::vector<Variable> absent_variables(const std::vector<Variable>& variables, const ColumnLayout& layout) {
  std::vector<Variable> absent;
  for (const Variable v : variables) {
    if (const auto column = column_of(v); column && !layout.has(*column)) absent.push_back(v);
  }
  return absent;
}

std::vector<std::string> absence_notices(const std::vector<Variable>& variables, const core::Model& model) {
  std::vector<std::string> notices;
  for (const core::Body& body : model.bodies) {
    std::string words;
    for (const Variable v : absent_variables(variables, body.pool->layout())) {
      words.append(words.empty() ? "" : ", ").append(info_of(v).name);
    }
    if (!words.empty())
      notices.push_back("body '" + body.name + "' does not have " + words + ": written as 0");
  }
  return notices;
}

BodyFacts facts_of(const core::Model& model, std::size_t body) {
  const core::Body& b = model.bodies[body];
  BodyFacts facts{static_cast<int>(body), b.component + 1, b.material, b.model->reference_density()};
  if (core::has_failed_component(*model.scene)) facts.failed = b.model->failed_component_rule();
  return facts;
}

double evaluate(Variable v, const core::ConstParticle& p, const BodyFacts& facts) {
  const auto at = [&](Column c) { return p[c]; };
  const auto optional = [&](Column c) { return p.layout().has(c) ? at(c) : 0.0; };
  const auto pressure = [&] { return at(Column::pressure) + at(Column::viscous_pressure); };
  const auto equivalent = [&] {
    return core::mises(core::Sym3<double>{at(Column::s_xx), at(Column::s_yy), at(Column::s_zz),
                                          at(Column::s_xy), at(Column::s_yz), at(Column::s_xz)});
  };
  switch (v) {
    case Variable::seqv: return equivalent();
    case Variable::epef: return optional(Column::effective_plastic_strain);
    case Variable::pres: return at(Column::pressure);
    case Variable::density: return at(Column::mass) / at(Column::volume);
    case Variable::tria: {
      const double s = equivalent();
      return s > 0 ? -at(Column::pressure) / s : 0;
    }
    case Variable::fail: return optional(Column::failed) >= 1 ? 1 : 0;
    case Variable::engk: {
      const core::Vec3<double> u{at(Column::velocity_x), at(Column::velocity_y), at(Column::velocity_z)};
      return 0.5 * at(Column::mass) * dot(u, u);
    }
    case Variable::engi: return at(Column::internal_energy) * at(Column::mass) / facts.reference_density;
    case Variable::cp: return optional(Column::sound_speed);
    case Variable::sigy: return optional(Column::yield_stress);
    case Variable::damg: return optional(Column::damage);
    case Variable::body: return facts.body;
    case Variable::com:
      return facts.failed && facts.failed->holds<double>(p.layout(), &p.nth(0)) ? 0 : facts.component;
    case Variable::mat: return facts.material;
    case Variable::kelv: return optional(Column::temperature);
    case Variable::velocity_0: return at(Column::velocity_x);
    case Variable::velocity_1: return at(Column::velocity_y);
    case Variable::velocity_2: return at(Column::velocity_z);
    case Variable::exx: return optional(Column::strain_xx);
    case Variable::eyy: return optional(Column::strain_yy);
    case Variable::ezz: return optional(Column::strain_zz);
    case Variable::posx: return at(Column::position_x);
    case Variable::posy: return at(Column::position_y);
    case Variable::posz: return at(Column::position_z);
    case Variable::sigma_x: return at(Column::s_xx) - pressure();
    case Variable::sigma_y: return at(Column::s_yy) - pressure();
    case Variable::sigma_z: return at(Column::s_zz) - pressure();
    case Variable::sigma_xy: return at(Column::s_xy);
    case Variable::sigma_yz: return at(Column::s_yz);
    case Variable::sigma_xz: return at(Column::s_xz);
    case Variable::count: break;
  }
  return 0;
}

}  // namespace mpm::io
