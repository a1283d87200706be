#pragma once

#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>
#include <unordered_map>

namespace rayengine {

/// Gives equal points one number: the order in which they were first seen.
class Weld {
 public:
  explicit Weld(std::size_t expected = 0) { numbers_.reserve(expected); }

  /// Second: whether the point is new.
  std::pair<std::uint32_t, bool> add(const glm::dvec3& p) {
    const auto [entry, is_new] = numbers_.try_emplace(p, static_cast<std::uint32_t>(numbers_.size()));
    return {entry->second, is_new};
  }

 private:
  struct Hash {
    std::size_t operator()(const glm::dvec3& p) const {
      std::uint64_t h = 0;
      // Adding zero makes -0 and 0, which compare equal, hash alike.
      for (const double x : {p.x + 0.0, p.y + 0.0, p.z + 0.0}) {
        h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ull;
        h ^= h >> 32;
      }
      return h;
    }
  };
  std::unordered_map<glm::dvec3, std::uint32_t, Hash> numbers_;
};

}  // namespace rayengine
