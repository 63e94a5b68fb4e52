// The passes of an implicit step (implicit_passes.hpp) with shape functions S. They use the functions'
// general form, particle by particle: the linear solver takes most of the time. Instantiated in
// implicit_passes_<...>.cpp.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>

#include <omp.h>

#include "core/contact/failed_component.hpp"
#include "core/implicit/implicit_passes.hpp"
#include "core/implicit/site_dilatation.hpp"
#include "core/implicit/stiffness_block.hpp"
#include "core/implicit/stress_response.hpp"
#include "core/simd/denormals.hpp"
#include "core/step/grid_to_particles.hpp"
#include "core/step/load_forces.hpp"
#include "core/step/particle_motion.hpp"
#include "core/step/site_averages.hpp"
#include "core/step/speeds.hpp"
#include "core/threads.hpp"

namespace mpm::core {

template <ShapePolicy S>
class ImplicitPassesWith final : public ImplicitPasses {
 public:
  explicit ImplicitPassesWith(Model& model)
      : model_(model),
        loads_(model),
        failed_(model),
        averages_(model.scene->solution.averaging == VolumeAveraging::cell),
        differences_(model.scene->solution.implicit && model.scene->solution.implicit->difference_tangent) {
#pragma omp parallel
    flush_denormals_to_zero();
    for (int t = 0; t < omp_get_max_threads(); ++t) scratch_.push_back(std::make_unique<Scratch>());
  }

  const Loads& loads() const override { return loads_; }
  void begin_step(double dt, double part) override {
    dt_ = dt;
    loads_.begin_step(model_.clock.time, dt, part);
    const auto& input = model_.scene->solution.implicit;
    const double ramp = input ? input->gravity_ramp : 0, now = model_.clock.time + part * dt;
    gravity_ = (ramp > now ? now / ramp : 1.0) * model_.scene->solution.gravity;
  }
  void map_start() override;
  void map_motion() override;
  void map_lag() override;
  bool map_forces(const AlignedDoubles& displacements) override;
  void add_tangent(const AlignedDoubles* displacements, const NodeUnknowns& unknowns,
                   BlockMatrix& matrix) override;
  StepMotion motion_of(const AlignedDoubles& displacements) override;
  void move_particles(const AlignedDoubles& displacements, const AlignedDoubles* velocities,
                      const AlignedDoubles* lags) override;
  std::vector<std::vector<DepartingParticle>>& departing() override { return departing_; }
  StepStatistics take_statistics() override;

 private:
  using Place = typename S::Place;
  static constexpr bool deforms = requires { &S::template deform<Row[9]>; };
  static constexpr bool settles = requires { &S::settle; };

  struct Scratch : ThreadScratch {
    Place places[batch_blocks];
    typename S::Field displacements, velocities, lags;
    Rows9 gradient, stress;
    Rows9 averaged;             ///< gradients with averaged volume changes
    alignas(64) Row volume;     ///< at the start of the step, with averaged volume changes
    SiteDilatation dilatation;  ///< of the current tile
    StressTangent stress_tangent;
    ForceTangent tangent;
    AlignedDoubles copies;  ///< of a batch's blocks
    StiffnessBlock stiffness;
    StepMotion motion;
  };
  /// Whether the batch's blocks are the particles' own or copies.
  enum class Blocks { own, copies };

  template <class F>
  void for_bricks(F f) {
    for_each_by_threads(0, model_.grid->owned(), 1, [&](int s) {
      f(static_cast<Slot>(s), *scratch_[static_cast<std::size_t>(omp_get_thread_num())]);
    });
  }
  /// f(tile, block, body, layout, block, lanes in use)
  template <class F>
  void for_each_block(Slot s, F f) {
    for (const ParticleTile& tile : model_.grid->brick(s).tiles) {
      BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
      for (std::size_t b = 0; b < tile.blocks.size(); ++b)
        f(tile, pool.layout(), pool.block(tile.blocks[b]), tile.used_lanes(b));
    }
  }
  /// f(tile, body), without bodies of rigid material unless `all`.
  template <class F>
  void for_each_tile(Slot s, bool all, F f) {
    for (const ParticleTile& tile : model_.grid->brick(s).tiles) {
      const Body& body = model_.bodies[static_cast<std::size_t>(tile.body)];
      if (all || !body.model->rigid()) f(tile, body);
    }
  }
  template <class F>
  void for_each_batch(const ParticleTile& tile, const BrickFrame& frame, Blocks which, Scratch& at, F f);
  void take_gradients(const BrickFrame& frame, Scratch& at) const;
  /// The gradients and the batch's midstep gradient. False where a particle inverts.
  bool take_strains(const BrickFrame& frame, const Body& body, Scratch& at) const;
  /// What take_strains() gave the laws.
  const Rows9& strains(const Body& body, const Scratch& at) const {
    return averages(body) ? at.averaged : at.gradient;
  }

  // Averaged volume changes (averaged_batches.hpp).
  bool averages(const Body& body) const { return averages_ && !body.model->rigid(); }
  static SiteDilatation::Site& site_of(Scratch& at, int i) {
    return at.dilatation.of(sites_of(at.places[i / block_lanes])[i % block_lanes]);
  }
  void find_dilatations(const ParticleTile& tile, const Body& body, const BrickFrame& frame, Scratch& at);
  static bool average_gradients(Scratch& at);
  void find_site_stress(const ParticleTile& tile, const Body& body, const BrickFrame& frame, Scratch& at);
  template <class F>
  void add_to_nodes(Scratch& at, int i, F f) const;
  void average_stress(Scratch& at) const;
  static void add_site_forces(const Scratch& at, double* contributions);
  void average_tangent(Scratch& at) const;
  void touch_site_nodes(Scratch& at) const;
  template <class F>
  static void add_site_stiffness(Scratch& at, bool structure_alone, F flush);
  double* clear_contributions(Slot s) const {
    double* contributions = model_.grid->contributions(NodeArray::first, s);
    std::fill_n(contributions, node_doubles * model_.grid->shape().nodes(), 0.0);
    return contributions;
  }
  void fold(NodeFields what, Slot s, double* contributions) const {
    if constexpr (S::node_block != NodeBlockShape{}) {
      const BoundaryFaces walls(*model_.grid, s);
      if (!walls.none()) walls.fold(what, contributions);
    }
  }
  const double* records(const AlignedDoubles& of, Slot s) const {
    return of.data() + static_cast<std::size_t>(node_doubles * model_.grid->shape().nodes()) *
                           static_cast<std::size_t>(s);
  }
  bool prescribed(int body) const { return loads_.motion(body).kind == BodyMotion::Kind::prescribed; }
  /// Adds the motion of a batch of copies, which it moves (motion_of_batches.hpp).
  void find_motion(const ParticleTile& tile, const Body& body, Scratch& at);
  void move_block(const BrickFrame& frame, const ParticleTile& tile, int b, double* block, int used,
                  bool dynamic, bool lags, Scratch& at);
  /// Adds S times the nodes' increments to three columns.
  static void add_increments(const ColumnLayout& layout, const Place& place, const typename S::Field& of,
                             Column first, double* block) {
    const typename S::Interpolation gained(place, of.increment());
    for (int a = 0; a < 3; ++a) {
      double* const to = block + layout.offset(next(first, a));
      store(to, load<Lanes<8>>(to) + gained.value[a]);
    }
  }

  Model& model_;
  Loads loads_;
  FailedComponent failed_;
  Vec3<double> gravity_{};  ///< of this step
  bool averages_;           ///< volume changes over the particles of a site
  bool differences_;        ///< derivatives of the stress by differences
  double dt_ = 0;
  std::vector<std::unique_ptr<Scratch>> scratch_;          ///< by thread
  std::vector<std::vector<DepartingParticle>> departing_;  ///< by slot
};

/// f(first block) for every batch, whose places have been found.
template <ShapePolicy S>
template <class F>
void ImplicitPassesWith<S>::for_each_batch(const ParticleTile& tile, const BrickFrame& frame, Blocks which,
                                           Scratch& at, F f) {
  Batch& batch = at.batch;
  batch.time = model_.clock.time + dt_;
  batch.dt = dt_;
  batch.cell_size = model_.grid->geometry().smallest_cell();
  BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
  batch.layout = &pool.layout();
  const auto doubles = static_cast<std::size_t>(block_lanes * pool.layout().columns());
  if (which == Blocks::copies && at.copies.size() < 2 * batch_blocks * doubles)
    at.copies.resize(2 * batch_blocks * doubles);  // and a second copy, for differences
  for (std::size_t first = 0; first < tile.blocks.size(); first += batch_blocks) {
    batch.blocks = static_cast<int>(std::min<std::size_t>(batch_blocks, tile.blocks.size() - first));
    batch.particles =
        static_cast<int>(std::min<std::size_t>(batch_particles, tile.count - block_lanes * first));
    for (int b = 0; b < batch.blocks; ++b) {
      double* const block = pool.block(tile.blocks[first + static_cast<std::size_t>(b)]);
      at.places[b].find(frame, pool.layout(), block);
      batch.block[b] = block;
      batch.background[b] = {};
      if (which == Blocks::own) continue;
      batch.block[b] = at.copies.data() + static_cast<std::size_t>(b) * doubles;
      std::copy_n(block, doubles, batch.block[b]);
    }
    batch.events = {};
    batch.vanishing = batch.negative = 0;
    f(first);
  }
}

/// The displacement gradients of the batch's particles; lanes out of use have none.
template <ShapePolicy S>
void ImplicitPassesWith<S>::take_gradients(const BrickFrame& frame, Scratch& at) const {
  Batch& batch = at.batch;
  for (int b = 0; b < batch.blocks; ++b)
    S::gradient(frame, at.places[b], at.displacements, at.gradient, block_lanes * b);
  for (double(&row)[batch_particles] : at.gradient)
    std::fill(row + batch.particles, row + block_lanes * batch.blocks, 0.0);
}

template <ShapePolicy S>
bool ImplicitPassesWith<S>::take_strains(const BrickFrame& frame, const Body& body, Scratch& at) const {
  take_gradients(frame, at);
  const bool averaged = !averages(body) || average_gradients(at);
  return set_midstep_gradient(strains(body, at), at.batch) && averaged;
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::map_start() {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  const Vec3<double> cell = model_.grid->geometry().cell;
  for_bricks([&](Slot s, Scratch&) {
    const BrickFrame frame(*model_.grid, s);
    double* const contributions = clear_contributions(s);
    for_each_block(s, [&](const ParticleTile& tile, const ColumnLayout& layout, double* block, int used) {
      const Place place(frame, layout, block);
      for (int l = 0; l < used; ++l) {
        const double m = block[layout.offset(Column::mass) + l];
        double per_shape[8] = {0, 0, 0, m, m * gravity_.x, m * gravity_.y, m * gravity_.z, 1};
        for (int a = 0; a < 3; ++a) per_shape[a] = m * block[layout.offset(next(Column::velocity_x, a)) + l];
        S::for_each_node(place, l, inverse_cell,
                         [&](int node, const NodeOffset&, double shape, const Vec3<double>& slope) {
                           double* to = contributions + node_doubles * node;
                           for (int i = 0; i < node_doubles; ++i) to[i] += shape * per_shape[i];
                           to[7] += std::abs(slope.x) * cell.x + std::abs(slope.y) * cell.y +
                                    std::abs(slope.z) * cell.z;
                         });
      }
      if (loads_.act(*model_.grid, s, tile.body))
        add_load_forces<S>(loads_, model_, s, tile.body, place, block, used, contributions);
    });
    fold(mapped::implicit_start, s, contributions);
  });
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::map_motion() {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  for_bricks([&](Slot s, Scratch&) {
    const BrickFrame frame(*model_.grid, s);
    double* const contributions = clear_contributions(s);
    for_each_block(s, [&](const ParticleTile& tile, const ColumnLayout& layout, double* block, int used) {
      const Place place(frame, layout, block);
      const bool moved = prescribed(tile.body);
      const ConstitutiveModel& material = *model_.bodies[static_cast<std::size_t>(tile.body)].model;
      const double c = material.initial_sound_speed(), shear = material.initial_shear_speed();
      // Nodes of cells cut by a surface can move without changing volumes, and a nearly incompressible
      // material should not hinder that with a share of its bulk modulus.
      const double modulus =
          material.reference_density() * (shear > 0 ? std::min(c * c, 4 * shear * shear) : c * c);
      for (int l = 0; l < used; ++l) {
        const double volume = block[layout.offset(Column::volume) + l];
        double per_shape[6] = {0, 0, 0, 0, volume, volume * modulus};
        if (moved) {
          const Vec3<double> v = loads_.motion(tile.body).velocity.velocity(block + l);
          for (int a = 0; a < 3; ++a) per_shape[a] = volume * v[a];
          per_shape[3] = volume;
        }
        for_each_weight<S>(place, l, inverse_cell, [&](int node, double shape) {
          for (int i = 0; i < 6; ++i) contributions[node_doubles * node + i] += shape * per_shape[i];
        });
      }
    });
    fold(mapped::implicit_motion, s, contributions);
  });
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::map_lag() {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  for_bricks([&](Slot s, Scratch&) {
    const BrickFrame frame(*model_.grid, s);
    double* const contributions = clear_contributions(s);
    for_each_block(s, [&](const ParticleTile&, const ColumnLayout& layout, double* block, int used) {
      if (!layout.has(Column::acceleration_lag_x)) return;
      const Place place(frame, layout, block);
      for (int l = 0; l < used; ++l) {
        const double m = block[layout.offset(Column::mass) + l];
        double lag[3];
        for (int a = 0; a < 3; ++a)
          lag[a] = m * dt_ * block[layout.offset(next(Column::acceleration_lag_x, a)) + l];
        for_each_weight<S>(place, l, inverse_cell, [&](int node, double shape) {
          for (int a = 0; a < 3; ++a) contributions[node_doubles * node + a] += shape * lag[a];
        });
      }
    });
    fold(mapped::implicit_lag, s, contributions);
  });
}

template <ShapePolicy S>
bool ImplicitPassesWith<S>::map_forces(const AlignedDoubles& displacements) {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  std::atomic<bool> usable = true;
  for_bricks([&](Slot s, Scratch& at) {
    const BrickFrame frame(*model_.grid, s);
    double* const contributions = clear_contributions(s);
    at.displacements.take_strain(frame, records(displacements, s));
    for_each_tile(s, false, [&](const ParticleTile& tile, const Body& body) {
      if (averages_) find_dilatations(tile, body, frame, at);
      for_each_batch(tile, frame, Blocks::copies, at, [&](std::size_t) {
        Batch& batch = at.batch;
        if (!take_strains(frame, body, at)) usable = false;
        body.model->update(batch, model_.options);
        if (batch.events.not_finite > 0 || batch.events.negative_volume > 0) usable = false;
        if (averages_)
          average_stress(at);
        else
          nodal_stress(at.gradient, batch, at.stress);
        for (int i = 0; i < batch.particles; ++i) {
          double p[9];
          for (int c = 0; c < 9; ++c) p[c] = at.stress[c][i];
          S::for_each_node(at.places[i / block_lanes], i % block_lanes, inverse_cell,
                           [&](int node, const NodeOffset&, double, const Vec3<double>& slope) {
                             double* to = contributions + node_doubles * node;
                             for (int a = 0; a < 3; ++a) {
                               const double force =
                                   p[3 * a] * slope.x + p[3 * a + 1] * slope.y + p[3 * a + 2] * slope.z;
                               to[node_field::force.first + a] -= force;
                               to[node_field::support.first] += std::abs(force);
                             }
                           });
        }
      });
      if (averages_) add_site_forces(at, contributions);
    });
    fold(mapped::implicit_force, s, contributions);
  });
  return usable;
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::add_tangent(const AlignedDoubles* displacements, const NodeUnknowns& unknowns,
                                        BlockMatrix& matrix) {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  std::mutex matrix_lock;
  for_bricks([&](Slot s, Scratch& at) {
    const BrickFrame frame(*model_.grid, s);
    StiffnessBlock& stiffness = at.stiffness;
    stiffness.begin(unknowns.of_brick(s), unknowns.nodes());
    if (displacements != nullptr) at.displacements.take_strain(frame, records(*displacements, s));
    const auto flush = [&] {
      const std::lock_guard one_at_a_time(matrix_lock);
      stiffness.flush(matrix, displacements == nullptr);
    };
    int site = -1;
    for_each_tile(s, false, [&](const ParticleTile& tile, const Body& body) {
      if (averages_ && displacements == nullptr) at.dilatation.begin(model_.grid->shape().nodes());
      if (averages_ && displacements != nullptr) {
        find_dilatations(tile, body, frame, at);
        find_site_stress(tile, body, frame, at);
      }
      for_each_batch(tile, frame, Blocks::copies, at, [&](std::size_t) {
        Batch& batch = at.batch;
        if (displacements != nullptr) {
          take_strains(frame, body, at);
          if (differences_)
            difference_tangent(*body.model, model_.options, batch,
                               at.copies.data() + batch_blocks * block_lanes * batch.layout->columns(),
                               at.stress_tangent);
          else
            body.model->tangent(batch, model_.options, at.stress_tangent);
          body.model->update(batch, model_.options);
          nodal_stress(strains(body, at), batch, at.stress);
          force_tangent(strains(body, at), batch, at.stress, at.stress_tangent, at.tangent);
          if (averages_) average_tangent(at);
        } else if (averages_) {
          touch_site_nodes(at);
        }
        for (int i = 0; i < batch.particles; ++i) {
          const Place& place = at.places[i / block_lanes];
          if (const int here = sites_of(place)[i % block_lanes]; here != site) {
            flush();
            site = here;
          }
          stiffness.begin_particle();
          S::for_each_node(place, i % block_lanes, inverse_cell,
                           [&](int node, const NodeOffset&, double, const Vec3<double>& slope) {
                             stiffness.add_node(node, slope);
                           });
          if (displacements != nullptr)
            stiffness.add_particle([&](int component) { return at.tangent.d[component][i]; });
        }
      });
      if (averages_) {
        flush();
        add_site_stiffness(at, displacements == nullptr, flush);
      }
    });
    flush();
  });
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::move_block(const BrickFrame& frame, const ParticleTile& tile, int b,
                                       double* block, int used, bool dynamic, bool lags, Scratch& at) {
  const ColumnLayout& layout = *at.batch.layout;
  const Place& place = at.places[b];
  const auto velocity = [&](int a) { return block + layout.offset(next(Column::velocity_x, a)); };
  const bool moved = prescribed(tile.body);
  if (moved) {
    const PrescribedMotion& motion = loads_.motion(tile.body).velocity;
    for (int l = 0; l < used; ++l) {
      const Vec3<double> v = motion.velocity(block + l);
      for (int a = 0; a < 3; ++a) {
        // The constraint supplies the kinetic energy.
        double& now = velocity(a)[l];
        at.work += 0.5 * block[layout.offset(Column::mass) + l] * (v[a] * v[a] - now * now);
        now = v[a];
      }
    }
  } else if (dynamic) {
    add_increments(layout, place, at.velocities, Column::velocity_x, block);
    if (lags && layout.has(Column::acceleration_lag_x))
      add_increments(layout, place, at.lags, Column::acceleration_lag_x, block);
  } else {
    std::fill_n(velocity(0), 3 * block_lanes, 0.0);
  }
  const MotionOfBlock<S> motion{place, at.displacements};
  if (moved)
    move_at_own_velocity(layout, dt_, block);
  else
    motion.move(layout, 1.0, block);
  if constexpr (settles) motion.carry(layout, 1.0, block);
  if constexpr (deforms)
    at.statistics.domains += S::deform(frame, layout, at.gradient, block_lanes * b, 1.0, block, used);
  if constexpr (settles) at.statistics.domains += S::settle(frame, layout, !moved, block, used);
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::move_particles(const AlignedDoubles& displacements,
                                           const AlignedDoubles* velocities, const AlignedDoubles* lags) {
  departing_.resize(static_cast<std::size_t>(model_.grid->owned()));
  for_bricks([&](Slot s, Scratch& at) {
    const BrickFrame frame(*model_.grid, s);
    auto& departing = departing_[static_cast<std::size_t>(s)];
    departing.clear();
    at.displacements.take_strain(frame, records(displacements, s));
    at.displacements.take_motion(records(displacements, s));
    if (velocities != nullptr) at.velocities.take_motion(records(*velocities, s));
    if (lags != nullptr) at.lags.take_motion(records(*lags, s));
    for_each_tile(s, true, [&](const ParticleTile& tile, const Body& body) {
      if (averages(body)) find_dilatations(tile, body, frame, at);
      for_each_batch(tile, frame, Blocks::own, at, [&](std::size_t first) {
        Batch& batch = at.batch;
        take_strains(frame, body, at);
        for (int b = 0; b < batch.blocks; ++b)
          move_block(frame, tile, b, batch.block[b], tile.used_lanes(first + static_cast<std::size_t>(b)),
                     velocities != nullptr, lags != nullptr, at);
        body.model->update(batch, model_.options);
        at.statistics.events += batch.events;
        if (batch.layout->has(Column::sound_speed)) {
          for (int b = 0; b < batch.blocks; ++b)
            std::copy_n(batch.sound_speed + block_lanes * b, block_lanes,
                        batch.column(Column::sound_speed, b));
        }
        at.statistics.fastest = fastest_particle(batch, 1 / wave_limit(*model_.scene), at.statistics.fastest);
        const auto c = static_cast<int>(&tile - model_.grid->brick(s).tiles.data());
        for (int b = 0; b < batch.blocks; ++b) {
          const std::size_t at_block = first + static_cast<std::size_t>(b);
          find_departing(c, at_block, frame, 0, failed_.of(tile), *batch.layout, batch.block[b],
                         tile.used_lanes(at_block), departing);
        }
      });
    });
    at.add_work_of_brick();
  });
}

template <ShapePolicy S>
StepStatistics ImplicitPassesWith<S>::take_statistics() {
  StepStatistics all;
  for (const auto& w : scratch_) {
    StepStatistics& mine = w->statistics;
    all.fastest = std::max(all.fastest, mine.fastest);
    all.domains += mine.domains;
    all.events += mine.events;
    all.work += mine.work;
    mine = {};
  }
  all.undefined = loads_.take_fault();
  return all;
}

}  // namespace mpm::core

#include "core/implicit/averaged_batches.hpp"
#include "core/implicit/motion_of_batches.hpp"
