#include "core/step/migration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>
#include <omp.h>

#include "core/shape/linear.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

/// Index of a column among a particle's columns laid out one after the other.
std::size_t place(const ColumnLayout& layout, Column c) {
  return static_cast<std::size_t>(layout.offset(c) / block_lanes);
}

Vec3<double> position_of(const ColumnLayout& layout, const double* columns) {
  const double* x = columns + place(layout, Column::position_x);
  return {x[0], x[1], x[2]};
}

bool adjacent(BrickCoord a, BrickCoord b) {
  return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1 && std::abs(a.z - b.z) <= 1;
}

Cohort& cohort_of(Brick& brick, int body) {
  const auto at = std::lower_bound(brick.cohorts.begin(), brick.cohorts.end(), body,
                                   [](const Cohort& c, int b) { return c.body < b; });
  if (at != brick.cohorts.end() && at->body == body) return *at;
  return *brick.cohorts.insert(at, Cohort{body, 0, {}});
}

/// Particle order[p] becomes particle p.
void reorder(BlockPool& pool, Cohort& cohort, const std::vector<std::uint32_t>& order) {
  thread_local std::vector<double> sorted;
  const ColumnLayout& layout = pool.layout();
  const auto block_doubles = static_cast<std::size_t>(layout.block_doubles());
  sorted.resize(cohort.blocks.size() * block_doubles);
  for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
    const double* from[block_lanes];  // lanes out of use hold what the first lane holds
    const int used = cohort.used_lanes(b);
    for (int l = 0; l < block_lanes; ++l) {
      const std::uint32_t p = order[block_lanes * b + static_cast<std::size_t>(l < used ? l : 0)];
      from[l] = pool.block(cohort.blocks[p / block_lanes]) + p % block_lanes;
    }
    double* to = sorted.data() + b * block_doubles;
    for (int c = 0; c < layout.columns(); ++c) {
      for (int l = 0; l < block_lanes; ++l) to[block_lanes * c + l] = from[l][block_lanes * c];
    }
  }
  std::sort(cohort.blocks.begin(), cohort.blocks.end());  // what is read next lies next in memory
  for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
    std::copy_n(sorted.data() + b * block_doubles, block_doubles, pool.block(cohort.blocks[b]));
  }
}

}  // namespace

std::string describe_particle(const Body& body, const double* columns) {
  const ColumnLayout& layout = body.pool->layout();
  const Vec3<double> x = position_of(layout, columns);
  return fmt::format("particle {:.0f} of body \"{}\" at ({:.6g}, {:.6g}, {:.6g})",
                     columns[place(layout, Column::identity)], body.name, x.x, x.y, x.z);
}

Migration::Migration(Model& model, Exchange& exchange)
    : model_(model), exchange_(exchange), harvests_(static_cast<std::size_t>(omp_get_max_threads())) {
  for (const Body& b : model.bodies) columns_of_.push_back(b.pool->layout().columns());
  for (Harvest& h : harvests_) {
    h.books.body_eroded.resize(model.bodies.size());
    h.books.body_left.resize(model.bodies.size());
  }
}

void Migration::dispose(std::size_t body_index, const double* columns, bool eroded, Harvest& harvest) const {
  const Body& body = model_.bodies[body_index];
  const ColumnLayout& layout = body.pool->layout();
  Books& books = harvest.books;
  const double m = columns[place(layout, Column::mass)];
  const double* v = columns + place(layout, Column::velocity_x);
  books.removed_mass.add(m);
  books.removed_kinetic.add(0.5 * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  books.removed_internal.add(columns[place(layout, Column::internal_energy)] * m /
                             body.model->reference_density());
  ++(eroded ? books.eroded : books.left_grid);
  ++(eroded ? books.body_eroded : books.body_left)[body_index];
  if (eroded) return;
  ++harvest.left;
  harvest.first_left.offer(columns[place(layout, Column::identity)],
                           [&] { return describe_particle(body, columns); });
}

void Migration::collect_from(Slot slot, std::vector<DepartingParticle>& departing, Harvest& harvest) {
  const BrickGrid& grid = *model_.grid;
  Brick& brick = model_.grid->brick(slot);
  double columns[column_count];
  const auto complain = [&](const Body& body, const char* what) {
    harvest.complaint.offer(columns[place(body.pool->layout(), Column::identity)],
                            [&] { return describe_particle(body, columns) + what; });
  };
  // From the last to the first: the particle that fills a gap is then never one that has yet to leave.
  std::sort(departing.begin(), departing.end(), [](const DepartingParticle& a, const DepartingParticle& b) {
    return a.cohort != b.cohort ? a.cohort > b.cohort : a.index > b.index;
  });
  for (const DepartingParticle& l : departing) {
    Cohort& cohort = brick.cohorts[static_cast<std::size_t>(l.cohort)];
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    extract(*body.pool, cohort, l.index, columns);
    const Vec3<double> x = position_of(body.pool->layout(), columns);
    if (l.eroded || !grid.geometry().contains(x)) {
      if (!l.eroded && !(std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z))) {
        complain(body, " is nowhere (not a number)");
        continue;
      }
      dispose(static_cast<std::size_t>(cohort.body), columns, l.eroded, harvest);
    } else {
      const BrickCoord to = grid.geometry().brick_at(x);
      if (to == brick.coord) continue;  // on the grid's upper face, or within round-off of the brick's own
      if (!adjacent(to, brick.coord)) {
        complain(body, " moved over more than a brick in one step");
        continue;
      }
      if (grid.find(to) == no_slot) harvest.wanted.push_back(to);
      harvest.travellers.add(to, cohort.body, columns, body.pool->layout().columns());
    }
    remove_swapping(*body.pool, cohort, l.index);
  }
  std::erase_if(brick.cohorts, [](const Cohort& c) { return c.count == 0; });
  departing.clear();
}

void Migration::merge(Harvest& h) {
  Books& books = model_.books;
  if (travellers_.size() == 0) std::swap(travellers_, h.travellers);  // mostly all there are
  for (std::size_t i = 0; i < h.travellers.size(); ++i) {
    const Travellers::Head& head = h.travellers.heads[i];
    travellers_.add(head.to, head.body, &h.travellers.columns[h.travellers.offsets[i]],
                    columns_of_[static_cast<std::size_t>(head.body)]);
  }
  wanted_.insert(wanted_.end(), h.wanted.begin(), h.wanted.end());
  left_now_ += h.left;
  first_left_.merge(h.first_left);
  if (!h.complaint.empty()) complaint_.offer(h.complaint.identity, [&] { return h.complaint.words; });
  h.first_left = {};
  h.complaint = {};
  if (h.books.eroded + h.books.left_grid > 0) {
    books.removed_mass += h.books.removed_mass;
    books.removed_kinetic += h.books.removed_kinetic;
    books.removed_internal += h.books.removed_internal;
    books.eroded += h.books.eroded;
    books.left_grid += h.books.left_grid;
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      books.body_eroded[b] += h.books.body_eroded[b];
      books.body_left[b] += h.books.body_left[b];
    }
    h.books = Books{};
    h.books.body_eroded.resize(model_.bodies.size());
    h.books.body_left.resize(model_.bodies.size());
  }
  h.travellers.clear();
  h.wanted.clear();
  h.left = 0;
}

void Migration::collect(std::vector<std::vector<DepartingParticle>>& departing) {
  wanted_.clear();
  left_now_ = 0;
  first_left_ = {};
  complaint_ = {};
  for_each_by_threads(
      std::size_t{0}, departing.size(), 16,
      [&](std::size_t s) {
        if (departing[s].empty()) return;
        collect_from(static_cast<Slot>(s), departing[s],
                     harvests_[static_cast<std::size_t>(omp_get_thread_num())]);
      },
      static_cast<int>(harvests_.size()));
  for (Harvest& h : harvests_) merge(h);
}

void Migration::deliver(bool claim) {
  if (claim) {
    std::sort(wanted_.begin(), wanted_.end());
    wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
    exchange_.claim(*model_.grid, wanted_);
  }
  exchange_.migrate(*model_.grid, travellers_, columns_of_);
  insert_travellers(model_, travellers_);
  travellers_.clear();
}

void insert_travellers(Model& model, const Travellers& travellers) {
  struct Arrival {
    Slot slot;
    std::int32_t body;
    double identity;
    std::size_t index;
  };
  std::vector<Arrival> arrivals(travellers.size());
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const Travellers::Head& head = travellers.heads[i];
    const ColumnLayout& layout = model.bodies[static_cast<std::size_t>(head.body)].pool->layout();
    arrivals[i] = {model.grid->find(head.to), head.body,
                   travellers.columns[travellers.offsets[i] + place(layout, Column::identity)], i};
  }
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    if (a.slot != b.slot) return a.slot < b.slot;
    return a.body != b.body ? a.body < b.body : a.identity < b.identity;
  });
  // Each brick's arrivals are one thread's work.
  std::vector<std::size_t> groups;
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (i == 0 || arrivals[i].slot != arrivals[i - 1].slot) groups.push_back(i);
  }
  groups.push_back(arrivals.size());
  for_each_by_threads(std::size_t{0}, groups.size() - 1, 16, [&](std::size_t g) {
    for (std::size_t i = groups[g]; i < groups[g + 1]; ++i) {
      const Arrival& a = arrivals[i];
      append(*model.bodies[static_cast<std::size_t>(a.body)].pool,
             cohort_of(model.grid->brick(a.slot), a.body), &travellers.columns[travellers.offsets[a.index]]);
    }
  });
}

void arrange_blocks(Model& model) {
  const std::vector<BlockPool*> pools = pools_of(model);
  std::vector<std::size_t> pool_of;  // of each body
  for (const Body& b : model.bodies)
    pool_of.push_back(static_cast<std::size_t>(std::ranges::find(pools, b.pool.get()) - pools.begin()));
  std::vector<std::vector<BlockIndex>> in_use(pools.size());
  for (Brick& brick : model.grid->bricks()) {
    for (Cohort& cohort : brick.cohorts) {
      std::vector<BlockIndex>& blocks = in_use[pool_of[static_cast<std::size_t>(cohort.body)]];
      for (BlockIndex& b : cohort.blocks) {
        blocks.push_back(b);
        b = static_cast<BlockIndex>(blocks.size() - 1);
      }
    }
  }
  for (std::size_t p = 0; p < pools.size(); ++p) pools[p]->arrange(in_use[p]);
}

void sort_by_cell(const BrickGrid& grid, BrickCoord brick, BlockPool& pool, Cohort& cohort) {
  constexpr NodeBlockShape shape{};  // of the least halo: the lowest nodes of cells are in the order of cells
  const BrickFrame frame(grid.geometry(), shape, brick);
  thread_local std::vector<std::uint8_t> cell;
  cell.resize(block_lanes * cohort.blocks.size());
  std::array<std::uint32_t, shape.nodes() + 1> start{};
  for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
    const LinearPlace place(frame, pool.layout(), pool.block(cohort.blocks[b]));
    const int used = cohort.used_lanes(b);
    for (int l = 0; l < block_lanes; ++l) {
      cell[block_lanes * b + static_cast<std::size_t>(l)] = static_cast<std::uint8_t>(place.node[l]);
      if (l < used) ++start[static_cast<std::size_t>(place.node[l]) + 1];
    }
  }
  cell.resize(cohort.count);
  if (std::is_sorted(cell.begin(), cell.end())) return;
  std::partial_sum(start.begin(), start.end(), start.begin());
  thread_local std::vector<std::uint32_t> order;
  order.resize(cohort.count);
  for (std::uint32_t p = 0; p < cohort.count; ++p) order[start[cell[p]]++] = p;
  reorder(pool, cohort, order);
}

void sort_by_identity(BlockPool& pool, Cohort& cohort) {
  const int offset = pool.layout().offset(Column::identity);
  const auto identity = [&](std::uint32_t p) {
    return pool.block(cohort.blocks[p / block_lanes])[offset + static_cast<int>(p % block_lanes)];
  };
  std::vector<std::uint32_t> order(cohort.count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return identity(a) < identity(b); });
  reorder(pool, cohort, order);
}

void Migration::tidy() {
  BrickGrid& grid = *model_.grid;
  for_each_by_threads(0, grid.owned(), 4, [&](int s) {
    Brick& brick = grid.brick(static_cast<Slot>(s));
    for (Cohort& cohort : brick.cohorts) {
      sort_by_cell(grid, brick.coord, *model_.bodies[static_cast<std::size_t>(cohort.body)].pool, cohort);
    }
  });
  std::vector<BrickCoord> empty;
  for (const Brick& b : grid.bricks()) {
    if (b.cohorts.empty()) empty.push_back(b.coord);
  }
  if (exchange_.any(!empty.empty())) exchange_.retire(grid, empty);
}

}  // namespace mpm::core
