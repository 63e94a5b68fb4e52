// The passes (passes.hpp) with shape functions S and transfer T. Operations on a brick, a block or a batch
// are functions of their own; for_bricks and for_each_block define the order and the prefetching.
// Instantiated once per pair (passes_<shape>.cpp), through make_passes_with alone: the compiler inlines
// members of a class template that is instantiated explicitly less freely (5 % of MUSL's time).
#pragma once

#include <cmath>
#include <limits>

#include <omp.h>

#include "core/simd/denormals.hpp"
#include "core/step/grid_to_particles.hpp"
#include "core/step/load_forces.hpp"
#include "core/step/particle_motion.hpp"
#include "core/step/particles_to_grid.hpp"
#include "core/step/passes.hpp"
#include "core/step/prefetch.hpp"
#include "core/step/speeds.hpp"
#include "core/threads.hpp"
#include "core/transfer/corrected.hpp"

namespace mpm::core {

template <ShapePolicy S, TransferPolicy T>
class PassesWith final : public Passes {
 public:
  PassesWith(Model& model, NodeHalo& halo);

  const Loads& loads() const override { return loads_; }
  void begin_step(double length) override {
    dt = length;
    transfer_step_ = {dt / (wave_weight_ * model_.clock.critical_dt)};
    loads_.begin_step(model_.clock.time, dt);
    begin_corrections();
  }

  void map_momentum_mass_force() override { map_to_grid<mapped::momentum_mass_force>(); }
  void map_momentum_mass() override { map_to_grid<mapped::momentum_mass>(); }
  void finish_exchange() override { halo_.end(*model_.grid); }
  void correct_velocities(int order) override;
  void finish_correction() override {
    if (correcting_) halo_.end(*model_.grid);
  }
  void update_velocities_and_map_back() override;
  void update_stress_and_move() override;
  void update_stress_and_map_forces() override;
  void update_velocities_and_move() override;
  void update_all() override;

  std::vector<std::vector<DepartingParticle>>& departing() override { return departing_; }
  StepStatistics take_statistics() override;

 private:
  using Place = typename S::Place;
  /// Whether particles have domains that deform with them.
  static constexpr bool deforms = requires { &S::template deform<Row[9]>; };
  static constexpr bool settles = requires { &S::settle; };
  /// Whether the transfer corrects velocities (core/transfer/corrected.hpp).
  static constexpr bool corrects = corrects_velocities<T>;
  struct Nothing {};
  struct Scratch : ThreadScratch {
    Place places[batch_blocks];
    typename S::Field field;
    [[no_unique_address]] std::conditional_t<corrects, typename S::Field, Nothing> corrected;
  };

  /// The number of leading columns that passes read up to the stress; up to the mass below.
  static constexpr int columns_to_stress = static_cast<int>(Column::viscous_pressure) + 1;
  static constexpr int columns_to_mass = static_cast<int>(Column::mass) + 1;

  // Order of bricks and blocks.
  template <class F>
  void for_bricks(int first, int last, F f);
  template <class F>
  void for_each_block(Slot s, int columns, F f);
  template <class F, class G>
  void for_each_batch(Slot s, const BrickFrame& frame, Scratch& at, F block_work, G batch_work);
  template <NodeFields what, class F>
  void map_bricks(F work);

  // Operations on a brick.
  template <NodeFields what>
  void map_to_grid();
  template <NodeFields what, class F>
  void map_brick(Slot s, F before);
  template <NodeFields what>
  void fold_at_walls(Slot s, double* contributions);
  void update_nodes_of_brick(Slot s, Scratch& at);
  void sum_and_update_nodes(Slot s, Scratch& at);
  void velocities_of_brick(Slot s, Scratch& at);
  double velocities_and_motion_of_brick(Slot s, Scratch& at);
  /// Whether the particles' velocities are already those at the start of the next step.
  enum class Velocities { of_last_step, of_next_step };
  template <bool moves, class F>
  void stress_of_brick(Slot s, Velocities velocities, Scratch& at, F prefetch_nodes);

  // Corrections of the velocities (correct_velocities.hpp).
  void begin_corrections();
  void add_order(Slot s, int order, Scratch& at);
  void map_increments(Slot s, Scratch& at);
  /// The nodes' sums of velocities v(l), in MotionRecords.
  double* corrected_nodes(Slot s) {
    return corrected_.data() +
           static_cast<std::size_t>(node_doubles * shared_.nodes()) * static_cast<std::size_t>(s);
  }
  /// Whether particles move with the corrected velocities in this step.
  bool moves_corrected() const {
    if constexpr (corrects) return correcting_ && transfer_.of_end;
    return false;
  }
  /// The same as a field. MUSL moves particles in a later pass, by the motion kept for it.
  const typename S::Field& moving_field(const Scratch& at) const {
    if constexpr (corrects) {
      if (moves_corrected() && scheme_ != Scheme::musl) return at.corrected;
    }
    return at.field;
  }
  /// The nodes' velocities and masses that move a brick's particles.
  const double* moving_nodes(Slot s, const Scratch& at) {
    return moves_corrected() ? corrected_nodes(s) : at.nodes.data();
  }

  // Operations on a block or a batch.
  void take_velocities(const BrickFrame& frame, const Place& place, const ColumnLayout& layout, double* block,
                       Scratch& at) const;
  void update_velocities(Slot s, const BrickFrame& frame, int body, const Place& place, double* block,
                         int used, Scratch& at);
  void move(int body, const MotionOfBlock<S>& motion, double* block, int used, Scratch& at);
  void update_domains(int body, const BrickFrame& frame, const ColumnLayout& layout, int b, double* block,
                      int used, Scratch& at);
  void volumetric_strain(const BrickFrame& frame, const Place& place, int b, Scratch& at);
  void update_material(const Body& body, Scratch& at);

  bool updates_volume_by_cell() const {
    return model_.options.volume_update == static_cast<int>(VolumeUpdate::cell);
  }
  BoundaryFaces faces(Slot s) const { return {*model_.grid, s}; }
  BrickFrame frame(Slot s) const { return {model_.grid->geometry(), model_.grid->brick(s).coord}; }
  /// Prefetches the contributions to the next brick's nodes while this brick's blocks are processed.
  template <NodeArray of>
  [[gnu::always_inline]] ContributionPrefetch<of> prefetch_nodes(Slot s) const {
    const BrickGrid& grid = *model_.grid;
    return {grid, shared_, s + 1, block_count(grid.brick(s))};
  }
  int motion_doubles() const { return motion_width * shared_.nodes(); }
  double* motion(Slot s) {
    return motion_.data() + static_cast<std::size_t>(motion_doubles()) * static_cast<std::size_t>(s);
  }
  /// Prefetches the next brick's stored nodal motion.
  SpreadPrefetch prefetch_motion(Slot s) {
    const BrickGrid& grid = *model_.grid;
    return {s + 1 < grid.owned() ? motion(s + 1) : nullptr, motion_doubles(), block_count(grid.brick(s))};
  }

  Model& model_;
  NodeHalo& halo_;
  SharedNodes shared_;
  NodeForces forces_;
  Loads loads_;
  T transfer_;
  const Scheme scheme_;
  const int orders_;
  bool correcting_ = false;  ///< in this step
  TransferStep transfer_step_;
  double dt = 0;           ///< of the current step
  double velocity_limit_;  ///< infinite without LimitVelocity
  double erosion_volume_;
  double wave_weight_;                                     ///< of wave speeds in the critical step
  std::vector<Scratch> scratch_;                           ///< by thread
  std::vector<std::vector<DepartingParticle>> departing_;  ///< by slot
  /// By slot; MUSL: nodal motion, kept between the passes that update the nodes and move the particles.
  AlignedDoubles motion_;
  AlignedDoubles corrected_;      ///< by slot; XPIC, FMPM: corrected_nodes()
  std::vector<double> critical_;  ///< by slot; USF: largest critical speed of the stress pass
};

/// Share of a full cell's mass below which a node's increment is scaled down in USL's strain rate. The nodal
/// acceleration f/m grows without bound as a particle enters a cell (thesis 2-49); its effect on the
/// particle's velocity stays bounded, that on its strain does not. Below 0.05 the Taylor bar still diverges;
/// at 1 the scaling excites oscillations; 0.2 works for time step factors up to 0.7.
inline constexpr double usl_mass_floor = 0.2;

template <ShapePolicy S, TransferPolicy T>
PassesWith<S, T>::PassesWith(Model& model, NodeHalo& halo)
    : model_(model),
      halo_(halo),
      shared_(model.grid->shape()),
      loads_(model),
      transfer_(model.scene->solution),
      scheme_(model.scene->solution.scheme),
      orders_(orders_of(model.scene->solution)) {
  const SolutionInput& solution = model.scene->solution;
  forces_.gravity = solution.gravity;
  forces_.damping = solution.damping;
  if (solution.scheme == Scheme::usl) {
    // The lightest material's density: a floor above the mass of a light body's full nodes would freeze that
    // body beside a heavy one.
    double density = std::numeric_limits<double>::infinity();
    for (const Body& b : model.bodies) density = std::min(density, b.model->reference_density());
    forces_.strain_mass_floor = usl_mass_floor * density * model.grid->geometry().cell_volume();
  }
  velocity_limit_ = solution.limit_velocity.value_or(std::numeric_limits<double>::infinity());
  erosion_volume_ = solution.volume.erode.value_or(0);
  wave_weight_ = 1 / wave_limit(*model.scene);
#pragma omp parallel
  flush_denormals_to_zero();
  scratch_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  for (Scratch& w : scratch_) {
    w.nodes.resize(static_cast<std::size_t>(node_doubles * model.grid->shape().nodes()));
    w.sums.resize(w.nodes.size());
  }
}

// --- order of bricks and blocks ----------------------------------------------------------------------------

/// f(slot, scratch) for the bricks first .. last - 1, by all threads.
template <ShapePolicy S, TransferPolicy T>
template <class F>
void PassesWith<S, T>::for_bricks(int first, int last, F f) {
  // Long runs of neighbours per thread: most prefetched data and sums then stay in that thread's cache. Four
  // runs per thread balance differences between bricks.
  const auto threads = static_cast<int>(scratch_.size());
  for_each_by_threads(
      first, last, std::max((last - first) / (4 * threads), 1),
      [&](int s) {
        prefetch_coming_bricks(*model_.grid, static_cast<Slot>(s));
        f(static_cast<Slot>(s), scratch_[static_cast<std::size_t>(omp_get_thread_num())]);
      },
      threads);
}

/// f(tile index, block index, body number, layout, block, lanes in use) for a brick's blocks. `columns`:
/// number of leading columns that are read.
template <ShapePolicy S, TransferPolicy T>
template <class F>
[[gnu::always_inline]] inline void PassesWith<S, T>::for_each_block(Slot s, int columns, F f) {
  const Brick& brick = model_.grid->brick(s);
  for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
    const ParticleTile& tile = brick.tiles[c];
    BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
    const BlockPrefetch prefetch(model_, s, c);
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      prefetch.template request<S>(b, pool.layout(), columns);
      f(static_cast<int>(c), b, tile.body, pool.layout(), pool.block(tile.blocks[b]), tile.used_lanes(b));
    }
  }
}

/// Processes the blocks of a brick in batches: for each block block_work(body, block of the batch, lanes in
/// use), then, with the next blocks prefetched, batch_work(tile index, first block index, tile). `at` holds
/// the batch and its particles' places.
template <ShapePolicy S, TransferPolicy T>
template <class F, class G>
[[gnu::always_inline]] inline void PassesWith<S, T>::for_each_batch(Slot s, const BrickFrame& frame,
                                                                    Scratch& at, F block_work, G batch_work) {
  const Brick& brick = model_.grid->brick(s);
  Batch& batch = at.batch;
  batch.time = model_.clock.time + dt;
  batch.dt = dt;
  batch.cell_size = model_.grid->geometry().smallest_cell();
  for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
    const ParticleTile& tile = brick.tiles[c];
    const BlockPrefetch prefetch(model_, s, c);
    BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
    batch.layout = &pool.layout();
    const int lines_before_update = std::max(pool.layout().columns() - parts_of_update, 0);
    for (std::size_t first = 0; first < tile.blocks.size(); first += batch_blocks) {
      batch.blocks = static_cast<int>(std::min<std::size_t>(batch_blocks, tile.blocks.size() - first));
      batch.particles =
          static_cast<int>(std::min<std::size_t>(batch_particles, tile.count - block_lanes * first));
      // All places first: locating a block is a long chain of operations, and the chains of several blocks
      // overlap.
      for (int b = 0; b < batch.blocks; ++b) {
        batch.block[b] = pool.block(tile.blocks[first + static_cast<std::size_t>(b)]);
        at.places[b].find(frame, pool.layout(), batch.block[b]);
      }
      for (int b = 0; b < batch.blocks; ++b) {
        const std::size_t at_block = first + static_cast<std::size_t>(b);
        batch.background[b] = prefetch.lines(at_block);
        batch.background[b].request(lines_before_update);
        block_work(tile.body, b, tile.used_lanes(at_block));
      }
      batch_work(c, first, tile);
    }
  }
}

/// work(slot, scratch) for all bricks, which maps the fields to be exchanged; the exchange of the boundary
/// bricks overlaps with the interior ones.
template <ShapePolicy S, TransferPolicy T>
template <NodeFields what, class F>
void PassesWith<S, T>::map_bricks(F work) {
  BrickGrid& grid = *model_.grid;
  for_bricks(0, grid.boundary(), work);
  halo_.begin(grid, what);
  for_bricks(grid.boundary(), grid.owned(), work);
}

// --- particles to grid ------------------------------------------------------------------------------------

/// before(body, place, block, used) for every block, then its contribution to the nodes.
template <ShapePolicy S, TransferPolicy T>
template <NodeFields what, class F>
void PassesWith<S, T>::map_brick(Slot s, F before) {
  BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame = this->frame(s);
  constexpr int width = record_doubles(what.array);
  double* contributions = grid.contributions(what.array, s);
  std::fill_n(contributions, width * grid.shape().nodes(), 0.0);
  SpreadPrefetch room(s + 1 < grid.owned() ? grid.contributions(what.array, s + 1) : nullptr,
                      width * grid.shape().nodes(), block_count(brick));
  typename S::template Sums<what> sums(contributions);
  typename S::template Scatter<what> cell;
  cell.clear();
  for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
    const ParticleTile& tile = brick.tiles[c];
    const Body& body = model_.bodies[static_cast<std::size_t>(tile.body)];
    const BlockPrefetch prefetch(model_, s, c);
    const ColumnLayout& layout = body.pool->layout();
    const bool loaded = maps_force(what) && loads_.act(grid, s, tile.body);
    // Locates the next block before this one is processed, so that its stores complete before they are read.
    Place places[2];
    if (!tile.blocks.empty()) places[0].find(frame, layout, body.pool->block(tile.blocks[0]));
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      if constexpr (maps_momentum(what))
        prefetch.template request<S>(b, layout, maps_force(what) ? columns_to_stress : columns_to_mass);
      room.next();
      double* block = body.pool->block(tile.blocks[b]);
      const int used = tile.used_lanes(b);
      if (b + 1 < tile.blocks.size())
        places[(b + 1) % 2].find(frame, layout, body.pool->block(tile.blocks[b + 1]));
      const Place& place = places[b % 2];
      before(tile.body, place, block, used);
      add_block<S, T, what>(frame, place, layout, block, used, cell, sums.records);
      if constexpr (maps_force(what)) {
        if (loaded) add_load_forces<S>(loads_, model_, s, tile.body, place, block, used, contributions);
      }
    }
  }
  cell.flush(frame, sums.records);
  sums.finish(frame);
  if constexpr (S::node_block != NodeBlockShape{}) fold_at_walls<what>(s, contributions);
}

/// Adds to the inner nodes what has been mapped beyond the grid's constrained faces.
template <ShapePolicy S, TransferPolicy T>
template <NodeFields what>
void PassesWith<S, T>::fold_at_walls(Slot s, double* contributions) {
  const BoundaryFaces walls = faces(s);
  if (walls.none()) return;
  walls.fold(what, contributions);
  if constexpr (maps_force(what)) {
    constexpr NodeArray masses = maps_mass(what) ? what.array : NodeArray::second;
    walls.reverse_weights(forces_.gravity, masses, model_.grid->contributions(masses, s), contributions);
  }
}

template <ShapePolicy S, TransferPolicy T>
template <NodeFields what>
void PassesWith<S, T>::map_to_grid() {
  map_bricks<what>([this](Slot s, Scratch&) { map_brick<what>(s, [](int, const Place&, double*, int) {}); });
}

// --- nodes ------------------------------------------------------------------------------------------------

/// Sums what the scheme has mapped and updates the nodes; the result in at.nodes follows MotionRecord.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::sum_and_update_nodes(Slot s, Scratch& at) {
  const BrickGrid& grid = *model_.grid;
  sum_contributions<NodeArray::first>(grid, shared_, s, at.nodes.data());
  // USF's first array has the forces only; momentum and mass are zero there, the second holds them.
  if (scheme_ == Scheme::usf) sum_contributions<NodeArray::second>(grid, shared_, s, at.nodes.data());
  update_nodes(forces_, dt, grid.geometry().mass_cutoff, faces(s), shared_.nodes(), at.nodes.data());
}

/// The same; at.field holds the result too, and at.corrected the corrected velocities.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_nodes_of_brick(Slot s, Scratch& at) {
  sum_and_update_nodes(s, at);
  at.field.take_motion(at.nodes.data());
  if constexpr (corrects) {
    if (!correcting_) return;
    add_order(s, orders_, at);
    at.corrected.take_motion(corrected_nodes(s));
  }
}

// --- particles --------------------------------------------------------------------------------------------

/// What the transfer gives the particles.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::take_velocities(const BrickFrame& frame,
                                                                     const Place& place,
                                                                     const ColumnLayout& layout,
                                                                     double* block, Scratch& at) const {
  if constexpr (corrects) {
    if (correcting_) return transfer_.template take_velocities<S>(place, layout, at.corrected, block);
  }
  transfer_.template update_velocities<S>(frame, place, layout, at.field, transfer_step_, block);
}

/// v += dv; the work of loads uses the velocities before the update.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_velocities(Slot s, const BrickFrame& frame, int body, const Place& place,
                                         double* block, int used, Scratch& at) {
  if (loads_.act(*model_.grid, s, body))
    at.work += work_of_loads<S>(loads_, model_, s, body, place, block, used, at.nodes.data());
  const ColumnLayout& layout = model_.bodies[static_cast<std::size_t>(body)].pool->layout();
  const BodyMotion& motion = loads_.motion(body);
  if (motion.kind == BodyMotion::Kind::rigid) {
    std::copy_n(block + layout.offset(Column::velocity_x), 3 * block_lanes, at.old);
    take_velocities(frame, place, layout, block, at);
    integrate_rigid_velocities(layout, forces_.gravity + loads_.acceleration(body), dt, block, used, at);
    return;
  }
  const bool falls = forces_.gravity != Vec3<double>{};
  if (falls) std::copy_n(block + layout.offset(Column::velocity_x), 3 * block_lanes, at.old);
  take_velocities(frame, place, layout, block, at);
  if (falls) correct_work_of_gravity(forces_.gravity, dt, layout, block, used, at);
  if (motion.kind == BodyMotion::Kind::prescribed)
    prescribe_velocities(layout, motion.velocity, block, used, at);
  else if (velocity_limit_ < std::numeric_limits<double>::infinity())
    limit_velocities(layout, velocity_limit_, block, used, at);
}

/// x += dt v, with the grid's velocity or, for a body that keeps its own velocities, with those; and the work
/// of gravity and damping.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::move(int body, const MotionOfBlock<S>& motion, double* block, int used, Scratch& at) {
  const ColumnLayout& layout = model_.bodies[static_cast<std::size_t>(body)].pool->layout();
  const bool does_work = forces_.damping != 0 || forces_.gravity != Vec3<double>{};
  if (does_work) std::copy_n(block + layout.offset(Column::position_x), 3 * block_lanes, at.old);
  if (loads_.motion(body).kind != BodyMotion::Kind::free)
    move_at_own_velocity(layout, dt, block);
  else
    motion.move(layout, dt, block);
  if constexpr (settles) motion.carry(layout, dt, block);
  if (does_work) add_work_of_motion(forces_, layout, block, used, at);
}

/// The particles' domains: by the velocity gradient of the batch's block `b`, or as they have been carried.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::update_domains(int body, const BrickFrame& frame,
                                                                    const ColumnLayout& layout, int b,
                                                                    double* block, int used, Scratch& at) {
  if constexpr (deforms)
    at.statistics.domains += S::deform(frame, layout, at.batch.gradient, block_lanes * b, dt, block, used);
  if constexpr (settles)
    at.statistics.domains +=
        S::settle(frame, layout, loads_.motion(body).kind == BodyMotion::Kind::free, block, used);
}

template <ShapePolicy S, TransferPolicy T>
[[gnu::noinline]] void PassesWith<S, T>::velocities_of_brick(Slot s, Scratch& at) {
  const BrickFrame frame = this->frame(s);
  for_each_block(s, columns_to_mass,
                 [&](int, std::size_t, int body, const ColumnLayout& layout, double* block, int used) {
                   update_velocities(s, frame, body, Place(frame, layout, block), block, used, at);
                 });
  at.add_work_of_brick();
}

/// Returns the largest speed of the brick's particles.
template <ShapePolicy S, TransferPolicy T>
[[gnu::noinline]] double PassesWith<S, T>::velocities_and_motion_of_brick(Slot s, Scratch& at) {
  const BrickFrame frame = this->frame(s);
  auto first = prefetch_nodes<NodeArray::first>(s);
  auto second = prefetch_nodes<NodeArray::second>(s);
  double fastest_square = 0;
  // The forces of this step were mapped with the domains of its start; those follow now, by the gradient of
  // the velocity that moves the particles.
  typename S::Field moving;
  if constexpr (deforms) {
    const double* nodes = moving_nodes(s, at);
    for (int n = 0; n < shared_.nodes(); ++n)
      std::copy_n(nodes + node_doubles * n + Motion::velocity_at, 3,
                  at.sums.data() + node_doubles * n + Motion::strain_velocity_at);
    moving.take_strain(frame, at.sums.data());
  }
  for_each_block(s, columns_to_mass,
                 [&](int c, std::size_t b, int body, const ColumnLayout& layout, double* block, int used) {
                   first.next();
                   second.next();
                   const Place place(frame, layout, block);
                   update_velocities(s, frame, body, place, block, used, at);
                   move(body, {place, moving_field(at)}, block, used, at);
                   if constexpr (deforms) S::gradient(frame, place, moving, at.batch.gradient, 0);
                   update_domains(body, frame, layout, 0, block, used, at);
                   for (int l = 0; l < used; l += real_width)
                     fastest_square = largest_lane(squared_speed(layout, block, l), used - l, fastest_square);
                   find_departing(c, b, frame, erosion_volume_, layout, block, used,
                                  departing_[static_cast<std::size_t>(s)]);
                 });
  at.add_work_of_brick();
  return std::sqrt(fastest_square);
}

// --- stress -----------------------------------------------------------------------------------------------

/// Of the cells, for block `b` of the batch, where the volume update asks for it.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::volumetric_strain(const BrickFrame& frame,
                                                                       const Place& place, int b,
                                                                       Scratch& at) {
  if (updates_volume_by_cell())
    S::cell_divergence(frame, place, at.field, dt, at.batch.cell_volumetric_strain, block_lanes * b);
}

/// For outputs only; no law reads it.
inline void store_sound_speed(Batch& batch) {
  if (!batch.layout->has(Column::sound_speed)) return;
  for (int b = 0; b < batch.blocks; ++b) {
    std::copy_n(batch.sound_speed + block_lanes * b, block_lanes, batch.column(Column::sound_speed, b));
  }
}

/// Updates the material of a batch with known kinematics and records the events.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::update_material(const Body& body, Scratch& at) {
  Batch& batch = at.batch;
  batch.events = {};
  batch.vanishing = batch.negative = 0;
  body.model->update(batch, model_.options);
  at.statistics.events += batch.events;
  if ((batch.vanishing | batch.negative) != 0)
    name_unphysical(model_.scene->solution.warn, body, batch, at.statistics);
  store_sound_speed(batch);
}

/// Velocity gradient, with `moves` the motion, then the material update, batch by batch. prefetch_nodes() is
/// called once per block.
template <ShapePolicy S, TransferPolicy T>
template <bool moves, class F>
[[gnu::noinline]] void PassesWith<S, T>::stress_of_brick(Slot s, Velocities velocities, Scratch& at,
                                                         F prefetch_nodes) {
  const BrickFrame frame = this->frame(s);
  Batch& batch = at.batch;
  double fastest = 0;
  const auto kinematics = [&](int body, int b, int used) {
    prefetch_nodes();
    volumetric_strain(frame, at.places[b], b, at);
    if constexpr (moves) {
      const MotionOfBlock<S> motion{at.places[b], at.field};
      motion.gradient(frame, batch.gradient, block_lanes * b);
      if (&moving_field(at) == &at.field)
        move(body, motion, batch.block[b], used, at);
      else
        move(body, {at.places[b], moving_field(at)}, batch.block[b], used, at);
      update_domains(body, frame, *batch.layout, b, batch.block[b], used, at);
    } else {
      S::gradient(frame, at.places[b], at.field, batch.gradient, block_lanes * b);
      refer_gradient_to_old_positions(batch, block_lanes * b, dt, updates_volume_by_cell());
    }
  };
  const auto stress = [&](std::size_t c, std::size_t first, const ParticleTile& tile) {
    update_material(model_.bodies[static_cast<std::size_t>(tile.body)], at);
    if (velocities == Velocities::of_next_step)
      at.statistics.fastest = fastest_particle(batch, wave_weight_, at.statistics.fastest);
    else
      fastest = std::max(fastest, fastest_wave(batch));
    if constexpr (moves) {
      for (int b = 0; b < batch.blocks; ++b) {
        const std::size_t at_block = first + static_cast<std::size_t>(b);
        find_departing(static_cast<int>(c), at_block, frame, erosion_volume_, *batch.layout, batch.block[b],
                       tile.used_lanes(at_block), departing_[static_cast<std::size_t>(s)]);
      }
    }
  };
  for_each_batch(s, frame, at, kinematics, stress);
  at.add_work_of_brick();
  if (velocities == Velocities::of_last_step) critical_[static_cast<std::size_t>(s)] = wave_weight_ * fastest;
}

// --- the passes -------------------------------------------------------------------------------------------

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_velocities_and_map_back() {
  motion_.resize(static_cast<std::size_t>(motion_doubles()) * static_cast<std::size_t>(model_.grid->owned()));
  map_bricks<mapped::momentum>([&](Slot s, Scratch& at) {
    update_nodes_of_brick(s, at);
    keep_motion(shared_.nodes(), moving_nodes(s, at), motion(s));
    auto nodes = prefetch_nodes<NodeArray::first>(s);
    SpreadPrefetch room = prefetch_motion(s);
    const BrickFrame frame = this->frame(s);
    map_brick<mapped::momentum>(s, [&](int body, const Place& place, double* block, int used) {
      nodes.next();
      room.next();
      update_velocities(s, frame, body, place, block, used, at);
    });
    at.add_work_of_brick();
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_stress_and_move() {
  const BrickGrid& grid = *model_.grid;
  departing_.resize(static_cast<std::size_t>(grid.owned()));
  for_bricks(0, grid.owned(), [&](Slot s, Scratch& at) {
    recall_motion(shared_.nodes(), motion(s), at.nodes.data());
    sum_contributions<NodeArray::second>(grid, shared_, s, at.sums.data());
    second_velocities(0, at.sums.data(), faces(s), shared_.nodes(), at.nodes.data());
    at.field.take_motion(at.nodes.data());
    at.field.take_strain(frame(s), at.nodes.data());
    auto nodes = prefetch_nodes<NodeArray::second>(s);
    SpreadPrefetch room = prefetch_motion(s);
    stress_of_brick<true>(s, Velocities::of_next_step, at, [&] {
      nodes.next();
      room.next();
    });
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_stress_and_map_forces() {
  const BrickGrid& grid = *model_.grid;
  critical_.resize(static_cast<std::size_t>(grid.owned()));
  map_bricks<mapped::force>([&](Slot s, Scratch& at) {
    sum_contributions<NodeArray::second>(grid, shared_, s, at.nodes.data());
    second_velocities(grid.geometry().mass_cutoff, at.nodes.data(), faces(s), shared_.nodes(),
                      at.nodes.data());
    at.field.take_strain(frame(s), at.nodes.data());
    auto nodes = prefetch_nodes<NodeArray::second>(s);
    stress_of_brick<false>(s, Velocities::of_last_step, at, [&] { nodes.next(); });
    map_brick<mapped::force>(s, [](int, const Place&, double*, int) {});
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_velocities_and_move() {
  const BrickGrid& grid = *model_.grid;
  departing_.resize(static_cast<std::size_t>(grid.owned()));
  for_bricks(0, grid.owned(), [&](Slot s, Scratch& at) {
    update_nodes_of_brick(s, at);
    // The wave speeds are those of the stress pass; the largest of each brick serves for all of its
    // particles.
    at.statistics.fastest = std::max(at.statistics.fastest, critical_[static_cast<std::size_t>(s)] +
                                                                velocities_and_motion_of_brick(s, at));
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_all() {
  const BrickGrid& grid = *model_.grid;
  departing_.resize(static_cast<std::size_t>(grid.owned()));
  for_bricks(0, grid.owned(), [&](Slot s, Scratch& at) {
    update_nodes_of_brick(s, at);
    velocities_of_brick(s, at);
    regularised_velocities(dt * forces_.gravity, faces(s), shared_.nodes(), at.nodes.data());
    at.field.take_strain(frame(s), at.nodes.data());
    auto nodes = prefetch_nodes<NodeArray::first>(s);
    stress_of_brick<true>(s, Velocities::of_next_step, at, [&] { nodes.next(); });
  });
}

template <ShapePolicy S, TransferPolicy T>
StepStatistics PassesWith<S, T>::take_statistics() {
  StepStatistics total;
  for (Scratch& w : scratch_) {
    total.fastest = std::max(total.fastest, w.statistics.fastest);
    total.limited += w.statistics.limited;
    total.domains += w.statistics.domains;
    total.events += w.statistics.events;
    total.vanishing.merge(w.statistics.vanishing);
    total.negative.merge(w.statistics.negative);
    total.work += w.statistics.work;
    w.statistics = {};
  }
  return total;
}

}  // namespace mpm::core

#include "core/step/correct_velocities.hpp"

namespace mpm::core {

template <class S, class T>
std::unique_ptr<Passes> make_passes_with(Model& model, NodeHalo& halo) {
  return std::make_unique<PassesWith<S, T>>(model, halo);
}

}  // namespace mpm::core
