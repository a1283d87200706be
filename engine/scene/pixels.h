#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace rayengine {

/// Memory in large pages, where the system has them and the size is worth them: to touch small pages first takes
/// longer than to fill them. Throws std::bad_alloc.
void* allocate_pages(std::size_t bytes);
void free_pages(void* memory);

/// Allocates in large pages, and leaves numbers that nobody gave a value as the memory comes: who renders a picture
/// writes all of it, and from several threads at once, where zeros would be written by one.
template <class T>
struct PixelMemory {
  using value_type = T;

  PixelMemory() = default;
  template <class U>
  PixelMemory(const PixelMemory<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(allocate_pages(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { free_pages(memory); }
  void construct(T* at) { ::new (at) T; }
  template <class... Values>
  void construct(T* at, Values&&... values) {
    ::new (at) T(std::forward<Values>(values)...);
  }

  bool operator==(const PixelMemory&) const = default;
};

using Pixels = std::vector<float, PixelMemory<float>>;

}  // namespace rayengine
