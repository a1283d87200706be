#pragma once

#include <cstdint>

namespace rayengine {

/// Over 2^32 the i-th number of van der Corput's sequence in base 2.
inline std::uint32_t reversed_bits(std::uint32_t i) {
  i = (i << 16) | (i >> 16);
  i = ((i & 0x00FF00FFu) << 8) | ((i & 0xFF00FF00u) >> 8);
  i = ((i & 0x0F0F0F0Fu) << 4) | ((i & 0xF0F0F0F0u) >> 4);
  i = ((i & 0x33333333u) << 2) | ((i & 0xCCCCCCCCu) >> 2);
  return ((i & 0x55555555u) << 1) | ((i & 0xAAAAAAAAu) >> 1);
}

}  // namespace rayengine
