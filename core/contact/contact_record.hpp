// What contact has done since time zero: the energy that it took from the nodes, and per pair of components
// impulses and heat of friction. Sums are exact, so that they are the same on any ranks and threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/exact_sum.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// Numbers of the pairs of components that are recorded: all, or with more than `most_components`
/// only that of the first two.
class ContactPairs {
 public:
  static constexpr int most_components = 16;

  ContactPairs() = default;
  explicit ContactPairs(std::size_t components)
      : components_(components > most_components ? 2 : static_cast<int>(components)) {}
  std::size_t size() const { return static_cast<std::size_t>(components_ * (components_ - 1) / 2); }
  /// The pair of components a < b: (0, 1), (0, 2), (1, 2), (0, 3) ...; -1 where it is not recorded.
  int number(std::int32_t a, std::int32_t b) const { return b < components_ ? b * (b - 1) / 2 + a : -1; }

 private:
  int components_ = 0;
};

struct ContactRecord {
  /// Of a pair of components.
  struct Pair {
    std::array<ExactSum, 3> impulse;  ///< on the second
    ExactSum friction_heat;
  };
  ExactSum dissipated;           ///< energy
  ExactSum other_friction_heat;  ///< of pairs that are not recorded
  std::vector<Pair> pairs;       ///< by ContactPairs::number

  bool empty() const { return pairs.empty(); }
  /// The part of the dissipated energy that friction took.
  ExactSum friction_heat() const {
    ExactSum sum = other_friction_heat;
    for (const Pair& pair : pairs) sum += pair.friction_heat;
    return sum;
  }
  /// `pair` -1: not recorded.
  void add(int pair, const Vec3<double>& impulse, double friction_heat) {
    if (pair < 0) return other_friction_heat.add(friction_heat);
    Pair& to = pairs[static_cast<std::size_t>(pair)];
    for (int a = 0; a < 3; ++a) to.impulse[static_cast<std::size_t>(a)].add(impulse[a]);
    to.friction_heat.add(friction_heat);
  }
  ContactRecord& operator+=(const ContactRecord& other) {
    dissipated += other.dissipated;
    other_friction_heat += other.other_friction_heat;
    pairs.resize(std::max(pairs.size(), other.pairs.size()));
    for (std::size_t i = 0; i < other.pairs.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) pairs[i].impulse[a] += other.pairs[i].impulse[a];
      pairs[i].friction_heat += other.pairs[i].friction_heat;
    }
    return *this;
  }
};

}  // namespace mpm::core
