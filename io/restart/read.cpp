#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/particles/tile_order.hpp"
#include "core/step/migration.hpp"
#include "core/step/scheme_change.hpp"
#include "io/output/file.hpp"
#include "io/restart/contents.hpp"
#include "io/restart/fit.hpp"
#include "io/restart/restart.hpp"
#include "io/restart/rows.hpp"

namespace mpm::io {

namespace {

bool same_grid(const core::GridGeometry& a, const core::GridGeometry& b) {
  return a.origin == b.origin && a.cell == b.cell && a.cells == b.cells && a.site == b.site;
}

/// The records that a rank reads before bricks have owners: about equal numbers of particles per rank.
std::vector<std::size_t> share_of(const RestartContents& contents, const core::Reductions& ranks) {
  std::uint64_t all = 0;
  for (const TileRecord& r : contents.tiles) all += r.particles;
  const auto shares = static_cast<std::uint64_t>(ranks.size());
  std::vector<std::size_t> mine;
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < contents.tiles.size(); ++i) {
    const std::uint64_t rank =
        all == 0 ? 0
                 : static_cast<std::uint64_t>(static_cast<double>(before) / static_cast<double>(all) *
                                              static_cast<double>(shares));
    if (std::min(rank, shares - 1) == static_cast<std::uint64_t>(ranks.rank())) mine.push_back(i);
    before += contents.tiles[i].particles;
  }
  return mine;
}

/// Maps a row of the file to a row of the model's body.
void convert(const double* row, const std::vector<int>& source, std::vector<double>& out) {
  out.resize(source.size());
  for (std::size_t c = 0; c < source.size(); ++c) out[c] = source[c] < 0 ? 0.0 : row[source[c]];
}

/// Records as removed the contents of bodies that no longer take part.
void book_removed(const RestartContents& contents, const Fit& fit, const std::string& path,
                  core::Model& model, core::Reductions& ranks) {
  std::vector<std::size_t> removed;
  for (const std::size_t i : share_of(contents, ranks)) {
    if (fit.of(contents.tiles[i]) == nullptr) removed.push_back(i);
  }
  together(ranks, [&] {
    for_each_record(path, contents, removed, [&](const TileRecord& record, const double* rows) {
      const BodyRecord& body = contents.bodies[static_cast<std::size_t>(record.body)];
      const auto at = [&](core::Column c) {
        return static_cast<std::size_t>(std::find(body.columns.begin(), body.columns.end(), c) -
                                        body.columns.begin());
      };
      const std::size_t m = at(core::Column::mass), e = at(core::Column::internal_energy);
      const std::size_t v = at(core::Column::velocity_x);
      for (std::uint64_t p = 0; p < record.particles; ++p, rows += body.columns.size()) {
        model.ledger.removed_mass.add(rows[m]);
        model.ledger.removed_kinetic.add(
            0.5 * rows[m] * (rows[v] * rows[v] + rows[v + 1] * rows[v + 1] + rows[v + 2] * rows[v + 2]));
        model.ledger.removed_internal.add(rows[e] * rows[m] / body.reference_density);
      }
    });
  });
}

/// Restores the bricks of the file.
void read_bricks(const std::string& path, const RestartContents& contents, const Fit& fit, core::Model& model,
                 core::Communication& communication) {
  core::Reductions& ranks = communication.reductions;
  std::vector<core::BrickCount> counts;
  for (const std::size_t i : share_of(contents, ranks)) {
    const TileRecord& r = contents.tiles[i];
    if (fit.of(r) != nullptr)
      counts.push_back({core::brick_of_key(r.brick), static_cast<std::int64_t>(r.particles)});
  }
  communication.bricks.partition(*model.grid, counts, model.scene->decomposition);

  std::vector<std::size_t> mine;
  for (std::size_t i = 0; i < contents.tiles.size(); ++i) {
    const TileRecord& r = contents.tiles[i];
    const core::Slot s = model.grid->find(core::brick_of_key(r.brick));
    if (fit.of(r) != nullptr && s != core::no_slot && s < model.grid->owned()) mine.push_back(i);
  }
  together(ranks, [&] {
    std::vector<double> row;
    for_each_record(path, contents, mine, [&](const TileRecord& record, const double* rows) {
      const Fit::Body& body = *fit.of(record);
      core::Brick& brick = model.grid->brick(model.grid->find(core::brick_of_key(record.brick)));
      for (std::uint64_t p = 0; p < record.particles; ++p, rows += body.file_columns) {
        convert(rows, body.source, row);
        core::append(model, brick, static_cast<int>(body.number), row.data());
      }
    });
  });
}

void refuse_outside(std::int64_t outside, const std::string& first, const core::Model& model,
                    core::Reductions& ranks) {
  ranks.sum(std::span(&outside, 1));
  if (outside == 0) return;
  std::string example;
  for (const std::string& line : ranks.gather(first)) {
    if (example.empty()) example = line;
  }
  throw core::InputErrors(
      model.scene->grid.source, "Grid",
      fmt::format("{} particles of the restart file are outside this grid; enlarge the grid. The first: {}",
                  outside, example));
}

/// Distributes particles on a new grid; each brick in the order of cells and identities, as in a new run.
void read_particles(const std::string& path, const RestartContents& contents, const Fit& fit,
                    core::Model& model, core::Communication& communication) {
  core::Reductions& ranks = communication.reductions;
  const core::GridGeometry& geometry = model.grid->geometry();
  core::MigrationBuffer moving;
  std::map<core::BrickKey, std::int64_t> particles;
  std::int64_t outside = 0;
  std::string first_outside;
  std::vector<std::size_t> mine = share_of(contents, ranks);
  std::erase_if(mine, [&](std::size_t i) { return fit.of(contents.tiles[i]) == nullptr; });
  together(ranks, [&] {
    std::vector<double> row;
    for_each_record(path, contents, mine, [&](const TileRecord& record, const double* rows) {
      const Fit::Body& body = *fit.of(record);
      for (std::uint64_t p = 0; p < record.particles; ++p, rows += body.file_columns) {
        convert(rows, body.source, row);
        const core::Vec3<double> x{row[0], row[1], row[2]};  // the first columns of every layout
        if (!geometry.contains(x)) {
          if (outside++ == 0) first_outside = core::describe_particle(model.bodies[body.number], row.data());
          continue;
        }
        const core::BrickCoord to = geometry.brick_at(x);
        ++particles[core::key_of(to)];
        moving.add(to, static_cast<int>(body.number), row.data(), static_cast<int>(row.size()));
      }
    });
  });
  refuse_outside(outside, first_outside, model, ranks);

  std::vector<core::BrickCount> counts;
  for (const auto& [key, n] : particles) counts.push_back({core::brick_of_key(key), n});
  communication.bricks.partition(*model.grid, counts, model.scene->decomposition);
  communication.particles.scatter(moving, core::columns_of(model));
  core::insert_particles(model, moving);
  core::sort_tiles(model);
  core::arrange_blocks(model);
}

/// The record of contact with the pairs of this scene, whose components may be others than the file's: found
/// again by name; of pairs that are gone the heat of friction remains.
core::ContactRecord pairs_of_scene(const RestartContents& contents, const core::Scene& scene) {
  const core::ContactRecord& old = contents.ledger.contact;
  const auto new_count = static_cast<std::int32_t>(core::component_count(scene));
  const core::ContactPairs numbers(static_cast<std::size_t>(new_count));
  core::ContactRecord found;
  found.dissipated = old.dissipated;
  found.other_friction_heat = old.other_friction_heat;
  found.pairs.resize(numbers.size());
  std::map<std::int32_t, std::string> names;
  for (const BodyRecord& body : contents.bodies) names[body.component_number] = body.component;
  // Behind the components is that of failed particles.
  const auto number_now = [&](std::int32_t number) -> std::int32_t {
    const auto at = names.find(number);
    if (at == names.end()) return core::has_failed_component(scene) ? core::failed_component(scene) : -1;
    const auto same = [&](const core::ComponentInput& c) { return c.name == at->second; };
    const auto now = std::ranges::find_if(scene.components, same);
    return now == scene.components.end() ? -1 : static_cast<std::int32_t>(now - scene.components.begin());
  };
  std::size_t k = 0;
  for (std::int32_t b = 1; k < old.pairs.size(); ++b) {
    for (std::int32_t a = 0; a < b && k < old.pairs.size(); ++a, ++k) {
      const core::ContactRecord::Pair& pair = old.pairs[k];
      const auto [first, second] = std::pair(number_now(a), number_now(b));
      const int number = first < 0 || second < 0 || first == second
                             ? -1
                             : numbers.number(std::min(first, second), std::max(first, second));
      if (number < 0) {
        found.other_friction_heat += pair.friction_heat;
        continue;
      }
      core::ContactRecord::Pair& to = found.pairs[static_cast<std::size_t>(number)];
      to = pair;
      if (first > second)
        for (core::ExactSum& impulse : to.impulse) impulse.negate();
    }
  }
  return found;
}

/// The ledger of all ranks continues on rank 0.
void restore_ledger(const RestartContents& contents, const Fit& fit, core::Model& model,
                    const core::Reductions& ranks) {
  const bool keeper = ranks.rank() == 0;
  model.ledger = keeper ? contents.ledger : core::Ledger{};
  if (keeper && model.scene->contact.enable && !contents.ledger.contact.empty())
    model.ledger.contact = pairs_of_scene(contents, *model.scene);
  model.ledger.body_eroded.assign(model.bodies.size(), 0);
  model.ledger.body_left.assign(model.bodies.size(), 0);
  for (std::size_t b = 0; b < contents.bodies.size(); ++b)
    if (fit.bodies[b]) {
      core::Body& body = model.bodies[fit.bodies[b]->number];
      body.rigid_state = contents.bodies[b].rigid;
      const auto& implicit = model.scene->solution.implicit;
      if (implicit && implicit->quasistatic()) body.face_forces = contents.bodies[b].face_forces;
    }
  if (!keeper) return;
  for (std::size_t b = 0; b < contents.bodies.size(); ++b) {
    if (!fit.bodies[b]) continue;
    for (core::Reaction& reaction : model.reactions)
      if (static_cast<std::size_t>(reaction.body) == fit.bodies[b]->number && contents.bodies[b].reaction)
        reaction.since_start = *contents.bodies[b].reaction;
    model.ledger.body_eroded[fit.bodies[b]->number] = contents.bodies[b].eroded;
    model.ledger.body_left[fit.bodies[b]->number] = contents.bodies[b].left;
  }
}

}  // namespace

RestartScene read_restart_scene(const std::string& path) {
  check_guard(path);
  const RestartContents contents = read_contents(path);
  return {contents.extra.scene_text, contents.provenance.path, contents.provenance.job_name};
}

RestartResult read_restart(const std::string& path, core::Model& model, core::Communication& communication) {
  core::Reductions& ranks = communication.reductions;
  RestartContents contents;
  together(ranks, [&] {
    if (ranks.rank() == 0) check_guard(path);
  });
  together(ranks, [&] { contents = read_contents(path); });

  RestartResult result;
  const Fit fit = fit_to_model(contents, model, result.notices);
  result.new_bodies = fit.new_bodies;
  model.clock = contents.clock;
  core::continue_scheme(model);
  model.initial_energy = contents.initial_energy;
  model.next_identity = contents.next_identity;
  restore_ledger(contents, fit, model, ranks);
  book_removed(contents, fit, path, model, ranks);
  if (same_grid(contents.grid, model.grid->geometry())) {
    read_bricks(path, contents, fit, model, communication);
  } else {
    result.notices.push_back("the grid differs from that of the restart file: particles are redistributed");
    read_particles(path, contents, fit, model, communication);
  }
  result.extra = std::move(contents.extra);
  result.extra.scene_text.clear();
  return result;
}

void verify_restart(const std::string& path, core::Reductions& ranks) {
  RestartContents contents;
  together(ranks, [&] {
    if (ranks.rank() == 0) check_guard(path);
  });
  together(ranks, [&] {
    contents = read_contents(path);
    for_each_record(path, contents, share_of(contents, ranks), [](const TileRecord&, const double*) {});
  });
}

std::uint64_t restart_state_hash(const std::string& path) {
  check_guard(path);
  const RestartContents contents = read_contents(path);
  std::vector<std::string> bodies;
  for (const BodyRecord& b : contents.bodies) {
    core::ColumnSet set;
    for (const core::Column c : b.columns) set.add(c);
    bodies.push_back(described(b.name, set));
  }
  return state_hash(contents.tiles, bodies);
}

}  // namespace mpm::io
