// What has no effect says so: one input per setting, with the note that it must bring.

#include <algorithm>
#include <array>

#include <catch2/catch.hpp>

#include "io/input/idle_rules.hpp"
#include "physics/material/material.hpp"
#include "physics/strength/list.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using test::bar;
using test::law;
using test::notes_of;
using test::replaced;
using test::rigid_bar;
using test::rigid_law;

struct Idle {
  std::string_view from, to;
  std::string note;  ///< empty: none
};

void check_table(const std::vector<Idle>& table) {
  for (const Idle& idle : table) {
    INFO(idle.from << "  ->  " << idle.to);
    const std::vector<std::string> expected =
        idle.note.empty() ? std::vector<std::string>{} : std::vector<std::string>{idle.note};
    CHECK(notes_of(replaced(bar, idle.from, idle.to)) == expected);
  }
}

TEST_CASE("an input all of which acts has no notes") { CHECK(notes_of(bar).empty()); }

TEST_CASE("settings of materials without effect") {
  const auto with = [](const std::string& attribute) { return std::string(law) + " " + attribute; };
  const std::string tensile = with("FailedType='0' TensileCutoff='-1'"), failed = with("FailedType='1'"),
                    both = with("FailedType='1' FailViscosity='2'"),
                    threshold = with("FailureDamageThreshold='0.5'"),
                    work = with("PlasticWorkCoefficient='0.5'"), room = with("roomt='300'"),
                    concrete =
                        "<StrengthModel type='HolmquistJohnsonCook' Young='1' Poisson='0.2' Yield0='1' A='1' "
                        "B='2' N='0.6' C='0' fc='48' SMax='7' D1='0.04' D2='1' EFMin='0.01' T='4' epso='1'",
                    only_with =
                        "used only with Contact failure_to_component=\"1\", or with DamageToFail=\"1\" of "
                        "HolmquistJohnsonCook",
                    warm = with("PlasticWorkCoefficient='0.5' SpecHeat='1' roomt='300'");
  check_table({
      {law, tensile,
       "line 6: <StrengthModel TensileCutoff=\"-1\">: no effect: used only with FailedType=\"2\""},
      {law, failed,
       "line 6: <StrengthModel FailedType=\"1\">: no effect: applies only to failed particles, and this "
       "material cannot fail"},
      {law, both,
       "line 6: <StrengthModel>: FailedType, FailViscosity have no effect: applies only to failed particles, "
       "and this material cannot fail"},
      {law, threshold, "line 6: <StrengthModel FailureDamageThreshold=\"0.5\">: no effect: " + only_with},
      {law, concrete + " FailureDamageThreshold='0.5' DamageToFail='1'", ""},
      {law, concrete + " FailureDamageThreshold='0.5'",
       "line 6: <StrengthModel FailureDamageThreshold=\"0.5\">: no effect: " + only_with},
      {law, work,
       "line 6: <StrengthModel PlasticWorkCoefficient=\"0.5\">: no effect: requires SpecHeat, which is not "
       "given"},
      {law, room,
       "line 6: <StrengthModel roomt=\"300\">: no effect: there is no temperature without SpecHeat"},
      {law, warm, ""},
      {law, with("limiter='shock' bq1='0' bq2='0'"),
       "line 6: <StrengthModel limiter=\"shock\">: no effect: bq1 and bq2 are 0: there is no artificial "
       "viscosity to limit"},
      {law, with("limiter='shock' bq1='0'"), ""},
      {law, with("limiter='none' bq1='0' bq2='0'"), ""},
      {law, with("FailedType='0' FailureDamageThreshold='1.0'"), ""},  // the defaults ask for nothing
      {"<StrengthModel type=\"IsoHarden\" Young=\"117e3\" Poisson=\".35\" Yield0=\"400\" TangMod=\"100\"",
       "<StrengthModel type='IsoElastic' Young='1' Poisson='0.3' SpecHeat='1'",
       "line 6: <StrengthModel SpecHeat=\"1\">: no effect: nothing heats this material"},
      {"<StrengthModel type=\"IsoHarden\" Young=\"117e3\" Poisson=\".35\" Yield0=\"400\" TangMod=\"100\"",
       "<StrengthModel type='Null' Young='1'",
       "line 6: <StrengthModel Young=\"1\">: no effect: the equation of state determines the stiffness"},
      {law, "<StrengthModel type='Null' mu='1' ck='2' nn='0.5'",
       "line 6: <StrengthModel mu=\"1\">: no effect: with ck the viscosity is that of the power law alone"},
      {law, "<StrengthModel type='Null' mu='1' nn='0.5'",
       "line 6: <StrengthModel nn=\"0.5\">: no effect: the exponent of the power law, which ck switches on"},
      {law, "<StrengthModel type='Null' mu='1'", ""},
      {law,
       "<StrengthModel type='DruckerPrager' Young='1' Poisson='0.3' qfai='0.3' kfai='1' qpsi='0' ten_f='1' "
       "match='1'",
       "line 6: <StrengthModel match=\"1\">: no effect: used only with phi, c and psi"},
      {"<EquationOfState type=\"Gruneisen\" C0=\"3940\" S1=\"1.49\" gamma0=\"1.96\"/>",
       "<EquationOfState type='PAlpha' Plock='1' Pcrush='0.1' n='3' rho0s='9e-3' EOSID='3' C0='1' S1='1' "
       "gamma0='1' c1='4'/>",
       "line 7: <EquationOfState c1=\"4\">: no effect: used only with EOSID=\"1\""},
      {"<FailureModel type=\"none\"/>", "<FailureModel type='none' Erosion='1'/>",
       "line 8: <FailureModel Erosion=\"1\">: no effect: type none has no criterion"},
      {"<FailureModel type=\"none\"/>",
       "<FailureModel type='PriStress' PriStressMax='0' PriStressMin='0' ShearStressMax='0'/>",
       "line 8: <FailureModel>: no effect: all its bounds are 0, which switches it off"},
      {"<FailureModel type=\"none\"/>", "<FailureModel type='PlaStrain' epmax='1'/>", ""},
      {"<FailureModel type=\"none\"/>", "<RandomFailure FailDistribution='2' WeibMed='2'/>",
       "line 8: <RandomFailure>: FailDistribution, WeibMed have no effect: RandomFailure is off"},
      {"<FailureModel type=\"none\"/>",
       "<RandomFailure enable='1'/><FailureModel type='PlaStrain' epmax='1'/>",
       "line 8: <RandomFailure enable=\"1\">: no effect: FailDistribution 0 gives every particle the same "
       "thresholds"},
      {"<FailureModel type=\"none\"/>", "<RandomFailure enable='1' FailDistribution='1'/>",
       "line 8: <RandomFailure enable=\"1\">: no effect: this material cannot fail"},
      {"<FailureModel type=\"none\"/>",
       "<RandomFailure enable='1' FailDistribution='1' WeibMod='3'/><FailureModel type='PlaStrain' "
       "epmax='1'/>",
       "line 8: <RandomFailure WeibMod=\"3\">: no effect: used only with FailDistribution=\"2\""},
      {"<FailureModel type=\"none\"/>",
       "<RandomFailure enable='1' FailDistribution='2' GaussStd='3'/><FailureModel type='PlaStrain' "
       "epmax='1'/>",
       "line 8: <RandomFailure GaussStd=\"3\">: no effect: used only with FailDistribution=\"1\""},
      {"<FailureModel type=\"none\"/>",
       "<RandomFailure enable='1' FailDistribution='1' DamageRandom='1'/><FailureModel type='PlaStrain' "
       "epmax='1'/>",
       "line 8: <RandomFailure DamageRandom=\"1\">: no effect: the law of this material has no damage"},
      {"</Material>",
       "</Material><Material name='spare'><ReferenceDensity value='1'/><StrengthModel type='IsoElastic' "
       "Young='1' Poisson='0'/></Material>",
       "line 9: <Material>: no effect: no body is made of this material"},
  });
}

TEST_CASE("settings of features that are off") {
  check_table({
      {"<WorkPlane", "<Friction><Coefficient value='0.1' mat1='cu' mat2='cu'/></Friction><WorkPlane",
       "line 10: <Friction>: no effect: used only by Contact, which is off"},
      {"<WorkPlane", "<WorkPlane name='spare'/><WorkPlane",
       "line 10: <WorkPlane>: no effect: no body uses this work plane"},
      {"<Component name=\"target\"", "<Component name=\"target\" normal_vector_weight='2'",
       "line 11: <Component normal_vector_weight=\"2\">: no effect: used only by Contact, which is off"},
      {"<InitialVelocity", "<PrescribedVelocity vx='0' vy='0' vz='1'/><InitialVelocity",
       "line 14: <InitialVelocity vz=\"-190\">: no effect: PrescribedVelocity replaces it from the start"},
      {"<InitialVelocity",
       "<PrescribedAcceleration ax='1' ay='0' az='0' arx='0' ary='0' arz='0'><Coefficient time='0' cx='1' "
       "cy='0' cz='0' crx='1' cry='0' crz='2'/></PrescribedAcceleration><InitialVelocity",
       "line 14: <Coefficient>: crx, crz have no effect: multiplies arx, ary, arz, which are 0"},
      {"<InitialVelocity",
       "<PrescribedAcceleration ax='1' ay='0' az='0' arx='0' ary='0' arz='0'><Coefficient time='0' cx='1' "
       "cy='0' cz='0' crx='1' cry='0' crz='0'/><Coefficient time='1' cx='1' cy='0' cz='0' crx='1' cry='0' "
       "crz='0'/></PrescribedAcceleration><InitialVelocity",
       "line 14: <Coefficient crx=\"1\">: no effect: multiplies arx, ary, arz, which are 0 (and 1 more such "
       "cases)"},
      {"<InitialVelocity",
       "<PrescribedAcceleration ax='1' ay='0' az='0' arx='0' ary='0' arz='0'><Coefficient time='1' cx='1' "
       "cy='0' cz='0' crx='0' cry='0' crz='0'/></PrescribedAcceleration><InitialVelocity",
       "line 14: <PrescribedAcceleration>: no effect: its first Coefficient is after EndTime"},
      {"<InitialVelocity",
       "<HarmExcit><A x='1' y='0' z='0'/><Omega x='1' y='1' z='1'/><Theta x='0' y='0' z='0'/><EndTime x='-1' "
       "y='-1' z='-1'/></HarmExcit><InitialVelocity",
       "line 14: <EndTime>: no effect: the load ends before the run starts"},
      {"<InitialVelocity", "<Traction pressure='1' ramp='0.5'/><InitialVelocity",
       "line 14: <Traction ramp=\"0.5\">: no effect: without a box there is no face across which the load "
       "falls to zero"},
      {"<InitialVelocity", "<Traction pressure='1' ramp='0.5' zmin='10'/><InitialVelocity", ""},
      {"<InitialVelocity", "<ConstrainRigidPosition value='0'/><InitialVelocity",
       "line 14: <ConstrainRigidPosition>: no effect: 0 is equivalent to omitting the element: a rigid body "
       "follows PrescribedVelocity, or without it moves freely"},
      {"<InitialVelocity", "<BodyContrl NoOutput='1'/><InitialVelocity",
       "line 14: <BodyContrl NoOutput=\"1\">: no effect: no PostProcessing writes particles"},
      {"<Grid ", "<Detonation><Item type='point' time='0' x='0' y='0' z='0'/></Detonation><Grid ",
       "line 17: <Detonation>: no effect: no body has a HighExpBurn material with beta 0 or 2"},
      {"</Cell>",
       "<MovingGrid enable='0' consider_failure_particle='1' time_step_factor='0.8' x_min='-1' "
       "z_max='50'/></Cell>",
       "line 23: <MovingGrid>: consider_failure_particle, x_min, z_max have no effect: MovingGrid is off"},
      {"</Cell>", "<MovingGrid enable='0'/></Cell>", ""},
      {"</Grid>", "<DynamicCell enable='1' clear_steps='10'/></Grid>",
       "line 24: <DynamicCell enable=\"1\">: no effect: only cells with particles are stored in any case"},
      {"</Grid>", "<DynamicCell enable='0' clear_steps='5'/></Grid>",
       "line 24: <DynamicCell clear_steps=\"5\">: no effect: only cells with particles are stored in any "
       "case"},
      {"<Solution>",
       "<Contact enable='0' failure_to_component='1' auto_normal_vector_weight='1' "
       "normal_vector_excluding_failure_particle='1' distance_type='1' min_distance='0.5' "
       "contact_time_step='1' contact_type='2' record_contact_force='1' "
       "contact_normal='regression'/><Solution>",
       "line 25: <Contact>: failure_to_component, auto_normal_vector_weight, "
       "normal_vector_excluding_failure_particle, distance_type, min_distance, contact_time_step, "
       "contact_type, record_contact_force, contact_normal have no effect: Contact is off"},
      {"<Solution>", "<Contact enable='0' contact_type='0' min_distance='0.0'/><Solution>", ""},
  });
}

TEST_CASE("settings of the run without effect") {
  std::string walls = replaced(bar, "boundary=\"0\"/>\n      <YMin", "boundary=\"2\"/>\n      <YMin");
  walls = replaced(walls, "boundary=\"0\"/>\n      <ZMin", "boundary=\"2\"/>\n      <ZMin");
  walls = replaced(walls, "boundary=\"0\"/>\n      <DCell", "boundary=\"2\"/>\n      <DCell");
  CHECK(notes_of(replaced(walls, "<Solution>", "<Solution near_boundary_stop='1'>")) ==
        std::vector<std::string>{"line 25: <Solution near_boundary_stop=\"1\">: no effect: applies only to "
                                 "grid faces with boundary=\"0\", and there are none"});
  check_table({
      {"<Solution>", "<Solution near_boundary_stop='1'>", ""},
      {"<Solution>", "<Solution xpic_order='3' xpic_interval='2'>",
       "line 25: <Solution>: xpic_order, xpic_interval have no effect: used only with transfer XPIC and "
       "FMPM"},
      {"<Solution>", "<Solution transfer='FMPM' xpic_order='3' xpic_interval='2'>", ""},
      {"<Solution>", "<Solution transfer='XPIC' xpic_order='1'>", ""},
      {"<EndTime", "<TimeStep specified='1e-4' factor='0.5' const='1'/><EndTime",
       "line 25: <TimeStep>: factor, const have no effect: the specified step is used instead"},
      {"<EndTime", "<TimeStep specified='0' factor='0.5'/><EndTime", ""},
      {law, std::string(law) + " VarSoundspeed='1'", ""},
      {"<EndTime", "<OpenMPSetting directionofdecomposition='2'/><EndTime",
       "line 25: <OpenMPSetting directionofdecomposition=\"2\">: no effect: bricks of cells are shared among "
       "the threads"},
      {"</PeneBlast>", "<Output><PostProcessing time_interval='1' var='pres'/></Output></PeneBlast>",
       "line 26: <PostProcessing>: no effect: neither h5part nor vtk_data requests a file"},
      {"</PeneBlast>", "<Output><Restart time_interval='1'/></Output></PeneBlast>",
       "line 26: <Restart>: no effect: the interval is longer than the run: no restart file is written at "
       "intervals"},
      {"</PeneBlast>", "<Output><Summary enable='0'/></Output></PeneBlast>",
       "line 26: <Summary enable=\"0\">: no effect: Job.summary.json is always written"},
      {"</PeneBlast>", "<Output><Summary enable='1'/></Output></PeneBlast>", ""},
      {"</PeneBlast>",
       "<DomainDecomposition dimension0='1' dimension1='2' dimension2='1' method='metis'/></PeneBlast>",
       "line 26: <DomainDecomposition>: dimension0, dimension1, dimension2 have no effect: method metis does "
       "not use them, except that their product must be the number of ranks"},
  });
}

TEST_CASE("rigid bodies by themselves") {
  CHECK(notes_of(rigid_bar()).empty());
  CHECK(notes_of(replaced(rigid_bar(), rigid_law, "<StrengthModel type='Rigid' bq1='1' VarSoundspeed='1'")) ==
        std::vector<std::string>{
            "line 6: <StrengthModel>: bq1, VarSoundspeed have no effect: a rigid body has neither stress nor "
            "heat"});
  CHECK(
      notes_of(replaced(rigid_bar(), rigid_law, "<StrengthModel type='Rigid' limiter='shock'")) ==
      std::vector<std::string>{
          "line 6: <StrengthModel limiter=\"shock\">: no effect: a rigid body has neither stress nor heat"});
  CHECK(notes_of(replaced(rigid_bar(), "<EndTime", "<LimitVelocity max='1'/><EndTime")) ==
        std::vector<std::string>{"line 25: <LimitVelocity>: no effect: it does not apply to rigid bodies"});
  CHECK(notes_of(replaced(rigid_bar(), "<Solution>", "<Solution mass='consistent'>")) ==
        std::vector<std::string>{
            "line 25: <Solution mass=\"consistent\">: no effect: it does not apply to rigid bodies"});
  CHECK(notes_of(replaced(rigid_bar(), "<EndTime", "<DynamicRelax damping='1'/><EndTime")) ==
        std::vector<std::string>{"line 25: <DynamicRelax>: no effect: it applies to deformable bodies, and "
                                 "with Contact to free rigid ones"});
  CHECK(notes_of(replaced(rigid_bar(), "<EndTime", "<Volume erode='1'/><EndTime")) ==
        std::vector<std::string>{"line 25: <Volume>: no effect: rigid bodies keep their volume"});
  CHECK(notes_of(replaced(rigid_bar(), "<EndTime", "<Volumetric averaging='cell'/><EndTime")) ==
        std::vector<std::string>{
            "line 25: <Volumetric averaging=\"cell\">: no effect: rigid bodies keep their volume"});
  CHECK(notes_of(replaced(rigid_bar(), "<EndTime", "<Volumetric relaxation='0.5'/><EndTime")) ==
        std::vector<std::string>{
            "line 25: <Volumetric relaxation=\"0.5\">: no effect: used only with averaging=\"cell\""});
}

TEST_CASE("a step that no speed of sound decides") {
  const std::string constant = replaced(bar, law, std::string(law) + " VarSoundspeed='1'");
  CHECK(notes_of(replaced(constant, "<EndTime", "<TimeStep specified='1e-4'/><EndTime")) ==
        std::vector<std::string>{"line 6: <StrengthModel VarSoundspeed=\"1\">: no effect: the speed of sound "
                                 "does not decide the step"});
}

TEST_CASE("parameters of another rule of implicit steps") {
  const auto with = [](const std::string& implicit) {
    std::string text = replaced(bar, "<Solution>", "<Solution Integration='impl'>");
    text = replaced(text, "<EndTime", "<Implicit " + implicit + "/><EndTime");
    std::vector<std::string> found;
    for (const std::string& note : notes_of(text))
      if (note.find("<Implicit") != std::string::npos) found.push_back(note);
    return found;
  };
  CHECK(with("rule='generalised_alpha' spectral_radius='0.5'").empty());
  const std::vector<std::string> radius{
      "line 25: <Implicit spectral_radius=\"0.5\">: no effect: used only by "
      "rule=\"generalised_alpha\" of dynamic problems"};
  CHECK(with("spectral_radius='0.5'") == radius);
  CHECK(with("type='quasistatic' spectral_radius='0.5'") == radius);
  CHECK(with("type='semi' rtol='1e-4' time_step='0.1'").empty());
  CHECK(with("gravity_ramp='0.1'") ==
        std::vector<std::string>{"line 25: <Implicit gravity_ramp=\"0.1\">: no effect: there is no Gravity"});
  CHECK(with("type='semi' max_newton='5'") ==
        std::vector<std::string>{"line 25: <Implicit max_newton=\"5\">: no effect: type=\"semi\" solves one "
                                 "linear system per step, to rtol"});
  CHECK(
      with("rule='generalised_alpha' newmark_beta='0.3'") ==
      std::vector<std::string>{"line 25: <Implicit newmark_beta=\"0.3\">: no effect: used only by Newmark's "
                               "rule of dynamic problems"});
}

TEST_CASE("the limiter of the viscosity with implicit steps") {
  const std::string limited = replaced(bar, law, std::string(law) + " limiter='shock'");
  CHECK(notes_of(limited).empty());
  std::string text = replaced(limited, "<Solution>", "<Solution Integration='impl'>");
  text = replaced(text, "<EndTime", "<Implicit time_step='0.01'/><EndTime");
  const std::vector<std::string> notes = notes_of(text);
  CHECK(std::ranges::count(notes,
                           "line 6: <StrengthModel limiter=\"shock\">: no effect: implicit steps have no "
                           "artificial viscosity") == 1);
}

TEST_CASE("laws without plastic strain are known") {
  physics::for_each_law<physics::StrengthModels>([]<class Law>(std::type_identity<Law>) {
    INFO(Law::name);
    CHECK(io::has_plastic_strain(Law::name) ==
          (std::ranges::count(Law::state, core::Column::effective_plastic_strain) == 1));
  });
  CHECK(io::has_plastic_strain("a user's law"));
}

/// Laws with and without damage and failure of their own.
const std::vector<std::string>& failing_laws() {
  static const std::vector<std::string> laws = [] {
    const std::string elastic = "Young='1e5' Poisson='0.3' ",
                      johnson_cook = "<StrengthModel type='JohnsonCook' " + elastic +
                                     "Yield0='400' B='1' n='1' C='0' m='1' roomt='293' "
                                     "melt='1000' SpecHeat='1' epso='1' ",
                      concrete = "<StrengthModel type='HolmquistJohnsonCook' " + elastic +
                                 "Yield0='1' A='1' B='2' N='0.6' C='0' fc='48' SMax='7' D1='0.04' D2='1' "
                                 "EFMin='0.01' T='4' epso='1' ",
                      foam = "<StrengthModel type='DFFoam' " + elastic +
                             "Yield0='5' alfa='2.1' epsud='1.6' alal='4' gama='1' bebe='2.5' ",
                      soil = "<StrengthModel type='DruckerPrager' " + elastic +
                             "qfai='0.3' kfai='1' qpsi='0' ten_f='1' ",
                      porous = "<StrengthModel type='Gurson' " + elastic +
                               "Yield0='400' q1='1.5' q2='1' f0='0.01' fc='0.15' ff='0.25' TangMod='100' ";
    return std::vector<std::string>{std::string(law) + " ",
                                    johnson_cook,
                                    johnson_cook + "D1='0' D2='0' D3='0' D4='0' D5='0' ",
                                    johnson_cook + "D1='0.5' D2='0' D3='0' D4='0' D5='0' ",
                                    concrete,
                                    concrete + "DamageToFail='1' ",
                                    concrete + "ErosionByDamage='1' ",
                                    concrete + "TensileFailure='1' ",
                                    concrete + "ErosionByPressure='1' ",
                                    foam + "vole='0' ",
                                    foam + "vole='0.5' ",
                                    soil,
                                    porous};
  }();
  return laws;
}

TEST_CASE("which laws have damage, and which fail by themselves") {
  for (const std::string& text : failing_laws()) {
    INFO(text);
    std::string input(bar);
    if (std::ranges::any_of(std::array{"DFFoam", "Gurson", "DruckerPrager"}, [&](const char* type) {
          return text.find(type) != text.npos;
        }))  // set the pressure
      input = replaced(input, "<EquationOfState type=\"Gruneisen\" C0=\"3940\" S1=\"1.49\" gamma0=\"1.96\"/>",
                       "");
    std::vector<core::Diagnostic> notes;
    const core::Scene scene = test::parse(replaced(input, law, text), notes);
    const core::ColumnSet columns = physics::make_material(scene.materials[0])->columns({});
    CHECK(io::can_fail(scene.materials[0]) == columns.has(core::Column::failed));
    CHECK(io::has_damage(scene.materials[0].strength) == columns.has(core::Column::damage));
    const std::vector<std::string> found =
        notes_of(replaced(replaced(input, law, text + "FailedType='1' "), "<FailureModel type=\"none\"/>",
                          "<RandomFailure enable='1' FailDistribution='1' DamageRandom='1'/>"));
    const auto has = [&](const std::string& end) {
      return std::ranges::any_of(found, [&](const std::string& note) { return note.ends_with(end); });
    };
    CHECK(has("applies only to failed particles, and this material cannot fail") ==
          !columns.has(core::Column::failed));
    CHECK(has("DamageRandom=\"1\">: no effect: the law of this material has no damage") ==
          !columns.has(core::Column::damage));
    CHECK(has("<RandomFailure enable=\"1\">: no effect: this material cannot fail") ==
          !(columns.has(core::Column::failed) || columns.has(core::Column::damage)));
  }
}

TEST_CASE("Young that nothing uses but automatic weights of normals") {
  const std::string rubber =
                        "<StrengthModel type='MooneyRivlin' Young='100' Poisson='0.49' Mr_A2='1' Mr_B2='1'",
                    fluid = "<StrengthModel type='Null' Young='1'",
                    by_eos = "the equation of state determines the stiffness",
                    rigid = "a rigid body has neither stress nor heat";
  const std::string line = "line 6: <StrengthModel Young=";
  const auto weighted = [](const std::string& text, const std::string& more = "") {
    std::string two = replaced(text, "</Component>",
                               "</Component><Component name='other'><Body name='second' material='cu' "
                               "type='Block'><Geometry dp='0.25' x0='6' y0='0' z0='1' lx='1' ly='1' "
                               "lz='1'/></Body></Component>");
    two = replaced(two, "<Solution>",
                   "<Contact enable='1' auto_normal_vector_weight='1'" + more + "/><Solution>");
    std::vector<std::string> found;
    for (const std::string& note : notes_of(two, true))
      if (note.find("<StrengthModel") != std::string::npos) found.push_back(note);
    return found;
  };
  const std::string without_eos =
      replaced(bar, "<EquationOfState type=\"Gruneisen\" C0=\"3940\" S1=\"1.49\" gamma0=\"1.96\"/>", "");
  const std::string of_rubber = replaced(without_eos, law, rubber), of_fluid = replaced(bar, law, fluid),
                    of_iron = replaced(rigid_bar(), rigid_law, std::string(rigid_law) + " Young='2' bq1='1'");
  const std::vector<std::string> rubber_note{
      line + "\"100\">: no effect: Mr_A2, Mr_B2 and Poisson determine the stiffness"};
  CHECK(notes_of(of_rubber) == rubber_note);
  CHECK(weighted(of_rubber) == rubber_note);
  CHECK(notes_of(of_fluid) == std::vector{line + "\"1\">: no effect: " + by_eos});
  CHECK(weighted(of_fluid).empty());
  CHECK(weighted(of_fluid, " contact_normal='regression'") ==
        std::vector{line + "\"1\">: no effect: " + by_eos});
  CHECK(notes_of(of_iron) ==
        std::vector<std::string>{"line 6: <StrengthModel>: Young, bq1 have no effect: " + rigid});
  CHECK(weighted(of_iron) ==
        std::vector<std::string>{"line 6: <StrengthModel bq1=\"1\">: no effect: " + rigid});
}

TEST_CASE("a bound of the plastic strain without one") {
  const std::string elastic =
      replaced(bar, law, "<StrengthModel type='IsoElastic' Young='117e3' Poisson='.35'");
  const std::string bounded =
      replaced(elastic, "<FailureModel type=\"none\"/>", "<FailureModel type='PlaStrain' epmax='1'/>");
  const std::string note = "line 8: <FailureModel>: no effect: this StrengthModel has no plastic strain";
  CHECK(notes_of(bounded) == std::vector{note});
  CHECK(
      notes_of(replaced(bounded, "type='IsoElastic'", "type='IsoElastic' FailedType='1'")) ==
      std::vector<std::string>{"line 6: <StrengthModel FailedType=\"1\">: no effect: applies only to failed "
                               "particles, and this material cannot fail",
                               note});
  CHECK(notes_of(replaced(bounded, "<FailureModel",
                          "<RandomFailure enable='1' FailDistribution='1'/><FailureModel")) ==
        std::vector<std::string>{
            note, "line 8: <RandomFailure enable=\"1\">: no effect: this material cannot fail"});
}

TEST_CASE("quasi-static steps read no velocities") {
  std::string text = replaced(bar, "<Solution>", "<Solution Integration='impl'>");
  text = replaced(text, "<EndTime", "<DynamicRelax damping='1'/><Implicit type='quasistatic'/><EndTime");
  const std::vector<std::string> both{
      "line 14: <InitialVelocity vz=\"-190\">: no effect: quasi-static steps have no inertia",
      "line 25: <DynamicRelax>: no effect: quasi-static steps have no velocities to damp"};
  CHECK(notes_of(text) == both);
  CHECK(notes_of(replaced(text, "vz=\"-190\"", "vz=\"0\"")) == std::vector{both[1]});
  CHECK(notes_of(replaced(text, "quasistatic", "dynamic")).empty());
  CHECK(notes_of(
            replaced(replaced(text, "quasistatic", "dynamic"), law, std::string(law) + " bq1='0' bq2='0'")) ==
        std::vector<std::string>{"line 6: <StrengthModel>: bq1, bq2 have no effect: implicit steps have no "
                                 "artificial viscosity"});
}

TEST_CASE("an explosive that is lit after the end") {
  const auto notes = [](const std::string& time) {
    const std::string explosive = replaced(
        bar, law,
        "<StrengthModel type='HighExpBurn' Young='10' Poisson='0.3' D='6930' beta='0' PCJ='21e3' mu='0'");
    return notes_of(replaced(
        explosive, "<Grid ",
        "<Detonation><Item type='point' time='" + time + "' x='0' y='0' z='0'/></Detonation><Grid "));
  };
  const auto said = [](const std::vector<std::string>& all) {
    return std::ranges::count(all, "line 17: <Item time=\"0.08\">: no effect: the run ends before");
  };
  CHECK(said(notes("0.08")) == 1);
  CHECK(said(notes("0.07")) == 0);
}

TEST_CASE("outputs of nothing, and a run of nothing") {
  const auto with = [](const std::string& control, const std::string& output) {
    return notes_of(replaced(replaced(bar, "    </Body>", control + "    </Body>"), "</PeneBlast>",
                             "<Output>" + output + "</Output></PeneBlast>"));
  };
  const std::string pictures = "<PostProcessing time_interval='0.01' vtk_data='1' var='pres'/>",
                    hidden = "<BodyContrl NoOutput='1'/>", removed = "<BodyContrl Deactive='1'/>";
  CHECK(with("", pictures).empty());
  CHECK(with(hidden, pictures) ==
        std::vector<std::string>{
            "line 26: <PostProcessing>: no effect: every body has NoOutput: its files have no particles"});
  CHECK(with(removed, "") ==
        std::vector<std::string>{"line 11: <Component>: the run has no particles: every body has "
                                 "Deactive=\"1\", or is an operand of Bool bodies (ForBoolBody)"});
  const auto at = [&](const std::string& x) {
    return with("", "<TimeHistory var='pres'><Point x='" + x + "' y='1' z='26.6'/></TimeHistory>");
  };
  CHECK(at("11.4").empty());
  for (const std::string x : {"11.5", "-0.1"})
    CHECK(at(x) == std::vector<std::string>{
                       "line 26: <Point>: no effect: the point is outside of the grid: its columns are 0"});
}

}  // namespace
