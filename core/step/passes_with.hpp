// The passes (passes.hpp) with shape functions S and transfer T. scheme_passes.hpp has what each does in
// which order, brick by brick; operations on a brick, a block or a batch are functions of their own
// (map_operations.hpp, brick_operations.hpp, contact_operations.hpp, correct_velocities.hpp, solve_mass.hpp,
// mass_products.hpp);
// brick_order.hpp has the order of bricks and blocks and the prefetching. Instantiated once per pair
// (passes_<shape>.cpp), through make_passes_with alone: the compiler inlines members of a class template that
// is instantiated explicitly less freely (5 % of MUSL's time).
#pragma once

#include <cmath>
#include <limits>
#include <tuple>

#include <omp.h>

#include "core/contact/contact.hpp"
#include "core/shape/cell_mass.hpp"
#include "core/shape/cells_of_particles.hpp"
#include "core/shape/face_traps.hpp"
#include "core/simd/denormals.hpp"
#include "core/step/cells_in_use.hpp"
#include "core/step/conduction.hpp"
#include "core/step/grid_to_particles.hpp"
#include "core/step/load_forces.hpp"
#include "core/step/mass_solution.hpp"
#include "core/step/particle_motion.hpp"
#include "core/step/particles_to_grid.hpp"
#include "core/step/pass_traits.hpp"
#include "core/step/passes.hpp"
#include "core/step/prefetch.hpp"
#include "core/step/shared_nodes.hpp"
#include "core/step/site_averages.hpp"
#include "core/step/sparse_bricks.hpp"
#include "core/step/speeds.hpp"
#include "core/step/strain_limit.hpp"
#include "core/threads.hpp"
#include "core/transfer/consistent.hpp"
#include "core/transfer/corrected.hpp"

namespace mpm::core {

template <ShapePolicy S, TransferPolicy T>
class PassesWith final : public Passes {
 public:
  PassesWith(Model& model, NodeHalo& halo, RigidBodies* rigid);

  const Loads& loads() const override { return loads_; }
  void begin_step(const StepLength& length) override {
    set_step(length);
    if (rigid_ != nullptr) rigid_->begin_step(loads_, forces_.gravity, length);
    if (selects_) sparse_.begin_step(*model_.grid);
    follows_grid_ = follow_grid();
    if (!contact_) begin_fields();
  }
  double largest_strain_rate(double above) override;
  void shorten_step(const StepLength& length) override {
    set_step(length);
    if (rigid_ != nullptr) rigid_->shorten_step(loads_, forces_.gravity, length);
    if (contact_) tell_contact_of_transfer();
  }

  void find_fields(Reductions& ranks) override {
    contact_->find_fields(*model_.grid, halo_, ranks);
    begin_fields();
    tell_contact_of_transfer();
  }
  void map_surfaces() override;
  void find_meetings() override;
  void map_reach() override;
  void drop_distant_pairs() override;
  void find_rigid_motion() override;
  void correct_rigid_motion() override;
  void move_rigid_bodies() override;
  void map_momentum_mass_force() override { map_to_grid<mapped::momentum_mass_force>(); }
  void map_momentum_mass() override { map_to_grid<mapped::start>(); }
  bool needs_forces_at_start() const override { return model_.grid->arrays().has(NodeArray::seventh); }
  void map_forces_at_start() override { map_to_grid<mapped::start_force>(); }
  void finish_exchange() override { halo_.end(*model_.grid); }
  void correct_velocities(int order) override;
  void finish_correction() override {
    if (correcting_) halo_.end(*model_.grid);
  }
  void solve_mass(MassSystem system) override;
  void update_velocities_and_map_back() override;
  void update_stress_and_move() override;
  void update_stress_and_map_forces() override;
  void update_velocities_and_move() override;
  void update_all() override;

  std::vector<std::vector<DepartingParticle>>& departing() override { return departing_; }
  StepStatistics take_statistics() override;

 private:
  using Place = typename S::Place;
  using Traits = PassTraits<S, T>;
  struct Nothing {};
  /// Of an update of the stresses: its length and end, and the time over its length by which the internal
  /// energy is then ahead of the kinetic one.
  struct StrainInterval {
    double dt = 0, end = 0, lead = 0;
    StrainPart part = StrainPart::all;
  };
  struct Scratch : ThreadScratch {
    Place places[batch_blocks];
    typename S::Field field;
    CellsOfParticles cells;                    ///< of the current brick
    std::vector<FieldNodes> fields;            ///< where components meet
    std::vector<FieldNodes> corrected_fields;  ///< the same with v(m), or solved ones, as strain velocities
    std::vector<double> orders;                ///< a copy of the sums of one of them
    RegressionScratch regression;
    ContactSums contact;
    std::vector<RigidNode> rigid_nodes;
    SiteAverages averages;   ///< of the current tile; empty where volume changes are not averaged
    double strain_rate = 0;  ///< largest of the thread's bricks
    std::tuple<CarriedSums<NodeArray::first>, CarriedSums<NodeArray::second>, CarriedSums<NodeArray::third>,
               CarriedSums<NodeArray::sixth>, CarriedSums<NodeArray::seventh>>
        carried;  ///< of this pass
    [[no_unique_address]] std::conditional_t<Traits::corrects || Traits::solves, typename S::Field, Nothing>
        corrected;
  };

  /// Once the velocity fields of the step are known.
  void begin_fields() {
    begin_mass();
    begin_corrections();
  }
  void set_step(const StepLength& length) {
    dt = length.dt;
    velocity_dt = length.velocity_dt;
    strain_lag_ = length.strain_lag;
    lag_ = length.lag;
    transfer_step_ = {dt / (wave_weight_ * model_.clock.critical_dt)};
    loads_.begin_step(model_.clock.time, dt, length.load_part);
  }

  /// USAVG's update at the start of a step completes that of the step before, with the velocities of then.
  StrainInterval interval_at_start() const;
  StrainInterval interval_at_end() const;

  /// The number of leading columns that passes read up to the stress; up to the mass below.
  static constexpr int columns_to_stress = static_cast<int>(Column::viscous_pressure) + 1;
  static constexpr int columns_to_mass = static_cast<int>(Column::mass) + 1;

  void tell_contact_of_transfer() {
    const double share = Traits::corrects && !correcting_ ? Flip::share_of_nodes(transfer_step_)
                                                          : transfer_.share_of_nodes(transfer_step_);
    contact_->set_transfer({share, correcting_, moves_corrected()});
  }

  // Order of bricks and blocks.
  template <class F>
  void for_bricks(int first, int last, F f);
  template <class F>
  void for_each_block(Slot s, std::int32_t component, int columns, F f);
  template <class E, class F, class G>
  void for_each_batch(Slot s, std::int32_t component, const BrickFrame& frame, Scratch& at, E tile_work,
                      F block_work, G batch_work);
  bool holds(const ParticleTile& tile, std::int32_t component) const {
    return component == all_components || tile.component == component;
  }
  /// Place of the field number `k` of those that a brick sees, among those of all owned bricks.
  std::size_t seen_index(Slot s, std::size_t k) const {
    return (contact_ ? contact_->first_seen(s) : static_cast<std::size_t>(s)) + k;
  }
  std::size_t seen_fields() const {
    return contact_ ? contact_->all_seen() : static_cast<std::size_t>(model_.grid->owned());
  }
  /// Whether a brick sees nodes where fields meet.
  bool has_meetings(Slot s) const {
    return contact_ && contact_->meets(s) && !contact_->meetings(s).nodes.empty();
  }
  /// Velocity field of a component in a brick that holds particles of it.
  int field_of(Slot s, std::int32_t component) const {
    return component == all_components ? 0 : model_.grid->field_of(s, component);
  }
  template <class F>
  void for_each_own_field(Slot s, F f);
  template <class F>
  void for_each_seen_field(Slot s, F f);
  std::int32_t own_component(Slot s, std::int32_t component) const;
  std::size_t seen_number(Slot s, std::int32_t component) const;
  template <class Update, class F>
  void for_each_field(Slot s, Scratch& at, Contact::Velocity which, Update update, F f);
  template <class Update>
  void take_fields(Slot s, Scratch& at, Update update);
  void take_free_fields(Slot s, Scratch& at);
  void take_fields_of_end(Slot s, Scratch& at);
  template <class Update>
  void meet(Slot s, Scratch& at, Contact::Velocity which, Update update);
  void book_blows(Slot s, const FieldNodes& field, Scratch& at);
  void keep_motion_of_others(Slot s, const Scratch& at);
  /// Of `some` nodes alone, if not null.
  template <NodeArray of>
  void sum(const SharedNodes& shared, Slot s, std::int32_t component, Scratch& at, double* sums,
           const NodeMask* some = nullptr) const {
    if (some != nullptr)
      sum_contributions<of>(*model_.grid, shared, s, *some, sums);
    else if (component == all_components)
      sum_contributions(*model_.grid, shared, s, std::get<CarriedSums<of>>(at.carried), sums);
    else
      sum_contributions<of>(*model_.grid, shared, s, component, sums);
  }
  /// Momentum and mass at the start of the step, where a scheme maps them before the forces.
  void sum_start(Slot s, std::int32_t component, Scratch& at, double* sums, const NodeMask* some = nullptr) {
    sum<NodeArray::sixth>(momentum_shared_, s, component, at, sums, some);
  }
  /// The same to strain with: without what rigid walls hold.
  void sum_start_held(Slot s, std::int32_t component, Scratch& at, double* sums,
                      const NodeMask* some = nullptr);
  template <NodeFields what, class F>
  void map_bricks(F work);

  template <class F>
  void find_rigid_motion(RigidStage stage, F take_nodes);

  // Operations on a brick.
  template <NodeFields what>
  void map_to_grid();
  void find_reached(Slot s);
  double erosion_volume(int body) const {
    return model_.bodies[static_cast<std::size_t>(body)].rigid ? 0.0 : erosion_volume_;
  }
  bool has_few_particles(Slot s) const {
    if (!selects_) return false;
    std::size_t particles = 0;
    for (const ParticleTile& tile : model_.grid->brick(s).tiles) particles += tile.count;
    return particles <= SparseBricks::most_particles(S::node_block, S::nodes_per_axis);
  }
  /// The nodes that the particles of a brick reach; null: all of them.
  const NodeMask* reached(Slot s) const {
    if constexpr (Traits::selects)
      return selects_ && s < model_.grid->owned() ? sparse_.reached(s) : nullptr;
    else
      return nullptr;
  }
  template <NodeFields what, class F>
  void map_brick(Slot s, std::int32_t component, Scratch& at, F before);
  /// Of a velocity field in a brick: the acceleration by loads that its bodies have in common, or that their
  /// particles map it.
  struct Weight {
    Vec3<double> acceleration{};
    bool by_particle = false;
  };
  template <NodeFields what, class Scatter, class F>
  void map_tile(Slot s, std::size_t c, const BrickFrame& frame, Scratch& at, const Weight& weight,
                double* contributions, SpreadPrefetch& room, Scatter& running, double* records, F before);
  void map_surface(Slot s, std::int32_t component);
  void map_reach(Slot s, std::int32_t component);
  Weight weight_of(Slot s, std::int32_t component) const;
  template <NodeFields what>
  void add_weight(Slot s, int field, const Vec3<double>& acceleration, double* contributions);
  template <NodeArray of>
  void sum_fields(Slot s, Scratch& at);
  void sum_and_update_nodes(Slot s, std::int32_t component, Scratch& at);
  /// Whether a brick's field takes its strain velocities as momenta and masses: where nothing changes them.
  bool takes_momenta(Slot s) const { return Traits::takes_momenta && !contact_ && faces(s).none(); }
  void take_strain(Slot s, std::int32_t component, const double* momenta, Scratch& at);
  void take_updated_nodes(Slot s, std::int32_t component, std::size_t k, Scratch& at);
  void velocities_of_brick(Slot s, std::int32_t component, Scratch& at);
  double velocities_and_motion_of_brick(Slot s, std::int32_t component, Scratch& at);
  void find_departing(Slot s, std::size_t c, std::size_t b, const BrickFrame& frame,
                      const ColumnLayout& layout, const double* block, Scratch& at);
  void keep_own_cells(Slot s, Scratch& at);
  template <bool moves, class F>
  void stress_of_brick(Slot s, std::int32_t component, Scratch& at, F prefetch_nodes);

  // Corrections of the velocities (correct_velocities.hpp).
  void begin_corrections();
  void add_order(Slot s, int order, std::int32_t component, std::size_t k, Scratch& at);
  void add_order(Slot s, int order, std::int32_t component, Scratch& at, double* to);
  void begin_orders(Slot s, Scratch& at);
  template <class F>
  void take_corrected_fields(Slot s, Scratch& at, F sums);
  void meet_corrected(Slot s, Scratch& at);
  /// The nodes' sums of velocities v(l) of the field number `k` of those that the brick sees, in
  /// MotionRecords.
  double* corrected_nodes(Slot s, std::size_t k) {
    return corrected_.data() + static_cast<std::size_t>(record_count()) * seen_index(s, k);
  }
  /// Doubles of a brick's node records.
  int record_count() const { return node_doubles * shared_.nodes(); }

  // Solutions with the consistent mass matrix (solve_mass.hpp).
  void begin_mass();
  void take_lumped_motion(Slot s, std::int32_t component, std::size_t k, Scratch& at);
  void begin_solution(Slot s, MassSystem system, std::int32_t component, std::size_t k, Scratch& at);
  void end_solution(Slot s, MassSystem system, std::size_t k);
  void take_solved_motion(Slot s, std::size_t k, Scratch& at);
  void take_solved_strain(Slot s, std::size_t k, Scratch& at);
  void move_with_strain(Scratch& at);
  void meet_solved(Slot s, Scratch& at);
  /// Whether the velocities at the end of the step are solved for, too: USF moves particles with them, and
  /// loads do their work on them.
  bool solves_velocities() const { return scheme_ == Scheme::usf || loads_.any(); }
  /// The records (mass_solution.hpp) of the field number `k` of those that the brick sees.
  double* solution(Slot s, std::size_t k) {
    return solution_.data() + static_cast<std::size_t>(record_count()) * seen_index(s, k);
  }
  double* direction(Slot s, std::size_t k) {
    return direction_.data() + static_cast<std::size_t>(record_count()) * seen_index(s, k);
  }

  // Products with the mass matrix, for both (mass_products.hpp).
  using ProductSums = typename S::template Sums<mapped::correction>;
  void begin_products();
  void sum_cell_masses(Slot s, std::int32_t component, double* moments);
  void add_product_by_cells(Slot s, std::int32_t component, Scratch& at, ProductSums& to);
  void add_product_by_particles(Slot s, std::int32_t component, const Scratch& at, ProductSums& to);
  void map_product(Slot s, std::int32_t component, const double* increments, Scratch& at);
  /// The moments of the field number `k` of those that the brick sees.
  double* cell_masses(Slot s, std::size_t k) {
    return cell_masses_.data() + static_cast<std::size_t>(cell_mass::brick_doubles) * seen_index(s, k);
  }

  /// Whether particles move with the corrected velocities in this step.
  bool moves_corrected() const {
    if constexpr (Traits::corrects) return correcting_ && transfer_.of_end;
    return false;
  }
  /// The same as a field. MUSL and USAVG move particles in a later pass, by the motion kept for it.
  const typename S::Field& moving_field(const Scratch& at) const;
  /// The nodes' velocities and masses that move a brick's particles of the field number `k`.
  const double* moving_nodes(Slot s, std::size_t k, const Scratch& at) {
    return moves_corrected() ? corrected_nodes(s, k) : at.nodes.data();
  }

  /// Number of the rigid body in contact that is this body; -1: its particles move with the grid or alone.
  int rigid(int body) const { return rigid_ == nullptr ? -1 : rigid_->of_body(body); }

  // Operations on a block or a batch.
  void take_velocities(const BrickFrame& frame, const Place& place, const ColumnLayout& layout, double* block,
                       Scratch& at) const;
  /// Whether all particles take velocities and places from the grid, and nothing else does work on them.
  bool follow_grid() const;
  void update_velocities(Slot s, const BrickFrame& frame, int body, const Place& place, double* block,
                         int used, Scratch& at);
  void update_velocities_apart(Slot s, const BrickFrame& frame, int body, const Place& place, double* block,
                               int used, Scratch& at);
  void move(int body, const MotionOfBlock<S>& motion, double* block, int used, Scratch& at);
  void update_domains(int body, const BrickFrame& frame, const ColumnLayout& layout, int b, double* block,
                      int used, Scratch& at);
  void sum_pressures(const BrickFrame& frame, const ParticleTile& tile, SiteAverages& to) const;
  template <bool moves>
  void sum_volume_changes(const BrickFrame& frame, const ParticleTile& tile, Scratch& at) const;
  void volumetric_strain(const BrickFrame& frame, const Place& place, int b, Scratch& at);
  void update_material(const Body& body, Scratch& at);

  /// Of strains at new positions, by how volumes are updated from them.
  ReferredTrace referred_trace() const;
  bool updates_volume_by_cell() const {
    return model_.options.volume_update == static_cast<int>(VolumeUpdate::cell);
  }
  /// Rate at which pressures inside a site become equal, and the modulus with which they do; rate 0: they do
  /// not.
  struct PressureRelaxation {
    double rate = 0, modulus = 0;
  };
  PressureRelaxation relaxation_of(const Body& body) const;
  bool averages_volume_change() const { return model_.scene->solution.averaging == VolumeAveraging::cell; }
  BoundaryFaces faces(Slot s) const { return {*model_.grid, s}; }
  BrickFrame frame(Slot s, std::int32_t component = all_components) const {
    return {*model_.grid, s, field_of(s, component)};
  }
  /// Prefetches the contributions to the next brick's nodes while this brick's blocks are processed.
  template <NodeArray of>
  [[gnu::always_inline]] ContributionPrefetch<of> prefetch_nodes(Slot s) const {
    const BrickGrid& grid = *model_.grid;
    const Slot next = reached(s + 1) == nullptr ? s + 1 : grid.owned();
    return {grid, of == NodeArray::first ? moving_shared_ : shared<of>(), next, block_count(grid.brick(s))};
  }
  /// The first array and the seventh hold forces.
  template <NodeArray of>
  const SharedNodes& shared() const {
    return of == NodeArray::first || of == NodeArray::seventh ? shared_ : momentum_shared_;
  }
  int motion_doubles() const {
    if constexpr (Traits::can_keep_field)
      if (keeps_field_) return S::Field::kept_doubles;
    return motion_width * moving_shared_.summed().nodes();
  }
  /// Of the field number `k` of those that the brick sees.
  double* motion(Slot s, std::size_t k = 0) {
    return motion_.data() + static_cast<std::size_t>(motion_doubles()) * seen_index(s, k);
  }
  /// Prefetches the next brick's stored nodal motion.
  SpreadPrefetch prefetch_motion(Slot s) {
    const BrickGrid& grid = *model_.grid;
    const bool all = s + 1 < grid.owned() && reached(s + 1) == nullptr;
    return {all ? motion(s + 1) : nullptr, motion_doubles(), block_count(grid.brick(s))};
  }

  Model& model_;
  NodeHalo& halo_;
  RigidBodies* rigid_;  ///< in contact; null without
  SharedNodes shared_;
  SharedNodes momentum_shared_;
  SharedNodes moving_shared_;  ///< of the first array, where the nodes' motion is found
  const bool keeps_field_;     ///< in motion()
  const bool selects_;         ///< selects_nodes()
  SparseBricks sparse_;
  NodeForces forces_;
  Loads loads_;
  std::unique_ptr<Contact> contact_;  ///< null without contact
  FailedComponent failed_;
  T transfer_;
  const Scheme scheme_;
  const int orders_;
  bool correcting_ = false;    ///< in this step
  bool follows_grid_ = false;  ///< follow_grid() in this step
  TransferStep transfer_step_;
  double dt = 0, velocity_dt = 0, strain_lag_ = 0, lag_ = 0;  ///< of the current step: StepLength
  StrainInterval strain_;                                     ///< of this pass
  double velocity_limit_;                                     ///< infinite without LimitVelocity
  double erosion_volume_;                                     ///< of deformable bodies
  double wave_weight_;                                        ///< of wave speeds in the critical step
  std::vector<Scratch> scratch_;                              ///< by thread
  std::vector<std::vector<DepartingParticle>> departing_;     ///< by slot
  /// By slot; MUSL: nodal motion, kept between the passes that update the nodes and move the particles.
  AlignedDoubles motion_;
  AlignedDoubles corrected_;    ///< XPIC, FMPM: corrected_nodes()
  AlignedDoubles solution_;     ///< consistent mass: solution()
  const bool by_cells_;         ///< multiplies_by_cells()
  AlignedDoubles cell_masses_;  ///< where by_cells_: cell_masses()
  bool masses_known_ = false;   ///< in this step
  AlignedDoubles direction_;    ///< consistent mass: direction()
  /// Whether the velocities' ranges tell in which bricks the strain may jump: with affine transfers nodes
  /// have velocities beyond those of the particles.
  const bool finds_ranges_;
  std::vector<VelocityRange> ranges_;  ///< by owned slot, at the start of the step
  std::vector<double> critical_;       ///< by slot; USF: largest critical speed of the stress pass
};

/// Share of a full cell's mass below which a node's increment is scaled down in USL's strain rate. The nodal
/// acceleration f/m grows without bound as a particle enters a cell (thesis 2-49); its effect on the
/// particle's velocity stays bounded, that on its strain does not. Below 0.05 the Taylor bar still diverges;
/// at 1 the scaling excites oscillations; 0.2 works for time step factors up to 0.7.
inline constexpr double usl_mass_floor = 0.2;

template <ShapePolicy S, TransferPolicy T>
PassesWith<S, T>::PassesWith(Model& model, NodeHalo& halo, RigidBodies* rigid)
    : model_(model),
      halo_(halo),
      rigid_(rigid),
      shared_(model.grid->shape()),
      momentum_shared_(model.grid->shape(), momentum_block<S>),
      moving_shared_(model.grid->shape(), model.grid->shape(), Traits::moving_block(model)),
      keeps_field_(Traits::can_keep_field && !Traits::moves_all_nodes(model)),
      selects_(Traits::selects_nodes(model)),
      loads_(model),
      failed_(model),
      transfer_(model.scene->solution),
      scheme_(model.scheme),
      orders_(orders_of(model.scene->solution)),
      by_cells_(multiplies_by_cells<S>(model.scene->solution)),
      finds_ranges_(strain_may_jump(model) && !is_affine(model.scene->solution.transfer)) {
  const SolutionInput& solution = model.scene->solution;
  forces_.gravity = solution.gravity;
  forces_.damping = solution.damping;
  if (scheme_ == Scheme::usl) {
    // The lightest material's density: a floor above the mass of a light body's full nodes would freeze that
    // body beside a heavy one.
    double density = std::numeric_limits<double>::infinity();
    for (const Body& b : model.bodies) density = std::min(density, b.model->reference_density());
    forces_.strain_mass_floor = usl_mass_floor * density * model.grid->geometry().cell_volume();
  }
  velocity_limit_ = solution.limit_velocity.value_or(std::numeric_limits<double>::infinity());
  erosion_volume_ = solution.volume.erode.value_or(0);
  wave_weight_ = 1 / wave_limit(model);
  if (model.scene->contact.enable) contact_ = std::make_unique<Contact>(model, rigid);
#pragma omp parallel
  flush_denormals_to_zero();
  scratch_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  for (Scratch& w : scratch_) {
    w.nodes.resize(static_cast<std::size_t>(node_doubles * model.grid->shape().nodes()));
    w.sums.resize(w.nodes.size());
    if (averages_volume_change()) w.averages.resize(model.grid->shape().nodes());
  }
}

}  // namespace mpm::core

#include "core/step/brick_operations.hpp"
#include "core/step/brick_order.hpp"
#include "core/step/contact_operations.hpp"
#include "core/step/correct_velocities.hpp"
#include "core/step/map_operations.hpp"
#include "core/step/mass_products.hpp"
#include "core/step/scheme_passes.hpp"
#include "core/step/solve_mass.hpp"

namespace mpm::core {

template <class S, class T>
std::unique_ptr<Passes> make_passes_with(Model& model, NodeHalo& halo, RigidBodies* rigid) {
  return std::make_unique<PassesWith<S, T>>(model, halo, rigid);
}

}  // namespace mpm::core
