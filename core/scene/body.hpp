#pragma once
// Bodies, the components that group them, and their prescribed loads and motion.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/errors.hpp"
#include "core/scene/expression.hpp"
#include "core/scene/geometry.hpp"
#include "core/tensor/tensor.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// Local axes: a point r of a body is at origin + r_x x_axis + r_y y_axis + r_z z_axis in the global frame.
/// The axes are orthonormal and right-handed; the input's lengths do not matter.
struct WorkPlane {
  std::string name;
  Vec3<double> origin{};
  Vec3<double> x_axis{1, 0, 0};
  Vec3<double> y_axis{0, 1, 0};
  Vec3<double> z_axis{0, 0, 1};
  SourceLocation source;
};

/// Body force per mass over time: amplitude times factor, linear between the points, zero after the last.
struct PrescribedAcceleration {
  struct Point {
    double time = 0;
    Vec3<double> linear_factor{};
    Vec3<double> angular_factor{};
  };
  Vec3<double> linear_amplitude{};   ///< length/time^2
  Vec3<double> angular_amplitude{};  ///< 1/time^2, rigid bodies only
  std::vector<Point> points;         ///< times strictly increasing
};

/// Body force per mass A sin(omega t + theta) per axis, until the axis' end time.
struct HarmonicExcitation {
  Vec3<double> amplitude{};          ///< length/time^2
  Vec3<double> angular_frequency{};  ///< 1/time
  Vec3<double> phase{};              ///< radian
  Vec3<double> end_time{};
};

/// Force per mass, constant or a function of position and time; components with expressions are 0.
struct BodyForce {
  Vec3<double> number{};  ///< length/time^2
  Expressions expressions;
};

/// A pressure on the whole surface of a body, or a traction on the surfaces with one axis as normal;
/// restricted to the part of the surface inside the box, if given. Factors over time: linear between the
/// points, zero outside.
struct SurfaceLoad {
  struct Point {
    double time = 0;
    double factor = 1;
  };
  double pressure = 0;      ///< stress, positive inwards
  Vec3<double> traction{};  ///< stress
  int normal = -1;          ///< axis of `traction`; -1: none
  /// Expressions for components of `traction` (0, 1, 2) and `pressure` (3).
  Expressions expressions;
  static constexpr int pressure_component = 3;
  Vec3<double> lower{-1e300, -1e300, -1e300};
  Vec3<double> upper{1e300, 1e300, 1e300};
  std::optional<double>
      ramp;  ///< width over which the load falls to zero across the box's faces; default: one cell
  std::vector<Point> points;  ///< times strictly increasing; none: constant
};

/// Fixes the finite element nodes between two planes.
struct FixedLayer {
  int direction = 0;  ///< 0, 1, 2: the axis that is fixed; 3: all
  int normal = 0;     ///< axis normal to the planes
  double min = 0;
  double max = 0;
};

/// Of a free rigid body, instead of those of its particles.
struct RigidInertia {
  double mass = 0;                     ///< > 0
  std::optional<Sym3<double>> tensor;  ///< about the centre of mass at the start, global axes
};

struct BodyInput {
  std::string name;
  std::size_t material = 0;  ///< index into Scene::materials
  std::string type;          ///< the type's name in the input; `geometry` holds the matching alternative
  Geometry geometry;
  double density = 0;                     ///< initial density; default: the reference density of the material
  std::optional<std::size_t> work_plane;  ///< index into Scene::work_planes; the global frame without
  bool deactivated = false;               ///< excluded from the run and the output
  bool for_bool = false;                  ///< operand of a Bool body; not a body of the run
  bool no_output = false;                 ///< not written to the particle files
  Vec3<double> initial_velocity{};
  Expressions initial_velocity_expressions;   ///< of the initial position, for some of its components
  std::optional<double> initial_temperature;  ///< > 0; the material's without
  std::optional<Vec3<double>> prescribed_velocity;
  Expressions prescribed_velocity_expressions;  ///< for some of its components
  std::optional<PrescribedAcceleration> prescribed_acceleration;
  std::optional<HarmonicExcitation> harmonic_excitation;
  std::optional<BodyForce> body_force;
  std::vector<SurfaceLoad> surface_loads;
  bool constrain_rigid_position = false;   ///< keeps its prescribed motion, loads included
  std::optional<double> adaptive_split;    ///< splits when longer than this fraction of a cell
  std::optional<double> fragment_spacing;  ///< particle spacing for the count of fragments
  std::vector<FixedLayer> fixed_layers;
  std::optional<RigidInertia> rigid_inertia;
  SourceLocation source;
};

struct ComponentInput {
  std::string name;
  double normal_weight = 0;  ///< weight of this component's normal in contact
  std::vector<BodyInput> bodies;
  SourceLocation source;
};

/// A point or a rectangle from which explosives are ignited.
struct DetonationItem {
  enum class Kind { point, plane };
  Kind kind = Kind::point;
  double time = 0;
  Vec3<double> position{};        ///< Kind::point
  int normal = 0;                 ///< Kind::plane: axis normal to the rectangle
  double location = 0;            ///< coordinate along the normal
  std::array<double, 2> lower{};  ///< left, bottom: the other two axes in ascending order
  std::array<double, 2> upper{};  ///< right, top
  SourceLocation source;
};

}  // namespace mpm::core
