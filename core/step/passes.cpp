#include "core/step/passes.hpp"

#include <limits>

#include <omp.h>

#include "core/simd/denormals.hpp"

namespace mpm::core {

namespace {

Vec3<double> to_vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

/// Blocks come from memory in an order that the hardware guesses only while nobody has moved.
void prefetch(const BlockPool& pool, const Cohort& cohort, std::size_t b, Column first, int columns) {
  if (b >= cohort.blocks.size()) return;
  const double* at = pool.block(cohort.blocks[b]) + pool.layout().offset(first);
  for (int c = 0; c < columns; ++c) __builtin_prefetch(at + block_lanes * c);
}

int used_lanes(const Cohort& cohort, std::size_t b) {
  return static_cast<int>(std::min<std::size_t>(block_lanes, cohort.count - block_lanes * b));
}

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
    : model_(model), exchange_(exchange), shared_(model.grid->shape()) {
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
#pragma omp parallel for schedule(dynamic, 4) num_threads(static_cast <int>(workplaces_.size()))
  for (int s = first; s < last; ++s)
    f(static_cast<Slot>(s), workplaces_[static_cast<std::size_t>(omp_get_thread_num())]);
}

// --- particles to grid ------------------------------------------------------------------------------------

template <Mapped what>
[[gnu::noinline]] void Passes::map_brick(Slot s) {
  BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  const CellCorners corners(grid.shape().side());
  double* contributions = grid.contributions(array_of(what), s);
  std::fill_n(contributions, record_doubles(array_of(what)) * grid.shape().nodes(), 0.0);
  CellSums<what> sums;
  sums.clear();
  for (const Cohort& cohort : brick.cohorts) {
    const BlockPool& pool = *model_.bodies[static_cast<std::size_t>(cohort.body)].pool;
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      prefetch(pool, cohort, b + 2, Column::position_x, maps_force(what) ? 16 : 7);
      add_block<what>(frame, corners, pool.layout(), pool.block(cohort.blocks[b]), used_lanes(cohort, b),
                      sums, contributions);
    }
  }
  sums.flush(contributions, corners);
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

/// work(slot, workplace), then map the brick, for all bricks; the boundary bricks' sums travel meanwhile.
template <Mapped what, class F>
void Passes::map_after(F work) {
  BrickGrid& grid = *model_.grid;
  const auto both = [&](Slot s, Workplace& at) {
    work(s, at);
    map_brick<what>(s);
  };
  for_bricks(0, grid.boundary(), both);
  exchange_.begin_halo(grid, array_of(what), components(what).first, components(what).count);
  for_bricks(grid.boundary(), grid.owned(), both);
}

template <Mapped what>
void Passes::map_to_grid() {
  map_after<what>([](Slot, Workplace&) {});
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

void Passes::hold_velocities(const Body& body, const Cohort& cohort, Workplace& at) {
  BlockPool& pool = *body.pool;
  const ColumnLayout& layout = pool.layout();
  double work = 0;
  for (std::uint32_t i = 0; i < cohort.count; ++i) {
    double* lane = pool.block(cohort.blocks[i / block_lanes]) + i % block_lanes;
    double* v[3];
    for (int a = 0; a < 3; ++a) v[a] = lane + layout.offset(next(Column::velocity_x, a));
    if (body.prescribed_velocity) {
      // What holds the velocity gives momentum m (v_p - v) at velocity v_p.
      const Vec3<double>& p = *body.prescribed_velocity;
      const double m = lane[layout.offset(Column::mass)];
      work += m * ((p.x - *v[0]) * p.x + (p.y - *v[1]) * p.y + (p.z - *v[2]) * p.z);
      for (int a = 0; a < 3; ++a) *v[a] = p[a];
    } else {
      const double speed = std::sqrt(*v[0] * *v[0] + *v[1] * *v[1] + *v[2] * *v[2]);
      if (speed > velocity_limit_) {
        work += 0.5 * lane[layout.offset(Column::mass)] * (velocity_limit_ * velocity_limit_ - speed * speed);
        for (int a = 0; a < 3; ++a) *v[a] *= velocity_limit_ / speed;
        ++at.found.limited;
      }
    }
  }
  if (work != 0) at.found.work.add(work);
}

[[gnu::noinline]] void Passes::velocities_of_brick(Slot s, Workplace& at) {
  BrickGrid& grid = *model_.grid;
  Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  const CellCorners corners(grid.shape().side());
  for (Cohort& cohort : brick.cohorts) {
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      prefetch(*body.pool, cohort, b + 2, Column::position_x, 7);
      add_velocity_increment(frame, corners, body.pool->layout(), at.nodes.data(),
                             body.pool->block(cohort.blocks[b]));
    }
    if (body.prescribed_velocity || velocity_limit_ < std::numeric_limits<double>::infinity()) {
      hold_velocities(body, cohort, at);
    }
  }
}

namespace {
/// Largest of v(block, lane) over the lanes in use.
template <class F>
double largest(const Batch& batch, F v) {
  Real most(0.0);
  for (int b = 0; b < batch.blocks; ++b) {
    const int used = std::min(block_lanes, batch.particles - block_lanes * b);
    for (int l = 0; l < block_lanes; l += real_width) {
      const Real value = v(b, l);
      if (l + real_width <= used) {
        most = max(value, most);
      } else {
        double each[real_width];
        store(each, value);
        for (int i = 0; l + i < used; ++i) most = max(Real(each[i]), most);
      }
    }
  }
  return reduce_max(most);
}

Real speed(const ColumnLayout& layout, const double* block, int lane) {
  const auto v = [&](Column c) { return load<Real>(block + layout.offset(c) + lane); };
  const Real x = v(Column::velocity_x), y = v(Column::velocity_y), z = v(Column::velocity_z);
  return sqrt(x * x + y * y + z * z);
}
}  // namespace

[[gnu::noinline]] void Passes::stress_of_brick(Slot s, Velocities velocities, Workplace& at) {
  BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  const CellCorners corners(grid.shape().side());
  Batch& batch = at.batch;
  batch.time = model_.clock.time + dt;
  batch.dt = dt;
  batch.cell_size = grid.geometry().smallest_cell();
  const bool by_cells = model_.options.volume_update == static_cast<int>(VolumeUpdate::cell);
  double fastest = 0;
  for (const Cohort& cohort : brick.cohorts) {
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    BlockPool& pool = *body.pool;
    const ColumnLayout& layout = pool.layout();
    batch.layout = &layout;
    for (std::size_t first = 0; first < cohort.blocks.size(); first += batch_blocks) {
      batch.blocks = static_cast<int>(std::min<std::size_t>(batch_blocks, cohort.blocks.size() - first));
      batch.particles =
          static_cast<int>(std::min<std::size_t>(batch_particles, cohort.count - block_lanes * first));
      for (int b = 0; b < batch.blocks; ++b) {
        const std::size_t at_block = first + static_cast<std::size_t>(b);
        prefetch(pool, cohort, at_block + 2, Column::position_x, layout.columns());
        batch.block[b] = pool.block(cohort.blocks[at_block]);
        velocity_gradient(frame, corners, layout, at.nodes.data(), batch.block[b], batch.gradient,
                          block_lanes * b);
        if (by_cells) {
          cell_strain(frame, corners, layout, at.nodes.data(), dt, batch.block[b],
                      batch.cell_volumetric_strain, block_lanes * b);
        }
      }
      batch.events = {};
      body.model->update(batch, model_.options);
      at.found.events += batch.events;
      keep_sound_speed(batch);
      fastest = std::max(fastest, largest(batch, [&](int b, int l) {
                           const Real critical = load<Real>(batch.critical_speed + block_lanes * b + l);
                           return velocities == Velocities::of_next_step
                                      ? critical + speed(layout, batch.block[b], l)
                                      : critical;
                         }));
    }
  }
  if (velocities == Velocities::of_next_step)
    at.found.fastest = std::max(at.found.fastest, fastest);
  else
    critical_[static_cast<std::size_t>(s)] = fastest;
}

/// The largest |v| of the brick's particles.
double Passes::fastest_of_brick(Slot s, Workplace& at) const {
  Batch& batch = at.batch;
  double fastest = 0;
  for (const Cohort& cohort : model_.grid->brick(s).cohorts) {
    BlockPool& pool = *model_.bodies[static_cast<std::size_t>(cohort.body)].pool;
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      batch.blocks = 1;
      batch.particles = used_lanes(cohort, b);
      batch.block[0] = pool.block(cohort.blocks[b]);
      fastest = std::max(fastest,
                         largest(batch, [&](int, int l) { return speed(pool.layout(), batch.block[0], l); }));
    }
  }
  return fastest;
}

[[gnu::noinline]] void Passes::move_brick(Slot s, Workplace& at) {
  BrickGrid& grid = *model_.grid;
  Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  const CellCorners corners(grid.shape().side());
  const Vec3<double> g = forces_.gravity;
  const bool works = g.x != 0 || g.y != 0 || g.z != 0 || forces_.damping != 0;
  std::vector<Leaver>& leavers = leavers_[static_cast<std::size_t>(s)];
  double work = 0;
  for (std::size_t c = 0; c < brick.cohorts.size(); ++c) {
    const Cohort& cohort = brick.cohorts[c];
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    BlockPool& pool = *body.pool;
    const ColumnLayout& layout = pool.layout();
    const bool erodes = layout.has(Column::failed) || erosion_volume_ > 0;
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      double* block = pool.block(cohort.blocks[b]);
      double* x = block + layout.offset(Column::position_x);
      const double* v = block + layout.offset(Column::velocity_x);
      const int used = used_lanes(cohort, b);
      double before[3 * block_lanes];
      if (works) std::copy_n(x, 3 * block_lanes, before);
      if (body.prescribed_velocity) {
        for (int i = 0; i < 3 * block_lanes; ++i) x[i] += dt * v[i];
      } else {
        move_with_grid(frame, corners, layout, at.nodes.data(), dt, block);
      }
      if (works) {
        const double* m = block + layout.offset(Column::mass);
        for (int i = 0; i < used; ++i) {
          for (int a = 0; a < 3; ++a) {
            const int at_a = block_lanes * a + i;
            work += m[i] * (g[a] - forces_.damping * v[at_a]) * (x[at_a] - before[at_a]);
          }
        }
      }
      unsigned gone = 0;
      if (erodes) {
        const double* volume = block + layout.offset(Column::volume);
        for (int i = 0; i < used; ++i) {
          const bool eroded = volume[i] < erosion_volume_ ||
                              (layout.has(Column::failed) && block[layout.offset(Column::failed) + i] >= 2);
          if (!eroded) continue;
          gone |= 1u << i;
          leavers.push_back({static_cast<int>(c),
                             static_cast<std::uint32_t>(block_lanes * b) + static_cast<std::uint32_t>(i),
                             true});
        }
      }
      unsigned outside = lanes_outside(frame, layout, block, used) & ~gone;
      for (; outside != 0; outside &= outside - 1) {
        leavers.push_back(
            {static_cast<int>(c),
             static_cast<std::uint32_t>(block_lanes * b) + static_cast<std::uint32_t>(__builtin_ctz(outside)),
             false});
      }
    }
  }
  if (work != 0) at.found.work.add(work);
}

// --- what the schemes are made of
// ---------------------------------------------------------------------------

void Passes::update_velocities_and_map_back() {
  map_after<Mapped::momentum>([&](Slot s, Workplace& at) {
    move_nodes(s, at);
    velocities_of_brick(s, at);
  });
}

void Passes::update_stress_and_move() {
  const BrickGrid& grid = *model_.grid;
  leavers_.resize(static_cast<std::size_t>(grid.owned()));
  for_bricks(0, grid.owned(), [&](Slot s, Workplace& at) {
    // The nodes' motion is computed again: that costs less than keeping it in memory from one pass to the
    // next.
    move_nodes(s, at);
    sum_contributions<NodeArray::second>(grid, shared_, s, at.sums.data());
    second_velocities(0, at.sums.data(), BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(s).coord),
                      shared_.nodes(), at.nodes.data());
    stress_of_brick(s, Velocities::of_next_step, at);
    move_brick(s, at);
  });
}

void Passes::update_stress_and_map_forces() {
  const BrickGrid& grid = *model_.grid;
  critical_.resize(static_cast<std::size_t>(grid.owned()));
  map_after<Mapped::force>([&](Slot s, Workplace& at) {
    sum_contributions<NodeArray::second>(grid, shared_, s, at.nodes.data());
    second_velocities(grid.geometry().mass_cutoff, at.nodes.data(),
                      BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(s).coord), shared_.nodes(),
                      at.nodes.data());
    stress_of_brick(s, Velocities::of_last_step, at);
  });
}

void Passes::update_velocities_and_move() {
  const BrickGrid& grid = *model_.grid;
  leavers_.resize(static_cast<std::size_t>(grid.owned()));
  for_bricks(0, grid.owned(), [&](Slot s, Workplace& at) {
    sum_contributions<NodeArray::first>(grid, shared_, s,
                                        at.nodes.data());  // forces; momenta and masses are zero
    sum_contributions<NodeArray::second>(grid, shared_, s, at.nodes.data());  // overwrites those
    update_nodes(forces_, dt, grid.geometry().mass_cutoff,
                 BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(s).coord), shared_.nodes(),
                 at.nodes.data());
    velocities_of_brick(s, at);
    // The wave speeds are of the stress pass; each brick's largest stands for all of its particles.
    at.found.fastest =
        std::max(at.found.fastest, critical_[static_cast<std::size_t>(s)] + fastest_of_brick(s, at));
    move_brick(s, at);
  });
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
    stress_of_brick(s, Velocities::of_next_step, at);
    move_brick(s, at);
  });
}

StepFindings Passes::take_findings() {
  StepFindings total;
  for (Workplace& w : workplaces_) {
    total.fastest = std::max(total.fastest, w.found.fastest);
    total.limited += w.found.limited;
    total.events += w.found.events;
    total.work += w.found.work;
    w.found = {};
  }
  return total;
}

}  // namespace mpm::core
