// Loops over the threads of a rank. An exception must not leave an OpenMP region; the first one is kept and
// rethrown after all threads have finished, so that running out of memory is reported as usual.
#pragma once

#include <exception>

#include <omp.h>

namespace mpm::core {

/// Keeps the first exception that any thread throws.
class FirstException {
 public:
  template <class F>
  void guard(F f) noexcept {
    try {
      f();
    } catch (...) {
#pragma omp critical(mpm_first_exception)
      if (!first_) first_ = std::current_exception();
    }
  }
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::exception_ptr first_;
};

/// f(i) for first <= i < last by `threads` threads, in chunks of `chunk` consecutive i; in no particular
/// order.
template <class Index, class F>
void for_each_by_threads(Index first, Index last, int chunk, F f, int threads = omp_get_max_threads()) {
  FirstException failure;
#pragma omp parallel for schedule(dynamic, chunk) num_threads(threads)
  for (Index i = first; i < last; ++i) failure.guard([&] { f(i); });
  failure.rethrow();
}

}  // namespace mpm::core
