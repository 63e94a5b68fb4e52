// Products M d of the mass matrix M_ij = sum_p m_p S_i S_j of a velocity field with vectors d of the nodes,
// which the orders of XPIC and FMPM (correct_velocities.hpp) and the solutions with the consistent mass
// matrix (solve_mass.hpp) map: by the particles, or by the cells through their moments
// (core/shape/cell_mass.hpp). Part of passes_with.hpp.
#pragma once

#include "core/step/passes_with.hpp"

namespace mpm::core {

/// In each step before its first product, which then sums the moments.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_products() {
  masses_known_ = false;
  if (by_cells_) cell_masses_.resize(static_cast<std::size_t>(cell_mass::brick_doubles) * seen_fields());
}

/// The moments of a brick's cells, of its particles of a component.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::sum_cell_masses(Slot s, std::int32_t component, double* moments) {
  if constexpr (trilinear_on_lattice<S>) {
    const BrickFrame frame = this->frame(s, component);
    std::fill_n(moments, cell_mass::brick_doubles, 0.0);
    cell_mass::Sums sums;
    for_each_block(s, component, columns_to_mass,
                   [&](std::size_t, std::size_t, int, const ColumnLayout& layout, double* block, int used) {
                     const Place place(frame, layout, block, used);
                     const double* m = block + layout.offset(Column::mass);
                     for (int i = 0; i < used; ++i) sums.add(place, i, m[i], moments);
                   });
    sums.flush(moments);
  }
}

/// Adds M d, of a brick's particles of a component, to a field's contributions: by the moments of its cells.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::add_product_by_cells(Slot s, std::int32_t component, Scratch& at, ProductSums& to) {
  if constexpr (trilinear_on_lattice<S>) {
    const BrickFrame frame = this->frame(s, component);
    double* moments = cell_masses(s, seen_number(s, component));
    if (!masses_known_) sum_cell_masses(s, component, moments);
    const double* d = at.corrected.increment();
    typename S::template Scatter<mapped::correction> cell;
    for (int c = 0; c < cell_mass::cells; ++c, moments += cell_mass::doubles) {
      if (moments[cell_mass::in_use] == 0) continue;
      cell.clear();
      cell.node = cell_mass::lowest_point(c);
      cell_mass::multiply(moments, d, cell.node, cell.sums.px, cell.sums.py, cell.sums.pz);
      cell.flush(frame, to.records);
    }
  }
}

/// The same by m S d of the particles.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::add_product_by_particles(Slot s, std::int32_t component, const Scratch& at,
                                                ProductSums& to) {
  const BrickFrame frame = this->frame(s, component);
  typename S::template Scatter<mapped::correction> cell;
  cell.clear();
  for_each_block(s, component, columns_to_mass,
                 [&](std::size_t, std::size_t, int, const ColumnLayout& layout, double* block, int used) {
                   const Place place(frame, layout, block, used);
                   MappedRows rows;
                   increment_momentum<S>(place, layout, at.corrected, block, rows);
                   add_particles(cell, frame, place, used, rows, to.records);
                 });
  cell.flush(frame, to.records);
}

/// Maps M d, d being the increments of these node records.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::map_product(Slot s, std::int32_t component, const double* increments, Scratch& at) {
  constexpr NodeFields what = mapped::correction;
  double* contributions = model_.grid->contributions(what.array, s, field_of(s, component));
  std::fill_n(contributions, record_doubles(what.array) * shared_.nodes(), 0.0);
  ProductSums sums(contributions);
  at.corrected.take_motion(increments);
  if (by_cells_)
    add_product_by_cells(s, component, at, sums);
  else
    add_product_by_particles(s, component, at, sums);
  sums.finish(frame(s, component));
  if constexpr (S::node_block != NodeBlockShape{}) faces(s).fold(what, contributions);
}

}  // namespace mpm::core
