// Particles that change rank keep every bit, and none is lost or doubled.
#include <bit>
#include <cstring>

#include <catch2/catch.hpp>

#include "parallel/communication.hpp"
#include "tests/parallel/world.hpp"

using namespace mpm::parallel;
using namespace mpm::parallel::test;
using mpm::core::BrickCoord;
using mpm::core::BrickCount;
using mpm::core::BrickGrid;
using mpm::core::MigrationBuffer;

namespace {

const std::vector<int> columns_of{18, 25, 21};

/// A particle's columns: where it goes, which body it is of, a number of its own, random bits (among them
/// not-a-numbers), and a hash of all these.
std::vector<double> make_columns(BrickCoord to, int body, std::uint64_t identity) {
  std::vector<double> columns(static_cast<std::size_t>(columns_of[static_cast<std::size_t>(body)]));
  std::uint64_t hash = mix(mpm::core::key_of(to), identity);
  columns[1] = std::bit_cast<double>(identity);
  for (std::size_t c = 2; c < columns.size(); ++c) {
    const std::uint64_t bits = c == 5 ? 0x7ff0000000000001u + identity : mix(hash, c);
    hash = mix(hash, bits);
    columns[c] = std::bit_cast<double>(bits);
  }
  columns[0] = std::bit_cast<double>(mix(hash, static_cast<std::uint64_t>(body)));
  return columns;
}

/// Number of particles, and a sum over all that two different sets will not share.
struct ParticleSums {
  std::int64_t particles = 0, identities = 0;
  bool operator==(const ParticleSums&) const = default;
};

/// Over all ranks; every particle must be as it was made. With `arrived`, every brick must be ours.
ParticleSums sums_over(MpiCommunication& exchange, const MigrationBuffer& particles, bool arrived) {
  std::vector<std::int64_t> sums(3);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto& [to, body, unused] = particles.heads[i];
    const double* columns = particles.columns.data() + particles.offsets[i];
    const auto identity = std::bit_cast<std::uint64_t>(columns[1]);
    const std::vector<double> made = make_columns(to, body, identity);
    if (std::memcmp(made.data(), columns, made.size() * sizeof(double)) != 0) ++sums[2];
    if (arrived && exchange.directory().table().owner(to) != world().rank()) ++sums[2];
    ++sums[0];
    sums[1] += static_cast<std::int64_t>(mix(identity, 5) >> 24);
  }
  exchange.reductions.sum(std::span(sums));
  REQUIRE(sums[2] == 0);
  return {sums[0], sums[1]};
}

std::vector<BrickCount> all_of(const std::vector<BrickCoord>& bricks) {
  std::vector<BrickCount> counts;
  for (const BrickCoord b : bricks) counts.push_back({b, 1});
  return counts;
}

/// `n` particles from our bricks into bricks next to them, or into the same.
MigrationBuffer leave_home(const MpiCommunication& exchange, const BrickGrid& grid, std::size_t n,
                           std::uint64_t round) {
  MigrationBuffer particles;
  if (grid.owned() == 0) return particles;
  std::mt19937_64 random(1000 * round + static_cast<unsigned>(world().rank()));
  while (particles.size() < n) {
    const auto home =
        grid.brick(static_cast<mpm::core::Slot>(random() % static_cast<unsigned>(grid.owned()))).coord;
    const BrickCoord to = home + mpm::core::neighbour_offset(static_cast<int>(random() % 27));
    if (!exchange.directory().table().contains(to)) continue;
    const auto body = static_cast<int>(random() % 3);
    const std::uint64_t identity =
        (round << 40) + (static_cast<std::uint64_t>(world().rank()) << 24) + particles.size();
    const std::vector<double> columns = make_columns(to, body, identity);
    particles.add(to, body, columns.data(), columns_of[static_cast<std::size_t>(body)]);
  }
  return particles;
}

}  // namespace

TEST_CASE("Particles to neighbouring bricks arrive whole, many times") {
  const double share = GENERATE(0.1, 0.5, 1.0);
  std::mt19937_64 random(11);
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  exchange.bricks.partition(grid, all_of(random_bricks(random, {4, 4, 5}, share)), {});
  for (std::uint64_t round = 0; round < 100; ++round) {
    MigrationBuffer particles = leave_home(exchange, grid, round % 7 == 0 ? 0 : 20 * round, round);
    const ParticleSums before = sums_over(exchange, particles, false);
    exchange.particles.migrate(grid, particles, columns_of);
    REQUIRE(sums_over(exchange, particles, true) == before);
  }
}

TEST_CASE("Particles in messages of more than ten megabytes") {
  std::mt19937_64 random(12);
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  // A column of bricks, one or two for each rank: most that leave go to another rank.
  std::vector<BrickCoord> bricks;
  for (std::int32_t z = 0; z < world().size(); ++z) bricks.push_back({0, 0, z});
  exchange.bricks.partition(grid, all_of(bricks), {});
  for (std::uint64_t round = 0; round < 3; ++round) {
    MigrationBuffer particles;
    // Of 8 bytes x 23 doubles, 60000 make 11 MB; all bricks send to the one above.
    for (const auto& b : grid.bricks()) {
      const BrickCoord up = b.coord + BrickCoord{0, 0, 1};
      const BrickCoord to = exchange.directory().table().contains(up) ? up : b.coord;
      for (std::uint64_t i = 0; i < 60000; ++i) {
        const int body = static_cast<int>(i % 3);
        const auto columns =
            make_columns(to, body, (round << 40) + (mpm::core::key_of(b.coord) >> 42 << 24) + i);
        particles.add(to, body, columns.data(), columns_of[static_cast<std::size_t>(body)]);
      }
    }
    const ParticleSums before = sums_over(exchange, particles, false);
    CHECK(before.particles == 60000 * world().size());
    exchange.particles.migrate(grid, particles, columns_of);
    CHECK(sums_over(exchange, particles, true) == before);
  }
}

TEST_CASE("Particles from any rank to any other") {
  std::mt19937_64 random(13);
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  const std::vector<BrickCoord> bricks = random_bricks(random, {5, 5, 5}, 0.3);
  exchange.bricks.partition(grid, all_of(bricks), {});
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{30000}}) {
    MigrationBuffer particles;
    std::mt19937_64 mine(n + static_cast<unsigned>(world().rank()));
    const std::size_t here = n * static_cast<std::size_t>(world().rank() % 3);  // some ranks have none
    for (std::size_t i = 0; i < here; ++i) {
      const BrickCoord to = bricks[mine() % bricks.size()];
      const int body = static_cast<int>(mine() % 3);
      const auto columns = make_columns(to, body, (static_cast<std::uint64_t>(world().rank()) << 24) + i);
      particles.add(to, body, columns.data(), columns_of[static_cast<std::size_t>(body)]);
    }
    const ParticleSums before = sums_over(exchange, particles, false);
    exchange.particles.scatter(particles, columns_of);
    CHECK(sums_over(exchange, particles, true) == before);
  }
}

TEST_CASE("MigrationBuffer pass through bricks claimed a moment ago") {
  const auto method = GENERATE(mpm::core::PartitionMethod::metis, mpm::core::PartitionMethod::uniform);
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  mpm::core::DecompositionInput how;
  how.method = method;
  if (method == mpm::core::PartitionMethod::uniform) how.dimensions = {1, 1, world().size()};
  exchange.bricks.partition(grid, all_of({{50, 50, 0}}), how);
  MigrationBuffer particles;
  if (grid.owned() == 1) {
    for (std::uint64_t i = 0; i < 100; ++i) {
      const auto columns = make_columns({50, 50, 0}, 0, i);
      particles.add({50, 50, 0}, 0, columns.data(), 18);
    }
  }
  // Upwards through the whole grid, one brick a round: claim the next, go there, retire the last.
  for (std::int32_t z = 1; z < 100; ++z) {
    const BrickCoord next{50, 50, z}, last{50, 50, z - 1};
    std::vector<BrickCoord> wanted, empty;
    if (particles.size() > 0) wanted = {next};
    exchange.bricks.activate(grid, wanted);
    MigrationBuffer leaving;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const auto identity = std::bit_cast<std::uint64_t>(particles.columns[particles.offsets[i] + 1]);
      const auto columns = make_columns(next, 0, identity);
      leaving.add(next, 0, columns.data(), 18);
    }
    if (leaving.size() > 0) empty = {last};
    exchange.particles.migrate(grid, leaving, columns_of);
    exchange.bricks.deactivate(grid, empty);
    particles = std::move(leaving);
    REQUIRE(sums_over(exchange, particles, true).particles == 100);
    REQUIRE(exchange.directory().table().size() == 1);
  }
}

TEST_CASE("A traveller to nowhere is a bug that says where") {
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  std::vector<BrickCoord> bricks;
  for (std::int32_t r = 0; r < world().size(); ++r) bricks.push_back({3 * r, 0, 0});
  exchange.bricks.partition(grid, all_of(bricks), {});
  const std::vector<double> columns(18);
  MigrationBuffer particles;
  particles.add({5, 6, 7}, 2, columns.data(), 18);
  CHECK_THROWS_WITH(exchange.particles.migrate(grid, particles, columns_of),
                    "a particle of body 2 migrates to brick (5, 6, 7), which does not exist");
  CHECK_THROWS_AS(exchange.particles.scatter(particles, columns_of), std::logic_error);

  const int other = (world().rank() + 1) % world().size();
  for (const BrickCoord b : bricks) {
    if (exchange.directory().table().owner(b) != other || world().size() == 1) continue;
    particles.clear();
    particles.add(b, 1, columns.data(), 18);
    CHECK_THROWS_WITH(exchange.particles.migrate(grid, particles, columns_of),
                      Catch::Contains("belongs to rank " + std::to_string(other)));
  }
}
