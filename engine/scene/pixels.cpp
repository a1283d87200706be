#include "engine/scene/pixels.h"

#include <sys/mman.h>

#include <cstdlib>

namespace rayengine {

void* allocate_pages(std::size_t bytes) {
  constexpr std::size_t page = std::size_t{2} << 20;  // of x86-64's large pages
  const bool large = bytes >= page;
  const std::size_t whole = (bytes + page - 1) / page * page;
  void* const memory = large ? std::aligned_alloc(page, whole) : std::malloc(bytes);
  if (!memory) throw std::bad_alloc();
  if (large) madvise(memory, whole, MADV_HUGEPAGE);  // small ones where it has none
  return memory;
}

void free_pages(void* memory) { std::free(memory); }

}  // namespace rayengine
