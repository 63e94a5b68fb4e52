// The rules of single elements and of settings that do not go together: one wrong input per rule, with all
// the faults that it must bring.

#include <catch2/catch.hpp>

#include "core/has_shape.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using test::bar;
using test::check_faults;
using test::faults;
using test::replaced;

TEST_CASE("laws are checked by their own tables") {
  check_faults({
      {"type=\"IsoHarden\"",
       "type=\"isoHarden\"",
       {"line 6: <StrengthModel type=\"isoHarden\">: expected one of IsoHarden, JohnsonCook, Null, "
        "Homemade; did you mean 'IsoHarden'?"}},
      {"Poisson=\".35\"",
       "Poisson=\".5\"",
       {"line 6: <StrengthModel Poisson=\".5\">: expected a number in (0, 0.5)"}},
      {"Poisson=\".35\"",
       "",
       {"line 6: <StrengthModel>: attribute 'Poisson' is missing: a number in (0, 0.5)"}},
      {"Poisson=\".35\"",
       "Poisson=\".35\" FailedType=\"1.5\"",
       {"line 6: <StrengthModel FailedType=\"1.5\">: expected a whole number in [0, 2]"}},
      {"Poisson=\".35\"",
       "Poisson=\".35\" D1=\"1000\"",
       {"line 6: <StrengthModel D1=\"1000\">: not available with type IsoHarden, only with JohnsonCook"}},
      {"Poisson=\".35\"",
       "Poisson=\".35\" SpecHeat=\"1\"",
       {"line 6: <StrengthModel SpecHeat=\"1\">: no such attribute; expected type, limiter, Young, Poisson, "
        "Yield0, TangMod, bq1, FailedType"}},
      {"Poisson=\".35\"",
       "Poisson=\".35\" limiter=\"shocks\"",
       {"line 6: <StrengthModel limiter=\"shocks\">: expected one of none, shock; did you mean 'shock'?"}},
      {"Poisson=\".35\"", "Poisson=\".35\" limiter=\"none\"", {"ok"}},
      {"Poisson=\".35\"", "Poisson=\".35\" limiter=\"shock\"", {"ok"}},
      {"type=\"IsoHarden\" Young=\"117e3\" Poisson=\".35\" Yield0=\"400\" TangMod=\"100\"",
       "type=\"JohnsonCook\" Young=\"1\" Poisson=\".3\" D1=\"1\"",
       {"line 6: <StrengthModel>: D1, D2 must be given together or not at all; missing: D2"}},
      {"type=\"IsoHarden\" Young=\"117e3\" Poisson=\".35\" Yield0=\"400\" TangMod=\"100\"",
       "type=\"Homemade\"",
       {"line 6: <StrengthModel>: attribute 'strength' is missing: a number greater than 0"}},
      {"type=\"IsoHarden\" Young=\"117e3\" Poisson=\".35\" Yield0=\"400\" TangMod=\"100\"",
       "type=\"Rigid\"",
       {"line 6: <StrengthModel type=\"Rigid\">: expected one of IsoHarden, JohnsonCook, Null, "
        "Homemade"}},
      {"<FailureModel type=\"none\"/>",
       "<FailureModel type=\"Pmin\" pmin=\"3\"/>",
       {"line 8: <FailureModel pmin=\"3\">: expected a number less than 0"}},
      {"<FailureModel type=\"none\"/>",
       "<FailureModel type=\"PriStress\"/>",
       {"line 8: <FailureModel type=\"PriStress\">: expected one of none, Pmin"}},
      {"<FailureModel type=\"none\"/>",
       "<FailureModel type=\"Pmin\"/>",
       {"line 8: <FailureModel>: attribute 'pmin' is missing: a number less than 0"}},
  });
  std::string eleven;
  for (int i = 0; i < 11; ++i) eleven += "<FailureModel type='Pmin' pmin='-1'/>";
  check_faults({{"<FailureModel type=\"none\"/>",
                 eleven,
                 {"line 8: <FailureModel>: a material has at most 10 failure models"}}});
}

TEST_CASE("known, but not implemented yet") {
  const std::string remove = "known, but not implemented yet; remove the element";
  const std::string zero = "known, but not implemented yet; remove the attribute or set it to its default, 0";
  if (core::has_shape("CPDI")) check_faults({{"<Grid shape=\"linear\">", "<Grid shape=\"CPDI\">", {"ok"}}});
  check_faults({
      {"<Solution>",
       "<Contact enable=\"1\"/><Solution>",
       {"line 25: <Contact enable=\"1\">: contact acts between components, and there is only one with "
        "bodies: "
        "give bodies that are to meet components of their own, or set enable to 0"}},
      {"<Solution>", "<Contact enable=\"0\"/><Solution>", {"ok"}},
      {"<Grid shape=\"linear\">",
       "<Grid shape=\"sgmp\">",
       {"line 17: <Grid shape=\"sgmp\">: expected one of linear, uGIMP, cpGIMP, CPDI, CPDI2, "
        "QuadraticBSpline, "
        "CubicBSpline, DDMP, SGMP; did you mean 'SGMP'?"}},
      {"<Grid shape=\"linear\">", "<Grid gimp=\"1\">", {"ok"}},
      {"<Grid shape=\"linear\">", "<Grid gimp=\"0\" shape=\"linear\">", {"ok"}},
      {"<Grid shape=\"linear\">", "<Grid shape=\"DDMP\">", {"ok"}},
      {"<Grid shape=\"linear\">", "<Grid shape=\"CPDI2\">", {"ok"}},
      {"boundary=\"2\"", "boundary=\"3\"", {"ok"}},
      {"<DCell", "<MovingGrid enable='1'/><DCell", {"line 22: <MovingGrid enable=\"1\">: " + zero}},
      {"<DCell", "<MovingGrid enable='0' x_min='0'/><DCell", {"ok"}},
      {"</Material>", "<RandomFailure enable='1'/></Material>", {"ok"}},
      {"</Material>",
       "<RandomFailure GaussMean='0'/></Material>",
       {"line 9: <RandomFailure GaussMean=\"0\">: expected a number greater than 0"}},
      {"</Material>", "<RandomFailure enable='0' FailDistribution='2'/></Material>", {"ok"}},
      {"<Solution>", "<Solution flip_fraction=\"1.0\" xpic_order=\"2\">", {"ok"}},
      {"<Solution>", "<Solution transfer=\"XPIC\">", {"ok"}},
      {"<Solution>", "<Solution transfer=\"FMPM\" xpic_order=\"20\" xpic_interval=\"5\">", {"ok"}},
      {"<Solution>",
       "<Solution transfer=\"FMPM\" xpic_order=\"21\" xpic_interval=\"0\">",
       {"line 25: <Solution xpic_order=\"21\">: expected a whole number in [1, 20]",
        "line 25: <Solution xpic_interval=\"0\">: expected a whole number greater than 0"}},
      {"<Solution>",
       "<Solution transfer=\"XPIC\" xpic_order=\"0\">",
       {"line 25: <Solution xpic_order=\"0\">: expected a whole number in [1, 20]"}},
      {"<Solution>",
       "<Solution transfer=\"FMPM\" flip_fraction=\"0.9\">",
       {"line 25: <Solution flip_fraction=\"0.9\">: is available only with transfer FLIP, not with FMPM"}},
      {"<Solution>", "<Solution flip_fraction=\"0.9\">", {"ok"}},
      {"<Solution>",
       "<Solution transfer=\"PIC\" flip_fraction=\"0.9\">",
       {"line 25: <Solution flip_fraction=\"0.9\">: is available only with transfer FLIP, not with PIC"}},
      {"<Solution>",
       "<Solution transfer=\"APIC\">",
       {"line 25: <Solution transfer=\"APIC\">: is not available with this shape function: expected shape "
        "QuadraticBSpline, CubicBSpline, uGIMP or cpGIMP"}},
      {"<EndTime", "<FEMSetting/><EndTime", {"line 25: <FEMSetting>: " + remove}},
      {"</PeneBlast>",
       "<Output><PostProcessing time_interval='1' tecplot='1'/></Output></PeneBlast>",
       {"line 26: <PostProcessing tecplot=\"1\">: " + zero}},
      {"</PeneBlast>",
       "<Output><GridLineResults normal='0' x='0' y='0'/></Output></PeneBlast>",
       {"line 26: <GridLineResults>: " + remove}},
      {"</PeneBlast>",
       "<DomainDecomposition imbalance_tolerance='1.1'/></PeneBlast>",
       {"line 26: <DomainDecomposition imbalance_tolerance=\"1.1\">: known, but not implemented yet; remove "
        "the "
        "attribute or set it to its default, 1.05"}},
      {"</PeneBlast>", "<DomainDecomposition rebalance_interval='auto'/></PeneBlast>", {"ok"}},
      {"<InitialVelocity", "<ConstrainRigidPosition value='1'/><InitialVelocity", {"ok"}},
      {"<InitialVelocity",
       "<RigidInertia mass='1'/><InitialVelocity",
       {"line 14: <RigidInertia>: has an effect on a rigid body in contact only"}},
      {"<InitialVelocity",
       "<Traction tx='1' xmin='2' xmax='1'/><InitialVelocity",
       {"line 14: <Traction>: normal is the axis of the traction tx, ty, tz: give both or neither",
        "line 14: <Traction xmax=\"1\">: must be greater than xmin"}},
      {"<InitialVelocity",
       "<Traction ramp='0'/><InitialVelocity",
       {"line 14: <Traction ramp=\"0\">: expected a number greater than 0",
        "line 14: <Traction>: expected a pressure, or tx, ty, tz and normal"}},
      {"<InitialVelocity",
       "<PrescribedVelocity vx='0' vy='0' vz='1'/><HarmExcit><A x='0' y='0' z='1'/><Omega x='1' y='1' z='1'/>"
       "<Theta x='0' y='0' z='0'/><EndTime x='1' y='1' z='1'/></HarmExcit><Traction pressure='1'/>"
       "<InitialVelocity",
       {"line 14: <HarmExcit>: has no effect with PrescribedVelocity: give ConstrainRigidPosition "
        "value=\"1\" to add it to that velocity, or replace PrescribedVelocity by InitialVelocity",
        "line 14: <Traction>: has no effect on a body whose velocity is prescribed or constrained"}},
  });
}

TEST_CASE("names that refer to others") {
  check_faults({
      {"material=\"cu\"",
       "material=\"Cu\"",
       {"line 12: <Body material=\"Cu\">: there is no material of this name; did you mean 'cu'?"}},
      {"material=\"cu\"",
       "material=\"copper\"",
       {"line 12: <Body material=\"copper\">: there is no material of this name"}},
      {"workPlane=\"plane\"",
       "workPlane=\"plain\"",
       {"line 12: <Body workPlane=\"plain\">: there is no work plane of this name; did you mean 'plane'?"}},
      {"</Component>",
       "<Body name='rod' material='cu' type='Block'><Geometry dp='1' x0='0' y0='0' z0='0' lx='1' "
       "ly='1' lz='1'/></Body></Component>",
       {"line 16: <Body name=\"rod\">: another body has this name already, on line 12"}},
      {"<WorkPlane",
       "<WorkPlane name='plane'/><WorkPlane",
       {"line 10: <WorkPlane name=\"plane\">: another work plane has this name already, on line 10"}},
      {"<WorkPlane",
       "<Friction><Coefficient value='0.1' mat1='cu' mat2='c'/></Friction><WorkPlane",
       {"line 10: <Coefficient mat2=\"c\">: there is no material of this name; did you mean 'cu'?"}},
      {"<WorkPlane",
       "<Friction><Coefficient value='0.1' mat1='cu' mat2='cu'/><Coefficient value='0.2' mat1='cu' "
       "mat2='cu'/></Friction><WorkPlane",
       {"line 10: <Coefficient>: the friction of this pair of materials is given twice"}},
      {"<WorkPlane",
       "<Friction><Coefficient value='0.1' rough='1' mat1='cu' mat2='cu'/></Friction><WorkPlane",
       {"line 10: <Coefficient value=\"0.1\">: rough surfaces do not slide: remove value or rough"}},
      {"<WorkPlane",
       "<Friction><Coefficient mat1='cu' mat2='cu'/></Friction><WorkPlane",
       {"line 10: <Coefficient>: expected value, the coefficient of friction, or rough=\"1\""}},
  });
  // A wrong coefficient is said once, and not again as one that differs from itself.
  std::string text = replaced(
      bar, "<WorkPlane", "<Friction><Coefficient value='-0.1' mat1='cu' mat2='cu'/></Friction><WorkPlane");
  text = replaced(text, "</Component>",
                  "</Component><Component name='other'><Body name='second' material='cu' "
                  "type='Block'><Geometry dp='0.38' "
                  "x0='9' y0='9' z0='9' lx='1' ly='1' lz='1'/></Body></Component>");
  CHECK(faults(replaced(text, "<Solution>", "<Contact enable='1'/><Solution>")) ==
        std::vector<std::string>{"line 10: <Coefficient value=\"-0.1\">: expected a number of at least 0"});
}

TEST_CASE("bodies and work planes") {
  const std::string_view block =
      "type=\"Block\" workPlane=\"plane\">\n      <Geometry dp=\"0.38\" x0=\"0\" y0=\"0\" "
      "z0=\"0\" lx=\"3.8\" ly=\"3.8\" lz=\"19\"/>";
  check_faults({
      {"r0z=\"0.38\"",
       "a31=\"1\"",
       {"line 10: <WorkPlane>: the axes (ex, ey, ez) and (a11, a21, a31) must be orthogonal; the angle "
        "between them "
        "is 45 degrees"}},
      {"r0z=\"0.38\"",
       "ez=\"0\"",
       {"line 10: <WorkPlane>: the axes (ex, ey, ez) and (a11, a21, a31) must not be zero"}},
      {"dp=\"0.38\"",
       "dp=\"1e-9\"",
       {"line 13: <Geometry dp=\"1e-9\">: this gives about 2.74e+29 particles, more than the limit of 2^48; "
        "expected a larger particle spacing"}},
      {"x0=\"0\"",
       "x0=\"100\"",
       {"line 12: <Body name=\"rod\">: the body is outside the grid: its x ranges from 100 to 103.8, that of "
        "the grid from 0 to 11.4"}},
      {block,
       "type=\"Sphere\"><Geometry dp='1' x0='5' y0='5' z0='5' Outer_Radius='2' Inner_Radius='2'/>",
       {"line 12: <Geometry Outer_Radius=\"2\">: expected more than Inner_Radius, 2"}},
      {block,
       "type=\"Sphere\"><Geometry dp='1' x0='5' y0='5' z0='5' Outer_Radius='2' half='1'/>",
       {"line 12: <Geometry half=\"1\">: requires angle=\"90\", not 360"}},
      {block,
       "type=\"Sphere\"><Geometry dp='1' x0='5' y0='5' z0='5' Outer_Radius='2' angle='0'/>",
       {"line 12: <Geometry angle=\"0\">: expected a number in (0, 360]"}},
      {block,
       "type=\"Cylinder\"><Geometry dp_bottom='1' dp_top='1' x0='5' y0='5' z0='5' Bottom_Outer_Radius='0' "
       "Top_Outer_Radius='0' height='1'/>",
       {"line 12: <Geometry Bottom_Outer_Radius=\"0\">: expected more than Bottom_Inner_Radius, 0",
        "line 12: <Geometry Top_Outer_Radius=\"0\">: expected more than Top_Inner_Radius, 0"}},
      {block,
       "type=\"Point\"><Geometry/>",
       {"line 12: <Geometry>: expected <Point> elements, or file=\"...\""}},
      {block,
       "type=\"Point\"><Geometry file='nowhere.txt'/>",
       {"line 12: <Geometry file=\"nowhere.txt\">: nowhere.txt: no such file"}},
      {block,
       "type=\"Point\"><Geometry file='/'/>",
       {"line 12: <Geometry file=\"/\">: /: this is a folder, not a file"}},
      {block,
       "type=\"Point\"><Geometry><Point mass='0' x='0' y='0' z='0'/></Geometry>",
       {"line 12: <Point mass=\"0\">: expected a number greater than 0"}},
      {block, "type=\"Point\">", {"line 12: <Body>: element <Geometry> is missing"}},
      {block,
       "type=\"Torus\"><Geometry what='1'/>",
       {"line 12: <Body type=\"Torus\">: expected one of Point, Block, Sphere, Cylinder, Ogive, Bool, "
        "PointForBar, "
        "LineForBar, NettyForBar, PointForMembrane, RectangularForMembrane, CylinderForMembrane, "
        "PointForFEM, "
        "BlockForFEM",
        "line 12: <Geometry what=\"1\">: no such attribute; the element has no attributes"}},
  });
}

TEST_CASE("the grid") {
  check_faults({
      {"<XMax value=\"11.4\"",
       "<XMax value=\"0\"",
       {"line 19: <XMax value=\"0\">: expected more than XMin, 0"}},
      {"dx=\"0.76\"",
       "dx=\"1e-12\"",
       {"line 22: <DCell dx=\"1e-12\">: this gives 1.14e+13 cells along the axis; at most 4194304 "
        "are possible: use larger cells"}},
      {"dx=\"0.76\"",
       "dx=\"9.5e-7\"",  // twelve million
       {"line 22: <DCell dx=\"9.5e-7\">: this gives 1.2e+07 cells along the axis; at most 4194304 are "
        "possible: use larger cells"}},
      {"dx=\"0.76\"",
       "dx=\"20\"",
       {"line 22: <DCell dx=\"20\">: a cell is larger than the grid, which is 11.4 long"}},
      {"dx=\"0.76\" dy=\"0.76\" dz=\"0.76\"",
       "dx=\"2.85e-6\" dy=\"2.85e-6\" dz=\"6.65e-6\"",
       {"line 18: <Cell>: 6.4e+19 cells cannot be numbered; expected fewer than 2^62"}},
      {"<XMax value=\"11.4\" boundary=\"0\"",
       "<XMax value=\"11.5\" boundary=\"1\"",
       {"line 19: <XMax value=\"11.5\">: a wall must coincide with a cell face: 15.131578947368421 cells of "
        "0.76 do not "
        "fit between 0 and 11.5; expected 11.4 or 12.16"}},
      {"<XMax value=\"11.4\"", "<XMax value=\"11.5\"", {"ok"}},
      {"<Cell type=\"regular\">",
       "<Cell type=\"irregular\">",
       {"line 18: <Cell type=\"irregular\">: expected one of regular, nonuniform; did you mean 'regular'?"}},
  });
}

TEST_CASE("a body whose volume at the start is outside the bounds of the volume") {
  const auto found = [](const std::string& bounds, const std::string& density) {
    return faults(replaced(replaced(bar, "<EndTime", "<Volume " + bounds + "/><EndTime"), "name=\"rod\"",
                           "name=\"rod\" density=\"" + density + "\""));
  };
  CHECK(found("min=\"0.5\" max=\"2\"", "16e-3") == std::vector<std::string>{"ok"});
  CHECK(found("min=\"0.5\" max=\"2\"", "20e-3") ==
        std::vector<std::string>{
            "line 12: <Body density=\"20e-3\">: body 'rod' starts with 0.4465 of its "
            "volume at reference density, outside of Volume min: change density, or min and max"});
  CHECK(found("max=\"2\"", "4e-3") ==
        std::vector<std::string>{
            "line 12: <Body density=\"4e-3\">: body 'rod' starts with 2.2325 of its "
            "volume at reference density, outside of Volume max: change density, or min and max"});
}

TEST_CASE("a body named twice in a history, and a job's name that is too long") {
  const std::string driven = replaced(bar, "<InitialVelocity vx=\"0\" vy=\"0\" vz=\"-190\"/>",
                                      "<PrescribedVelocity vx=\"0\" vy=\"0\" vz=\"-190\"/>");
  const auto history = [&](const std::string& bodies) {
    return faults(
        replaced(driven, "</PeneBlast>",
                 "<Output><TimeHistory var='force'>" + bodies + "</TimeHistory></Output></PeneBlast>"));
  };
  CHECK(history("<Body name='rod'/>") == std::vector<std::string>{"ok"});
  CHECK(
      history("<Body name='rod'/><Body name='rod'/>") ==
      std::vector<std::string>{"line 26: <Body name=\"rod\">: this TimeHistory has this body already: remove "
                               "one of the two"});
  const auto named = [](std::size_t bytes) {
    return io::parse_scene(bar, std::string(bytes, 'j') + ".xmp", test::small_catalogue());
  };
  CHECK_NOTHROW(named(200));
  CHECK_THROWS_WITH(named(201), Catch::Contains("the job's name has 201 bytes, which is too long for the "
                                                "names of its files: rename the file, to at most 200"));
}

TEST_CASE("solution and output") {
  check_faults({
      {"<EndTime",
       "<Volume min=\"1\" max=\"1\"/><EndTime",
       {"line 25: <Volume max=\"1\">: expected more than min, 1"}},
      {"<EndTime",
       "<Volume min=\"1.1\"/><EndTime",
       {"line 25: <Volume min=\"1.1\">: expected at most 1, the volume at reference density"}},
      {"<EndTime",
       "<Volume max=\"0.9\"/><EndTime",
       {"line 25: <Volume max=\"0.9\">: expected at least 1, the volume at reference density"}},
      {"<EndTime",
       "<Volumetric averaging=\"brick\"/><EndTime",
       {"line 25: <Volumetric averaging=\"brick\">: expected one of none, cell"}},
      {"<EndTime",
       "<Volumetric averaging=\"cell\" relaxation=\"2\"/><EndTime",
       {"line 25: <Volumetric relaxation=\"2\">: expected a number in [0, 1]"}},
      {"<EndTime",
       "<Volumetric averaging=\"cell\"/><Volume update_type=\"1\"/><EndTime",
       {"line 25: <Volumetric averaging=\"cell\">: does not go with <Volume update_type=\"1\">, which takes "
        "the volume change from the cell's nodes: expected none, or another update_type"}},
      {"</PeneBlast>",
       "<Output><TimeHistory var='pres'/></Output></PeneBlast>",
       {"line 26: <TimeHistory>: expected at least one <Particle> or <Point>"}},
      {"</PeneBlast>",
       "<Output><TimeHistory var='force'/></Output></PeneBlast>",
       {"line 26: <TimeHistory>: force and moment are variables of a <Body>: expected at least one"}},
      {"</PeneBlast>",
       "<Output><TimeHistory var='force|moment'><Point x='0' y='0' z='0'/><Body "
       "name='rood'/></TimeHistory></Output></PeneBlast>",
       {"line 26: <Body name=\"rood\">: there is no body of this name; did you mean 'rod'?",
        "line 26: <TimeHistory>: force and moment are variables of a <Body>: a <Particle> or <Point> needs "
        "another"}},
      {"</PeneBlast>",
       "<Output><TimeHistory var='force'><Body name='rod'/></TimeHistory></Output></PeneBlast>",
       {"line 26: <Body name=\"rod\">: force and moment are those of rigid bodies in contact and of bodies "
        "with a prescribed velocity; this body is neither"}},
      {"</PeneBlast>",
       "<Output><TimeHistory var='press'><Point x='0' y='0' z='0'/></TimeHistory></Output></PeneBlast>",
       {"line 26: <TimeHistory var=\"press\">: expected one or more of seqv, epef, pres, density, tria, "
        "fail, engk, "
        "engi, cp, sigy, damg, body, com, mat, kelv, velocity_0, velocity_1, velocity_2, exx, eyy, ezz, "
        "posx, posy, "
        "posz, SigmaX, SigmaY, SigmaZ, SigmaXY, SigmaYZ, SigmaXZ, force, moment, joined by |; did you mean "
        "'pres'?"}},
      {"</PeneBlast>",
       "<DomainDecomposition dimension0='2'/></PeneBlast>",
       {"line 26: <DomainDecomposition>: dimension0, dimension1, dimension2 must be given together or not at "
        "all; missing: "
        "dimension1, dimension2"}},
  });
}

TEST_CASE("what implicit steps cannot do") {
  const auto with = [](const std::string& attributes, const std::string& children) {
    return "<Solution Integration=\"impl\"" + attributes + ">" + children;
  };
  check_faults({
      {"<Solution>", with("", ""), {"ok"}},
      {"<Solution>", with("", "<Implicit type='quasistatic' rtol='1e-8' gravity_ramp='1'/>"), {"ok"}},
      {"<Solution>", with(" algorithm='MUSL'", ""), {"ok"}},
      {"<Solution>",
       with(" algorithm='USF'", ""),
       {"line 25: <Solution algorithm=\"USF\">: is not available with implicit steps, whose stress is that "
        "at the end of the step: remove it, or use explicit steps (remove Integration)"}},
      {"<Solution>",
       with(" algorithm='USL'", ""),
       {"line 25: <Solution algorithm=\"USL\">: is not available with implicit steps, whose stress is that "
        "at the end of the step: remove it, or use explicit steps (remove Integration)"}},
      {"<Solution>",
       with(" transfer='XPIC'", ""),
       {"line 25: <Solution transfer=\"XPIC\">: implicit steps take FLIP alone: their displacements follow "
        "from the nodes, and only velocity increments return to the particles"}},
      {"<Solution>",
       with("", "<LimitVelocity max='1'/>"),
       {"line 25: <LimitVelocity max=\"1\">: is not available with implicit steps; remove it"}},
      {"<Solution>",
       with("", "<Volumetric averaging='cell' relaxation='0.5'/>"),
       {"line 25: <Volumetric relaxation=\"0.5\">: is not available with implicit steps: expected 0"}},
      {"<Solution>",
       with("", "<Volume update_type='3'/>"),
       {"line 25: <Volume update_type=\"3\">: implicit steps take the volume from the deformation gradient; "
        "remove it"}},
      {"<Solution>",
       with("", "<Implicit newmark_beta='0.1'/>"),
       {"line 25: <Implicit newmark_beta=\"0.1\">: steps are stable without limit only from half of "
        "newmark_gamma, 0.25"}},
      {"<Solution>",
       with("", "<Implicit time_step='1' min_step='2'/>"),
       {"line 25: <Implicit time_step=\"1\">: expected at least min_step, 2"}},
      {"<Solution>", with("", "<Implicit rule='generalised_alpha' spectral_radius='1'/>"), {"ok"}},
      {"<Solution>",
       with("", "<Implicit rule='generalised_alpha' spectral_radius='1.1'/>"),
       {"line 25: <Implicit spectral_radius=\"1.1\">: expected a number in [0, 1]"}},
      {"<Solution>", with("", "<Implicit stabilisation='0'/>"), {"ok"}},
      {"<Solution>",
       with("", "<Implicit stabilisation='-1e-3'/>"),
       {"line 25: <Implicit stabilisation=\"-1e-3\">: expected a number in [0, 1]"}},
      {"<Solution>",
       with("", "<Implicit time_step='1' max_step='0.5'/>"),
       {"line 25: <Implicit max_step=\"0.5\">: expected at least time_step, 1"}},
  });
}

TEST_CASE("what the consistent mass matrix cannot do") {
  const auto with = [](const std::string& attributes) {
    return "<Solution" + attributes + " mass=\"consistent\">";
  };
  const std::string fault = "line 25: <Solution mass=\"consistent\">: ";
  check_faults({
      {"<Solution>", with(""), {"ok"}},
      {"<Solution>", with(" transfer=\"FLIP\" flip_fraction=\"1\" algorithm=\"USF\""), {"ok"}},
      {"<Solution>", "<Solution transfer=\"PIC\" mass=\"lumped\">", {"ok"}},
      {"<Solution>",
       "<Solution mass=\"full\">",
       {"line 25: <Solution mass=\"full\">: expected one of lumped, consistent"}},
      {"<Solution>",
       with(" transfer=\"FMPM\""),
       {fault + "is available only with transfer FLIP, not with FMPM: expected lumped, or transfer FLIP"}},
      {"<Solution>",
       with(" flip_fraction=\"0.9\""),
       {fault + "is available only with the whole of FLIP: expected lumped, or flip_fraction 1"}},
      {"<Solution>",
       with(" algorithm=\"USL\""),
       {fault +
        "is not available with algorithm USL, whose strains would gain energy at light nodes: expected "
        "lumped, or algorithm MUSL, USAVG or USF"}},
      {"<Solution>",
       with(" Integration=\"impl\""),
       {fault + "is not available with implicit steps, which have lumped masses: expected lumped"}},
  });
}

TEST_CASE("what the consistent mass matrix does not go with elsewhere") {
  const auto faults = [](std::string_view from, std::string_view to) {
    return test::faults(
        test::replaced(test::replaced(test::bar, from, to), "<Solution>", "<Solution mass=\"consistent\">"));
  };
  for (const std::string shape : {"CPDI", "CPDI2"}) {
    if (!core::has_shape(shape)) continue;
    CHECK(faults("<Grid shape=\"linear\">", "<Grid shape=\"" + shape + "\">") ==
          std::vector<std::string>{
              "line 25: <Solution mass=\"consistent\">: is not available with CPDI and CPDI2, whose domains "
              "tangle at the surface of a fluid: expected lumped, or another shape function"});
  }
}

}  // namespace
