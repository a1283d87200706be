#pragma once

#include <memory>
#include <vector>

#include "accel/treelets.h"
#include "cpu/isa/bvh_job.h"

namespace rayengine {

/// What a Geometry holds itself, not its instances, laid out for the queries of isa/bvh.inl. Immutable once built.
class BvhScene {
 public:
  /// Throws Error when there is no memory.
  explicit BvhScene(std::shared_ptr<const Geometry> geometry);

  const Geometry& geometry() const { return *geometry_; }
  const BvhJob& job() const { return job_; }
  std::size_t bytes() const;

 private:
  template <class T>
  void fill(std::vector<TriangleBlock<T>>& blocks);
  BvhLeaf leaf(const Treelet& treelet, std::uint32_t& blocks) const;

  std::shared_ptr<const Geometry> geometry_;
  Treelets treelets_;
  std::vector<BvhLeaf> leaves_;  ///< by treelet; those without a box last
  std::vector<TriangleBlock<float>> float_blocks_;
  std::vector<TriangleBlock<double>> double_blocks_;
  std::vector<std::uint8_t> kinds_;
  BvhJob job_{};
};

}  // namespace rayengine
