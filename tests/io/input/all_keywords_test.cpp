// Every element and attribute of the input language, written down from its description, passes; and the
// Specification has nothing that is not written down here.

#include <set>

#include <catch2/catch.hpp>

#include "io/input/checker.hpp"
#include "io/input/document.hpp"
#include "io/input/echo.hpp"
#include "io/input/node.hpp"
#include "io/input/specification.hpp"
#include "io/input/text.hpp"
#include "physics/catalogue.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;

const std::string common =
    " bq1='1.5' bq2='0.06' FailedType='2' TensileCutoff='-1' FailViscosity='0.1' VarSoundspeed='1' "
    "FailureDamageThreshold='0.9' Young='2e5' Poisson='0.3' TemperatureCoefficient='1e-5' roomt='300' "
    "CoefficientOfThermalConductivity='0.1' SpecHeat='400' limiter='shock' ";
const std::string plastic = common + "Yield0='200' PlasticWorkCoefficient='0.9' ";

/// A material with the given models, named m0, m1, ...
std::string material(const std::string& strength, const std::string& rest = {}) {
  static int count = 0;
  return "<Material name='" + std::to_string(count++) + "'><ReferenceDensity value='1'/><StrengthModel " +
         strength + "/>" + rest + "</Material>\n";
}

std::string materials() {
  const std::string eos[] = {
      "type='Polynomial' c0='0' c1='1' c2='2' c3='3' c4='4' c5='5' c6='6'",
      "type='Polynomial2' A1='1' A2='2' A3='3' B0='4' B1='5' T1='6' T2='7'",
      "type='JWL' A='1' B='2' R1='4' R2='1' w='0.3'",
      "type='Gruneisen' C0='3900' E0='0' S1='1.5' gamma0='2' simplified='1'",
      "type='PAlpha' Plock='2' Pcrush='1' n='2' rho0s='2' EOSID='1' c0='0' c1='1' c2='2' c3='3' c4='4' "
      "c5='5' c6='6' A1='1' A2='2' A3='3' B0='4' B1='5' T1='6' T2='7' S1='1.5' gamma0='2' "
      "simplified='0' C0='3000'",
      "type='HolmquistJohnsonCook' PCrush='1' MuCrush='0.1' K1='1' K2='-2' K3='3' PLock='2' "
      "MuLock='0.2' Poisson='0.2' C0='1000' E0='0'"};
  std::string text;
  for (const std::string& e : eos)
    text += material("type='Null' mu='1' ck='2' nn='0.5'" + common, "<EquationOfState " + e + "/>");
  text += material("type='IsoElastic'" + common,
                   "<FailureModel type='none'/><FailureModel type='PlaStrain' epmax='1' Erosion='1'/>"
                   "<FailureModel type='Pmin' pmin='-1'/>"
                   "<FailureModel type='PriStress' PriStressMax='1' PriStressMin='-1' ShearStressMax='0'/>"
                   "<FailureModel type='PriStrain' PriStrainMax='1' PriStrainMin='0' ShearStrainMax='1'/>"
                   "<FailureModel type='InstGeoStrain' ErosionStrain='2'/>"
                   "<RandomFailure enable='1' RandomType='2' FailDistribution='2' GaussMean='1' "
                   "GaussStd='0.2' WeibMed='1.2549' "
                   "WeibMod='20.270' WeibRefVol='1' WeibPartVol='1000' DamageRandom='1'/>");
  text +=
      "<Material name='cu' library='OFHC-Cu-linear' units='mm g ms'><ReferenceDensity value='1'/>"
      "<StrengthModel type='IsoElastic' Young='1' Poisson='0.3'/></Material>\n";
  text += material("type='CauchyElastic'" + common) + material("type='Elastic_1D'" + common);
  text += material("type='ElaPlastic'" + plastic) + material("type='IsoHarden' TangMod='100'" + plastic);
  text += material("type='Voce' Q='100' b='20' H='10'" + plastic);
  text += material("type='LinHarElaPlastic_1D' TangMod='100' Young='1' Yield0='2'");
  text += material(
      "type='JohnsonCook' B='1' n='0.3' C='0.01' m='1' melt='1300' epso='1' D1='1' D2='2' D3='-3' D4='0' "
      "D5='1'" +
      plastic);
  text += material("type='SimJohnsonCook' B='1' n='0.3' C='0.01' epso='1'" + plastic);
  text += material("type='HighExpBurn' D='6930' beta='0' PCJ='21e3' mu='0'" + common);
  text += material(
      "type='HolmquistJohnsonCook' A='1' B='2' N='0.6' C='0.01' fc='48' SMax='7' D1='0.04' D2='1' "
      "EFMin='0.01' T='4' "
      "epso='1' TensileFailure='1' Threshold='1' ErosionByDamage='1' ErosionByPressure='1' TensileDamage='1' "
      "DamageToFail='1'" +
      plastic);
  text += material("type='MooneyRivlin' Mr_A2='1' Mr_B2='2'" + common) + material("type='Rigid'");
  text += material("type='NeoHookean'" + common) + material("type='Corotated'" + common);
  text += material(
      "type='RHT' fc='35' ft_fc='0.1' fs_fc='0.2' A='1.6' N='0.6' Q20='0.7' BQ='0.01' PREFACT='2' "
      "TENSRAT='0.7' "
      "COMPRAT='0.5' B='1.6' M='0.6' alpha='0.03' delta='0.04' epso='1' SFMax='1e20' CapFlag='1' D1='0.04' "
      "D2='1' "
      "EFMin='0.01' SHRATD='0.13'" +
      plastic);
  text += material(
      "type='JH2' A='1' B='2' C='0' M='0.6' N='0.6' epso='1' T='200' SFMax='1' Shel='1' Phel='1' beta='1' "
      "D1='0.005' "
      "D2='1' K2='0' K3='0'" +
      plastic);
  text += material(
      "type='DruckerPrager' qfai='0.4' kfai='1' qpsi='0.1' ten_f='1' phi='30' c='1' psi='10' match='1' "
      "closes='1' "
      "PlasticWorkCoefficient='0.5'" +
      common);
  text += material("type='DFFoam' alfa='2' epsud='1' alal='1' gama='1' bebe='3' vole='0.5'" + plastic);
  text += material(
      "type='Gurson' q1='1.5' q2='1' f0='0.01' Gauss_f0='0.01' Gauss_sn='0.001' fc='0.15' ff='0.25' "
      "fN='0.04' "
      "sN='0.1' eN='0.3' epmax='1' TangMod='100'" +
      plastic);
  text += material("type='Gurson' q1='1.5' q2='1' f0='0.01' fc='0.15' ff='0.25' N_hard='10'" + plastic);
  text +=
      material("type='Gurson' q1='1.5' q2='1' f0='0.01' fc='0.15' ff='0.25' B='1' n='0.3' C='0.01' epso='1'" +
               plastic);
  return text;
}

std::string body(const std::string& type, const std::string& geometry, const std::string& rest = {}) {
  static int count = 0;
  return "<Body name='b" + std::to_string(count++) + "' material='0' type='" + type + "'>" + geometry + rest +
         "</Body>\n";
}

std::string bodies() {
  const std::string base = " x0='0' y0='0' z0='0' ";
  const std::string block = "<Geometry dp='1' lx='5' ly='5' lz='5'" + base + "/>";
  const std::string corner = "<Geometry dp='1' lx='2' ly='2' lz='2'" + base + "/>";
  const std::string round = " dp_bottom='1' dp_top='0.5' angle='90' discretization='1'" + base;
  const std::string nodes = "<Point node_id='1' x='0' y='0' z='0'/><Point node_id='2' x='1' y='0' z='0'/>";
  std::string text =
      "<Body name='a' material='1' type='Block' density='1' workPlane='plane' Deactive='0' ForBoolBody='1'>" +
      block + "</Body><Body name='b' material='1' type='Block' ForBoolBody='1'>" + corner +
      "<RigidInertia mass='1' Ixx='1' Iyy='1' Izz='1' Ixy='0' Iyz='0' Ixz='0'/></Body>" +
      "<Body name='a-b' material='1' type='Bool' BoolType='subtract' BoolBodyA='a' BoolBodyB='b'/>";
  text += body("Point", "<Geometry><Point mass='1' x='1' y='1' z='1'/></Geometry>");
  text += body("Point", "<Geometry file='points.txt'/>");
  text += body("Sphere",
               "<Geometry dp='1' Outer_Radius='5' Inner_Radius='1' angle='90' half='1' discretization='1'" +
                   base + "/>");
  text += body(
      "Cylinder",
      "<Geometry Bottom_Inner_Radius='1' Bottom_Outer_Radius='2' Top_Inner_Radius='0' Top_Outer_Radius='1' "
      "height='5'" +
          round + "/>");
  text += body("Ogive", "<Geometry Ogive_Radius='6' End_Radius='2'" + round + "/>");
  text += body("PointForBar", "<Geometry>" + nodes +
                                  "<Element element_id='1' id0='1' id1='2' sectional_area='1'/></Geometry>");
  text += body("PointForBar", "<Geometry nb_nodes='2' nb_elements='1' file='bars.txt'/>");
  text += body("LineForBar",
               "<Geometry sectional_area='1' element_size='1' nb_lines='2' extend_direction='0' "
               "expand_direction='1' length='5' internal='1'" +
                   base + "/>");
  text += body("NettyForBar",
               "<Geometry sectional_area='1' element_size_x='1' element_size_y='1' element_size_z='0' "
               "nb_lines_x='2' nb_lines_y='2' nb_layers_z='2' internal_x='1' internal_y='1' internal_z='1' "
               "line_direction='0' colum_direction='1' colum_nb_copy='1' colum_interval='5' line_nb_copy='1' "
               "line_interval='5'" +
                   base + "/>");
  text += body("PointForMembrane", "<Geometry thickness='0.1'>" + nodes +
                                       "<Point node_id='3' x='0' y='1' z='0'/>"
                                       "<Element element_id='1' id0='1' id1='2' id2='3'/></Geometry>");
  text += body("RectangularForMembrane",
               "<Geometry thickness='0.1' element_size='1' lx='5' ly='5'" + base + "/>");
  text += body("RectangluarForMembrane",
               "<Geometry thickness='0.1' element_size='1' lx='5' ly='5'" + base + "/>");
  text += body("CylinderForMembrane",
               "<Geometry thickness='0.1' element_size='1' radius='2' height='5' angle='180'" + base + "/>");
  text += body("PointForFEM", "<Geometry>" + nodes +
                                  "<Element element_id='1' id1='1' id2='2' id3='1' id4='2' id5='1' id6='2' "
                                  "id7='1' id8='2'/></Geometry>");
  text += body("BlockForFEM", block, "<LocalBoundaryCond FixedDirection='3' Normal='0' Min='0' Max='1'/>");
  text += body("Block", block,
               "<InitialVelocity vx='0' vy='0' vz='0'/><InitialTemperature value='400'/><PrescribedVelocity "
               "vx='0' vy='0' vz='0'/>"
               "<PrescribedAcceleration ax='1' ay='0' az='0' arx='0' ary='0' arz='0'>"
               "<Coefficient time='0' cx='1' cy='0' cz='0' crx='0' cry='0' crz='0'/></PrescribedAcceleration>"
               "<ConstrainRigidPosition value='1'/><AdaptiveSplit value='0.5'/><CountFragDp value='1'/>"
               "<BodyContrl Deactive='0' NoOutput='1'/>");
  text += body(
      "Block", block,
      "<Traction pressure='1' tx='1' ty='2' tz='3' normal='0' xmin='0' xmax='1' ymin='0' ymax='1' zmin='0' "
      "zmax='1' ramp='2'><Coefficient time='0' c='1'/><Coefficient time='1' c='2'/></Traction>");
  text += body("Block", block,
               "<InitialVelocity vx='0.1*sin(pi*x/25)' vy='X' vz='0'/>"
               "<BodyForce bx='1' by='if(x > 0, y, z)*t' bz='X + Y + Z'/>"
               "<Traction pressure='x*t' tx='t' ty='y' tz='z' normal='0'/>");
  text += body("Block", block, "<PrescribedVelocity vx='t' vy='X*y' vz='0'/>");
  text += body("Block", block,
               "<HarmExcit><A x='0' y='0' z='1'/><Omega x='1' y='1' z='1'/><Theta x='0' y='0' z='0'/>"
               "<EndTime x='1' y='1' z='1'/></HarmExcit>");
  text += body("Block", block,
               "<HarmExcit><A ax='0' ay='0' az='1'/><Omega x='1' y='1' z='1'/><Theta x='0' y='0' z='0'/>"
               "<EndTime x='1' y='1' z='1'/></HarmExcit>");
  return text;
}

constexpr std::string_view faces =
    "<XMin value='0' boundary='0'/><XMax value='10' boundary='1'/><YMin value='0' boundary='2'/><YMax "
    "value='10' boundary='3'/>"
    "<ZMin value='0' boundary='4'/><ZMax value='10' boundary='0'/><DCell dx='1' dy='1' dz='1'/>";

std::string make_all_keywords() {
  return "<?xml version='1.0' encoding='utf-8'?>\n<PeneBlast version='1.0'>\n"
         "<Header><Name value='n'/><Heading value='h'/><Description value='d'/><Unit time='ms' length='mm' "
         "mass='g'/></Header>\n" +
         materials() +
         "<Friction><Coefficient value='0.2' mat1='0' mat2='1' rough='0'/><Coefficient rough='1' mat1='1' "
         "mat2='1'/></Friction>\n"
         "<WorkPlane name='plane' r0x='0' r0y='0' r0z='0' ex='0' ey='0' ez='2' a11='1' a21='0' a31='0'/>\n"
         "<Component name='c' normal_vector_weight='1'>\n" +
         bodies() +
         "</Component>\n<Detonation><Item type='point' time='0' x='1' y='1' z='1'/><Item type='plane' "
         "time='0' normal='2' "
         "location='0' left='0' right='1' bottom='0' top='1'/></Detonation>\n"
         "<Grid mass_cutoff='0' gimp='1' shape='uGIMP'><Cell type='nonuniform'>" +
         std::string(faces) +
         "<XSegment end='4' cells='4' ratio='1'/><XSegment end='10' cells='3' ratio='2'/><YSegment end='10' "
         "cells='4' ratio='1'/>"
         "<ZSegment end='10' cells='4' ratio='1'/>"
         "<MovingGrid enable='1' consider_failure_particle='1' time_step_factor='0.8' x_min='-1' x_max='11' "
         "y_min='-1' y_max='11' "
         "z_min='-1' z_max='11'/></Cell><DynamicCell enable='1' clear_steps='10'/></Grid>\n"
         "<Contact enable='0' failure_to_component='0' auto_normal_vector_weight='0' "
         "normal_vector_excluding_failure_particle='0' "
         "distance_type='2' min_distance='0.01' contact_time_step='1' contact_type='2' "
         "record_contact_force='1' contact_normal='regression'/>\n"
         "<Solution algorithm='USF' near_boundary_stop='1' Integration='expl' transfer='XPIC' "
         "flip_fraction='1' xpic_order='3' xpic_interval='2' mass='lumped'>"
         "<EndTime value='1'/><TimeStep factor='0.6' const='0' specified='0.0' "
         "NotConsiderVisForCp='1'/><LimitVelocity max='1'/>"
         "<Volume update_type='4' erode='0.1' min='0.1' max='10'/><Volumetric averaging='cell' "
         "relaxation='0.5'/><Warn "
         "type='ie|vol|grid' level='2'/><EnergyFraction value='0.1'/>"
         "<DynamicRelax damping='0.1'/><Gravity ax='0' ay='0' az='-9.8'/>"
         "<FEMSetting CoupleFEM_MPM='1' FEMContact='1'><RigidWall RigidnDir='-3' RigidCoor='0'/><Hourglass "
         "HGMethod='2' Qhg='0.1'/>"
         "<GlobalBoundaryCond FixedDirection='1' Normal='0' Min='1' Max='5'/></FEMSetting>"
         "<OpenMPSetting nthread='2' directionofdecomposition='2'/>"
         "<Implicit type='quasistatic' newmark_beta='0.25' newmark_gamma='0.5' time_step='1' min_step='0.1' "
         "max_step='2' rtol='1e-6' "
         "atol='1e-9' max_newton='20' jacobian='matrixfree' rule='newmark' gravity_ramp='0.5' "
         "spectral_radius='0.5' stabilisation='1e-3'/></Solution>\n"
         "<Output><Console print_time='1.0e-3' print_momentum='0'/><PostProcessing time_interval='1' "
         "h5part='1' vtk_data='2' "
         "tecplot='1' cellresult='1' OutGridData='2' StaFragSize='1' StaFragTimeInterval='1' "
         "var='seqv|epef|pres|density|tria|fail|"
         "engk|engi|cp|sigy|damg|body|com|mat|kelv|velocity_0|velocity_1|velocity_2|exx|eyy|ezz|posx|posy|"
         "posz|SigmaX|SigmaY|SigmaZ|"
         "SigmaXY|SigmaYZ|SigmaXZ'/><TimeHistory var='pres|seqv|force|moment'><Particle x='0' y='0' "
         "z='0'/><Point x='0' y='0' z='0'/><Body name='b15'/>"
         "</TimeHistory><GridLineResults normal='0' x='0' y='0'/><FEMProfileResults normal='0' x='0' y='0'/>"
         "<Restart time_interval='1'/><Statistics memory='1' cell_occupy='1'/><Summary "
         "enable='1'/></Output>\n"
         "<DomainDecomposition dimension0='1' dimension1='1' dimension2='1' method='metis' "
         "rebalance_interval='10' "
         "imbalance_tolerance='1.1'/>\n</PeneBlast>\n";
}

const std::string& all_keywords() {
  static const std::string text = make_all_keywords();  // once: its names are counted
  return text;
}

/// `Parent/Element@attribute[type]` of all that a document uses.
void used(const io::Node& node, const std::string& path, std::set<std::string>& names) {
  names.insert(path);
  for (const io::XmlAttribute& a : node.document().attributes(node.element()))
    names.insert(path + "@" + std::string(a.name) + "[" + std::string(node.type()) + "]");
  for (const io::ElementSpec& child : node.spec().children)
    for (const io::Node& n : node.children(child.name)) used(n, path + "/" + child.name, names);
}

/// All rows of the specification of which no type is used.
void unused(const io::ElementSpec& spec, const std::string& path, const std::set<std::string>& names,
            std::vector<std::string>& found) {
  if (!names.contains(path)) found.push_back(path);
  for (const io::AttributeSpec& a : spec.attributes) {
    for (const std::string& type : a.for_types)
      if (!names.contains(path + "@" + a.name + "[" + type + "]") && a.required)
        found.push_back(path + "@" + a.name + "[" + type + "]");
    const auto any = names.lower_bound(path + "@" + a.name + "[");
    if (any == names.end() || !any->starts_with(path + "@" + a.name + "["))
      found.push_back(path + "@" + a.name);
  }
  for (const io::ElementSpec& child : spec.children) unused(child, path + "/" + child.name, names, found);
}

TEST_CASE("every keyword is accepted, and every keyword is described") {
  const std::string text = all_keywords();
  std::optional<io::XmlError> error;
  const io::Document document = io::parse_document(text, error);
  REQUIRE_FALSE(error.has_value());
  io::Diagnostics diagnostics("all.xmp");
  const io::ElementSpec language = io::language(physics::catalogue());
  io::check(document, language, true, diagnostics);
  CHECK_NOTHROW(diagnostics.raise_if_any());

  std::set<std::string> names;
  used(io::Node(document, 0, language, {}), "", names);
  std::vector<std::string> missing;
  unused(language, "", names, missing);
  CHECK(io::join(missing, ", ") == "");
}

TEST_CASE("every keyword reaches the scene, and the echo keeps it") {
  const io::ReadOptions options{.check_files = false, .accept_later = true};
  const core::Scene scene = io::parse_scene(all_keywords(), "all.xmp", physics::catalogue(), options);
  const std::string echo = io::to_text(scene);
  CHECK(io::to_text(io::parse_scene(echo, "all.xmp", physics::catalogue(), options)) == echo);

  CHECK(scene.materials.size() == 29);
  CHECK(scene.materials[0].limiter == core::ViscosityLimiter::shock);
  CHECK(scene.materials[7].limiter == core::ViscosityLimiter::none);  // unsaid
  CHECK(scene.components[0].bodies.size() == 24);
  CHECK(std::get<core::BoolGeometry>(scene.components[0].bodies[2].geometry).subtrahend.body == 1);
  CHECK(scene.detonations.size() == 2);
  CHECK(scene.grid.axes[0].segments.size() == 2);
  CHECK(scene.grid.axes[0].cells == 7);
  CHECK(scene.solution.fem->rigid_walls[0].axis == 2);
  CHECK_FALSE(scene.solution.fem->rigid_walls[0].positive_normal);
  CHECK(scene.solution.implicit->quasistatic());
  CHECK(scene.materials[6].failures.size() == 5);
}

TEST_CASE("what is known but not implemented yet says so, for each element and value") {
  try {
    io::parse_scene(all_keywords(), "all.xmp", physics::catalogue(),
                    {.check_files = false, .accept_later = false});
    FAIL("accepted");
  } catch (const core::InputErrors& errors) {
    for (const core::Diagnostic& d : errors.diagnostics()) {
      INFO(to_text(d));
      CHECK(d.message.starts_with("known, but not implemented yet; "));
    }
    CHECK(errors.diagnostics().size() >= 25);
  }
}

}  // namespace
