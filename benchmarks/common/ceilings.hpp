// The two ceilings of a time step: memory bandwidth and floating-point rate. Measured in the same run as the
// results compared with them.
//
// triad      a = b + k c over arrays far larger than the caches; 24 bytes per element (the line of `a` that
// is
//            fetched before it is written is not counted, as is the custom)
// in place   a = k a + d; 16 bytes per element, all of which travel
// FMA        independent chains of fused multiply-adds in registers, two operations each
#pragma once

#include <array>
#include <cstdlib>
#include <memory>
#include <new>

#include <omp.h>
#include <sys/mman.h>

#include "benchmarks/common/clock.hpp"
#include "core/simd/lanes.hpp"

namespace mpm::benchmarks {

struct Ceilings {
  double triad = 0;     ///< bytes/s, all threads together
  double in_place = 0;  ///< bytes/s, all threads together
  double flops = 0;     ///< 1/s, all threads together
  /// Upper bound for a step.
  double bandwidth() const { return std::max(triad, in_place); }
  void take_best(const Ceilings& o) {
    triad = std::max(triad, o.triad);
    in_place = std::max(in_place, o.in_place);
    flops = std::max(flops, o.flops);
  }
};

namespace detail {

using Vector = core::Lanes<8>;  // the compiler cuts it to what the machine has

class Buffer {
 public:
  explicit Buffer(std::size_t n) : size_(n) {
    constexpr std::size_t huge_page = std::size_t{1} << 21;
    const std::size_t bytes = (n * sizeof(double) + huge_page - 1) / huge_page * huge_page;
    data_.reset(static_cast<double*>(std::aligned_alloc(huge_page, bytes)));
    if (!data_) throw std::bad_alloc();
    madvise(data_.get(), bytes, MADV_HUGEPAGE);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < n; ++i) data_[i] = 1;
  }
  double* data() { return data_.get(); }
  std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(double* p) const { std::free(p); }
  };
  std::unique_ptr<double[], Free> data_;
  std::size_t size_;
};

/// Largest of several rates; f() does `work` per call, on all threads.
template <class F>
double best_rate(double work, int repeats, F f) {
  Series seconds;
  for (int r = 0; r < repeats; ++r) {
    const Seconds before = Seconds::now();
    f();
    const Seconds passed = Seconds::now() - before;
    seconds.add(omp_get_max_threads() == 1 ? passed.cpu : passed.wall);
  }
  return work / seconds.best();
}

inline void triad(Buffer& a, Buffer& b, Buffer& c) {
  double *x = a.data(), *y = b.data(), *z = c.data();
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < a.size(); i += 8) {
    core::store(x + i, core::load<Vector>(y + i) + Vector(1e-9) * core::load<Vector>(z + i));
  }
}

inline void in_place(Buffer& a) {
  double* x = a.data();
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < a.size(); i += 8) {
    core::store(x + i, core::load<Vector>(x + i) * Vector(1.0000001) + Vector(1e-9));
  }
}

/// Chains long enough to hide the latency, few enough to stay in 16 registers of any width.
inline constexpr int fma_chains = 10;
inline void multiply_and_add(long rounds) {
#pragma omp parallel
  {
    std::array<Vector, fma_chains> x;
    for (int i = 0; i < fma_chains; ++i) x[static_cast<std::size_t>(i)] = Vector(1.0 + 1e-3 * i);
    Vector a(0.999999), b(1e-6);
    asm volatile("" : "+m"(a), "+m"(b));  // unknown to the compiler
    for (long r = 0; r < rounds; ++r) {
#pragma GCC unroll 10
      for (std::size_t i = 0; i < fma_chains; ++i) x[i] = x[i] * a + b;
    }
    for (const Vector& v : x) keep(v);
  }
}

}  // namespace detail

/// On as many threads as OpenMP gives; takes about a second.
inline Ceilings measure_ceilings() {
  using namespace detail;
  Ceilings c;
  {
    constexpr std::size_t n = std::size_t{1} << 24;  // 128 MiB each
    Buffer x(n), y(n), z(n);
    c.triad = best_rate(24.0 * n, 5, [&] { triad(x, y, z); });
    c.in_place = best_rate(16.0 * n, 5, [&] { in_place(x); });
  }
  constexpr long rounds = 2'000'000;
  c.flops =
      best_rate(2.0 * 8 * fma_chains * rounds * omp_get_max_threads(), 5, [] { multiply_and_add(rounds); });
  return c;
}

}  // namespace mpm::benchmarks
