#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>

#include "accel/walk.h"

namespace rayengine {

/// Which rays may hit which instances, step by step: each ray meets its instances by ascending distance, and rays that
/// meet the same one in a step are told together, so that they can be traced through it as a packet.
class InstanceWalk {
 public:
  static constexpr std::size_t most_rays = 64;

  /// A ray, by its place among those given, and an instance that it may hit.
  struct Pair {
    std::uint32_t instance, ray;
    friend auto operator<=>(const Pair&, const Pair&) = default;
  };

  /// At most most_rays, over a tree of treelets of one instance each, listed among its quadrics. `ends` are the t
  /// beyond which rays want no more, below tmin if they want nothing; between steps they may be lowered. All must
  /// outlive this.
  InstanceWalk(const Treelets& tree, std::span<const Ray> rays, std::span<const double> ends);

  /// The pairs of the next step, those of an instance together; none when all is done. Instances without a box come
  /// first, and every ray meets them.
  std::span<const Pair> next();

 private:
  static constexpr std::uint32_t capacity = 8;

  void meet_unbounded();
  void meet_listed();
  bool list_more();

  const Treelets& tree_;
  std::span<const double> ends_;
  std::uint32_t unbounded_met_ = 0;
  std::uint32_t step_ = 0, steps_ = 0;  ///< of the lists
  std::size_t live_ = 0;                ///< rays that are not done, kept together
  std::array<std::uint32_t, most_rays> number_;
  std::array<Ray, most_rays> rays_;
  std::array<WalkCursor, most_rays> cursors_;
  std::array<std::uint32_t, most_rays> counts_;
  std::array<TreeletEntry, most_rays * capacity> lists_;
  std::array<Pair, most_rays> pairs_;
  std::size_t pair_count_ = 0;
};

}  // namespace rayengine
