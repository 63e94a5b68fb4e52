// Notes of methods that the input does not choose, and of motions that they do not bring about.

#include <algorithm>

#include <catch2/catch.hpp>

#include "core/has_shape.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using test::bar;
using test::notes_of;
using test::replaced;

using Notes = std::vector<std::string>;

std::string linear(std::string_view why) {
  return "line 17: <Grid>: linear shape functions, the default: " + std::string(why) +
         "; stresses scatter and energy is lost where particles cross cells, and finer cells do not help: "
         "shape=\"SGMP\" avoids this at about the same cost (docs/choosing.md)";
}

TEST_CASE("linear functions by default, where bodies move over several cells") {
  const std::string unchosen = replaced(bar, " shape=\"linear\"", "");
  CHECK(notes_of(unchosen) == Notes{linear("bodies approach each other or a wall by up to 20 cells")});
  CHECK(notes_of(bar).empty());
  CHECK(notes_of(replaced(bar, "linear", "SGMP")).empty());
  CHECK(notes_of(replaced(unchosen, "-190", "-9")).empty());  // 0.95 cells
  const std::string alone =
      replaced(replaced(replaced(unchosen, "\"0\" boundary=\"2\"", "\"0\" boundary=\"0\""),
                        "\"0\" boundary=\"2\"", "\"0\" boundary=\"0\""),
               "\"0\" boundary=\"2\"", "\"0\" boundary=\"3\"");
  CHECK(notes_of(alone).empty());  // it flies without stress
  const std::string lit =
      replaced(replaced(unchosen, "-190", "0"), "</PeneBlast>",
               "<Detonation><Item type='point' time='0' x='0' y='0' z='0'/></Detonation></PeneBlast>");
  const Notes notes = notes_of(lit);
  CHECK(std::count(notes.begin(), notes.end(), linear("explosives move what is around them across cells")) ==
        1);
}

TEST_CASE("USL with a transfer that has no stable step with it") {
  const std::string usl = replaced(replaced(bar, "linear", "uGIMP"), "<Solution>",
                                   "<Solution algorithm=\"USL\" transfer=\"AFLIP\">");
  CHECK(notes_of(usl) ==
        Notes{"line 25: <Solution>: with algorithm USL and transfer AFLIP the energy grows at "
              "steps of any length: choose MUSL, USAVG or USF (docs/stability.md)"});
  CHECK(notes_of(replaced(usl, "AFLIP", "APIC")).empty());
  if (core::has_shape("cpGIMP")) CHECK(notes_of(replaced(usl, "uGIMP", "cpGIMP")).empty());
  CHECK(notes_of(replaced(usl, "USL", "USAVG")).empty());
}

TEST_CASE("methods whose energy grows in long runs") {
  const auto notes = [](const std::string& shape, const std::string& attributes) {
    return notes_of(replaced(replaced(bar, "linear", shape), "<Solution>", "<Solution " + attributes + ">"));
  };
  const Notes usf{
      "line 25: <Solution>: with algorithm USF, these shape functions and this mapping of velocities the "
      "energy may grow in runs of some ten thousand steps: choose USAVG (docs/stability.md)"};
  CHECK(notes("linear", "algorithm='USF' mass='consistent'") == usf);
  CHECK(notes("linear", "algorithm='USAVG' mass='consistent'").empty());
  CHECK(notes("linear", "algorithm='USF'").empty());
  if (core::has_shape("cpGIMP")) {
    CHECK(notes("cpGIMP", "algorithm='USF' mass='consistent'") == usf);
    CHECK(notes("cpGIMP", "algorithm='USF' transfer='AFLIP'") == usf);
    CHECK(notes("cpGIMP", "transfer='AFLIP'").empty());
  }
  if (core::has_shape("CPDI")) {
    CHECK(notes("CPDI", "algorithm='USF' transfer='FMPM' xpic_order='5'") == usf);
    CHECK(notes("CPDI", "algorithm='USF' transfer='FMPM' xpic_order='3'").empty());
  }
  if (core::has_shape("CPDI2")) {
    CHECK(notes("CPDI2", "transfer='FMPM' xpic_order='3'") ==
          Notes{"line 25: <Solution>: with CPDI2 and FMPM of an order above 2 the energy may grow in runs of "
                "some thousand steps: choose xpic_order=\"2\", or CPDI (docs/stability.md)"});
    CHECK(notes("CPDI2", "transfer='FMPM' xpic_order='2'").empty());
  }
}

TEST_CASE("a deformable body of prescribed velocity beside another one") {
  const std::string second = replaced(
      bar, "</Component>",
      "<Body name='ram' material='cu' type='Block'><Geometry dp='0.38' x0='0' y0='0' z0='20' lx='3.8' "
      "ly='3.8' lz='0.76'/><PrescribedVelocity vx='0' vy='0' vz='-1'/></Body></Component>");
  CHECK(
      notes_of(second) ==
      Notes{"line 16: <Body>: body 'ram' has a prescribed velocity and a deformable material: explicit "
            "steps prescribe it to the particles, not to the nodes, so that it presses on other bodies with "
            "its own stiffness and they may enter it; choose a material a hundred times stiffer than "
            "theirs, or Rigid with Contact"});
  CHECK(notes_of(replaced(bar, "<InitialVelocity vx=\"0\" vy=\"0\" vz=\"-190\"/>",
                          "<PrescribedVelocity vx='0' vy='0' vz='-1'/>"))
            .empty());  // there is nothing that could enter it
}

TEST_CASE("quasi-static bodies that nothing holds along an axis") {
  const std::string still =
      replaced(replaced(bar, "<InitialVelocity vx=\"0\" vy=\"0\" vz=\"-190\"/>", ""), "<Solution>",
               "<Solution Integration=\"impl\"><Implicit type=\"quasistatic\"/>");
  CHECK(notes_of(still).empty());
  const std::string free =
      replaced(still, "<YMin value=\"0\" boundary=\"2\"/>", "<YMin value=\"0\" boundary=\"0\"/>");
  CHECK(
      notes_of(free) ==
      Notes{"line 17: <Grid>: no symmetry plane, fixed face or body of prescribed velocity holds the bodies "
            "along y: in quasi-static steps, which have no inertia, they may drift there"});
  CHECK(notes_of(
            replaced(free, "<XMax value=\"11.4\" boundary=\"0\"/>", "<XMax value=\"11.4\" boundary=\"1\"/>"))
            .empty());
}

}  // namespace
