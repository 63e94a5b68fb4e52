// Memory of whole pages.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace mpm::core {

struct FreePages {
  void operator()(double* p) const { std::free(p); }
};
using Pages = std::unique_ptr<double[], FreePages>;

/// Room for at least so many. Huge pages where it fills one: the passes over bricks touch more memory than
/// small pages' addresses are kept for. Not initialised. Throws std::bad_alloc.
Pages allocate_pages(std::size_t doubles);

}  // namespace mpm::core
