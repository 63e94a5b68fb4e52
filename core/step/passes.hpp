// The passes over bricks that a time step is made of. Each is one loop over this rank's bricks, shared by its
// threads; a scheme is a list of them (schemes.cpp). A brick is worked on by one thread from its first
// particle to its last, so sums inside it have one order.
#pragma once

#include <vector>

#include "core/model.hpp"
#include "core/step/ahead.hpp"
#include "core/step/exchange.hpp"
#include "core/step/grid_to_particles.hpp"
#include "core/step/loads.hpp"
#include "core/step/node_update.hpp"
#include "core/step/particles_to_grid.hpp"
#include "core/step/witness.hpp"

namespace mpm::core {

/// A particle that does not stay where it is.
struct Leaver {
  int cohort = 0;
  std::uint32_t index = 0;
  bool eroded = false;  ///< to be deleted; otherwise it has left its brick
};

/// What a rank learns in the course of a step, to be agreed with the others at its end.
struct StepFindings {
  double fastest = 0;        ///< largest (Q + sqrt(Q^2 + c^2)) + |v| of any particle, length/time
  std::int64_t limited = 0;  ///< velocities held by LimitVelocity
  MaterialEvents events;
  Witnesses vanishing, negative;  ///< particles of negative volume and energy, where the scene watches them
  ExactSum work;                  ///< external work
};

class Passes {
 public:
  Passes(Model& model, Exchange& exchange);

  /// Every step begins with this: its length, and the loads that act in it.
  void begin_step(double length) {
    dt = length;
    if (loads_.any()) loads_.begin_step(model_, model_.clock.time, dt);
  }

  const Loads& loads() const { return loads_; }

  /// Particles to grid; those of other ranks' interest first, whose sums are on their way when this returns.
  template <Mapped what>
  void map_to_grid();
  void finish_exchange() { exchange_.end_halo(*model_.grid); }

  /// MUSL: equation of motion on the nodes, v += dv, and the new momentum back to the nodes.
  void update_velocities_and_map_back();
  /// MUSL: strain with the re-mapped velocity, stress, then move.
  void update_stress_and_move();

  /// USF: strain with the velocity before the motion, stress, and its forces to the nodes.
  void update_stress_and_map_forces();
  /// USF: equation of motion with the new stress, v += dv, then move.
  void update_velocities_and_move();

  /// USL: equation of motion, strain and stress, v += dv, then move.
  void update_all();

  std::vector<std::vector<Leaver>>& leavers() { return leavers_; }
  /// What was found since the last call, over all threads.
  StepFindings take_findings();

 private:
  struct alignas(128) Workplace {  // of one thread
    Batch batch;
    StepFindings found;
    double work = 0;  ///< external, of the brick at hand
    alignas(64) double before[3 * block_lanes];
    BlockPlace places[batch_blocks];
    AlignedDoubles nodes, sums;  ///< of the brick at hand: records of node_doubles, each a cache line
    void book_work() {
      if (work != 0) found.work.add(work);
      work = 0;
    }
  };
  template <class F>
  void for_bricks(int first, int last, F f);

  /// Sum the first array and move the nodes: `at.nodes` as grid_to_particles.hpp describes.
  void move_nodes(Slot s, Workplace& at);
  /// before(body, place, block, used) for every block, then its share of the nodes.
  template <Mapped what, class F>
  void map_brick(Slot s, F before);
  template <Mapped what, class F>
  void map_bricks(F work);
  void kick(Slot s, const Body& body, const BlockPlace& place, double* block, int used, Workplace& at);
  /// The velocity of a rigid body that nothing guides.
  void fly_on(const Body& body, const BlockPlace& place, double* block, int used, Workplace& at);
  void hold_velocities(const Body& body, double* block, int used, Workplace& at);
  void velocities_of_brick(Slot s, Workplace& at);
  double kick_and_move(Slot s, Workplace& at);
  int number_of(const Body& body) const { return static_cast<int>(&body - model_.bodies.data()); }
  /// Whether the particles' velocities are already those with which the next step begins.
  enum class Velocities { of_last_step, of_next_step };
  /// ask_for_nodes() is called once per block, to bring what the next brick's nodes are made of.
  template <bool moves, class F>
  void stress_of_brick(Slot s, Velocities velocities, Workplace& at, F ask_for_nodes);
  int motion_doubles() const { return motion_width * shared_.nodes(); }
  double* motion(Slot s);
  template <NodeArray of>
  ContributionsAhead<of> nodes_ahead(Slot s) const;
  RoomAhead motion_ahead(Slot s);
  void move(const Body& body, const BlockPlace& place, double* block, int used, Workplace& at);
  void note_unphysical(const Body& body, const Batch& batch, StepFindings& found) const;
  void book_motion(const ColumnLayout& layout, const double* block, int used, Workplace& at) const;
  void note_leavers(Slot s, std::size_t cohort, std::size_t b, const BrickFrame& frame,
                    const ColumnLayout& layout, const double* block, int used);

  Model& model_;
  Exchange& exchange_;
  SharedNodes shared_;
  NodeForces forces_;
  Loads loads_;
  double dt = 0;           ///< of the step under way
  double velocity_limit_;  ///< infinite without LimitVelocity
  double erosion_volume_;
  std::vector<Workplace> workplaces_;
  std::vector<std::vector<Leaver>> leavers_;  ///< by slot
  /// By slot; MUSL: the nodes' motion, kept between the passes that move them and the particles on them.
  AlignedDoubles motion_;
  std::vector<double> critical_;  ///< by slot; USF: largest critical speed of the stress pass
};

}  // namespace mpm::core
