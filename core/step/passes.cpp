#include "core/step/passes.hpp"

#include <cmath>
#include <limits>

#include <omp.h>

#include "core/simd/denormals.hpp"
#include "core/step/ahead.hpp"
#include "core/step/speeds.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

void move_at_own_velocity(const ColumnLayout& layout, double dt, double* block) {
  double* x = block + layout.offset(Column::position_x);
  const double* v = block + layout.offset(Column::velocity_x);
  for (int i = 0; i < 3 * block_lanes; ++i) x[i] += dt * v[i];
}

/// The first columns that passes read: up to the stress, and up to the mass.
constexpr int columns_to_stress = static_cast<int>(Column::viscous_pressure) + 1;
constexpr int columns_to_mass = static_cast<int>(Column::mass) + 1;

/// For outputs that show it; no law reads it back.
void keep_sound_speed(Batch& batch) {
  if (!batch.layout->has(Column::sound_speed)) return;
  for (int b = 0; b < batch.blocks; ++b) {
    std::copy_n(batch.sound_speed + block_lanes * b, block_lanes, batch.column(Column::sound_speed, b));
  }
}

/// Share of a full cell's mass below which a node's increment is scaled down in USL's strain rate. The nodal
/// acceleration f/m grows without bound as a particle enters a cell (thesis 2-49); what reaches the
/// particle's own velocity stays bounded, what reaches its strain does not. Below 0.05 the Taylor bar still
/// diverges; at 1 the scaling feeds oscillations instead; 0.2 is good for time step factors up to 0.7.
constexpr double usl_mass_floor = 0.2;

}  // namespace

Passes::Passes(Model& model, Exchange& exchange)
    : model_(model), exchange_(exchange), shared_(model.grid->shape()), loads_(model) {
  const SolutionInput& solution = model.scene->solution;
  forces_.gravity = to_vec(solution.gravity);
  forces_.damping = solution.damping;
  if (solution.scheme == Scheme::usl) {
    // The lightest material's: a floor above what a light body's full nodes weigh would freeze it beside a
    // heavy one.
    double density = std::numeric_limits<double>::infinity();
    for (const Body& b : model.bodies) density = std::min(density, b.model->reference_density());
    forces_.strain_mass_floor = usl_mass_floor * density * model.grid->geometry().cell_volume();
  }
  velocity_limit_ = solution.limit_velocity.value_or(std::numeric_limits<double>::infinity());
  erosion_volume_ = solution.volume.erode.value_or(0);
#pragma omp parallel
  flush_denormals_to_zero();
  workplaces_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  for (Workplace& w : workplaces_) {
    w.nodes.resize(static_cast<std::size_t>(node_doubles * model.grid->shape().nodes()));
    w.sums.resize(w.nodes.size());
  }
}

template <class F>
void Passes::for_bricks(int first, int last, F f) {
  // Long runs of neighbours for each thread: what it asks for ahead is then its own, and few of the sums come
  // from the other's cache. Four runs a thread even out what bricks differ in.
  const auto threads = static_cast<int>(workplaces_.size());
  for_each_by_threads(
      first, last, std::max((last - first) / (4 * threads), 1),
      [&](int s) {
        ask_for_coming_bricks(*model_.grid, static_cast<Slot>(s));
        f(static_cast<Slot>(s), workplaces_[static_cast<std::size_t>(omp_get_thread_num())]);
      },
      threads);
}

// --- particles to grid ------------------------------------------------------------------------------------

template <Mapped what, class F>
void Passes::map_brick(Slot s, F before) {
  BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  double* contributions = grid.contributions(array_of(what), s);
  std::fill_n(contributions, record_doubles(array_of(what)) * grid.shape().nodes(), 0.0);
  RoomAhead room(s + 1 < grid.owned() ? grid.contributions(array_of(what), s + 1) : nullptr,
                 record_doubles(array_of(what)) * grid.shape().nodes(), blocks_of(brick));
  CellSums<what> sums;
  sums.clear();
  for (std::size_t c = 0; c < brick.cohorts.size(); ++c) {
    const Cohort& cohort = brick.cohorts[c];
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    const BlocksAhead ahead(model_, s, c);
    const ColumnLayout& layout = body.pool->layout();
    const bool loaded = maps_force(what) && loads_.act(grid, s, cohort.body);
    // The next block is located before this one is worked on: what was stored is then there when it is read.
    BlockPlace places[2];
    if (!cohort.blocks.empty()) places[0].find(frame, layout, body.pool->block(cohort.blocks[0]));
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      if constexpr (what == Mapped::momentum_mass_force) ahead.prefetch(b, columns_to_stress);
      if constexpr (what == Mapped::momentum_mass || what == Mapped::momentum)
        ahead.prefetch(b, columns_to_mass);
      room.next();
      double* block = body.pool->block(cohort.blocks[b]);
      const int used = cohort.used_lanes(b);
      if (b + 1 < cohort.blocks.size())
        places[(b + 1) % 2].find(frame, layout, body.pool->block(cohort.blocks[b + 1]));
      const BlockPlace& place = places[b % 2];
      before(body, place, block, used);
      add_block<what>(frame, place, layout, block, used, sums, contributions);
      if constexpr (maps_force(what)) {
        if (loaded) loads_.add_forces(model_, s, cohort.body, place, block, used, contributions);
      }
    }
  }
  sums.flush(frame, contributions);
}

namespace {
struct Components {
  int first, count;
};
constexpr Components components(Mapped what) {
  return what == Mapped::momentum_mass_force ? Components{0, 7}
         : what == Mapped::momentum_mass     ? Components{0, 4}
         : what == Mapped::momentum          ? Components{0, 3}
                                             : Components{4, 3};
}
}  // namespace

/// work(slot, workplace) for all bricks, which maps what they are to send; the boundary bricks' sums travel
/// meanwhile.
template <Mapped what, class F>
void Passes::map_bricks(F work) {
  BrickGrid& grid = *model_.grid;
  for_bricks(0, grid.boundary(), work);
  exchange_.begin_halo(grid, array_of(what), components(what).first, components(what).count);
  for_bricks(grid.boundary(), grid.owned(), work);
}

namespace {
constexpr auto as_they_are = [](const Body&, const BlockPlace&, double*, int) {};
}

template <Mapped what>
void Passes::map_to_grid() {
  map_bricks<what>([this](Slot s, Workplace&) { map_brick<what>(s, as_they_are); });
}
template void Passes::map_to_grid<Mapped::momentum_mass_force>();
template void Passes::map_to_grid<Mapped::momentum_mass>();

// --- nodes ------------------------------------------------------------------------------------------------

void Passes::move_nodes(Slot s, Workplace& at) {
  const BrickGrid& grid = *model_.grid;
  sum_contributions<NodeArray::first>(grid, shared_, s, at.nodes.data());
  update_nodes(forces_, dt, grid.geometry().mass_cutoff,
               BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(s).coord), shared_.nodes(),
               at.nodes.data());
}

// --- particles --------------------------------------------------------------------------------------------

/// v += dv; the work of loads belongs to the velocities from before it.
void Passes::kick(Slot s, const Body& body, const BlockPlace& place, double* block, int used, Workplace& at) {
  if (const int number = number_of(body); loads_.act(*model_.grid, s, number))
    at.work += loads_.work(model_, s, number, place, block, used, at.nodes.data());
  if (body.rigid && !body.prescribed_velocity) return fly_on(body, place, block, used, at);
  add_velocity_increment(place, body.pool->layout(), at.nodes.data(), block);
  if (body.prescribed_velocity || velocity_limit_ < std::numeric_limits<double>::infinity()) {
    hold_velocities(body, block, used, at);
  }
}

[[gnu::noinline]] void Passes::velocities_of_brick(Slot s, Workplace& at) {
  BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  for (std::size_t c = 0; c < brick.cohorts.size(); ++c) {
    const Cohort& cohort = brick.cohorts[c];
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    const BlocksAhead ahead(model_, s, c);
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      ahead.prefetch(b, columns_to_mass);
      double* block = body.pool->block(cohort.blocks[b]);
      kick(s, body, BlockPlace(frame, body.pool->layout(), block), block, cohort.used_lanes(b), at);
    }
  }
  at.book_work();
}

template <bool moves, class F>
[[gnu::noinline]] void Passes::stress_of_brick(Slot s, Velocities velocities, Workplace& at,
                                               F ask_for_nodes) {
  BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  Batch& batch = at.batch;
  batch.time = model_.clock.time + dt;
  batch.dt = dt;
  batch.cell_size = grid.geometry().smallest_cell();
  const bool by_cells = model_.options.volume_update == static_cast<int>(VolumeUpdate::cell);
  double fastest = 0;
  for (std::size_t c = 0; c < brick.cohorts.size(); ++c) {
    const Cohort& cohort = brick.cohorts[c];
    const BlocksAhead ahead(model_, s, c);
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    BlockPool& pool = *body.pool;
    const ColumnLayout& layout = pool.layout();
    batch.layout = &layout;
    const int lines_first = std::max(layout.columns() - lines_asked_by_materials, 0);
    for (std::size_t first = 0; first < cohort.blocks.size(); first += batch_blocks) {
      batch.blocks = static_cast<int>(std::min<std::size_t>(batch_blocks, cohort.blocks.size() - first));
      batch.particles =
          static_cast<int>(std::min<std::size_t>(batch_particles, cohort.count - block_lanes * first));
      // All places first: a block's is a long chain of operations, and those of several blocks overlap.
      for (int b = 0; b < batch.blocks; ++b) {
        batch.block[b] = pool.block(cohort.blocks[first + static_cast<std::size_t>(b)]);
        at.places[b].find(frame, layout, batch.block[b]);
      }
      for (int b = 0; b < batch.blocks; ++b) {
        const std::size_t at_block = first + static_cast<std::size_t>(b);
        batch.ahead[b] = ahead.lines(at_block);
        batch.ahead[b].ask(lines_first);
        ask_for_nodes();
        double* block = batch.block[b];
        const BlockPlace& place = at.places[b];
        if (by_cells) {
          cell_strain(frame, place, at.nodes.data(), dt, batch.cell_volumetric_strain, block_lanes * b);
        }
        velocity_gradient(frame, place, at.nodes.data(), batch.gradient, block_lanes * b);
        if constexpr (moves) { move(body, place, block, cohort.used_lanes(at_block), at); }
      }
      batch.events = {};
      batch.vanishing = batch.negative = 0;
      body.model->update(batch, model_.options);
      at.found.events += batch.events;
      if ((batch.vanishing | batch.negative) != 0) note_unphysical(body, batch, at.found);
      keep_sound_speed(batch);
      if (velocities == Velocities::of_next_step)
        at.found.fastest = fastest_particle(batch, at.found.fastest);
      else
        fastest = std::max(fastest, fastest_wave(batch));
      if constexpr (moves) {
        for (int b = 0; b < batch.blocks; ++b) {
          const std::size_t at_block = first + static_cast<std::size_t>(b);
          note_leavers(s, c, at_block, frame, layout, batch.block[b], cohort.used_lanes(at_block));
        }
      }
    }
  }
  at.book_work();
  if (velocities == Velocities::of_last_step) critical_[static_cast<std::size_t>(s)] = fastest;
}

/// x += dt v, of the grid or, where a body keeps its velocity, its own; and the work of gravity and damping.
void Passes::move(const Body& body, const BlockPlace& place, double* block, int used, Workplace& at) {
  const ColumnLayout& layout = body.pool->layout();
  const bool books = forces_.damping != 0 || forces_.gravity != Vec3<double>{};
  if (books) std::copy_n(block + layout.offset(Column::position_x), 3 * block_lanes, at.before);
  if (body.keeps_velocity())
    move_at_own_velocity(layout, dt, block);
  else
    move_with_grid(place, layout, at.nodes.data(), dt, block);
  if (books) book_motion(layout, block, used, at);
}

void Passes::note_leavers(Slot s, std::size_t cohort, std::size_t b, const BrickFrame& frame,
                          const ColumnLayout& layout, const double* block, int used) {
  std::vector<Leaver>& leavers = leavers_[static_cast<std::size_t>(s)];
  const auto note = [&](int lane, bool eroded) {
    leavers.push_back({static_cast<int>(cohort),
                       static_cast<std::uint32_t>(block_lanes * b) + static_cast<std::uint32_t>(lane),
                       eroded});
  };
  unsigned gone = 0;
  if (layout.has(Column::failed) || erosion_volume_ > 0) {
    const double* volume = block + layout.offset(Column::volume);
    for (int i = 0; i < used; ++i) {
      const bool eroded = volume[i] < erosion_volume_ ||
                          (layout.has(Column::failed) && block[layout.offset(Column::failed) + i] >= 2);
      if (!eroded) continue;
      gone |= 1u << i;
      note(i, true);
    }
  }
  unsigned outside = lanes_outside(frame, layout, block, used) & ~gone;
  for (; outside != 0; outside &= outside - 1) note(__builtin_ctz(outside), false);
}

// --- what the schemes are made of -------------------------------------------------------------------------

double* Passes::motion(Slot s) {
  return motion_.data() + static_cast<std::size_t>(motion_doubles()) * static_cast<std::size_t>(s);
}

/// What the next brick's nodes are made of, asked for while this brick's blocks are worked on.
template <NodeArray of>
[[gnu::always_inline]] inline ContributionsAhead<of> Passes::nodes_ahead(Slot s) const {
  const BrickGrid& grid = *model_.grid;
  return {grid, shared_, s + 1, blocks_of(grid.brick(s))};
}

/// Likewise what is kept of their motion.
RoomAhead Passes::motion_ahead(Slot s) {
  const BrickGrid& grid = *model_.grid;
  return {s + 1 < grid.owned() ? motion(s + 1) : nullptr, motion_doubles(), blocks_of(grid.brick(s))};
}

void Passes::update_velocities_and_map_back() {
  const BrickGrid& grid = *model_.grid;
  motion_.resize(static_cast<std::size_t>(motion_doubles()) * static_cast<std::size_t>(grid.owned()));
  map_bricks<Mapped::momentum>([&](Slot s, Workplace& at) {
    move_nodes(s, at);
    keep_motion(shared_.nodes(), at.nodes.data(), motion(s));
    auto nodes = nodes_ahead<NodeArray::first>(s);
    RoomAhead room = motion_ahead(s);
    map_brick<Mapped::momentum>(s, [&](const Body& body, const BlockPlace& place, double* block, int used) {
      nodes.next();
      room.next();
      kick(s, body, place, block, used, at);
    });
    at.book_work();
  });
}

void Passes::update_stress_and_move() {
  const BrickGrid& grid = *model_.grid;
  leavers_.resize(static_cast<std::size_t>(grid.owned()));
  for_bricks(0, grid.owned(), [&](Slot s, Workplace& at) {
    recall_motion(shared_.nodes(), motion(s), at.nodes.data());
    sum_contributions<NodeArray::second>(grid, shared_, s, at.sums.data());
    second_velocities(0, at.sums.data(), BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(s).coord),
                      shared_.nodes(), at.nodes.data());
    auto nodes = nodes_ahead<NodeArray::second>(s);
    RoomAhead room = motion_ahead(s);
    stress_of_brick<true>(s, Velocities::of_next_step, at, [&] {
      nodes.next();
      room.next();
    });
  });
}

void Passes::update_stress_and_map_forces() {
  const BrickGrid& grid = *model_.grid;
  critical_.resize(static_cast<std::size_t>(grid.owned()));
  map_bricks<Mapped::force>([&](Slot s, Workplace& at) {
    sum_contributions<NodeArray::second>(grid, shared_, s, at.nodes.data());
    second_velocities(grid.geometry().mass_cutoff, at.nodes.data(),
                      BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(s).coord), shared_.nodes(),
                      at.nodes.data());
    auto nodes = nodes_ahead<NodeArray::second>(s);
    stress_of_brick<false>(s, Velocities::of_last_step, at, [&] { nodes.next(); });
    map_brick<Mapped::force>(s, as_they_are);
  });
}

void Passes::update_velocities_and_move() {
  BrickGrid& grid = *model_.grid;
  leavers_.resize(static_cast<std::size_t>(grid.owned()));
  for_bricks(0, grid.owned(), [&](Slot s, Workplace& at) {
    sum_contributions<NodeArray::first>(grid, shared_, s,
                                        at.nodes.data());  // forces; momenta and masses are zero
    sum_contributions<NodeArray::second>(grid, shared_, s, at.nodes.data());  // overwrites those
    update_nodes(forces_, dt, grid.geometry().mass_cutoff,
                 BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(s).coord), shared_.nodes(),
                 at.nodes.data());
    // The wave speeds are of the stress pass; each brick's largest stands for all of its particles.
    at.found.fastest =
        std::max(at.found.fastest, critical_[static_cast<std::size_t>(s)] + kick_and_move(s, at));
  });
}

/// Returns the largest speed of the brick's particles.
[[gnu::noinline]] double Passes::kick_and_move(Slot s, Workplace& at) {
  BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  auto first_ahead = nodes_ahead<NodeArray::first>(s);
  auto second_ahead = nodes_ahead<NodeArray::second>(s);
  double fastest_square = 0;
  for (std::size_t c = 0; c < brick.cohorts.size(); ++c) {
    const Cohort& cohort = brick.cohorts[c];
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    const ColumnLayout& layout = body.pool->layout();
    const BlocksAhead ahead(model_, s, c);
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      ahead.prefetch(b, columns_to_mass);
      first_ahead.next();
      second_ahead.next();
      double* block = body.pool->block(cohort.blocks[b]);
      const int used = cohort.used_lanes(b);
      const BlockPlace place(frame, layout, block);
      kick(s, body, place, block, used, at);
      move(body, place, block, used, at);
      for (int l = 0; l < used; l += real_width)
        fastest_square = largest_lane(squared_speed(layout, block, l), used - l, fastest_square);
      note_leavers(s, c, b, frame, layout, block, used);
    }
  }
  at.book_work();
  return std::sqrt(fastest_square);
}

void Passes::update_all() {
  leavers_.resize(static_cast<std::size_t>(model_.grid->owned()));
  for_bricks(0, model_.grid->owned(), [&](Slot s, Workplace& at) {
    move_nodes(s, at);
    velocities_of_brick(s, at);
    const BrickGrid& grid = *model_.grid;
    regularised_velocities(dt * forces_.gravity,
                           BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(s).coord), shared_.nodes(),
                           at.nodes.data());
    auto nodes = nodes_ahead<NodeArray::first>(s);
    stress_of_brick<true>(s, Velocities::of_next_step, at, [&] { nodes.next(); });
  });
}

StepFindings Passes::take_findings() {
  StepFindings total;
  for (Workplace& w : workplaces_) {
    total.fastest = std::max(total.fastest, w.found.fastest);
    total.limited += w.found.limited;
    total.events += w.found.events;
    total.vanishing.merge(w.found.vanishing);
    total.negative.merge(w.found.negative);
    total.work += w.found.work;
    w.found = {};
  }
  return total;
}

}  // namespace mpm::core
