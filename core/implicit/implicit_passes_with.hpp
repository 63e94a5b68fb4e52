// The passes of an implicit step (implicit_passes.hpp) with shape functions S: the class, and its loops over
// bricks, tiles and batches. What the passes do is in the headers included at the end. They use the
// functions' general form, particle by particle: the linear solver takes most of the time. Instantiated in
// make_implicit_passes.cpp.
#pragma once

#include <algorithm>
#include <memory>

#include <omp.h>

#include "core/contact/failed_component.hpp"
#include "core/implicit/implicit_passes.hpp"
#include "core/implicit/site_dilatation.hpp"
#include "core/implicit/stiffness_block.hpp"
#include "core/implicit/stress_response.hpp"
#include "core/simd/denormals.hpp"
#include "core/step/particle_motion.hpp"
#include "core/step/site_averages.hpp"
#include "core/threads.hpp"

namespace mpm::core {

template <ShapePolicy S>
class ImplicitPassesWith final : public ImplicitPasses {
 public:
  ImplicitPassesWith(Model& model, const RigidBodies* rigid, std::span<const int> with_faces,
                     const BrickFields& fields)
      : model_(model),
        rigid_(rigid),
        fields_(fields),
        loads_(model),
        failed_(model),
        averages_(model.scene->solution.averaging == VolumeAveraging::cell),
        differences_(model.scene->solution.implicit && model.scene->solution.implicit->difference_tangent),
        linearised_(model.scene->solution.implicit && model.scene->solution.implicit->linearised()) {
    gives_nothing_.assign(model.bodies.size(), false);
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      gives_nothing_[b] = this->rigid(static_cast<int>(b)) >= 0;
    for (const int b : with_faces) gives_nothing_[static_cast<std::size_t>(b)] = true;
#pragma omp parallel
    flush_denormals_to_zero();
    for (int t = 0; t < omp_get_max_threads(); ++t) scratch_.push_back(std::make_unique<Scratch>());
  }

  const Loads& loads() const override { return loads_; }
  void begin_step(double dt, double part) override {
    dt_ = dt;
    loads_.begin_step(model_.clock.time, dt, part, Loads::VelocityOfStep::mean);
    const auto& input = model_.scene->solution.implicit;
    const double ramp = input ? input->gravity_ramp : 0, now = model_.clock.time + part * dt;
    gravity_ = (ramp > now ? now / ramp : 1.0) * model_.scene->solution.gravity;
  }
  void map_start() override;
  void map_motion() override;
  void map_surface() override;
  void map_lag() override;
  void map_drive() override;
  bool map_forces(const AlignedDoubles& displacements) override;
  void add_tangent(const AlignedDoubles* displacements, const NodeUnknowns& unknowns,
                   BlockMatrix& matrix) override;
  void add_reactions(const AlignedDoubles& impulses) override;
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
  template <class F>
  void for_fields(F f) {
    for_bricks([&](Slot s, Scratch& at) {
      for (const BrickField& field : fields_.of(s)) f(field, at);
    });
  }
  /// f(tile, layout, block, lanes in use), without bodies that give the nodes nothing unless `all`.
  template <class F>
  void for_each_block(const BrickField& field, bool all, F f) {
    for (const ParticleTile& tile : model_.grid->brick(field.slot).tiles) {
      if (!field.has(tile) || (!all && gives_nothing(tile.body))) continue;
      BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
      for (std::size_t b = 0; b < tile.blocks.size(); ++b)
        f(tile, pool.layout(), pool.block(tile.blocks[b]), tile.used_lanes(b));
    }
  }
  /// f(tile, body), without bodies of rigid material unless `all`.
  template <class F>
  void for_each_tile(const BrickField& field, bool all, F f) {
    for (const ParticleTile& tile : model_.grid->brick(field.slot).tiles) {
      if (!field.has(tile)) continue;
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
  template <class W, class F>
  static void add_site_stiffness(Scratch& at, bool structure_alone, double softness, W with_matrix, F flush);
  static double softness_of(const ConstitutiveModel& material);
  template <class Has, class F>
  void map_vectors(Has has, F vector);
  double* clear_contributions(const BrickField& field) const {
    double* contributions = model_.grid->contributions(NodeArray::first, field.slot, field.number);
    std::fill_n(contributions, node_doubles * model_.grid->shape().nodes(), 0.0);
    return contributions;
  }
  void fold(NodeFields what, const BrickField& field, double* contributions) const {
    if constexpr (S::node_block != NodeBlockShape{}) {
      const BoundaryFaces walls(*model_.grid, field.slot);
      if (!walls.none()) walls.fold(what, contributions);
    }
  }
  const double* records(const AlignedDoubles& of, const BrickField& field) const {
    return of.data() + static_cast<std::size_t>(node_doubles * model_.grid->shape().nodes()) * field.index;
  }
  /// Number of the rigid body in contact that is this body; -1: none.
  int rigid(int body) const { return rigid_ == nullptr ? -1 : rigid_->of_body(body); }
  bool gives_nothing(int body) const { return gives_nothing_[static_cast<std::size_t>(body)]; }
  bool prescribed(int body) const { return loads_.motion(body).kind == BodyMotion::Kind::prescribed; }
  ReactionSums& reaction_of(int body, Scratch& at) const {
    std::vector<ReactionSums>& reactions = at.statistics.reactions;
    const std::size_t r = loads_.motion(body).reaction;
    if (reactions.size() <= r) reactions.resize(r + 1);
    return reactions[r];
  }
  /// Adds the motion of a batch of copies, which it moves.
  void find_motion(const ParticleTile& tile, const Body& body, Scratch& at);
  void move_block(const BrickFrame& frame, const ParticleTile& tile, int b, double* block, int used,
                  bool dynamic, bool lags, Scratch& at);
  void move_field(const BrickField& field, const AlignedDoubles& displacements,
                  const AlignedDoubles* velocities, const AlignedDoubles* lags,
                  std::vector<DepartingParticle>& departing, Scratch& at);
  void add_missing_impulses(int body, const Place& place, const ColumnLayout& layout, const double* block,
                            int used, Scratch& at) const;
  static void add_increments(const ColumnLayout& layout, const Place& place, const typename S::Field& of,
                             Column first, double* block);

  Model& model_;
  const RigidBodies* rigid_;
  const BrickFields& fields_;
  Loads loads_;
  FailedComponent failed_;
  Vec3<double> gravity_{};           ///< of this step
  std::vector<bool> gives_nothing_;  ///< by body: to the nodes
  bool averages_;                    ///< volume changes over the particles of a site
  bool differences_;                 ///< derivatives of the stress by differences
  bool linearised_;                  ///< semi-implicit steps
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
      const std::size_t number = first + static_cast<std::size_t>(b);
      double* const block = pool.block(tile.blocks[number]);
      at.places[b].find(frame, pool.layout(), block, tile.used_lanes(number));
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
  if (body.model->rigid()) {
    // Of one that acts at its faces, the field is that of the others around it.
    for (double(&row)[batch_particles] : at.gradient) std::fill_n(row, batch_particles, 0.0);
  } else {
    take_gradients(frame, at);
  }
  const bool averaged = !averages(body) || average_gradients(at);
  return set_midstep_gradient(strains(body, at), at.batch) && averaged;
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
    all.reactions.resize(std::max(all.reactions.size(), mine.reactions.size()));
    for (std::size_t r = 0; r < mine.reactions.size(); ++r) all.reactions[r] += mine.reactions[r];
    mine = {};
  }
  all.undefined = loads_.take_fault();
  return all;
}

}  // namespace mpm::core

#include "core/implicit/averaged_batches.hpp"
#include "core/implicit/forces_of_batches.hpp"
#include "core/implicit/maps_of_blocks.hpp"
#include "core/implicit/motion_of_batches.hpp"
#include "core/implicit/updates_of_batches.hpp"
