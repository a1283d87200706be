#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

namespace rayengine {

inline constexpr std::size_t chunks = 64;

/// Calls work(chunk, begin, end) for as many chunks of so many, on all threads: the same chunks, however many those
/// are.
template <class Work>
void for_each_chunk(std::size_t count, Work work) {
  tbb::parallel_for(std::size_t{0}, chunks,
                    [&](std::size_t chunk) { work(chunk, count * chunk / chunks, count * (chunk + 1) / chunks); });
}

}  // namespace rayengine
