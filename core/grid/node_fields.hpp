// Nodal fields of the background grid, by name.
//
// Every brick stores its contributions to its nodes in one to seven arrays of records. A field names
// consecutive components of an array's record; kernels, sums and the halo exchange use fields. A scheme maps
// to the grid twice per step and needs the first sums again after the second map: hence two arrays, and a
// sixth for momentum and mass where a scheme maps them before the forces; a seventh for the forces before the
// strain, which tell at rigid walls what they hold.
// Corrections of the velocities (core/transfer/corrected.hpp) are mapped between the two, and products with
// the consistent mass matrix (core/transfer/consistent.hpp): the third array. Contact needs the surfaces of
// the bodies at both: the fourth, and how far they reach: the fifth. Fields of different phases may share
// memory: heat conduction uses the arrays while the mechanics does not.
//
// A record of the first and the seventh array fills a cache line of 64 bytes, one of the others half a line.
#pragma once

#include <array>
#include <initializer_list>
#include <string_view>

namespace mpm::core {

enum class NodeArray : int { first, second, third, fourth, fifth, sixth, seventh };
inline constexpr std::array node_arrays{NodeArray::first,  NodeArray::second, NodeArray::third,
                                        NodeArray::fourth, NodeArray::fifth,  NodeArray::sixth,
                                        NodeArray::seventh};
/// Doubles per record of summed nodes, and per record of the arrays of forces.
inline constexpr int node_doubles = 8;
constexpr int record_doubles(NodeArray of) {
  return of == NodeArray::first || of == NodeArray::seventh ? node_doubles : node_doubles / 2;
}

/// Components [first, first + count) of every record of an array.
struct NodeFields {
  NodeArray array = NodeArray::first;
  int first = 0;
  int count = 0;

  constexpr int end() const { return first + count; }
  constexpr bool includes(const NodeFields& other) const {
    return array == other.array && first <= other.first && other.end() <= end();
  }
  constexpr bool operator==(const NodeFields&) const = default;
  /// Joins two adjacent fields. Fields that are not adjacent are a compile-time error.
  friend constexpr NodeFields operator|(const NodeFields& a, const NodeFields& b) {
    if (a.array != b.array || a.end() != b.first) throw "only neighbouring fields of one array can be joined";
    return {a.array, a.first, a.count + b.count};
  }
};

namespace node_field {
// Mechanics. `second_...`: MUSL maps the momentum a second time, the mass with it for shape functions whose
// forces reach farther than their momentum. `start_...`: USF and USAVG, at the start of a step.
inline constexpr NodeFields momentum{NodeArray::first, 0, 3};
inline constexpr NodeFields mass{NodeArray::first, 3, 1};
inline constexpr NodeFields force{NodeArray::first, 4, 3};
inline constexpr NodeFields second_momentum{NodeArray::second, 0, 3};
inline constexpr NodeFields second_mass{NodeArray::second, 3, 1};
inline constexpr NodeFields start_momentum{NodeArray::sixth, 0, 3};
inline constexpr NodeFields start_mass{NodeArray::sixth, 3, 1};
inline constexpr NodeFields start_force{NodeArray::seventh, 4, 3};
// Cells in use or their weights in means, and densities of their thinnest material
// (core/step/cells_in_use.hpp), which are cleared before forces take their place.
inline constexpr NodeFields thinnest_of_cells{NodeArray::first, 6, 1};
inline constexpr NodeFields cells_in_use{NodeArray::first, 7, 1};
// Implicit steps: sum of S + h |grad S|, positive where a node is active; volumes, those of bodies of
// prescribed motion alone and of all; volumes times moduli, and over moduli.
inline constexpr NodeFields support{NodeArray::first, 7, 1};
inline constexpr NodeFields moved_volume{NodeArray::first, 3, 1};
inline constexpr NodeFields volume{NodeArray::first, 4, 1};
inline constexpr NodeFields modulus{NodeArray::first, 5, 1};
inline constexpr NodeFields compliance{NodeArray::first, 6, 1};
// Momentum of an order of XPIC or FMPM, or product with the consistent mass matrix.
inline constexpr NodeFields correction{NodeArray::third, 0, 3};
// Contact: sums of m grad S and of m S.
inline constexpr NodeFields surface{NodeArray::fourth, 0, 3};
inline constexpr NodeFields surface_mass{NodeArray::fourth, 3, 1};
// Contact: how far a body reaches along its normal; the largest contribution counts, not the sum.
inline constexpr NodeFields reach{NodeArray::fifth, 0, 1};
// Heat conduction (conduction.hpp).
inline constexpr NodeFields heat_capacity{NodeArray::second, 0, 1};
inline constexpr NodeFields heat{NodeArray::second, 1, 1};
inline constexpr NodeFields heat_flow{NodeArray::first, 0, 1};
inline constexpr NodeFields unresolved_heat{NodeArray::first, 1, 1};
}  // namespace node_field

struct NamedNodeFields {
  std::string_view name;
  NodeFields fields;
};
inline constexpr std::array node_field_table{
    NamedNodeFields{"momentum", node_field::momentum},
    NamedNodeFields{"mass", node_field::mass},
    NamedNodeFields{"force", node_field::force},
    NamedNodeFields{"second momentum", node_field::second_momentum},
    NamedNodeFields{"second mass", node_field::second_mass},
    NamedNodeFields{"start momentum", node_field::start_momentum},
    NamedNodeFields{"start mass", node_field::start_mass},
    NamedNodeFields{"start force", node_field::start_force},
    NamedNodeFields{"thinnest of cells", node_field::thinnest_of_cells},
    NamedNodeFields{"cells in use", node_field::cells_in_use},
    NamedNodeFields{"support", node_field::support},
    NamedNodeFields{"moved volume", node_field::moved_volume},
    NamedNodeFields{"volume", node_field::volume},
    NamedNodeFields{"modulus", node_field::modulus},
    NamedNodeFields{"compliance", node_field::compliance},
    NamedNodeFields{"correction", node_field::correction},
    NamedNodeFields{"surface", node_field::surface},
    NamedNodeFields{"surface mass", node_field::surface_mass},
    NamedNodeFields{"reach", node_field::reach},
    NamedNodeFields{"heat capacity", node_field::heat_capacity},
    NamedNodeFields{"heat", node_field::heat},
    NamedNodeFields{"heat flow", node_field::heat_flow},
    NamedNodeFields{"unresolved heat", node_field::unresolved_heat},
};

/// What particles map to the grid in one pass: fields of one array that are written, summed and exchanged
/// together.
namespace mapped {
inline constexpr NodeFields momentum_mass_force = node_field::momentum | node_field::mass | node_field::force;
inline constexpr NodeFields force = node_field::force;  ///< momentum and mass of the records stay zero
/// Implicit steps: momentum, mass, external force and support; internal forces, and their absolute values in
/// the place of the support; and the motion of moved bodies.
inline constexpr NodeFields implicit_start = momentum_mass_force | node_field::support;
inline constexpr NodeFields implicit_force = node_field::force | node_field::support;
inline constexpr NodeFields implicit_motion = node_field::momentum | node_field::moved_volume |
                                              node_field::volume | node_field::modulus |
                                              node_field::compliance;
/// Surface and volume of a rigid body in contact, in the places of momentum and mass.
inline constexpr NodeFields implicit_surface = node_field::momentum | node_field::mass;
/// Of generalised alpha: mass times the lag of the acceleration, in the place of the momentum.
inline constexpr NodeFields implicit_lag = node_field::momentum;
inline constexpr NodeFields momentum_mass = node_field::second_momentum | node_field::second_mass;
inline constexpr NodeFields start = node_field::start_momentum | node_field::start_mass;
inline constexpr NodeFields start_force = node_field::start_force;   ///< momentum and mass stay zero
inline constexpr NodeFields momentum = node_field::second_momentum;  ///< mass stays zero
inline constexpr NodeFields correction = node_field::correction;
inline constexpr NodeFields cells_in_use = node_field::cells_in_use;
inline constexpr NodeFields thinnest_of_cells = node_field::thinnest_of_cells;
inline constexpr NodeFields cells_in_use_and_thinnest =
    node_field::thinnest_of_cells | node_field::cells_in_use;
inline constexpr NodeFields surface = node_field::surface | node_field::surface_mass;
inline constexpr NodeFields reach = node_field::reach;
inline constexpr NodeFields heat = node_field::heat_capacity | node_field::heat;
inline constexpr NodeFields heat_flow = node_field::heat_flow | node_field::unresolved_heat;
}  // namespace mapped

constexpr bool maps_momentum(NodeFields f) {
  return f.includes(node_field::momentum) || f.includes(node_field::second_momentum) ||
         f.includes(node_field::start_momentum) || f.includes(node_field::correction);
}
constexpr bool maps_mass(NodeFields f) {
  return f.includes(node_field::mass) || f.includes(node_field::second_mass) ||
         f.includes(node_field::start_mass);
}
constexpr bool maps_force(NodeFields f) {
  return f.includes(node_field::force) || f.includes(node_field::start_force);
}

/// The arrays that a scene's schemes use; the others are not allocated.
class NodeArraySet {
 public:
  constexpr NodeArraySet(std::initializer_list<NodeArray> arrays) {
    for (NodeArray a : arrays) add(a);
  }
  constexpr void add(NodeArray a) { bits_ |= 1u << static_cast<unsigned>(a); }
  constexpr bool has(NodeArray a) const { return (bits_ >> static_cast<unsigned>(a) & 1u) != 0; }
  constexpr bool operator==(const NodeArraySet&) const = default;

 private:
  unsigned bits_ = 0;
};

// Named views of records in their different uses. `Double`: double or const double.

/// Summed contributions, in a record of the first array.
template <class Double>
struct MappedRecord {
  Double* at;
  Double* momentum() const { return at + node_field::momentum.first; }
  Double& mass() const { return at[node_field::mass.first]; }
  Double* force() const { return at + node_field::force.first; }
};

/// A node after its update.
template <class Double>
struct MotionRecord {
  static constexpr int velocity_at = 0, mass_at = 3, increment_at = 4, strain_velocity_at = 4, omitted_at = 7;
  Double* at;
  Double* velocity() const { return at + velocity_at; }  ///< at the end of the step
  Double& mass() const { return at[mass_at]; }
  Double* increment() const { return at + increment_at; }  ///< of the velocity in this step
  /// Strain velocity of the particles; overwrites the increment once they have taken it.
  Double* strain_velocity() const { return at + strain_velocity_at; }
  /// USL: share of the increment that the strain velocity omits.
  Double& omitted_share() const { return at[omitted_at]; }
};
using Motion = MotionRecord<double>;

}  // namespace mpm::core
