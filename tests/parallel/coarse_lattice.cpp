#include "parallel/implicit/coarse_lattice.hpp"

#include <array>
#include <set>

#include <catch2/catch.hpp>

#include "tests/parallel/world.hpp"

using namespace mpm::parallel;
using namespace mpm::parallel::test;

namespace {

using Place = std::array<std::int32_t, 4>;  // and the field

/// Nodes of a box with holes, of two fields that meet, each on some rank; some are held.
LatticeNodes nodes_on_ranks() {
  LatticeNodes nodes;
  const auto ranks = static_cast<std::uint64_t>(world().size());
  for (std::int32_t n = -1; n < 19; ++n) {
    // The fields share a layer.
    const std::int32_t field = n < 9 ? 0 : 3, k = field == 0 ? n : n - 10 + 7;
    for (std::int32_t j = 0; j < 7; ++j)
      for (std::int32_t i = -1; i < 12; ++i) {
        const auto at = static_cast<std::uint64_t>(i + 1 + 16 * (j + 16 * (n + 1)));
        // Neighbours are mostly on one rank, as with bricks.
        if (mix(at, 1) % 5 == 0 || mix(at / 4, 2) % ranks != static_cast<std::uint64_t>(world().rank()))
          continue;
        nodes.places.insert(nodes.places.end(), {i, j, k});
        nodes.fields.push_back(field);
        nodes.held.push_back(k < 2 ? 7 : static_cast<std::uint8_t>(mix(at, 3) % 8));
      }
  }
  const auto own = static_cast<std::int64_t>(nodes.own());
  const Gathered<std::int64_t> all = world().all_gather(std::span(&own, 1));
  for (int r = 0; r < world().size(); ++r) {
    if (r < world().rank()) nodes.first += all.items[static_cast<std::size_t>(r)];
    nodes.all += all.items[static_cast<std::size_t>(r)];
  }
  return nodes;
}

}  // namespace

TEST_CASE("Coarser grids interpolate linear fields exactly, whatever ranks own their nodes") {
  LatticeNodes fine = nodes_on_ranks();
  for (int level = 0; level < 3; ++level) {
    Interpolation from;
    const LatticeNodes coarse = coarsen(world().handle(), fine, from);
    // All coarse nodes, in the order of their numbers.
    const auto places = world().all_gather(std::span<const std::int32_t>(coarse.places)).items;
    const auto fields = world().all_gather(std::span<const std::int32_t>(coarse.fields)).items;
    const auto held = world().all_gather(std::span<const std::uint8_t>(coarse.held)).items;
    REQUIRE(static_cast<std::int64_t>(held.size()) == coarse.all);
    std::set<Place> there_are;
    for (std::size_t n = 0; n < held.size(); ++n)
      there_are.insert({places[3 * n], places[3 * n + 1], places[3 * n + 2], fields[n]});
    CHECK(there_are.size() == held.size());
    if (coarse.own() > 0) {
      const auto first = static_cast<std::size_t>(3 * coarse.first);
      CHECK(places[first] == coarse.places[0]);
    }

    std::vector<std::uint8_t> moves(held.size());  // by what interpolates from it here
    for (std::size_t i = 0; i < fine.own(); ++i) {
      for (int a = 0; a < 3; ++a) {
        const bool given = (fine.held[i] >> a & 1) != 0;
        double sum = 0, x[3] = {};
        for (const Interpolation::Source& s : from.of(i)) {
          const auto n = static_cast<std::size_t>(s.number);
          const double weight = s.weight[static_cast<std::size_t>(a)];
          const bool coarse_given = (held[n] >> a & 1) != 0;
          CHECK((weight != 0) == (given == coarse_given));
          CHECK(fields[n] == fine.fields[i]);
          if (!given) moves[n] |= static_cast<std::uint8_t>(1 << a);
          sum += weight;
          for (std::size_t b = 0; b < 3; ++b) x[b] += weight * 2 * places[3 * n + b];
        }
        if (given) continue;
        // Weights are powers of 1/2: exact.
        CHECK(sum == 1);
        for (std::size_t b = 0; b < 3; ++b) CHECK(x[b] == fine.places[3 * i + b]);
      }
    }
    const auto of_ranks = world().all_gather(std::span<const std::uint8_t>(moves)).items;
    for (std::size_t n = 0; n < held.size(); ++n) {
      int any = 0;
      for (std::size_t r = n; r < of_ranks.size(); r += held.size()) any |= of_ranks[r];
      CHECK(any == (7 & ~held[n]));
    }
    fine = coarse;
  }
}
