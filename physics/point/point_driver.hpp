// One particle of a material, driven along a path without a grid, by the same batch update as in a run. For
// calibration (mpm_point) and for the tests of the laws. No input or output here.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/material/constitutive_model.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::physics {

class PointDriver {
 public:
  using Update = std::function<void(core::Batch&, const core::UpdateOptions&)>;
  struct Options {
    double density = 0;      ///< at the start; 0: the reference density
    double temperature = 0;  ///< at the start; 0: the material's
    double cell_size = 0;    ///< length of the artificial viscosity; 0: none
    core::UpdateOptions update{};
    core::ColumnSet extra_columns{};  ///< in addition to the material's, e.g. yield_stress
  };

  PointDriver(const core::ConstitutiveModel& model, const Options& options);
  /// With another update instead of model.update, for the comparison of value types.
  PointDriver(const core::ConstitutiveModel& model, const Options& options, Update update);
  PointDriver(const PointDriver&) = delete;  // the batch points into the particle's block
  PointDriver& operator=(const PointDriver&) = delete;

  /// One step with the velocity gradient at midstep. Units 1/time and time.
  void step(const core::Mat3<double>& gradient, double dt);
  /// The tangent of that step, before it: core::StressTangent of one particle.
  using Tangent = std::array<std::array<double, 9>, 6>;
  Tangent tangent(const core::Mat3<double>& gradient, double dt);

  bool has(core::Column column) const { return layout_.has(column); }
  double value(core::Column column) const { return block_[static_cast<std::size_t>(layout_.offset(column))]; }
  void set(core::Column column, double value);

  core::Sym3<double> deviator() const;
  /// Cauchy stress s - (p + q) I, positive in tension.
  core::Sym3<double> stress() const;
  double density() const { return value(core::Column::mass) / value(core::Column::volume); }
  /// V over the volume at the start.
  double volume_ratio() const { return value(core::Column::volume) / initial_volume_; }
  /// Internal energy over the volume at reference density.
  double energy() const { return value(core::Column::internal_energy); }
  double time() const { return batch_.time; }
  double sound_speed() const { return value(core::Column::sound_speed); }
  double critical_speed() const { return batch_.critical_speed[0]; }
  const core::MaterialEvents& events() const { return batch_.events; }

  /// Everything that a step changes, for restoring.
  struct State {
    std::vector<double> block;
    double time = 0;
    core::MaterialEvents events;
  };
  State save() const { return {block_, batch_.time, batch_.events}; }
  void restore(const State& state);

 private:
  void prepare(const core::Mat3<double>& gradient, double dt);

  const core::ConstitutiveModel& model_;
  core::UpdateOptions options_;
  Update update_;
  core::ColumnLayout layout_;
  std::vector<double> block_;  ///< one block; all its lanes hold the same particle
  core::Batch batch_{};
  double initial_volume_ = 1;
};

/// How the velocity gradient follows from one scalar, the rate; x is the axis.
enum class PathKind {
  uniaxial_strain,  ///< rate of D_xx
  uniaxial_stress,  ///< rate of D_xx, the lateral rates such that the lateral stresses vanish
  simple_shear,     ///< rate of d v_x / d y
  hydrostatic,      ///< rate of the trace, equal in all directions
  gradient,         ///< rate times a given tensor
};

struct Path {
  PathKind kind = PathKind::uniaxial_strain;
  double rate = 1;              ///< > 0, 1/time
  std::vector<double> targets;  ///< values of the integral of the rate, reached in sequence from 0
  int steps = 100;              ///< per target
  core::Mat3<double> gradient{};
};

/// Follows a path of one kind (physics/point/path.hpp has the others); `visit(strain)` is called before the
/// first and after every step. Returns false where the lateral stress of uniaxial stress could not be brought
/// to zero.
bool drive(PointDriver& point, const Path& path, const std::function<void(double strain)>& visit);

}  // namespace mpm::physics
