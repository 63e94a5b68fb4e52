#include "io/output/variables.hpp"

#include <catch2/catch.hpp>

#include "core/particle_range.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using core::Column;
using io::Variable;

namespace {

/// One particle whose state gives every variable a value of its own.
struct OneParticle {
  core::ColumnLayout layout;
  std::vector<double> block;

  explicit OneParticle(const core::ColumnSet& more) : layout(with_mechanics(more)) {
    block.resize(static_cast<std::size_t>(layout.block_doubles()));
    set(Column::position_x, 1);
    set(Column::position_y, 2);
    set(Column::position_z, 3);
    set(Column::velocity_x, 4);
    set(Column::velocity_y, 5);
    set(Column::velocity_z, 6);
    set(Column::mass, 8);
    set(Column::volume, 2);
    set(Column::s_xx, 20);
    set(Column::s_yy, -10);
    set(Column::s_zz, -10);
    set(Column::s_xy, 1);
    set(Column::s_yz, 2);
    set(Column::s_xz, 3);
    set(Column::pressure, 60);
    set(Column::viscous_pressure, 7);
    set(Column::internal_energy, 0.5);
  }
  static core::ColumnSet with_mechanics(core::ColumnSet set) {
    set.add(core::ColumnSet::mechanics());
    return set;
  }
  void set(Column c, double value) { block[static_cast<std::size_t>(layout.offset(c) + 3)] = value; }
  double operator()(Variable v) const {
    return io::evaluate(v, core::ConstParticle(layout, block.data() + 3),
                        {.body = 1, .component = 2, .material = 5, .reference_density = 4});
  }
};

}  // namespace

TEST_CASE("Each variable is what the manual says") {
  OneParticle p({Column::effective_plastic_strain, Column::failed, Column::sound_speed, Column::yield_stress,
                 Column::damage, Column::temperature, Column::strain_xx, Column::strain_yy,
                 Column::strain_zz});
  p.set(Column::effective_plastic_strain, 0.25);
  p.set(Column::failed, 2);
  p.set(Column::sound_speed, 70);
  p.set(Column::yield_stress, 90);
  p.set(Column::damage, 0.75);
  p.set(Column::temperature, 300);
  p.set(Column::strain_xx, 0.1);
  p.set(Column::strain_yy, 0.2);
  p.set(Column::strain_zz, 0.3);
  const double mises = std::sqrt(1.5 * (400 + 100 + 100 + 2 * (1 + 4 + 9)));
  CHECK(p(Variable::seqv) == Approx(mises).epsilon(1e-15));
  CHECK(p(Variable::tria) == Approx(-60 / mises).epsilon(1e-15));
  const std::pair<Variable, double> expected[] = {{Variable::epef, 0.25},
                                                  {Variable::pres, 60},
                                                  {Variable::density, 4},
                                                  {Variable::fail, 1},
                                                  {Variable::engk, 0.5 * 8 * (16 + 25 + 36)},
                                                  {Variable::engi, 0.5 * 8 / 4.0},
                                                  {Variable::cp, 70},
                                                  {Variable::sigy, 90},
                                                  {Variable::damg, 0.75},
                                                  {Variable::body, 1},
                                                  {Variable::com, 2},
                                                  {Variable::mat, 5},
                                                  {Variable::kelv, 300},
                                                  {Variable::velocity_0, 4},
                                                  {Variable::velocity_1, 5},
                                                  {Variable::velocity_2, 6},
                                                  {Variable::exx, 0.1},
                                                  {Variable::eyy, 0.2},
                                                  {Variable::ezz, 0.3},
                                                  {Variable::posx, 1},
                                                  {Variable::posy, 2},
                                                  {Variable::posz, 3},
                                                  {Variable::sigma_x, 20 - 67},
                                                  {Variable::sigma_y, -10 - 67},
                                                  {Variable::sigma_z, -10 - 67},
                                                  {Variable::sigma_xy, 1},
                                                  {Variable::sigma_yz, 2},
                                                  {Variable::sigma_xz, 3}};
  for (const auto& [v, value] : expected) {
    INFO(io::info_of(v).name);
    CHECK(p(v) == value);
  }
  CHECK(std::size(expected) + 2 == io::variable_table.size());
}

TEST_CASE("What a body does not carry is 0, and is known to be absent") {
  const OneParticle p(core::ColumnSet{});
  for (std::size_t i = 0; i < io::variable_table.size(); ++i) {
    const auto v = static_cast<Variable>(i);
    INFO(io::info_of(v).name);
    const bool absent = io::absent_variables({v}, p.layout).size() == 1;
    CHECK(absent == io::column_of(v).has_value());
    if (absent) CHECK(p(v) == 0);
  }
}

TEST_CASE("Components count from 1, bodies and materials from 0") {
  core::SoloCommunication solo;
  const core::Model model = tests::small_model(solo);
  const io::BodyFacts first = io::facts_of(model, 0), last = io::facts_of(model, 2);
  CHECK((first.component == 1 && first.body == 0 && first.material == 0));
  CHECK((last.component == 2 && last.body == 2));
}

TEST_CASE("Failed particles are in component 0 where they form one") {
  core::SoloCommunication solo;
  for (const bool form_one : {false, true}) {
    const auto scene = tests::small_scene();
    scene->contact.enable = true;
    scene->contact.failed_to_component = form_one;
    core::Model model = tests::prepared_model(scene);
    tests::fill(model, solo);
    int failed = 0, others = 0;
    for (const core::ConstParticleBlock& block : core::blocks_of(std::as_const(model))) {
      const io::BodyFacts facts = io::facts_of(model, static_cast<std::size_t>(block.body));
      for (const core::ConstParticle p : block) {
        const double component = io::evaluate(Variable::com, p, facts);
        const bool has_failed = p.layout().has(Column::failed) && p[Column::failed] > 0;
        CHECK(component == (has_failed && form_one ? 0 : facts.component));
        ++(has_failed ? failed : others);
      }
    }
    CHECK((failed > 20 && others > 20));
  }
}

TEST_CASE("The log says which body lacks what") {
  core::SoloCommunication solo;
  const core::Model model = tests::small_model(solo);
  const auto notices = io::absence_notices(io::variables_of({"seqv", "kelv", "damg"}), model);
  CHECK(notices == std::vector<std::string>{"body 'bar' does not have damg: written as 0",
                                            "body 'wall <&> floor' does not have kelv, damg: written as 0",
                                            "body 'dust' does not have damg: written as 0"});
}

TEST_CASE("The triaxiality of a state without deviator is 0, not a division by zero") {
  OneParticle p(core::ColumnSet{});
  for (int c = 0; c < 6; ++c) p.set(core::next(Column::s_xx, c), 0);
  CHECK(p(Variable::tria) == 0);
}

TEST_CASE("Only what nobody else asks for is asked for by outputs") {
  CHECK(io::columns_for(io::variables_of({"seqv", "epef", "damg", "kelv", "fail"})) == core::ColumnSet{});
  CHECK(io::columns_for(io::variables_of({"cp"})) == core::ColumnSet{Column::sound_speed});
  CHECK(io::columns_for(io::variables_of({"sigy", "eyy"})).size() == 7);
  core::OutputInput output;
  output.histories.emplace_back().variables = {"cp"};
  CHECK(io::columns_for(output) == core::ColumnSet{Column::sound_speed});
}

TEST_CASE("Words become variables, each once") {
  CHECK(io::variables_of({"SigmaXZ", "seqv", "SigmaXZ"}) == std::vector{Variable::sigma_xz, Variable::seqv});
  CHECK_FALSE(io::variable_of("sigmaxz"));
  CHECK_THROWS_WITH(io::variables_of({"seqf"}), "there is no variable 'seqf'");
}
