// Sum of particles' stiffness over the nodes that they share: a dense matrix that grows with the nodes, and
// goes to the global matrix once for all particles of a site.
#pragma once

#include <algorithm>
#include <span>
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
    used_at_.assign(static_cast<std::size_t>(count), -1);
    used_.clear();
    numbers_.clear();
    held_.clear();
  }

  /// A particle's nodes: grad S_i, for each component of the displacement, of the unknown that determines it.
  void begin_particle() {
    for (const Weight& w : used_) used_at_[static_cast<std::size_t>(w.at)] = -1;
    used_.clear();
  }
  void add_node(int node, const Vec3<double>& slope) {
    const NodeUnknowns::Node& n = of_[node];
    Weight& w = weight_of(place_of(n));
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) w.slope[k][j] += n.sign[k] * slope[j];
  }
  /// Adds grad S_a . d . grad S_b of the nodes since begin_particle(); d(9 (3 i + j) + 3 k + l) the
  /// derivative of P_ij by G_kl.
  template <class D>
  void add_particle(D d);

  /// The place in the sum of the unknown that determines a node, and its signs.
  struct Unknown {
    std::size_t place;
    const std::int8_t (&sign)[3];
  };
  Unknown unknown_of(int node) {
    const NodeUnknowns::Node& n = of_[node];
    return {static_cast<std::size_t>(place_of(n)), n.sign};
  }
  /// Adds left_a right_b over the unknowns so far, three per place.
  void add_product(std::span<const double> left, std::span<const double> right) {
    const std::size_t n = 3 * numbers_.size();
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c < n; ++c) sum_[r * stride_ + c] += left[r] * right[c];
  }

  /// Passes stiffness e e^T over the unknowns so far on, without held components, apart from the sum.
  void pass_product(BlockMatrix& matrix, std::span<double> e, double stiffness) const {
    if (!e.empty()) e = e.first(3 * numbers_.size());
    for (std::size_t k = 0; k < e.size(); ++k)
      if ((held_[k / 3] >> k % 3 & 1) != 0) e[k] = 0;
    matrix.add_product(numbers_, e, stiffness);
  }
  /// Passes the sum on, without the rows and columns of held components, and clears it.
  void flush(BlockMatrix& matrix, bool structure_alone);
  bool empty() const { return numbers_.empty(); }

 private:
  struct Weight {
    std::int16_t at;
    double slope[3][3];
  };
  std::int16_t place_of(const NodeUnknowns::Node& n) {
    std::int16_t& at = place_[static_cast<std::size_t>(n.from)];
    if (at < 0) {
      at = static_cast<std::int16_t>(numbers_.size());
      numbers_.push_back(n.number);
      held_.push_back(of_[n.from].held);
      grow();
    }
    return at;
  }
  Weight& weight_of(std::int16_t at) {
    std::int16_t& index = used_at_[static_cast<std::size_t>(at)];
    if (index < 0) {
      index = static_cast<std::int16_t>(used_.size());
      used_.push_back({at, {}});
    }
    return used_[static_cast<std::size_t>(index)];
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
  std::vector<std::int16_t> place_;    ///< by node of the brick
  std::vector<std::int16_t> used_at_;  ///< by place in the sum: the index in `used_`
  std::vector<std::int64_t> numbers_;
  std::vector<std::uint8_t> held_;
  std::vector<Weight> used_;
  std::vector<double> sum_, packed_, right_;
  std::size_t stride_ = 0;
};

template <class D>
void StiffnessBlock::add_particle(D d) {
  double a[9][9];
  for (int i = 0; i < 81; ++i) a[i / 9][i % 9] = d(i);
  // d P_ij / d u_k of the nodes: a row of contiguous values for each ij.
  const std::size_t n = used_.size(), width = 3 * n;
  right_.resize(9 * width);
  bool in_order = true;
  for (std::size_t q = 0; q < n; ++q) {
    const Weight& column = used_[q];
    in_order = in_order && static_cast<std::size_t>(column.at) == q;
    for (std::size_t ij = 0; ij < 9; ++ij)
      for (std::size_t k = 0; k < 3; ++k)
        right_[ij * width + 3 * q + k] = a[ij][3 * k] * column.slope[k][0] +
                                         a[ij][3 * k + 1] * column.slope[k][1] +
                                         a[ij][3 * k + 2] * column.slope[k][2];
  }
  for (const Weight& row : used_) {
    for (std::size_t i = 0; i < 3; ++i) {
      double* const to = sum_.data() + (3 * static_cast<std::size_t>(row.at) + i) * stride_;
      const double* const right = right_.data() + 3 * i * width;
      const double x = row.slope[i][0], y = row.slope[i][1], z = row.slope[i][2];
      // The usual case: the particles of a site have the same nodes in the same order.
      if (in_order) {
        for (std::size_t c = 0; c < width; ++c)
          to[c] += x * right[c] + y * right[width + c] + z * right[2 * width + c];
      } else {
        for (std::size_t q = 0; q < n; ++q)
          for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t c = 3 * q + k;
            to[3 * static_cast<std::size_t>(used_[q].at) + k] +=
                x * right[c] + y * right[width + c] + z * right[2 * width + c];
          }
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
  std::fill(used_at_.begin(), used_at_.end(), std::int16_t{-1});
  used_.clear();
  numbers_.clear();
  held_.clear();
}

}  // namespace mpm::core
