// Notes of bodies that meet, with contact and without, and of rigid bodies; and what rigid bodies are
// refused.

#include <algorithm>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using test::bar;
using test::notes_of;
using test::parse;
using test::replaced;
using test::rigid_bar;

/// A second body beside the rod, of the rod's component or of one of its own.
std::string two_bodies(std::string_view text, double x, bool own_component) {
  const std::string second = fmt::format(
      "<Body name='second' material='cu' type='Block'><Geometry dp='0.25' x0='{}' y0='0' z0='1' lx='1' "
      "ly='1' "
      "lz='1'/></Body></Component>",
      x);
  return replaced(text, "</Component>",
                  (own_component ? "</Component><Component name='other'>" : "") + second);
}

TEST_CASE("several components without contact") {
  const std::string stick =
      "without contact, bodies of different components that come within a cell of each other stick together: "
      "they neither slide nor separate";
  CHECK(notes_of(two_bodies(bar, 6, false)).empty());
  CHECK(notes_of(two_bodies(bar, 6, true)) == std::vector<std::string>{"line 16: <Component>: " + stick});
  CHECK(notes_of(two_bodies(bar, 4.5, true)) ==
        std::vector<std::string>{"line 16: <Component>: bodies 'rod' and 'second' touch at the start; " +
                                 stick});
  CHECK(
      notes_of(two_bodies(rigid_bar(), 6, true)) ==
      std::vector<std::string>{"line 11: <Component>: rigid bodies pass through each other without contact"});
  // With contact this is not said; nor of a body that takes no part.
  const std::string touching = two_bodies(bar, 4.5, true);
  CHECK(notes_of(
            replaced(touching, "<Solution>", "<Contact enable='1' contact_normal='regression'/><Solution>"),
            true)
            .empty());
  CHECK(notes_of(replaced(touching, "name='second'", "name='second' Deactive='1'")).empty());
}

TEST_CASE("normals of contact: weights that tie, and weights that nothing uses") {
  const auto notes = [](const std::string& contact, const std::string& weights, int bodies) {
    std::string text = two_bodies(bar, 4.5, true);
    if (bodies == 3)
      text = replaced(text, "<Grid ",
                      "<Component name='third'><Body name='ball' material='cu' type='Sphere'><Geometry "
                      "dp='0.38' x0='9' y0='9' z0='9' Outer_Radius='1'/></Body></Component><Grid ");
    text = replaced(text, "name='other'", "name='other' " + weights);
    return notes_of(replaced(text, "<Solution>", "<Contact enable='1' " + contact + "/><Solution>"), true);
  };
  const std::string tied =
      "line 25: <Contact>: components 'target' and 'other' have the same normal_vector_weight: their normals "
      "are "
      "the means of both bodies' gradients of mass, which tilt at the edges of a body on a wider one and "
      "hold "
      "it there. Set contact_normal to automatic or regression, or give the wider body the larger weight";
  CHECK(notes("", "", 2).empty());
  CHECK(notes("contact_normal='mass_gradient'", "normal_vector_weight='1'", 2).empty());
  CHECK(notes("contact_normal='mass_gradient'", "", 2) == std::vector{tied});
  CHECK(notes("contact_normal='regression'", "", 2).empty());
  const auto averaged = [&](const std::string& type) {
    return notes_of(replaced(two_bodies(bar, 4.5, true), "<Solution>",
                             "<Contact enable='1' contact_normal='regression' contact_type='" + type +
                                 "'/><Solution algorithm='USAVG'>"),
                    true);
  };
  CHECK(averaged("0").empty());
  CHECK(averaged("1") ==
        std::vector<std::string>{
            "line 25: <Solution algorithm=\"USAVG\">: with Contact, bodies that rebound gain "
            "energy, as their strains do not follow the impulses of contact. Use MUSL, or "
            "contact_type 0"});
  for (const std::string scheme : {"USF", "USL"}) {
    const std::string text =
        replaced(two_bodies(bar, 4.5, true), "<Solution>",
                 "<Contact enable='1' contact_normal='regression'/><Solution algorithm='" + scheme + "'>");
    CHECK(notes_of(text, true) ==
          std::vector<std::string>{
              "line 25: <Solution algorithm=\"" + scheme +
              "\">: with Contact, bodies that rebound gain energy, as their strains do not "
              "follow the impulses of contact. Use MUSL"});
  }
  CHECK(notes("contact_normal='mass_gradient'", "", 3) ==
        std::vector{replaced(replaced(tied, "'target' and 'other'", "'target', 'other' and 'third'"),
                             "hold it there.",
                             "hold it there, and where three of them meet the normals of the pairs do not go "
                             "together.")});
  CHECK(notes("contact_normal='mass_gradient' auto_normal_vector_weight='1'", "", 2) ==
        std::vector{replaced(tied, "normal_vector_weight:", "normal_vector_weight, by their stiffness:")});
  CHECK(
      notes("contact_normal='regression' auto_normal_vector_weight='1'", "normal_vector_weight='2'", 2) ==
      std::vector<std::string>{"line 16: <Component normal_vector_weight=\"2\">: no effect: with "
                               "contact_normal=\"regression\" the particles of both bodies give the normal",
                               "line 25: <Contact auto_normal_vector_weight=\"1\">: no effect: with "
                               "contact_normal=\"regression\" the particles of both bodies give the normal"});
}

TEST_CASE("settings of contact that others replace, or that meet no case") {
  const auto notes = [](const std::string& contact, const std::string& friction) {
    std::string text =
        replaced(two_bodies(bar, 4.5, true), "name='other'", "name='other' normal_vector_weight='2'");
    text = replaced(text, "<WorkPlane", friction + "<WorkPlane");
    return notes_of(replaced(text, "<Solution>", "<Contact enable='1' " + contact + "/><Solution>"), true);
  };
  CHECK(notes("", "").empty());
  CHECK(notes("auto_normal_vector_weight='1'", "") ==
        std::vector<std::string>{"line 16: <Component normal_vector_weight=\"2\">: no effect: "
                                 "auto_normal_vector_weight=\"1\" gives the weights"});
  CHECK(notes("normal_vector_excluding_failure_particle='1'", "") ==
        std::vector<std::string>{
            "line 25: <Contact normal_vector_excluding_failure_particle=\"1\">: no effect: "
            "no body has a material that can fail"});
  const auto friction = [](const std::string& with) {
    return "<Material name='pb'><ReferenceDensity value='1'/><StrengthModel type='IsoElastic' Young='1' "
           "Poisson='0.3'/></Material><Friction><Coefficient value='0.3' mat1='cu' mat2='" +
           with + "'/></Friction>";
  };
  const auto idle = [&](const std::string& with) {
    return std::ranges::count(notes("", friction(with)),
                              "line 10: <Coefficient>: no effect: no two components have these materials");
  };
  CHECK(idle("cu") == 0);
  CHECK(idle("pb") == 1);
}

TEST_CASE("a rough rigid surface that nothing measures") {
  const auto notes = [](const std::string& contact) {
    std::string text =
        replaced(two_bodies(rigid_bar(), 6, true), "<WorkPlane",
                 "<Friction><Coefficient rough='1' mat1='cu' mat2='soft'/></Friction><WorkPlane");
    text = replaced(
        text, "<Material ",
        "<Material name='soft'><ReferenceDensity value='1'/><StrengthModel type='IsoElastic' Young='1' "
        "Poisson='0.3'/></Material><Material ");
    text = replaced(text, "name='second' material='cu'", "name='second' material='soft'");
    return std::ranges::count(
        notes_of(replaced(text, "<Solution>", "<Contact enable='1' " + contact + "/><Solution>"), true),
        "line 10: <Coefficient rough=\"1\">: friction of the rigid body acts at nodes inside it only with "
        "distance_type=\"2\" and min_distance; without, what sticks is held above it, as far as contact "
        "reaches");
  };
  CHECK(notes("") == 1);
  CHECK(notes("distance_type='1' min_distance='0.9'") == 1);
  CHECK(notes("distance_type='2' min_distance='0.05'") == 0);
}

TEST_CASE("contact cannot part driven rigid bodies") {
  const std::string still = "<PrescribedVelocity vx='0' vy='0' vz='0'/>",
                    falls = "<PrescribedVelocity vx='0' vy='0' vz='-1'/>";
  const auto passing = [](const std::string& first, const std::string& second) {
    std::string text =
        replaced(two_bodies(rigid_bar(), 6, true), "<InitialVelocity", first + "<InitialVelocity");
    text = replaced(text, "lz='1'/></Body>", "lz='1'/>" + second + "</Body>");
    const std::vector<std::string> notes =
        notes_of(replaced(text, "<Solution>", "<Contact enable='1'/><Solution>"), true);
    return std::ranges::count_if(notes, [](const std::string& note) {
      return note.find("rigid bodies 'rod' and 'second' both have a prescribed motion") !=
                 std::string::npos ||
             note.find("rigid bodies 'second' and 'rod' both have a prescribed motion") != std::string::npos;
    });
  };
  CHECK(passing(falls, still) == 1);
  CHECK(passing(still, falls) == 1);
  CHECK(passing(falls, "") == 0);     // the second is free
  CHECK(passing(still, still) == 0);  // they never meet
}

TEST_CASE("contact without failure, with a given step, and of many components") {
  const auto notes = [](const std::string& contact, const std::string& step, std::string text) {
    text = replaced(text, "<Solution>",
                    "<Contact enable='1' contact_normal='regression' " + contact + "/><Solution>");
    return notes_of(replaced(text, "<EndTime", step + "<EndTime"), true);
  };
  const std::string two = two_bodies(bar, 6, true);
  CHECK(notes("failure_to_component='1'", "", two) ==
        std::vector<std::string>{"line 25: <Contact failure_to_component=\"1\">: no effect: no body has a "
                                 "material that can fail; give it a FailureModel"});
  CHECK(notes("failure_to_component='1'", "",
              replaced(two, "<FailureModel type=\"none\"/>", "<FailureModel type='PlaStrain' epmax='1'/>"))
            .empty());
  CHECK(notes("contact_time_step='1'", "<TimeStep factor='0.5'/>", two).empty());
  for (const std::string step : {"specified='1e-4'", "const='1'"})
    CHECK(notes("contact_time_step='1'", "<TimeStep " + step + "/>", two) ==
          std::vector<std::string>{
              "line 25: <Contact contact_time_step=\"1\">: no effect: TimeStep specified or "
              "const decides the step"});
  std::string many = two;
  for (int i = 3; i <= 16; ++i)
    many = replaced(many, "<Grid ",
                    fmt::format("<Component name='c{0}'><Body name='b{0}' material='cu' "
                                "type='Block'><Geometry dp='0.25' x0='9' y0='9' z0='{0}' lx='1' "
                                "ly='1' lz='0.5'/></Body></Component><Grid ",
                                i));
  CHECK(notes("record_contact_force='1'", "", many).empty());
  many = replaced(many, "<Grid ",
                  "<Component name='last'><Body name='last' material='cu' type='Block'><Geometry "
                  "dp='0.25' x0='9' y0='9' z0='20' lx='1' ly='1' lz='1'/></Body></Component><Grid ");
  CHECK(notes("record_contact_force='1'", "", many) ==
        std::vector<std::string>{
            "line 25: <Contact record_contact_force=\"1\">: the scene has 17 components: with "
            "more than 16 only the force between the first two is recorded"});
}

TEST_CASE("gaps that contact does not measure") {
  const auto notes = [](const std::string& contact) {
    return notes_of(replaced(two_bodies(bar, 6, true), "<Solution>",
                             "<Contact enable='1' contact_normal='regression' " + contact + "/><Solution>"),
                    true);
  };
  const std::string without =
      "no effect: without min_distance bodies touch at all nodes that both reach, up to two cells apart; "
      "give "
      "min_distance=\"0.5\" with distance_type 1, 0.05 with 2";
  CHECK(notes("distance_type='1'") ==
        std::vector<std::string>{"line 25: <Contact distance_type=\"1\">: " + without});
  CHECK(notes("distance_type='2' min_distance='0'") ==
        std::vector<std::string>{"line 25: <Contact distance_type=\"2\">: " + without});
  CHECK(notes("min_distance='0.5'") ==
        std::vector<std::string>{"line 25: <Contact min_distance=\"0.5\">: no effect: used only with "
                                 "distance_type=\"1\" or \"2\""});
  CHECK(notes("distance_type='2' min_distance='0.05'").empty());
  CHECK(notes("").empty());
}

TEST_CASE("a rigid body without a law of motion") {
  // `motion`: of a rigid body beside a deformable one.
  const auto notes = [](const std::string& motion, const std::string& gravity = "") {
    std::string text =
        replaced(two_bodies(bar, 6, true), "<Solution>",
                 "<Contact enable='1' contact_type='1' contact_normal='regression'/><Solution>");
    text = replaced(text, "<EndTime", gravity + "<EndTime");
    text = replaced(text, "lz='1'/></Body>", "lz='1'/>" + motion + "</Body>");
    text = replaced(text, "name='second' material='cu'", "name='second' material='iron'");
    return notes_of(replaced(text, "</Material>",
                             "</Material><Material name='iron'><ReferenceDensity value='1'/><StrengthModel "
                             "type='Rigid'/></Material>"),
                    true);
  };
  const std::string
      start =
          "line 16: <Body>: rigid body 'second' has no law of motion: from rest, it moves freely under "
          "contact",
      end = ". Give it PrescribedVelocity where it is held or driven, InitialVelocity where it is free";
  CHECK(notes("") == std::vector{start + end});
  CHECK(notes("", "<Gravity ax='0' ay='0' az='-1'/>") == std::vector{start + " and gravity" + end});
  for (const std::string motion :
       {"<InitialVelocity vx='0' vy='0' vz='0'/>", "<PrescribedVelocity vx='0' vy='0' vz='0'/>"})
    CHECK(notes(motion).empty());
}

TEST_CASE("a free rigid body is in contact of type 1 whatever the type") {
  const auto named = [](const std::string& type, const std::string& motion) {
    const std::string text =
        replaced(two_bodies(rigid_bar(), 6, true), "<InitialVelocity", motion + "<InitialVelocity");
    const std::vector<std::string> notes =
        notes_of(replaced(text, "<Solution>", "<Contact enable='1' " + type + "/><Solution>"), true);
    return std::ranges::count_if(notes, [](const std::string& note) {
      return note.find("is free: where it touches others contact is of type 1") != std::string::npos;
    });
  };
  CHECK(named("", "") == 1);
  CHECK(named("contact_type='2'", "") == 1);
  CHECK(named("contact_type='1'", "") == 0);
}

TEST_CASE("rigid bodies beside others are refused") {
  const std::string mixed =
      replaced(replaced(two_bodies(bar, 6, true), "material='cu'", "material='iron'"), "</Material>",
               "</Material><Material name='iron'><ReferenceDensity value='1'/><StrengthModel "
               "type='Rigid'/></Material>");
  std::vector<core::Diagnostic> notes;
  CHECK_THROWS_WITH(
      parse(mixed, notes),
      "case.xmp:16: <Body material=\"iron\">: a rigid body acts on others only through contact, which is "
      "off: it "
      "would pass through 'rod' without exerting a force. Set Contact enable to 1, give the body a "
      "deformable "
      "material, with PrescribedVelocity where its motion is known (such a body pushes with its stiffness), "
      "or "
      "remove it; a scene of rigid bodies only is accepted");
  CHECK_NOTHROW(parse(replaced(mixed, "name='second'", "name='second' Deactive='1'"), notes));
  CHECK_NOTHROW(parse(replaced(mixed, "<Solution>", "<Contact enable='1'/><Solution>"), notes, true));
  CHECK_THROWS_WITH(
      parse(replaced(rigid_bar(), "<InitialVelocity", "<Traction pressure='1'/><InitialVelocity"), notes),
      "case.xmp:14: <Traction>: has no effect on a rigid body; use PrescribedAcceleration");
}

}  // namespace
