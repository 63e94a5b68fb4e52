#include "tests/support/reference_gradients.hpp"

#include <algorithm>

namespace mpm::tests {

Matrix relative_to_old_positions(const Matrix& L, double dt) {
  Matrix A{}, X = L;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) A[i][j] = (i == j ? 1.0 : 0.0) - dt * L[i][j];
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (i == k) continue;
      const double factor = A[i][k] / A[k][k];
      for (std::size_t j = 0; j < 3; ++j) {
        A[i][j] -= factor * A[k][j];
        X[i][j] -= factor * X[k][j];
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) X[i][j] /= A[i][i];
  return X;
}

void add_own_kick(const ReferenceParticle& particle, const std::vector<KickedNode>& nodes, const Vector& cell,
                  double dt, Matrix& L) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double h = cell[axis], pressure = particle.p - particle.s[axis][axis];
    if (!(pressure > 0)) continue;
    double place = 0;  // in the cell, over its edge: the sum of the upper nodes' weights
    double velocity = 0, lower_face = 0, upper_face = 0;  // of the faces: sums of w_i^2/m_i
    for (const KickedNode& node : nodes) {
      const double w = h * node.slope[axis];  // with a sign
      velocity += node.weight * node.velocity[axis];
      if (w > 0) place += node.weight;
      (w > 0 ? upper_face : lower_face) += w * w / node.mass;
    }
    const bool upper = place > 0.5;
    const double distance = h * (upper ? 1 - place : place), B = upper ? upper_face : lower_face;
    const double away = upper ? -velocity : velocity, kick = dt * particle.V * pressure * B / h;
    const double most = dt * particle.V * pressure / (particle.m * h);
    if (!(away > 0 && away < 2 * most && distance < dt * std::max(kick, 2 * away))) continue;
    const double share = std::max(away / kick, 0.5) * std::min(1.0, 2 - away / most);
    for (std::size_t a = 0; a < 3; ++a)
      L[a][axis] +=
          a == axis ? share * kick / h : -std::min(share, 1.0) * kick / h * particle.s[a][axis] / pressure;
  }
}

}  // namespace mpm::tests
