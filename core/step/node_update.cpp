#include "core/step/node_update.hpp"

#include <algorithm>

#include "core/simd/lanes.hpp"

namespace mpm::core {

namespace {

using Record = Lanes<8>;
using Half = Lanes<4>;
}  // namespace

BoundaryFaces::BoundaryFaces(const GridGeometry& geometry, const NodeBlockShape& shape, BrickCoord brick)
    : shape_(shape) {
  const int first[3] = {brick_cells * brick.x, brick_cells * brick.y, brick_cells * brick.z};
  for (int axis = 0; axis < 3; ++axis) {
    const Boundary lower = geometry.boundary[static_cast<std::size_t>(2 * axis)];
    const Boundary upper = geometry.boundary[static_cast<std::size_t>(2 * axis + 1)];
    const std::int64_t last = geometry.cells[static_cast<std::size_t>(axis)] - first[axis];
    if (is_constrained(lower) && -first[axis] >= shape.lowest())
      face_[count_++] = {axis, -first[axis], -1, lower};
    if (is_constrained(upper) && last <= shape.highest())
      face_[count_++] = {axis, static_cast<int>(last), 1, upper};
  }
}

template <class F>
void BoundaryFaces::for_each_outer_node(const Face& face, F f) const {
  if (!has_outer_nodes(face)) return;
  const int s = shape_.side();
  const int strides[3] = {1, s, s * s};
  const int along = strides[face.axis] * face.sign;
  const int u = strides[(face.axis + 1) % 3], v = strides[(face.axis + 2) % 3];
  const int first = (face.layer + shape_.below) * strides[face.axis];
  for (int a = 0; a < s; ++a) {
    for (int b = 0; b < s; ++b) {
      const int wall = first + a * u + b * v;
      f(face, wall + along, wall, wall - along);
    }
  }
}

namespace {

/// The axis of component `c` of a record if it belongs to a mapped vector, or -1.
int axis_of(NodeFields what, int c) {
  const int momentum =
      what.array == NodeArray::first ? node_field::momentum.first : node_field::second_momentum.first;
  if (maps_momentum(what) && c >= momentum && c < momentum + 3) return c - momentum;
  if (maps_force(what) && c >= node_field::force.first && c < node_field::force.end())
    return c - node_field::force.first;
  if (what == mapped::surface) return c < node_field::surface.end() ? c : -1;
  return -1;
}

bool is_mechanics(NodeFields what) { return maps_momentum(what) || maps_force(what); }

/// All arrays hold the mass in the same component.
bool is_mass(NodeFields what, int c) {
  static_assert(node_field::mass.first == node_field::second_mass.first &&
                node_field::mass.first == node_field::start_mass.first);
  return maps_mass(what) && c == node_field::mass.first;
}

}  // namespace

void add_weights(const Vec3<double>& acceleration, int nodes, NodeArray of, const double* masses,
                 double* records) {
  const Half a(Half::vector{acceleration.x, acceleration.y, acceleration.z, 0});
  for (int n = 0; n < nodes; ++n) {
    double* force = MappedRecord<double>{records + node_doubles * n}.force();
    store(force, load<Half>(force) + Half(masses[record_doubles(of) * n + node_field::mass.first]) * a);
  }
}

void BoundaryFaces::fold(NodeFields what, double* contributions) const {
  for (int i = 0; i < count_; ++i) {
    if (record_doubles(what.array) == node_doubles)
      fold<Record>(face_[i], what, contributions);
    else
      fold<Half>(face_[i], what, contributions);
  }
}

/// Part: a record of what.array.
template <class Part>
void BoundaryFaces::fold(const Face& face, NodeFields what, double* contributions) const {
  constexpr int width = LaneTraits<Part>::width;
  const bool extrapolates = face.boundary == Boundary::rigid_wall && is_mechanics(what);
  Part sign(1.0), kept(0.0);
  for (int c = 0; c < width; ++c) {
    const int axis = axis_of(what, c);
    if (extrapolates || (axis >= 0 && (face.boundary == Boundary::fixed || axis == face.axis)))
      sign.set(c, -1);
    if (!extrapolates && is_mass(what, c)) kept.set(c, 1);
  }
  for_each_outer_node(face, [&](const Face&, int outer, int wall, int mirror) {
    double* from = contributions + width * outer;
    double *to_wall = contributions + width * wall, *to_mirror = contributions + width * mirror;
    const Part given = load<Part>(from);
    if (extrapolates) store(to_wall, load<Part>(to_wall) + Part(2.0) * given);
    store(to_mirror, load<Part>(to_mirror) + sign * given);
    store(from, select(kept > Part(0.0), given, Part(0.0)));
  });
}

void BoundaryFaces::reverse_weights(const Vec3<double>& gravity, NodeArray of, const double* masses,
                                    double* forces) const {
  const auto mirrors = [&](const Face& face) {
    return has_outer_nodes(face) && face.boundary != Boundary::rigid_wall;
  };
  if (gravity == Vec3<double>{} || std::none_of(face_, face_ + count_, mirrors)) return;
  const auto mass = [&](int n) { return Half(masses[record_doubles(of) * n + node_field::mass.first]); };
  std::array<Half, NodeBlockShape{most_layers, most_layers}.nodes()> weights;
  const auto weight = [&](int n) -> Half& { return weights[static_cast<std::size_t>(n)]; };
  for (int n = 0; n < shape_.nodes(); ++n) weight(n) = mass(n);
  // The masses before the folds, then the folds of the weights.
  for (int i = count_ - 1; i >= 0; --i) {
    if (!mirrors(face_[i])) continue;
    for_each_outer_node(face_[i],
                        [&](const Face&, int outer, int, int inside) { weight(inside) -= weight(outer); });
  }
  for (int i = 0; i < count_; ++i) {
    if (!mirrors(face_[i])) continue;
    Half sign(1.0);
    for (int a = 0; a < 3; ++a)
      if (face_[i].boundary == Boundary::fixed || a == face_[i].axis) sign.set(a, -1);
    for_each_outer_node(
        face_[i], [&](const Face&, int outer, int, int inside) { weight(inside) += sign * weight(outer); });
  }
  const Half g(Half::vector{gravity.x, gravity.y, gravity.z, 0});
  for (int n = 0; n < shape_.nodes(); ++n) {
    double* force = MappedRecord<double>{forces + node_doubles * n}.force();
    store(force, load<Half>(force) + (weight(n) - mass(n)) * g);
  }
}

void BoundaryFaces::fill(double* record) const {
  for_each_outer_node([&](const Face& face, int outer, int wall, int mirror) {
    const Record inside = load<Record>(record + node_doubles * mirror);
    double* at = record + node_doubles * outer;
    const Motion to{at};
    if (face.boundary == Boundary::rigid_wall) {
      const Record on_wall = load<Record>(record + node_doubles * wall);
      store(at, Record(2.0) * on_wall - inside);
    } else {
      store(at, inside);
      for (int a = 0; a < 3; ++a) {
        if (face.boundary != Boundary::fixed && a != face.axis) continue;
        to.velocity()[a] = -to.velocity()[a];
        to.increment()[a] = -to.increment()[a];
      }
    }
    to.mass() = 0;
    to.omitted_share() = 0;
  });
}

void BoundaryFaces::for_each_tie(const std::function<void(int, int, const bool (&)[3])>& f) const {
  for_each_outer_node([&](const Face& face, int outer, int, int inside) {
    bool reverses[3];
    for (int a = 0; a < 3; ++a) reverses[a] = face.boundary == Boundary::fixed || a == face.axis;
    f(outer, inside, reverses);
  });
}

void BoundaryFaces::mirror(int i, double* record) const {
  for_each_outer_node([&](const Face&, int outer, int, int inside) {
    record[node_doubles * outer + i] = record[node_doubles * inside + i];
  });
}

void update_nodes(const NodeForces& forces, double dt, double mass_cutoff, const BoundaryFaces& faces,
                  const NodeSelection& nodes, double* record) {
  const Half gravity(Half::vector{forces.gravity.x, forces.gravity.y, forces.gravity.z, 0});
  const double floor = forces.strain_mass_floor, kept = 1 - dt * forces.damping;
  const auto update = [&](double* at) {
    const MappedRecord<double> sums{at};
    const double m = sums.mass();
    if (!(m > mass_cutoff)) return store(at, Record(0.0));
    const double inverse = 1 / m;
    const Half v = load<Half>(sums.momentum()) * Half(kept * inverse);
    const Half a = load<Half>(sums.force()) * Half(inverse) + gravity;
    const Half dv = Half(dt) * a;
    const Motion motion{at};
    store(motion.velocity(), v + dv);
    store(motion.increment(), dv);
    motion.mass() = m;
    motion.omitted_share() = m < floor ? 1 - m / floor : 0;
  };
  nodes.for_each([&](int first, int count) {
    for (int n = first; n < first + count; ++n) update(record + node_doubles * n);
  });
  // Nodes on a fixed or symmetry face keep neither momentum nor force (thesis, below 2-41): particles feel
  // them through the stress alone, and no energy is lost. A rigid wall stops a node that would leave the
  // grid, and particles are stopped by their stress, as at a symmetry face, but for tension, which no wall
  // bears. A node that moves away with u and that pressure stops gives them -u |u/dv|: all of dv where it
  // barely stops, nearly nothing under high pressure. A velocity mapped from particles beside the wall is not
  // that of the wall: to take it from them in every step would cost up to half of the energy of a rebound,
  // however short the steps.
  //
  // A full node on a face has half the mass of one inside, and so has its floor: 1 - 2 m / floor.
  faces.for_each_node(record, [](int axis, int sign, Boundary boundary, double* at) {
    double *v = Motion{at}.velocity(), *dv = Motion{at}.increment();
    double& omitted = Motion{at}.omitted_share();
    omitted = std::max(0.0, 2 * omitted - 1);
    if (boundary == Boundary::fixed) {
      for (int a = 0; a < 3; ++a) v[a] = dv[a] = 0;
    } else if (boundary == Boundary::symmetry) {
      v[axis] = dv[axis] = 0;
    } else if (boundary == Boundary::rigid_wall && sign * v[axis] > 0) {
      const double before = v[axis] - dv[axis];
      if (sign * before < 0)
        dv[axis] = -before * std::abs(before / dv[axis]);
      else if (sign * dv[axis] > 0)
        dv[axis] = 0;
      v[axis] = 0;
    }
  });
  faces.fill(record);
}

void hold_at_rigid_walls(const NodeForces& forces, double dt, double mass_cutoff, const BoundaryFaces& faces,
                         double* record) {
  const double gravity[] = {forces.gravity.x, forces.gravity.y, forces.gravity.z};
  const double kept = 1 - dt * forces.damping;
  faces.for_each_node(record, [&](int axis, int sign, Boundary boundary, double* at) {
    const MappedRecord<double> sums{at};
    const double m = sums.mass();
    if (boundary != Boundary::rigid_wall || !(m > mass_cutoff)) return;
    double& momentum = sums.momentum()[axis];
    if (sign * (kept * momentum + dt * (sums.force()[axis] + m * gravity[axis])) > 0) momentum = 0;
  });
}

void keep_motion(const NodeSelection& nodes, const double* record, double* motion) {
  nodes.for_each([&](int first, int count) {
    for (int n = first; n < first + count; ++n, motion += motion_width)
      store(motion, load<Half>(record + node_doubles * n));
  });
}
void recall_motion(const NodeSelection& nodes, const double* motion, double* record) {
  nodes.for_each([&](int first, int count) {
    for (int n = first; n < first + count; ++n, motion += motion_width)
      store(record + node_doubles * n, load<Half>(motion));
  });
}

namespace {
/// Applies the walls to the strain velocities. A node stopped by a rigid wall (zero velocity) must not strain
/// particles either: its strain velocity would do work on them that has no source.
void constrain_second_velocity(const BoundaryFaces& faces, double* record) {
  faces.for_each_node(record, [](int axis, int sign, Boundary boundary, double* at) {
    double* u = Motion{at}.strain_velocity();
    if (boundary == Boundary::fixed) {
      for (int a = 0; a < 3; ++a) u[a] = 0;
    } else if (boundary == Boundary::symmetry || (boundary == Boundary::rigid_wall &&
                                                  (sign * u[axis] > 0 || Motion{at}.velocity()[axis] == 0))) {
      u[axis] = 0;
    }
  });
  faces.fill(record);
}
}  // namespace

void copy_vector(int nodes, const double* source, MotionVector from, MotionVector to, double* motion) {
  for (int n = 0; n < nodes; ++n)
    std::copy_n(source + node_doubles * n + from, 3, motion + node_doubles * n + to);
}

void add_vector(int nodes, const double* source, MotionVector from, double multiple, MotionVector to,
                double* motion) {
  for (int n = 0; n < nodes; ++n)
    for (int a = 0; a < 3; ++a)
      motion[node_doubles * n + to + a] += multiple * source[node_doubles * n + from + a];
}

void second_velocities(double mass_cutoff, const double* momenta, const double* masses,
                       const BoundaryFaces& faces, const NodeSelection& nodes, double* record) {
  nodes.for_each([&](int first, int count) {
    for (int n = first; n < first + count; ++n) {
      const Motion at{record + node_doubles * n};
      const double m = masses[node_doubles * n + Motion::mass_at];
      store(at.strain_velocity(),
            m > mass_cutoff ? load<Half>(momenta + node_doubles * n) * Half(1 / m) : Half(0.0));
    }
  });
  constrain_second_velocity(faces, record);
}

void begin_correction(bool of_start, const BoundaryFaces& faces, int nodes, const double* motion,
                      double* sum) {
  for (int n = 0; n < nodes; ++n) {
    const MotionRecord<const double> from{motion + node_doubles * n};
    const Motion to{sum + node_doubles * n};
    for (int a = 0; a < 3; ++a) {
      to.velocity()[a] = from.velocity()[a];
      to.increment()[a] = from.velocity()[a] - (of_start ? from.increment()[a] : 0);
    }
    to.mass() = from.mass();
    to.omitted_share() = 0;
  }
  faces.for_each_node(sum, [](int axis, int, Boundary boundary, double* at) {
    if (boundary == Boundary::rigid_wall && Motion{at}.velocity()[axis] == 0)
      Motion{at}.increment()[axis] = 0;
  });
  faces.fill(sum);
}

void continue_correction(const BoundaryFaces& faces, double* momenta, int nodes, double* sum) {
  // Held components keep dv = 0, as those at rest at a rigid wall do.
  faces.for_each_node(sum, [&](int axis, int, Boundary boundary, double* at) {
    double* momentum = momenta + (at - sum);
    for (int a = 0; a < 3; ++a) {
      const bool along = a == axis && (boundary == Boundary::symmetry || Motion{at}.velocity()[a] == 0);
      if (boundary != Boundary::fixed && !along) continue;
      momentum[a] = 0;
      Motion{at}.increment()[a] = 0;
    }
  });
  for (int n = 0; n < nodes; ++n) {
    const Motion at{sum + node_doubles * n};
    const double m = at.mass();
    if (!(m > 0)) continue;
    for (int a = 0; a < 3; ++a) {
      at.increment()[a] -= momenta[node_doubles * n + a] * (1 / m);
      at.velocity()[a] += at.increment()[a];
    }
  }
  faces.for_each_node(sum, [](int axis, int sign, Boundary boundary, double* at) {
    double *v = Motion{at}.velocity(), *dv = Motion{at}.increment();
    if (boundary != Boundary::rigid_wall || !(sign * v[axis] > 0)) return;
    dv[axis] -= v[axis];
    v[axis] = 0;
  });
  faces.fill(sum);
}

void regularised_velocities(const Vec3<double>& fall, const BoundaryFaces& faces, int nodes, double* record) {
  const Half g(Half::vector{fall.x, fall.y, fall.z, 0});
  for (int n = 0; n < nodes; ++n) {
    const Motion at{record + node_doubles * n};
    store(at.strain_velocity(),
          load<Half>(at.velocity()) - Half(at.omitted_share()) * (load<Half>(at.increment()) - g));
  }
  constrain_second_velocity(faces, record);
}

}  // namespace mpm::core
