// What is near a place, against a search of all.
#include "core/implicit/place_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

using namespace mpm::core;

TEST_CASE("Boxes find all that is within their edge of a place, once, and nothing beyond two edges") {
  constexpr double size = 0.7;
  constexpr std::size_t count = 2000;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-4, 4);
  const auto place = [&] { return Vec3<double>{any(random), any(random), any(random)}; };
  std::vector<Vec3<double>> places;
  PlaceBoxes boxes(size);
  for (std::size_t i = 0; i < count; ++i) {
    places.push_back(place());
    boxes.add(places.back(), i);
  }
  std::size_t missed = 0, far = 0, near = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3<double> x = place();
    std::vector<int> times(count, 0);
    boxes.for_each_around(x, [&](std::size_t i) { ++times[i]; });
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3<double> to = places[i] - x;
      const double distance = std::max({std::abs(to.x), std::abs(to.y), std::abs(to.z)});
      near += distance <= size ? 1 : 0;
      missed += distance <= size && times[i] != 1 ? 1 : 0;
      far += distance > 2 * size && times[i] != 0 ? 1 : 0;
    }
  }
  CHECK(near > 100);
  CHECK(missed == 0);
  CHECK(far == 0);
}
