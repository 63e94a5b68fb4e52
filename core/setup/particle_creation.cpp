#include "core/setup/particle_creation.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/discretise/shape_check.hpp"
#include "core/particles/tile_order.hpp"
#include "core/step/offending_particle.hpp"

namespace mpm::core {

namespace {

constexpr std::uint64_t units_in_run = 16;       // adjacent units of a body that one rank creates
constexpr std::size_t seeds_in_piece = 1 << 14;  // seeds that a rank creates between two sends

/// This rank's share of a body's units, in pieces: f(seeds). Runs of units are distributed cyclically.
template <class F>
void for_each_piece(const SeedSource& source, int rank, int ranks, F f) {
  const std::uint64_t units = source.units();
  const auto stride = units_in_run * static_cast<std::uint64_t>(ranks);
  std::vector<Seed> seeds;
  for (std::uint64_t first = units_in_run * static_cast<std::uint64_t>(rank); first < units;
       first += stride) {
    for (std::uint64_t u = first; u < std::min(first + units_in_run, units); ++u) {
      source.generate(u, u + 1, seeds);
      if (seeds.size() < seeds_in_piece) continue;
      f(seeds);
      seeds.clear();
    }
  }
  if (!seeds.empty()) f(seeds);
}

/// A cube along the axes, as shape functions with domains of the particles store it.
void set_first_domain(const ColumnLayout& layout, double half_edge, std::vector<double>& columns) {
  const auto set = [&](Column c, double v) {
    if (layout.has(c)) columns[layout.index(c)] = v;
  };
  for (int a = 0; a < 3; ++a) {
    set(next(Column::half_size_x, a), half_edge);
    set(next(Column::edge_1x, 4 * a), half_edge);
    for (int c = 0; c < 8; ++c)
      set(next(Column::corner_0x, 3 * c + a), (c >> a & 1) != 0 ? half_edge : -half_edge);
  }
}

}  // namespace

std::vector<BodySeeds> seeds_of(const Model& model, std::span<const std::size_t> bodies) {
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  std::vector<BodySeeds> seeds;
  ErrorList wrong;
  for (const std::size_t b : bodies) {
    const auto block =
        static_cast<std::int64_t>(sizeof(double)) * model.bodies[b].pool->layout().block_doubles();
    wrong.collect([&] {
      seeds.push_back({b, inputs[b], make_seed_source(*model.scene, *inputs[b]), block});
    });
  }
  wrong.raise_if_any();
  return seeds;
}

void refuse_uncounted(std::span<const BodySeeds> bodies, std::uint64_t first_identity) {
  double identities = static_cast<double>(first_identity), particles = 0;
  const BodySeeds* largest = nullptr;
  for (const BodySeeds& b : bodies) {
    identities += static_cast<double>(b.source->identities());
    particles += b.source->expected_particles();
    if (largest == nullptr || b.source->identities() > largest->source->identities()) largest = &b;
  }
  if (identities < static_cast<double>(identity_limit)) return;
  throw InputErrors(
      largest->input->source, "Body",
      fmt::format("the lattices of the bodies, of which that of body `{}` is the largest, have {} sites, "
                  "more than the largest identity (2^53), for about {:.3g} particles; use a larger dp",
                  largest->input->name,
                  largest->source->identities() >= identity_limit ? "at least 9.01e+15"
                                                                  : fmt::format("{:.3g}", identities),
                  particles));
}

std::vector<BrickCount> SeedCount::in_bricks() const {
  std::vector<BrickCount> counts;
  for (const auto& [key, n] : bricks) counts.push_back({brick_of_key(key), n});
  return counts;
}

SeedCount count_seeds(const GridGeometry& geometry, std::span<const BodySeeds> bodies,
                      const Reductions& ranks) {
  SeedCount count;
  std::map<BrickKey, std::int64_t> bricks;  // of one body
  for (const BodySeeds& body : bodies) {
    bricks.clear();
    std::int64_t& particles = count.bodies.emplace_back();
    for_each_piece(*body.source, ranks.rank(), ranks.size(), [&](const std::vector<Seed>& seeds) {
      particles += static_cast<std::int64_t>(seeds.size());
      for (const Seed& s : seeds) {
        const Vec3<double>& x = s.position;
        if (geometry.contains(x)) {
          if (body.block_bytes > 0) ++bricks[key_of(geometry.brick_at(x))];
          continue;
        }
        ++count.outside;
        if (count.first_outside.empty()) {
          count.first_outside =
              fmt::format("{}:{}: <Body name=\"{}\">: a particle at ({:.6g}, {:.6g}, {:.6g})",
                          body.input->source.file, body.input->source.line, body.input->name, x.x, x.y, x.z);
        }
      }
    });
    for (const auto& [key, n] : bricks) {
      count.bricks[key] += n;
      count.block_bytes += (n + block_lanes - 1) / block_lanes * body.block_bytes;
    }
  }
  return count;
}

void refuse_outside(const Scene& scene, const GridGeometry& g, const SeedCount& count, Reductions& ranks) {
  std::int64_t outside[1] = {count.outside};
  ranks.sum(std::span<std::int64_t>(outside));
  if (outside[0] == 0) return;
  std::string first;
  for (const std::string& line : ranks.gather(count.first_outside)) {
    if (first.empty()) first = line;
  }
  throw InputErrors(
      scene.grid.source, "Grid",
      fmt::format("{} particles are outside the grid [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}]; "
                  "enlarge the grid or move the body. The first: {}",
                  outside[0], g.origin.x, g.origin.x + double(g.cells[0]) * g.cell.x, g.origin.y,
                  g.origin.y + double(g.cells[1]) * g.cell.y, g.origin.z,
                  g.origin.z + double(g.cells[2]) * g.cell.z, first));
}

void refuse_empty(const Scene& scene, std::span<const BodySeeds> bodies, const SeedCount& count,
                  Reductions& ranks) {
  std::vector<std::int64_t> particles = count.bodies;
  ranks.sum(std::span<std::int64_t>(particles));
  ErrorList wrong;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (particles[b] == 0) wrong.add(no_particles(scene, *bodies[b].input));
  wrong.raise_if_any();
}

void fill_columns(const ColumnLayout& layout, const BodyInput& input, StartVelocity& velocity,
                  const Seed& seed, double identity, std::vector<double>& columns) {
  columns.assign(static_cast<std::size_t>(layout.columns()), 0.0);
  const auto set = [&](Column c, double v) { columns[layout.index(c)] = v; };
  const Vec3<double> v = velocity.at(seed.position);
  for (int a = 0; a < 3; ++a) {
    set(next(Column::position_x, a), seed.position[a]);
    set(next(Column::velocity_x, a), v[a]);
    if (layout.has(next(Column::first_x, a))) set(next(Column::first_x, a), seed.position[a]);
  }
  set(Column::mass, seed.mass);
  set(Column::volume, seed.volume);
  set(Column::identity, identity);
  set_first_domain(layout, 0.5 * std::cbrt(seed.volume), columns);
  if (input.initial_temperature && layout.has(Column::temperature))
    set(Column::temperature, *input.initial_temperature);
}

void refuse_undefined_velocities(std::span<const BodySeeds> bodies, std::uint64_t first_identity, double time,
                                 Reductions& ranks) {
  OffendingParticle mine;  // its words begin with the numbers of the body and of the expression
  bool varies = false;
  auto base = static_cast<double>(first_identity);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const BodyInput& input = *bodies[b].input;
    StartVelocity velocity(input, time);
    varies = varies || velocity.varies();
    if (velocity.varies()) {
      for_each_piece(*bodies[b].source, ranks.rank(), ranks.size(), [&](const std::vector<Seed>& seeds) {
        for (const Seed& s : seeds) {
          const std::optional<StartVelocity::Fault> fault = velocity.first_not_finite(s.position);
          if (!fault) continue;
          const double identity = base + static_cast<double>(s.identity);
          const Vec3<double>& x = s.position;
          mine.offer(identity, [&] {
            return fmt::format(
                "{} {} {} for particle {:.0f} of body \"{}\" at ({:.6g}, {:.6g}, {:.6g}), t = "
                "{:.9g}: give an expression that is finite there",
                b, fault->expression, not_finite_in_words(fault->value), identity, input.name, x.x, x.y, x.z,
                time);
          });
        }
      });
    }
    base += static_cast<double>(bodies[b].source->identities());
  }
  if (!varies) return;
  const std::string first = first_of_all(ranks, mine).words;
  if (first.empty()) return;
  std::size_t body_end = 0, end = 0;
  const BodyInput& input = *bodies[std::stoul(first, &body_end)].input;
  const Expression& e = StartVelocity::expressions_of(input)[std::stoul(first.substr(body_end), &end)];
  throw InputErrors({Diagnostic{e.source.file, e.source.line, e.element, e.attribute, e.text,
                                first.substr(body_end + end + 1)}});
}

void create_particles(Model& model, std::span<const BodySeeds> bodies, Communication& communication) {
  Reductions& ranks = communication.reductions;
  const std::vector<int> columns = columns_of(model);
  std::vector<bool> created(model.bodies.size());
  for (const BodySeeds& of : bodies) {
    const Body& body = model.bodies[of.body];
    const ColumnLayout& layout = body.pool->layout();
    MigrationBuffer particles;
    std::vector<double> values;
    const auto send = [&] {
      communication.particles.scatter(particles, columns);
      insert_particles(model, particles);
      particles.clear();
    };
    const auto base = static_cast<double>(model.next_identity);
    StartVelocity velocity(*of.input, model.clock.time);
    const bool at_rest = StartVelocity::is_at_rest(model.scene->solution, *of.input);
    for_each_piece(*of.source, ranks.rank(), ranks.size(), [&](const std::vector<Seed>& seeds) {
      for (const Seed& s : seeds) {
        fill_columns(layout, *of.input, velocity, s, base + static_cast<double>(s.identity), values);
        if (at_rest) std::fill_n(values.begin() + layout.index(Column::velocity_x), 3, 0.0);
        const BrickCoord to = model.grid->geometry().brick_at(s.position);
        particles.add(to, static_cast<int>(of.body), values.data(), layout.columns());
      }
      ranks.any(true);
      send();
    });
    // Other ranks may have more pieces: keep receiving until all have finished.
    while (ranks.any(false)) send();
    model.next_identity += of.source->identities();
    created[of.body] = true;
  }
  sort_tiles(model, created);
  arrange_blocks(model);
}

}  // namespace mpm::core
