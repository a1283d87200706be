#pragma once

#include <memory>
#include <vector>

#include "cpu/reference/bvh.h"
#include "cpu/reference/trial.h"

namespace rayengine::reference {

/// One Geometry made ready to be walked, and below it the groups that it places.
class Walk {
 public:
  explicit Walk(const Geometry& geometry);

  /// Gives every hit of the ray that lies in its interval, and not clearly beyond sink.reach(), to `sink`.
  void trace(const Ray& ray, Sink& sink) const;
  std::size_t bytes() const;

 private:
  void trace(const Placed& placed, Sink& sink) const;
  void trace_item(const Placed& placed, std::uint32_t item, Sink& sink) const;
  void trace_instance(const Placed& placed, const Instance& instance, Sink& sink) const;
  Box box_of(std::uint32_t item) const;

  const Geometry& geometry_;
  std::vector<std::unique_ptr<Walk>> groups_;
  std::vector<std::uint32_t> unbounded_;  ///< items that are tested always
  std::unique_ptr<Bvh> bvh_;              ///< of items: triangles first, then quadrics, then instances
};

}  // namespace rayengine::reference
