// What the oracle does to its nodes' velocities beyond FLIP with lumped mass: the orders of XPIC and FMPM,
// and the consistent mass matrix.
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "tests/support/reference_stepper.hpp"

namespace mpm::tests {

/// XPIC and FMPM: u = sum of du(l), du(l) = (1 - S+ S) du(l - 1) on the nodes, where walls hold what they
/// held in the equation of motion.
template <class Support>
void ReferenceStepper::add_orders() {
  for_active_nodes([&](const Index&, Node& node) {
    node.u = node.v;
    node.du = case_.transfer == ReferenceTransfer::fmpm ? node.v : node.start;
    for (std::size_t a = 0; a < 3; ++a)
      if (node.held[a]) node.du[a] = 0;
  });
  for (int order = 2; order <= case_.order; ++order) {
    for (Node& node : grid_) node.q = {};
    for (const auto& particle : case_.particles) {
      const Support& at = support<Support>(particle);
      Vector seen{};
      for (std::size_t n = 0; n < at.count; ++n)
        for (std::size_t a = 0; a < 3; ++a) seen[a] += at.value(n, a) * grid_[at.node[n]].du[a];
      for (std::size_t n = 0; n < at.count; ++n)
        for (std::size_t a = 0; a < 3; ++a) grid_[at.node[n]].q[a] += particle.m * at.value(n, a) * seen[a];
    }
    for_active_nodes([&](const Index& index, Node& node) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (node.held[a]) {
          node.du[a] = 0;
          continue;
        }
        node.du[a] -= node.q[a] / node.m;
        const double before = node.u[a];
        node.u[a] += node.du[a];
        if (stop(index, a, node.u[a]) == Stop::wall) {
          node.du[a] = -before;
          node.u[a] = 0;
          node.held[a] = true;
        }
      }
    });
  }
}

template <class Support>
void ReferenceStepper::solve_mass(Vector Node::*of, Vector Node::*stopped) {
  std::vector<Eigen::Index> number(grid_.size(), -1);
  std::vector<std::pair<Index, Node*>> nodes;
  for_active_nodes([&](const Index& index, Node& node) {
    number[static_cast<std::size_t>(&node - grid_.data())] = static_cast<Eigen::Index>(nodes.size());
    nodes.emplace_back(index, &node);
  });
  const auto count = static_cast<Eigen::Index>(nodes.size());
  const double b = case_.mass_blend;
  for (std::size_t a = 0; a < 3; ++a) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
    for (const auto& particle : case_.particles) {
      const Support& at = support<Support>(particle);
      for (std::size_t i = 0; i < at.count; ++i)
        for (std::size_t j = 0; j < at.count; ++j)
          if (number[at.node[i]] >= 0 && number[at.node[j]] >= 0)
            matrix(number[at.node[i]], number[at.node[j]]) +=
                (1 - b) * particle.m * at.value(i, a) * at.value(j, a);
    }
    Eigen::VectorXd right(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Node& node = *nodes[static_cast<std::size_t>(i)].second;
      matrix(i, i) += b * node.m;
      right(i) = node.m * (node.*of)[a];
    }
    // Rows and columns of what walls hold: u_i is given.
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& [index, node] = nodes[static_cast<std::size_t>(i)];
      const bool rests = at_rigid_wall(index, a) && (node->*stopped)[a] == 0;
      if (!rests && stop(index, a, 0) != Stop::held) continue;
      const double given = (node->*of)[a];
      right -= given * matrix.col(i);
      matrix.row(i).setZero();
      matrix.col(i).setZero();
      matrix(i, i) = 1;
      right(i) = given;
    }
    const Eigen::VectorXd solution = matrix.partialPivLu().solve(right);
    for (Eigen::Index i = 0; i < count; ++i)
      (nodes[static_cast<std::size_t>(i)].second->*of)[a] = solution(i);
  }
}

void ReferenceStepper::stop_at_walls(Vector Node::*of) {
  for_active_nodes([&](const Index& index, Node& node) {
    for (std::size_t a = 0; a < 3; ++a)
      if (stop(index, a, (node.*of)[a]) == Stop::wall) (node.*of)[a] = 0;
  });
}

/// Consistent mass: the increments; USF: the velocities at the end.
template <class Support>
void ReferenceStepper::solve_motion(double dt) {
  for_active_nodes([&](const Index&, Node& node) {
    for (std::size_t a = 0; a < 3; ++a) node.du[a] = dt * node.a[a];
  });
  solve_mass<Support>(&Node::du, &Node::v);
  for_active_nodes([&](const Index& index, Node& node) {
    for (std::size_t a = 0; a < 3; ++a) {
      node.a[a] = node.du[a] / dt;
      if (case_.scheme != ReferenceScheme::usf) continue;
      node.u[a] += node.du[a];
      if (at_rigid_wall(index, a) && node.v[a] == 0) node.u[a] = 0;
    }
  });
  stop_at_walls(&Node::u);
}

template void ReferenceStepper::add_orders<ReferenceStepper::CellSupport>();
template void ReferenceStepper::solve_mass<ReferenceStepper::CellSupport>(Vector Node::*of,
                                                                          Vector Node::*stopped);
template void ReferenceStepper::solve_motion<ReferenceStepper::CellSupport>(double dt);
template void ReferenceStepper::add_orders<ReferenceStepper::AnySupport>();
template void ReferenceStepper::solve_mass<ReferenceStepper::AnySupport>(Vector Node::*of,
                                                                         Vector Node::*stopped);
template void ReferenceStepper::solve_motion<ReferenceStepper::AnySupport>(double dt);

}  // namespace mpm::tests
