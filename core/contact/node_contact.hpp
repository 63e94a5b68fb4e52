// Contact at one node of the background grid between the velocity fields of several components (thesis 4.3):
// impulses that stop approach along the normal, with Coulomb's friction.
//
// Two fields a and b with the normal n from a to b, velocities v without contact and masses m. With the
// approach u = v_a - v_b and 1/m* = 1/m_a + 1/m_b, the impulse on b, and its opposite on a, is
//   none                       where u.n <= 0: they part (4-35)
//   m* u                       where they stick: m* |u_t| <= mu m* u.n (4-47), u_t = u - u.n n
//   m* u.n (n + mu u_t/|u_t|)  where they slide (4-48)
// which is (4-40) and (4-46) without the velocity of the centre of mass: momentum is kept exactly.
//
// More than two fields: the impulses P of all pairs follow from the same velocities, P_n <- max(0, P_n + m*
// u.n), P_t <- P_t + m* u_t within mu P_n, with m_a replaced by m_a over the number of a's contacts
// (mass splitting: R. Tonge, F. Benevolenski and A. Voroshilov, ACM Trans. Graph. 31 (2012) 105), and so on
// until the velocities rest. No order of the pairs or components enters.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/tensor/tensor.hpp"

namespace mpm::core {

/// A component at a node.
struct ContactField {
  double mass = 0;
  Vec3<double> velocity{};  ///< without contact, then with it
};

/// Two fields at a node that may touch.
struct ContactPair {
  int first = 0, second = 0;  ///< numbers of the fields
  Vec3<double> normal{};      ///< unit vector from the first to the second
  double friction = 0;        ///< Coulomb's coefficient
  enum class Holds { nothing, normal, all };
  Holds holds = Holds::nothing;  ///< what the impulse brings to rest whatever its sign
  Vec3<double> impulse{};        ///< result: on the second; the first gets the opposite
};

/// Two fields whose masses differ by more than this factor do not touch: the velocity of the lighter one is
/// that of few particles far from the node, and blocks that slide would stick to it.
inline constexpr double contact_mass_ratio = 1e5;

/// Sets the impulses of the pairs and the velocities of the fields.
void resolve_contacts(std::span<ContactField> fields, std::span<ContactPair> pairs);

/// Of a pair that is alone at a node, one of its fields of infinite mass, the other one of this `mass`:
/// d(impulse)/du, u the velocity of the first field relative to the second one. Where the fields slide, the
/// impulse across the normal n is mu m u.n along their motion t, and the derivative is not symmetric:
/// m n n^T + mu m t n^T + mu m (u.n)/|u_t| (1 - n n^T - t t^T).
Mat3<double> impulse_derivative(const ContactPair& pair, const Vec3<double>& approach, double mass);
/// The symmetric matrix K with impulse = K u along the normal and across it, for the impulse of the pair.
Mat3<double> impulse_secant(const ContactPair& pair, const Vec3<double>& approach, double mass);

/// A surface has a direction where its gradient over a cell is at least this share of the mass at the node.
/// At the surface of a filled half-space it is 2, deeper inside it falls to zero as the distance leaves the
/// reach of shape functions; at 1e-3 what lies on the half-space has a mass that is below contact_mass_ratio.
/// Less is round-off, as in the middle of a plate of two cells, and would point anywhere.
inline constexpr double least_slope = 1e-3;
/// Less than this is that of an inside where particles are not evenly spaced: particles give better normals,
/// where they are known.
inline constexpr double uneven_slope = 0.1;

/// Where the surface of a component is at a node.
struct ContactSurface {
  Vec3<double> mass_gradient{};  ///< sum of m grad S over its particles: points outward (4-31)
  double weight = 0;             ///< normal_vector_weight
  bool excluded = false;         ///< decides only where the other is excluded too
  double slope = std::numeric_limits<double>::infinity();  ///< its gradient over a cell, by its mass
};

/// `mass`: of its particles at the node. Each axis by its own edge, as cells need not be cubes.
inline double slope_of(const Vec3<double>& mass_gradient, double mass, const Vec3<double>& cell) {
  const Vec3<double> g{mass_gradient.x * cell.x, mass_gradient.y * cell.y, mass_gradient.z * cell.z};
  const double length = std::sqrt(dot(g, g));
  return mass > 0 ? length / mass : std::numeric_limits<double>::infinity();
}

inline bool has_direction(const ContactSurface& s, double least = least_slope) {
  return s.slope >= least && s.mass_gradient != Vec3<double>{};
}

/// Which of two gives the normal: the one that is not excluded, else that of the larger weight; null: both.
inline const ContactSurface* deciding(const ContactSurface& first, const ContactSurface& second) {
  if (first.excluded != second.excluded) return first.excluded ? &second : &first;
  if (first.weight == second.weight) return nullptr;
  return first.weight > second.weight ? &first : &second;
}

/// Normal from `first` to `second`: that of the deciding one, or the mean of both (4-32). One without a
/// direction leaves it to the other. None where no surface has a direction, or both have opposite ones: as
/// nothing tells along which way they press, the node is left alone.
std::optional<Vec3<double>> contact_normal(const ContactSurface& first, const ContactSurface& second);

}  // namespace mpm::core
