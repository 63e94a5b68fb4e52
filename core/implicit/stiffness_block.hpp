// Sum of particles' stiffness over the nodes that they share: a dense matrix that grows with the nodes, and
// goes to the global matrix once for all particles of a site.
#pragma once

#include <vector>

#include "core/implicit/newton_solver.hpp"
#include "core/implicit/node_unknowns.hpp"

namespace mpm::core {

class StiffnessBlock {
 public:
  /// For the nodes of one brick.
  void begin(const NodeUnknowns::Node* nodes, int count) {
    of_ = nodes;
    place_.assign(static_cast<std::size_t>(count), -1);
    numbers_.clear();
    held_.clear();
  }

  /// A particle's nodes: grad S_i, for each component of the displacement, of the unknown that determines it.
  void begin_particle() { used_.clear(); }
  void add_node(int node, const Vec3<double>& slope) {
    const NodeUnknowns::Node& n = of_[node];
    std::int16_t& at = place_[static_cast<std::size_t>(n.from)];
    if (at < 0) {
      at = static_cast<std::int16_t>(numbers_.size());
      numbers_.push_back(n.number);
      held_.push_back(of_[n.from].held);
      grow();
    }
    Weight& w = weight_of(at);
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) w.slope[k][j] += n.sign[k] * slope[j];
  }
  /// Adds grad S_a . d . grad S_b of the nodes since begin_particle(); d(9 (3 i + j) + 3 k + l) the
  /// derivative of P_ij by G_kl.
  template <class D>
  void add_particle(D d);

  /// Passes the sum on, without the rows and columns of held components, and clears it.
  void flush(BlockMatrix& matrix, bool structure_alone);
  bool empty() const { return numbers_.empty(); }

 private:
  struct Weight {
    std::int16_t at;
    double slope[3][3];
  };
  static constexpr int most_nodes = 216;  ///< of one brick: 6 x 6 x 6
  Weight& weight_of(std::int16_t at) {
    for (Weight& w : used_)
      if (w.at == at) return w;
    used_.push_back({at, {}});
    return used_.back();
  }
  /// Keeps the rows of the sum at a distance that holds all nodes so far.
  void grow() {
    const std::size_t n = 3 * numbers_.size();
    if (n <= stride_) return;
    const std::size_t wider = std::max<std::size_t>(2 * stride_, 96);
    std::vector<double> moved(wider * wider, 0.0);
    for (std::size_t r = 0; r < stride_; ++r)
      std::copy_n(sum_.begin() + static_cast<std::ptrdiff_t>(r * stride_), stride_,
                  moved.begin() + static_cast<std::ptrdiff_t>(r * wider));
    sum_ = std::move(moved);
    stride_ = wider;
  }

  const NodeUnknowns::Node* of_ = nullptr;
  std::vector<std::int16_t> place_;  ///< by node of the brick
  std::vector<std::int64_t> numbers_;
  std::vector<std::uint8_t> held_;
  std::vector<Weight> used_;
  std::vector<double> sum_, packed_;
  std::size_t stride_ = 0;
};

template <class D>
void StiffnessBlock::add_particle(D d) {
  double a[9][9];
  for (int i = 0; i < 81; ++i) a[i / 9][i % 9] = d(i);
  for (const Weight& column : used_) {
    double right[9][3];  // d P_ij / d u_k of the column's node
    for (int ij = 0; ij < 9; ++ij)
      for (int k = 0; k < 3; ++k)
        right[ij][k] = a[ij][3 * k] * column.slope[k][0] + a[ij][3 * k + 1] * column.slope[k][1] +
                       a[ij][3 * k + 2] * column.slope[k][2];
    for (const Weight& row : used_) {
      double* to = sum_.data() + 3 * static_cast<std::size_t>(row.at) * stride_ + 3 * column.at;
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
          to[k] += row.slope[i][0] * right[3 * i][k] + row.slope[i][1] * right[3 * i + 1][k] +
                   row.slope[i][2] * right[3 * i + 2][k];
        to += stride_;
      }
    }
  }
}

inline void StiffnessBlock::flush(BlockMatrix& matrix, bool structure_alone) {
  const std::size_t n = 3 * numbers_.size();
  if (n == 0) return;
  if (structure_alone) {
    matrix.add(numbers_, nullptr);
  } else {
    packed_.resize(n * n);
    for (std::size_t r = 0; r < n; ++r) {
      double* row = sum_.data() + r * stride_;
      const bool held_row = (held_[r / 3] >> r % 3 & 1) != 0;
      for (std::size_t c = 0; c < n; ++c) {
        const bool held = held_row || (held_[c / 3] >> c % 3 & 1) != 0;
        packed_[r * n + c] = held ? 0.0 : row[c];
        row[c] = 0;
      }
    }
    matrix.add(numbers_, packed_.data());
  }
  std::fill(place_.begin(), place_.end(), std::int16_t{-1});
  numbers_.clear();
  held_.clear();
}

}  // namespace mpm::core
