// What a step may do to particles: strain, walls, and bodies that meet.
#include "core/implicit/step_motion.hpp"

#include <catch2/catch.hpp>

#include "core/communication/solo.hpp"

using namespace mpm::core;

namespace {

const std::vector<std::string> names{"ball", "target"};

/// Two cubes of a cell's edge, the first `gap` cells below the second along z, and their displacements.
StepMotion two_cubes(double gap, const Vec3<double>& first, const Vec3<double>& second) {
  StepMotion motion(2);
  for (const double corner : {0.0, 1.0}) {
    motion.add_particle(0, {corner, corner, corner}, first);
    motion.add_particle(1, {corner, corner, corner + 1 + gap}, second);
  }
  SoloReductions ranks;
  motion.combine(ranks);
  return motion;
}

}  // namespace

TEST_CASE("A step is refused for its strain and for a particle beyond a wall") {
  StepMotion motion(2);
  motion.add_strain(0.9 * StepMotion::largest_strain);
  motion.add_beyond_wall(-3);
  CHECK(motion.objection(names).empty());
  StepMotion of_thread = motion;
  of_thread.add_strain(1.1 * StepMotion::largest_strain);
  motion.merge(of_thread);
  CHECK(motion.objection(names).find("strained") != std::string::npos);
  StepMotion passing(2);
  passing.add_beyond_wall(0.1);
  CHECK(passing.objection(names).find("passes a wall by 0.1 cells") != std::string::npos);
}

TEST_CASE("Bodies that meet within a step may move by a cell against each other") {
  const auto meet = [](double gap, double first, double second) {
    const std::string why = two_cubes(gap, {0, 0, first}, {0, 0, second}).objection(names);
    if (!why.empty()) CHECK(why.find("bodies \"ball\" and \"target\" meet") != std::string::npos);
    return !why.empty();
  };
  CHECK(meet(4, 3.5, 0));      // half a cell is left
  CHECK(meet(4, 1.6, -1.6));   // both move
  CHECK(meet(4, 30, 0));       // through the other
  CHECK_FALSE(meet(4, 2, 0));  // two cells are left
  CHECK_FALSE(meet(1.5, 0.9, 0));
  CHECK_FALSE(meet(0.5, 8, 4));                                           // in contact before
  CHECK_FALSE(meet(4, 20, 20));                                           // together
  CHECK_FALSE(meet(4, -20, 20));                                          // apart
  CHECK(two_cubes(4, {12, 0, 8}, {}).objection(names).empty() == false);  // boxes know nothing of the path
  CHECK(two_cubes(4, {12, 0, 0}, {}).objection(names).empty());
}
