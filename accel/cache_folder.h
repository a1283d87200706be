#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>

namespace rayengine {

/// Where files are kept that can always be made again: $XDG_CACHE_HOME/rayengine, else ~/.cache/rayengine; empty when
/// neither is known.
std::filesystem::path cache_folder();

using Bytes = std::span<const std::byte>;

/// A 128-bit name for content. Not cryptographic: made for accidents, not for enemies.
class ContentHash {
 public:
  ContentHash& add(Bytes bytes);
  /// 32 hexadecimal digits.
  std::string name() const;

 private:
  std::uint64_t low_ = 0x9e3779b97f4a7c15u, high_ = 0xc2b2ae3d27d4eb4fu;
};

/// Writes `parts` one after the other to `file`, making its folder where need be; others see all of it or nothing. Says
/// whether it could: a cache that cannot be written is no error.
bool write_cache_file(const std::filesystem::path& file, std::initializer_list<Bytes> parts);

}  // namespace rayengine
