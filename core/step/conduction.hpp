// Heat conduction on the grid, before the mechanics of a step: rho c dT/dt = div(k grad T).
//
// Heat and heat capacity are mapped from the particles to the nodes, as momentum and mass are; the flux
// through each particle, from the nodal temperatures, changes the nodal heat; the particles take the nodal
// increments:
//   T_i = sum m c T S_i / C_i,  C_i = sum m c S_i,  Q_i = -sum V k grad T . grad S_i,  dT_i = dt Q_i / C_i
// The sum of Q_i is zero, so heat, a part of the internal energy, is conserved to round-off. The grid's faces
// and bodies without conductivity are adiabatic. The update is stable up to dt_c = 1/(2 a (1/dx^2 + 1/dy^2 +
// 1/dz^2)) with a = k/(rho c), the bound of the regular grid with lumped capacities; the critical step
// includes this bound.
//
// The grid does not resolve variations of T within a cell, such as the jump at a contact of hot and cold, and
// increments alone never smooth them. Therefore T also changes by -(1 - P) R T', T' = (1 - P) T, with
// P T = sum S_i T_i and each particle's R = dt/dt_c, by (k h)^4 on resolved waves. P conserves heat, so this
// does for any R. In the product with the weights m c it is symmetric and, as R <= 1, at most (1 - P)^2; with
// the increments' 2 P that is at most 2: stable. The arrays, idle between steps, hold (Q, C R T'), (C, C T).
// Shown by tests/system/physics_heat.py.
#pragma once

#include <memory>

#include "core/communication/node_halo.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Largest stable step for the current state of this rank's particles; infinity where nothing conducts.
double conduction_step(const Model& model);

class Conduction {
 public:
  virtual ~Conduction() = default;

  /// Whether any body conducts; if none does, the step has no heat phases.
  virtual bool any() const = 0;
  virtual void map_heat() = 0;
  virtual void map_flux(double dt) = 0;
  virtual void update_temperatures(double dt) = 0;
  virtual void finish_exchange() = 0;
};

/// For the scene's shape functions.
std::unique_ptr<Conduction> make_conduction(Model& model, NodeHalo& halo);

/// Whether any body of the model conducts heat.
bool conducts_heat(const Model& model);

}  // namespace mpm::core
