// What the passes (passes_with.hpp) with shape functions S and transfer T do and need, and what they do in a
// scene.
#pragma once

#include <algorithm>
#include <type_traits>

#include "core/grid/node_fields.hpp"
#include "core/material/batch.hpp"
#include "core/model.hpp"
#include "core/shape/cell_mass.hpp"
#include "core/shape/linear.hpp"
#include "core/step/conduction.hpp"
#include "core/step/loads.hpp"
#include "core/transfer/consistent.hpp"
#include "core/transfer/corrected.hpp"

namespace mpm::core {

/// Whether products with the mass matrix go by the moments of cells: their sums cost about as much as one
/// product by the particles, which is all that order 2 needs.
template <ShapePolicy S>
bool multiplies_by_cells(const SolutionInput& solution) {
  return trilinear_on_lattice<S> && (solution.mass == MassMatrix::consistent || orders_of(solution) > 2);
}

template <ShapePolicy S, TransferPolicy T>
struct PassTraits {
  /// Whether particles have domains that deform with them, or whose particles follow them.
  static constexpr bool deforms = requires { &S::template deform<Row[9]>; };
  static constexpr bool settles = requires { &S::settle; };
  /// Whether gradients jump at the faces of cells, where USF traps particles (core/shape/face_traps.hpp).
  static constexpr bool traps = std::is_same_v<S, Linear>;
  /// Whether the transfer corrects velocities (core/transfer/corrected.hpp), or solves with the consistent
  /// mass matrix (core/transfer/consistent.hpp).
  static constexpr bool corrects = corrects_velocities<T>;
  static constexpr bool solves = solves_mass<T>;

  /// Whether the nodes that a particle reaches are known by its lowest one.
  static constexpr bool selects = requires(const typename S::Place& place) { S::lowest_of(place, 0); };
  /// Whether bricks with few particles are treated apart: where nothing else uses the contributions to nodes
  /// or the motion of nodes that no particle of the brick reaches.
  static bool selects_nodes(const Model& model) {
    return selects && !corrects && !solves && !model.scene->contact.enable && !conducts_heat(model);
  }

  /// Whether what particles move with is kept as their field has it, not at the nodes.
  static constexpr bool can_keep_field = requires(typename S::Field field, double* kept) {
    field.keep_velocity(nullptr, kept);
  };
  /// Whether the field can take strain velocities as momenta and masses.
  static constexpr bool takes_momenta =
      !solves && requires(typename S::Field field, const BrickFrame& frame) {
    field.take_strain(frame, 0.0, static_cast<const double*>(nullptr));
  };
  /// What MUSL and USAVG map back to the grid. Where the motion of all nodes is not found (moving_block) or
  /// kept, the strain velocities need the masses once more.
  static constexpr NodeFields mapped_back =
      momentum_block<S> == S::node_block && !can_keep_field ? mapped::momentum : mapped::momentum_mass;
  /// The nodes of a brick whose motion is found: with MUSL and USAVG those that its particles take it from,
  /// unless contact, a correction, a solution, the work of a surface load or a rigid wall (node_update.hpp)
  /// needs all of them.
  static NodeBlockShape moving_block(const Model& model) {
    return moves_all_nodes(model) ? S::node_block : momentum_block<S>;
  }
  static bool moves_all_nodes(const Model& model) {
    return corrects || solves || !maps_back(model.scheme) || model.scene->contact.enable ||
           has_surface_loads(*model.scene) ||
           std::ranges::count(model.grid->geometry().boundary, Boundary::rigid_wall) > 0;
  }
};

}  // namespace mpm::core
