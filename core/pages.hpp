// Page-aligned memory.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace mpm::core {

struct FreePages {
  void operator()(double* p) const { std::free(p); }
};
using Pages = std::unique_ptr<double[], FreePages>;

/// Memory for at least this many doubles, not initialised. Huge pages where it fills one: the passes over
/// bricks touch more memory than the TLB covers with small pages. Throws std::bad_alloc.
Pages allocate_pages(std::size_t doubles);

}  // namespace mpm::core
