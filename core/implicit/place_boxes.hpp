// Finds what is near a place.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/tensor/tensor.hpp"

namespace mpm::core {

/// Numbers by place: those in the 27 boxes of edge `size` around one.
class PlaceBoxes {
 public:
  explicit PlaceBoxes(double size) : per_size_(1 / size) {}
  void add(const Vec3<double>& x, std::size_t number) { of_[key(box(x))].push_back(number); }
  template <class F>
  void for_each_around(const Vec3<double>& x, F f) const {
    const std::array<std::int64_t, 3> at = box(x);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const auto found = of_.find(key({at[0] + i, at[1] + j, at[2] + k}));
          if (found == of_.end()) continue;
          for (const std::size_t number : found->second) f(number);
        }
  }

 private:
  std::array<std::int64_t, 3> box(const Vec3<double>& x) const {
    std::array<std::int64_t, 3> at;
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = static_cast<std::int64_t>(std::floor(per_size_ * x[static_cast<int>(a)]));
    return at;
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& at) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
    std::uint64_t all = 0;
    for (const std::int64_t i : at) all = all << 21 | (static_cast<std::uint64_t>(i) & mask);
    return all;
  }
  double per_size_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> of_;
};

}  // namespace mpm::core
