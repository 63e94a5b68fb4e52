#include "core/step/migration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <omp.h>

#include "core/contact/failed_component.hpp"
#include "core/particles/tile_order.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

Vec3<double> position_of(const ColumnLayout& layout, const double* columns) {
  const double* x = columns + layout.index(Column::position_x);
  return {x[0], x[1], x[2]};
}

bool adjacent(BrickCoord a, BrickCoord b) {
  return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1 && std::abs(a.z - b.z) <= 1;
}

}  // namespace

std::string describe_particle(const Body& body, const double* columns) {
  const ColumnLayout& layout = body.pool->layout();
  const Vec3<double> x = position_of(layout, columns);
  return fmt::format("particle {:.0f} of body \"{}\" at ({:.6g}, {:.6g}, {:.6g})",
                     columns[layout.index(Column::identity)], body.name, x.x, x.y, x.z);
}

Migration::Migration(Model& model, Communication& communication)
    : model_(model),
      communication_(communication),
      far_(model.scene->solution.integration == Integration::implicit),
      columns_of_(columns_of(model)),
      by_thread_(static_cast<std::size_t>(omp_get_max_threads())) {
  for (ThreadMigration& h : by_thread_) {
    h.ledger.body_eroded.resize(model.bodies.size());
    h.ledger.body_left.resize(model.bodies.size());
  }
}

void Migration::dispose(std::size_t body_index, const double* columns, bool eroded,
                        ThreadMigration& mine) const {
  const Body& body = model_.bodies[body_index];
  const ColumnLayout& layout = body.pool->layout();
  Ledger& ledger = mine.ledger;
  const double m = columns[layout.index(Column::mass)];
  const double* v = columns + layout.index(Column::velocity_x);
  ledger.removed_mass.add(m);
  ledger.removed_kinetic.add(0.5 * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  ledger.removed_internal.add(columns[layout.index(Column::internal_energy)] * m /
                              body.model->reference_density());
  ++(eroded ? ledger.eroded : ledger.left_grid);
  ++(eroded ? ledger.body_eroded : ledger.body_left)[body_index];
  if (eroded) return;
  ++mine.left;
  mine.first_left.offer(columns[layout.index(Column::identity)],
                        [&] { return describe_particle(body, columns); });
}

void Migration::collect_from(Slot slot, std::vector<DepartingParticle>& departing, ThreadMigration& mine) {
  const BrickGrid& grid = *model_.grid;
  Brick& brick = model_.grid->brick(slot);
  double columns[column_count];
  const auto report = [&](const Body& body, const char* what) {
    mine.fault.offer(columns[body.pool->layout().index(Column::identity)],
                     [&] { return describe_particle(body, columns) + what; });
  };
  // In descending order: the particle moved into a gap is then never one that is still to leave.
  std::sort(departing.begin(), departing.end(), [](const DepartingParticle& a, const DepartingParticle& b) {
    return a.tile != b.tile ? a.tile > b.tile : a.index > b.index;
  });
  for (const DepartingParticle& l : departing) {
    ParticleTile& tile = brick.tiles[static_cast<std::size_t>(l.tile)];
    const Body& body = model_.bodies[static_cast<std::size_t>(tile.body)];
    extract(*body.pool, tile, l.index, columns);
    const Vec3<double> x = position_of(body.pool->layout(), columns);
    if (l.eroded || !grid.geometry().contains(x)) {
      if (!l.eroded && !(std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z))) {
        report(body, " has a position that is not finite");
        continue;
      }
      dispose(static_cast<std::size_t>(tile.body), columns, l.eroded, mine);
    } else {
      const BrickCoord to = grid.geometry().brick_at(x);
      // On the grid's upper face, or within round-off of its own brick.
      if (to == brick.coord && component_of(model_, tile.body, columns) == tile.component) {
        model_.grid->own_cells(slot).reset();  // the pass that moved it has left it out
        continue;
      }
      if (!far_ && !adjacent(to, brick.coord)) {
        report(body, " moved by more than one brick in one step");
        continue;
      }
      if (grid.find(to) == no_slot) mine.wanted.push_back(to);
      mine.particles.add(to, tile.body, columns, body.pool->layout().columns());
    }
    remove_swapping(*body.pool, tile, l.index);
  }
  std::erase_if(brick.tiles, [](const ParticleTile& c) { return c.count == 0; });
  departing.clear();
}

void Migration::merge(ThreadMigration& h) {
  Ledger& ledger = model_.ledger;
  if (particles_.size() == 0) std::swap(particles_, h.particles);  // usually nearly all of them
  for (std::size_t i = 0; i < h.particles.size(); ++i) {
    const MigrationBuffer::Head& head = h.particles.heads[i];
    particles_.add(head.to, head.body, &h.particles.columns[h.particles.offsets[i]],
                   columns_of_[static_cast<std::size_t>(head.body)]);
  }
  wanted_.insert(wanted_.end(), h.wanted.begin(), h.wanted.end());
  left_now_ += h.left;
  first_left_.merge(h.first_left);
  if (!h.fault.empty()) fault_.offer(h.fault.identity, [&] { return h.fault.words; });
  h.first_left = {};
  h.fault = {};
  if (h.ledger.eroded + h.ledger.left_grid > 0) {
    ledger.removed_mass += h.ledger.removed_mass;
    ledger.removed_kinetic += h.ledger.removed_kinetic;
    ledger.removed_internal += h.ledger.removed_internal;
    ledger.eroded += h.ledger.eroded;
    ledger.left_grid += h.ledger.left_grid;
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      ledger.body_eroded[b] += h.ledger.body_eroded[b];
      ledger.body_left[b] += h.ledger.body_left[b];
    }
    h.ledger = Ledger{};
    h.ledger.body_eroded.resize(model_.bodies.size());
    h.ledger.body_left.resize(model_.bodies.size());
  }
  h.particles.clear();
  h.wanted.clear();
  h.left = 0;
}

void Migration::collect(std::vector<std::vector<DepartingParticle>>& departing) {
  wanted_.clear();
  left_now_ = 0;
  first_left_ = {};
  fault_ = {};
  for_each_by_threads(
      std::size_t{0}, departing.size(), 16,
      [&](std::size_t s) {
        if (departing[s].empty()) return;
        collect_from(static_cast<Slot>(s), departing[s],
                     by_thread_[static_cast<std::size_t>(omp_get_thread_num())]);
      },
      static_cast<int>(by_thread_.size()));
  for (ThreadMigration& h : by_thread_) merge(h);
}

void Migration::deliver(bool claim) {
  if (claim) {
    std::sort(wanted_.begin(), wanted_.end());
    wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
    communication_.bricks.activate(*model_.grid, wanted_);
  }
  // Bricks that this rank does not know may belong to any rank.
  if (claim && far_)
    communication_.particles.scatter(particles_, columns_of_);
  else
    communication_.particles.migrate(*model_.grid, particles_, columns_of_);
  insert_particles(model_, particles_);
  particles_.clear();
}

void Migration::sort_and_prune() {
  BrickGrid& grid = *model_.grid;
  for_each_by_threads(0, grid.owned(), 4, [&](int s) {
    Brick& brick = grid.brick(static_cast<Slot>(s));
    for (ParticleTile& tile : brick.tiles) {
      sort_by_site(grid, brick.coord, *model_.bodies[static_cast<std::size_t>(tile.body)].pool, tile);
    }
  });
  std::vector<BrickCoord> empty;
  for (const Brick& b : grid.bricks()) {
    if (b.tiles.empty()) empty.push_back(b.coord);
  }
  if (communication_.reductions.any(!empty.empty())) communication_.bricks.deactivate(grid, empty);
}

}  // namespace mpm::core
