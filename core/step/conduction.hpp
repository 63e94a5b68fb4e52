// Heat conduction on the grid, before the mechanics of a step: rho c dT/dt = div(k grad T).
//
// Heat and its capacity go from the particles to the nodes, as momentum and mass do; the flux through each
// particle, from the nodes' temperatures, changes the nodes' heat; the particles take the nodes' increments:
//   T_i = sum m c T S_i / C_i,  C_i = sum m c S_i,  Q_i = -sum V k grad T . grad S_i,  dT_i = dt Q_i / C_i
// The sum of Q_i is zero, so heat is kept to round-off; it is internal energy, which moves with it. The
// grid's faces are adiabatic, and so are bodies without conductivity. Stable up to dt_c = 1/(2 a (1/dx^2 +
// 1/dy^2 + 1/dz^2)) for a = k/(rho c), the bound of the regular grid with lumped capacities; that joins the
// critical step.
//
// Increments alone never even out what varies within a cell, such as the jump at a contact of hot and cold:
// the grid does not see it. So the part of T that two passes over the grid do not reproduce,
// T'' = (1 - P)^2 T with P T = sum S_i T_i, decays at the rate 1/dt_c. On waves that the grid resolves that
// acts as (k h)^4 only, so the order stays two; and as P keeps the heat, so does the decay.
// The first node array and the second, idle between steps, carry (Q, C T') and (C, C T), T' = (1 - P) T.
// Shown by tests/system/physics_heat.py.
#pragma once

#include <memory>

#include "core/communication/node_halo.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Largest stable step of this rank's particles as they are; infinity where nothing conducts.
double conduction_step(const Model& model);

class Conduction {
 public:
  virtual ~Conduction() = default;

  /// Whether any body conducts. Without, there are no phases for it.
  virtual bool any() const = 0;
  virtual void map_heat() = 0;
  virtual void map_flux() = 0;
  virtual void update_temperatures(double dt) = 0;
  virtual void finish_exchange() = 0;
};

/// With the scene's shape.
std::unique_ptr<Conduction> make_conduction(Model& model, NodeHalo& halo);

/// Whether any body of the model conducts heat.
bool conducts_heat(const Model& model);

}  // namespace mpm::core
