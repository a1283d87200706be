#include "cpu/instance_walk.h"

#include <algorithm>

namespace rayengine {

InstanceWalk::InstanceWalk(const Treelets& tree, std::span<const Ray> rays, std::span<const double> ends)
    : tree_(tree), ends_(ends) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!(ends[i] >= rays[i].tmin)) continue;
    number_[live_] = static_cast<std::uint32_t>(i);
    rays_[live_] = rays[i];
    cursors_[live_++] = {};
  }
}

void InstanceWalk::meet_unbounded() {
  const std::uint32_t instance = tree_.quadrics[tree_.unbounded.first_quadric + unbounded_met_++];
  for (std::size_t i = 0; i < live_; ++i)
    if (ends_[number_[i]] >= rays_[i].tmin) pairs_[pair_count_++] = {instance, number_[i]};
}

void InstanceWalk::meet_listed() {
  for (std::size_t i = 0; i < live_; ++i) {
    const TreeletEntry& entry = lists_[i * capacity + step_];
    if (step_ >= counts_[i] || entry.t > ends_[number_[i]]) continue;
    pairs_[pair_count_++] = {tree_.quadrics[tree_.treelets[entry.treelet].first_quadric], number_[i]};
  }
  ++step_;
  const std::span pairs(pairs_.data(), pair_count_);
  if (!std::ranges::is_sorted(pairs)) std::ranges::sort(pairs);
}

/// For the rays that want more. Whether there are any.
bool InstanceWalk::list_more() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < live_; ++i) {
    const double end = ends_[number_[i]];
    const bool passed = steps_ > 0 && counts_[i] > 0 && lists_[i * capacity + counts_[i] - 1].t > end;
    if (cursors_[i].finished() || passed || !(end >= rays_[i].tmin)) continue;
    number_[kept] = number_[i];
    rays_[kept] = rays_[i];
    rays_[kept].tmax = std::min(rays_[i].tmax, end);
    cursors_[kept++] = cursors_[i];
  }
  live_ = kept;
  if (live_ == 0) return false;
  walk(tree_, std::span(rays_).first(live_), std::span(cursors_).first(live_), capacity,
       std::span(lists_).first(live_ * capacity), std::span(counts_).first(live_));
  step_ = 0, steps_ = *std::max_element(counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(live_));
  return true;
}

std::span<const InstanceWalk::Pair> InstanceWalk::next() {
  pair_count_ = 0;
  while (pair_count_ == 0 && unbounded_met_ < tree_.unbounded.quadric_count) meet_unbounded();
  while (pair_count_ == 0) {
    if (step_ == steps_ && !list_more()) break;
    if (step_ < steps_) meet_listed();
  }
  return std::span(pairs_).first(pair_count_);
}

}  // namespace rayengine
