// What contact has done since time zero: the energy that it took from the nodes and the impulses between the
// components. Sums are exact, so that they are the same on any ranks and threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/exact_sum.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// Numbers of the pairs of components whose impulses are recorded: all, or with more than `most_components`
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
  ExactSum dissipated;             ///< energy
  ExactSum friction_heat;          ///< the part of it that friction took
  std::vector<ExactSum> impulses;  ///< of pair k in 3 k .. 3 k + 2: on its second component

  bool empty() const { return impulses.empty(); }
  void add_impulse(int pair, const Vec3<double>& impulse) {
    for (int a = 0; a < 3; ++a) impulses[static_cast<std::size_t>(3 * pair + a)].add(impulse[a]);
  }
  ContactRecord& operator+=(const ContactRecord& other) {
    dissipated += other.dissipated;
    friction_heat += other.friction_heat;
    impulses.resize(std::max(impulses.size(), other.impulses.size()));
    for (std::size_t i = 0; i < other.impulses.size(); ++i) impulses[i] += other.impulses[i];
    return *this;
  }
};

}  // namespace mpm::core
