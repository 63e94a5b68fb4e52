// The nodes' part of a solution with the consistent mass matrix (core/transfer/consistent.hpp): M_b u = D u_0
// from the lumped u_0 of a brick's MotionRecords. Products with M are sums over the particles, mapped between
// these operations (core/step/solve_mass.hpp).
//
// Every brick keeps two records per node and velocity field. Solution: a Motion, of which u is the velocity
// or the increment. Direction: a Motion too, since its increment, the step of the iteration, is what
// particles interpolate; its velocity is the residual D^-1 r, its omitted share the components that walls
// hold (bits 0..2).
#pragma once

#include "core/step/node_update.hpp"
#include "core/transfer/consistent.hpp"

namespace mpm::core {

/// Of a Motion's vectors u is solved for, the velocity or the increment: u = u_0 = the vector `from` of
/// `motion`, and the first step of the iteration. What the walls have stopped is held: at rigid walls where
/// that component of the vector `stopped` of `motion` is zero. Nodes below the cutoff take no part.
void begin_mass_solution(const BoundaryFaces& faces, int nodes, double mass_cutoff, const double* motion,
                         MotionVector from, MotionVector stopped, MotionVector u, double* direction,
                         double* solution);
/// One iteration with `products`, the sums of m S (sum S d) over the particles with the last step d.
void advance_mass_solution(const BoundaryFaces& faces, int nodes, const double* products, bool first,
                           const MassIteration::Step& step, MotionVector u, double* direction,
                           double* solution);
/// The velocity at the end of the step from that at the start and the increment, both solutions. What the
/// iteration for the increment has held at a rigid wall stays at rest.
void add_increment(const BoundaryFaces& faces, int nodes, const double* direction, double* solution);
/// Stops what a rigid wall does not let through, and sets the outer nodes.
void end_mass_solution(const BoundaryFaces& faces, double* solution);

}  // namespace mpm::core
