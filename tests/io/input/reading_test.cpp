// What a right input becomes.

#include <catch2/catch.hpp>

#include "io/input/echo.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using test::bar;
using test::replaced;

TEST_CASE("a scene holds what the input states") {
  const core::Scene scene = test::parse(bar);
  REQUIRE(scene.materials.size() == 1);
  const core::MaterialInput& cu = scene.materials[0];
  CHECK(cu.name == "cu");
  CHECK(cu.reference_density == 8.93e-3);
  CHECK(cu.strength.type == "IsoHarden");
  CHECK(cu.strength.at("Poisson") == 0.35);
  CHECK(cu.strength.at("bq1") == 1.5);  // default of the table
  CHECK(cu.limiter == core::ViscosityLimiter::none);
  CHECK_FALSE(cu.strength.has("SpecHeat"));  // neither given nor with a default
  CHECK(cu.strength.value_or("SpecHeat", 7) == 7);
  REQUIRE(cu.eos.has_value());
  CHECK(cu.eos->at("C0") == 3940);
  CHECK(cu.eos->at("E0") == 0);
  CHECK(cu.failures.empty());  // type none
  CHECK(cu.source.line == 4);

  REQUIRE(scene.components.size() == 1);
  REQUIRE(scene.components[0].bodies.size() == 1);
  const core::BodyInput& rod = scene.components[0].bodies[0];
  CHECK(rod.name == "rod");
  CHECK(rod.density == 8.93e-3);
  CHECK(rod.work_plane == 0);
  CHECK(rod.initial_velocity == core::Vec3<double>{0., 0., -190.});
  CHECK_FALSE(rod.prescribed_velocity.has_value());
  CHECK(rod.source.file == "case.xmp");
  CHECK(rod.source.line == 12);
  const auto& block = std::get<core::BlockGeometry>(rod.geometry);
  CHECK(block.spacing == 0.38);
  CHECK(block.size == core::Vec3<double>{3.8, 3.8, 19.});

  CHECK(scene.grid.axes[2].cells == 35);
  CHECK(scene.grid.axes[2].lower == core::Boundary::symmetry);
  CHECK(scene.grid.axes[2].upper == core::Boundary::free);
  CHECK(scene.provenance.job_name == "case");
  CHECK(scene.provenance.hash.size() == 16);
}

TEST_CASE("defaults") {
  const core::Scene scene = test::parse(bar);
  const core::SolutionInput& solution = scene.solution;
  CHECK(solution.scheme == core::Scheme::musl);
  CHECK(solution.transfer == core::Transfer::flip);
  CHECK(solution.mass == core::MassMatrix::lumped);
  CHECK(solution.integration == core::Integration::explicit_dynamics);
  CHECK_FALSE(solution.near_boundary_stop);
  CHECK(solution.end_time == 0.08);
  CHECK(solution.time_step.factor == 0.9);
  CHECK_FALSE(solution.limit_velocity.has_value());
  CHECK(solution.volume.update == core::VolumeUpdate::rate);
  CHECK(solution.averaging == core::VolumeAveraging::none);
  CHECK_FALSE(solution.volume.erode.has_value());
  CHECK_FALSE(solution.threads.has_value());
  CHECK(scene.output.console.print_time == 0.08 / 100);
  CHECK_FALSE(scene.output.post_processing.has_value());
  CHECK(scene.output.summary);
  CHECK(scene.grid.mass_cutoff == std::numeric_limits<double>::epsilon());
  CHECK(scene.decomposition.method == core::PartitionMethod::automatic);
  CHECK_FALSE(scene.contact.enable);

  const auto sphere =
      test::parse(replaced(replaced(bar, "type=\"Block\"", "type=\"Sphere\""),
                           "dp=\"0.38\" x0=\"0\" y0=\"0\" z0=\"0\" lx=\"3.8\" ly=\"3.8\" lz=\"19\"",
                           "dp='1' x0='5' y0='5' z0='5' Outer_Radius='2'"));
  const auto& g = std::get<core::SphereGeometry>(sphere.components[0].bodies[0].geometry);
  CHECK(g.inner_radius == 0);
  CHECK(g.angle == 360);
  CHECK_FALSE(g.upper_half);
  CHECK(g.layout == core::Layout::orthogonal);
}

TEST_CASE("a program's defaults are the input's") {
  // A scene that a test or a program makes without a file starts from the same values as an empty element.
  const std::string with_all =
      replaced(bar, "<EndTime value=\"0.08\"/>",
               "<EndTime value='1'/><TimeStep/><Volume/><Warn type='ie'/><DynamicRelax "
               "damping='0'/>");
  core::Scene read = test::parse(replaced(with_all, "</PeneBlast>", "<Contact enable='0'/></PeneBlast>"));
  read.solution.warn = {};
  core::Scene made = read;
  made.solution = {};
  made.solution.end_time = 1;
  made.contact = {};
  CHECK(io::to_text(made) == io::to_text(read));
}

TEST_CASE("the limiter of the artificial viscosity") {
  const std::string text = replaced(bar, "TangMod=\"100\"", "TangMod=\"100\" limiter=\"shock\"");
  const core::Scene scene = test::parse(text);
  CHECK(scene.materials[0].limiter == core::ViscosityLimiter::shock);
  CHECK_FALSE(scene.materials[0].strength.has("limiter"));  // a word, no value of the law
  CHECK(io::to_text(scene).find("limiter=\"shock\"") != std::string::npos);
}

TEST_CASE("settings") {
  std::string text = replaced(bar, "<Solution><EndTime value=\"0.08\"/>",
                              R"(<Solution algorithm="USL" near_boundary_stop="1">
    <EndTime value="1"/><TimeStep factor="0.5" const="1" specified="1e-4" NotConsiderVisForCp="1"/>
    <LimitVelocity max="1e4"/><Volume update_type="3" erode="0.1" min="0.2" max="5"/><Volumetric averaging="cell" relaxation="0.25"/><Warn type=" ie | grid " level="2"/>
    <EnergyFraction value="0.01"/><DynamicRelax damping="3"/><Gravity ax="0" ay="0" az="-9.81"/>
    <OpenMPSetting nthread="4" directionofdecomposition="2"/>)");
  text = replaced(text, "</PeneBlast>", R"(<Output><Console print_time="0.1" print_momentum="1"/>
    <PostProcessing time_interval="0.5" h5part="1" vtk_data="2" var="seqv|epef|seqv"/>
    <TimeHistory var="pres"><Particle x="1" y="2" z="3"/><Point x="4" y="5" z="6"/></TimeHistory>
    <TimeHistory var="engk"><Point x="0" y="0" z="0"/></TimeHistory>
    <Restart time_interval="0.25"/><Statistics memory="1" cell_occupy="1"/></Output>
    <DomainDecomposition dimension0="2" dimension1="1" dimension2="3"/></PeneBlast>)");
  const core::Scene scene = test::parse(text);
  const core::SolutionInput& s = scene.solution;
  CHECK(s.scheme == core::Scheme::usl);
  CHECK(s.near_boundary_stop);
  CHECK((s.time_step.factor == 0.5 && s.time_step.constant && s.time_step.specified == 1e-4 &&
         s.time_step.ignore_viscosity));
  CHECK(s.limit_velocity == 1e4);
  CHECK((s.volume.update == core::VolumeUpdate::deformation_gradient && s.volume.erode == 0.1 &&
         s.volume.min == 0.2 && s.volume.max == 5));
  CHECK(s.averaging == core::VolumeAveraging::cell);
  CHECK(s.pressure_relaxation == 0.25);
  CHECK((s.warn.negative_internal_energy && !s.warn.negative_volume && s.warn.outside_grid));
  CHECK(s.warn.level == core::WarnInput::Level::stop);
  CHECK(s.energy_fraction == 0.01);
  CHECK(s.damping == 3);
  CHECK(s.gravity == core::Vec3<double>{0., 0., -9.81});
  CHECK(s.threads == 4);
  const core::OutputInput& o = scene.output;
  CHECK((o.console.print_time == 0.1 && o.console.print_momentum));
  REQUIRE(o.post_processing.has_value());
  CHECK(o.post_processing->h5part);
  CHECK(o.post_processing->vtk == core::PostProcessingInput::Vtk::file_per_body);
  CHECK(o.post_processing->variables == std::vector<std::string>{"seqv", "epef"});
  REQUIRE(o.histories.size() == 2);
  CHECK(o.histories[0].particles == std::vector{core::Vec3<double>{1., 2., 3.}});
  CHECK(o.histories[0].points == std::vector{core::Vec3<double>{4., 5., 6.}});
  CHECK(o.restart_interval == 0.25);
  CHECK((o.statistics.memory && o.statistics.cell_occupancy));
  CHECK(scene.decomposition.dimensions == std::array{2, 1, 3});
  CHECK(scene.decomposition.method == core::PartitionMethod::uniform);
}

TEST_CASE("a material may be declared after its body") {
  std::string text(bar);
  const std::size_t begin = text.find("  <Material"), end = text.find("</Material>") + 12;
  const std::string material = text.substr(begin, end - begin);
  text.erase(begin, end - begin);
  const core::Scene scene = test::parse(replaced(text, "</PeneBlast>", material + "</PeneBlast>"));
  CHECK(scene.components[0].bodies[0].density == 8.93e-3);
}

TEST_CASE("a body's own density") {
  const core::Scene scene = test::parse(replaced(bar, "type=\"Block\"", "type=\"Block\" density=\"9e-3\""));
  CHECK(scene.components[0].bodies[0].density == 9e-3);
  CHECK(scene.materials[0].reference_density == 8.93e-3);
}

TEST_CASE("a body's own temperature, also when written down again") {
  const core::Scene scene =
      test::parse(replaced(bar, "<InitialVelocity", "<InitialTemperature value='600.5'/><InitialVelocity"));
  CHECK(scene.components[0].bodies[0].initial_temperature == 600.5);
  CHECK(test::parse(io::to_text(scene)).components[0].bodies[0].initial_temperature == 600.5);
  CHECK_FALSE(test::parse(std::string(bar)).components[0].bodies[0].initial_temperature);
}

TEST_CASE("work planes are orthonormal whatever lengths the input gives") {
  const core::Scene scene = test::parse(replaced(
      bar, "<WorkPlane", "<WorkPlane name='w' ex='3' ey='0' ez='0' a11='0' a21='0' a31='2'/><WorkPlane"));
  const core::WorkPlane& plane = scene.work_planes[0];
  CHECK(plane.z_axis == core::Vec3<double>{1., 0., 0.});
  CHECK(plane.x_axis == core::Vec3<double>{0., 0., 1.});
  CHECK(plane.y_axis == core::Vec3<double>{0., -1., 0.});  // z cross x
}

TEST_CASE("both ways to leave a body out") {
  for (const std::string_view way : {"Deactive='1' ", ""}) {
    std::string text = replaced(bar, "name=\"rod\"", std::string(way) + "name=\"rod\"");
    if (way.empty())
      text = replaced(text, "<InitialVelocity", "<BodyContrl Deactive='1' NoOutput='1'/><InitialVelocity");
    const core::BodyInput body = test::parse(text).components[0].bodies[0];
    CHECK(body.deactivated);
    CHECK(body.no_output == way.empty());
  }
}

TEST_CASE("gb2312 is read, also with the characters of its supersets") {
  // 铜 is in GB2312; 镕 is only in GBK. The comment holds 材料.
  std::string text = replaced(bar, "encoding=\"utf-8\"", "encoding=\"gb2312\"");
  text = replaced(text, "<Material name=\"cu\">",
                  "<!-- \xB2\xC4\xC1\xCF --><Material name=\"\xCD\xAD\xE9\x46\">");
  text = replaced(text, "material=\"cu\"", "material=\"\xCD\xAD\xE9\x46\"");
  const core::Scene scene = test::parse(text);
  CHECK(scene.materials[0].name == "\xE9\x93\x9C\xE9\x95\x95");

  const auto found = test::faults(replaced(text, "material=\"\xCD\xAD\xE9\x46\"", "material=\"\xCD\xAD\""));
  CHECK(found == std::vector<std::string>{
                     "line 12: <Body material=\"\xE9\x93\x9C\">: there is no material of this name"});
}

TEST_CASE("other encodings") {
  CHECK(test::faults("\xEF\xBB\xBF" + std::string(bar)).front() == "ok");  // byte order mark
  std::string latin = replaced(bar, "encoding=\"utf-8\"", "encoding=\"ISO-8859-1\"");
  latin = replaced(latin, "<Name value=\"bar\"/>", "<Name value=\"M\xFCller\"/>");
  CHECK(test::parse(latin).header.name == "M\xC3\xBCller");
  CHECK(test::faults(replaced(bar, "<Name value=\"bar\"/>", "<Name value=\"M\xFCller\"/>"))
            .front()
            .starts_with("line 3: not well-formed XML: "));
  std::string wide = "\xFF\xFE";
  for (const char c : replaced(bar, "encoding=\"utf-8\"", "encoding=\"utf-16\"")) wide += {c, '\0'};
  CHECK(test::faults(wide).front() == "ok");
}

TEST_CASE("bytes that are not of the encoding") {
  const std::string text = replaced(replaced(bar, "encoding=\"utf-8\"", "encoding=\"gb2312\""),
                                    "<Name value=\"bar\"/>", "<Name value=\"\xFF\xFF\"/>");
  CHECK(test::faults(text).front() ==
        "line 3: not well-formed XML: AttValue: ' expected (some bytes are invalid in the encoding that the "
        "first line declares)");
  CHECK(test::faults(replaced(bar, "encoding=\"utf-8\"", "encoding=\"klingon\"")).front() ==
        "line 1: not well-formed XML: Unsupported encoding klingon");
}

TEST_CASE("lines of elements and attributes, also beyond 65535") {
  const std::string text =
      replaced(bar, "<Solution>", std::string(100000, '\n') + "<Solution\n\n  algorithm='MUSL'\n speed='1'>");
  CHECK(test::faults(text).front().starts_with("line 100028: <Solution speed="));
}

TEST_CASE("the echo is an input that gives the same scene") {
  const core::Scene scene = test::parse(bar);
  const std::string echo = io::to_text(scene);
  CHECK(io::to_text(test::parse(echo)) == echo);
  CHECK(echo.find("<TimeStep factor=\"0.9\" const=\"0\" specified=\"0\" NotConsiderVisForCp=\"0\"/>") !=
        echo.npos);
  const std::string odd =
      replaced(bar, "<Name value=\"bar\"/>", "<Name value=\"a&lt;b &amp; &quot;c&quot;&#10;d\"/>");
  CHECK(test::parse(io::to_text(test::parse(odd))).header.name == "a<b & \"c\"\nd");
}

TEST_CASE("jobs and files") {
  const test::TemporaryFolder folder;
  const core::Catalogue& catalogue = test::small_catalogue();
  folder.write("bar.v2.xmp", bar);
  CHECK(io::read_scene(folder / "bar.v2.xmp", catalogue).provenance.job_name == "bar.v2");
  CHECK(io::read_scene(folder / "bar.v2", catalogue).provenance.job_name == "bar.v2");

  const std::string long_name(200, 'n');  // longer than the 80 characters that others cut
  folder.write(long_name + ".xmp", bar);
  CHECK(io::read_scene(folder / long_name, catalogue).provenance.job_name == long_name);

  std::filesystem::create_directory(folder / "taylor");  // a folder does not hide the file beside it
  folder.write("taylor.xmp", bar);
  CHECK(io::read_scene(folder / "taylor", catalogue).provenance.job_name == "taylor");
}

TEST_CASE("files that cannot be read") {
  const test::TemporaryFolder folder;
  const auto fault = [&](std::string_view name) {
    const std::filesystem::path file = folder / name;
    try {
      io::read_scene(file, test::small_catalogue());
    } catch (const core::InputErrors& errors) { return test::replaced(errors.what(), file.string(), "FILE"); }
    return std::string("ok");
  };
  std::filesystem::create_directory(folder / "sub");
  folder.write("empty.xmp", " \n");
  folder.write("binary.xmp", std::string_view("\x7f"
                                              "ELF\0\0\1",
                                              7));
  CHECK(fault("none.xmp") == "FILE: no such file");
  CHECK(fault("none").starts_with("FILE: no such file, nor "));
  CHECK(fault("sub") == "FILE: this is a folder, not a file");
  CHECK(fault("empty.xmp") == "FILE: the file is empty");
  CHECK(fault("binary.xmp").starts_with("FILE:1: not well-formed XML: "));
  CHECK(fault(std::string(5000, 'x')).starts_with("FILE: no such file"));
}

TEST_CASE("particle files are relative to the input") {
  const test::TemporaryFolder folder;
  const std::string text = replaced(replaced(bar, "type=\"Block\"", "type=\"Point\""),
                                    "dp=\"0.38\" x0=\"0\" y0=\"0\" z0=\"0\" lx=\"3.8\" ly=\"3.8\" lz=\"19\"",
                                    "file=\"points.txt\"");
  folder.write("case.xmp", text);
  CHECK_THROWS_WITH(io::read_scene(folder / "case.xmp", test::small_catalogue()),
                    Catch::Contains("points.txt: no such file"));
  CHECK_NOTHROW(io::read_scene(folder / "case.xmp", test::small_catalogue(), {.check_files = false}));
  folder.write("points.txt", "1 0 0 0\n");
  const core::Scene scene = io::read_scene(folder / "case.xmp", test::small_catalogue());
  CHECK(std::get<core::PointGeometry>(scene.components[0].bodies[0].geometry).file ==
        (folder / "points.txt").string());
}

}  // namespace
