// The consistent tangent of a material: the derivative of the stress at the end of a step with respect to the
// increment of the displacement gradient, h = dt L, for each particle of a batch.
#pragma once

#include "core/material/batch.hpp"

namespace mpm::core {

/// d[i][j] = d sigma_i / d h_j of each particle, stress: sigma = s - (p + q) I in the order xx yy zz xy yz
/// xz, h in the order of Mat3 (row i, column j: dt d v_i / d x_j). The rotation of the stress is included: in
/// general no symmetry in any two indices of h.
struct StressTangent {
  alignas(64) Row d[6][9];
};

}  // namespace mpm::core
