// The forces that keep bodies in their motion, as sums of impulses since time zero: of a body whose velocity
// is prescribed, the impulse m (v_prescribed - v) that its particles get beside the grid's; of a rigid body,
// that of contact. Sums are exact, so that they are the same on any ranks and threads.
#pragma once

#include <array>

#include "core/exact_sum.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

struct ReactionSums {
  /// Moments of contact on a rigid body are about its centre of mass, others about the origin. For these the
  /// last sums are mass and mass times position of the body at the start of the last step; else zero.
  enum Sum : std::size_t { impulse, moment = impulse + 3, mass = moment + 3, place, count = place + 3 };
  std::array<ExactSum, count> sums;

  void add(Sum first, const Vec3<double>& v) {
    for (std::size_t a = 0; a < 3; ++a) sums[first + a].add(v[static_cast<int>(a)]);
  }
  /// Adds those of a later step.
  void add_step(const ReactionSums& step) {
    for (std::size_t i = 0; i < mass; ++i) sums[i] += step.sums[i];
    for (std::size_t i = mass; i < count; ++i) sums[i] = step.sums[i];
  }
  ReactionSums& operator+=(const ReactionSums& other) {
    for (std::size_t i = 0; i < count; ++i) sums[i] += other.sums[i];
    return *this;
  }
};

/// Of a body of the model; the sums of this rank.
struct Reaction {
  int body = 0;
  bool by_contact = false;  ///< on a rigid body in contact; else what prescribes its velocity
  ReactionSums since_start;
};

}  // namespace mpm::core
