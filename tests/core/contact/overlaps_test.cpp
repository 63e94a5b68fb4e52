// Bodies in the same place at the start are named; bodies that touch are not.
#include "core/contact/overlaps.hpp"

#include <catch2/catch.hpp>

#include "tests/core/step/case.hpp"

using namespace mpm::tests;

namespace {

/// Two blocks of 4 x 4 x 4 cells with a gap along x; what is said about their components, or about them.
std::vector<std::string> words(double gap, double aside = 0, bool of_bodies = false, bool contact = true) {
  ReferenceCase c = open_space(ReferenceShape::linear, ReferenceScheme::musl);
  const ReferenceParticle like = tumbling_block().particles.front();
  for (const bool second : {false, true}) {
    for (int i = 0; i < 512; ++i) {
      ReferenceParticle p = like;
      const auto at = [&](int n) { return 0.25 + 0.5 * (n % 8); };
      p.x = {(second ? 7 + gap : 3) + at(i), 4.3 + at(i / 8) + (second ? aside : 0), 4.2 + at(i / 64)};
      p.V = 0.125;
      p.m = c.material.density * p.V;
      p.s = {};
      c.particles.push_back(p);
    }
  }
  SmallRun run(c, 512, true);
  run.scene->components[0].name = "one";
  run.scene->components[1].name = "two";
  run.scene->contact.enable = contact;
  for (std::size_t b = 0; b < run.model.bodies.size(); ++b) run.model.bodies[b].name = b == 0 ? "a" : "b";
  if (of_bodies) return mpm::core::shared_places_in_words(run.model, run.solo.reductions);
  return mpm::core::overlaps_in_words(run.model, run.solo);
}

}  // namespace

TEST_CASE("Overlaps at the start: with their size, place and number of particles") {
  CHECK(words(0.3).empty());
  CHECK(words(0).empty());                             // the faces touch
  CHECK(words(0, 0.25).empty());                       // also with lattices that do not fit
  CHECK(words(-0.2).empty());                          // particles are 0.3 apart
  CHECK(words(-3.75).size() == 1);                     // lattices shifted by half a spacing, on one axis ...
  CHECK(words(-3.75, 0.25).size() == 1);               // ... and on two
  const std::vector<std::string> found = words(-0.3);  // 0.2, in two layers of 64
  REQUIRE(found.size() == 1);
  CHECK(found[0] ==
        "components 'one' and 'two' overlap at the start by 0.3 x 4 x 4, from (6.7, 4.3, 4.2) to (7, 8.3, "
        "8.2): 128 "
        "of their particles are within half a spacing of the other's; contact will push them apart. Move the "
        "bodies, "
        "or give them one component");
  const std::string deep = words(-3.8, 0.1).front();  // several layers: still the whole of what is in common
  CHECK(deep.find("by 3.8 x 3.9 x 4, from (3.2, 4.4, 4.2) to (7, 8.3, 8.2): 1024 of") != std::string::npos);
}

TEST_CASE("Bodies in the same place that contact does not part") {
  CHECK(words(0, 0.25, true, false).empty());
  CHECK(words(-0.3, 0, true, true).empty());  // their components overlap
  const std::vector<std::string> found = words(-3.8, 0.1, true, false);
  REQUIRE(found.size() == 1);
  CHECK(found[0].find("bodies 'a' and 'b' overlap at the start by 3.8 x 3.9 x 4, from (3.2, 4.4, 4.2) to (7, "
                      "8.3, 8.2)") == 0);
  CHECK(found[0].find("masses add up") != std::string::npos);
}
