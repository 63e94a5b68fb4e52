#include "core/pages.hpp"

#include <new>

#include <sys/mman.h>

namespace mpm::core {

Pages allocate_pages(std::size_t doubles) {
  constexpr std::size_t page = 4096, huge_page = std::size_t{1} << 21;
  const std::size_t wanted = doubles * sizeof(double);
  const std::size_t alignment = wanted < huge_page ? page : huge_page;
  const std::size_t bytes = (wanted + alignment - 1) / alignment * alignment;
  Pages pages(static_cast<double*>(std::aligned_alloc(alignment, bytes)));
  if (!pages) throw std::bad_alloc();
  if (alignment == huge_page) madvise(pages.get(), bytes, MADV_HUGEPAGE);  // a hint; small pages work too
  return pages;
}

}  // namespace mpm::core
