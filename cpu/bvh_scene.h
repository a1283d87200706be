#pragma once

#include <memory>
#include <vector>

#include "accel/treelets.h"
#include "cpu/isa/bvh_job.h"

namespace rayengine {

/// The queries of the best instruction set that this machine has.
const BvhQueries& bvh_queries();

/// Triangles so thin that doubles see no plane in them. Double would hit them at a t that is all rounding; who asks
/// exact arithmetic where double cannot tell keeps them.
enum class Planeless { left_out, kept };

/// Whether boxes say which primitives a ray may meet, or it is tested against all of them.
enum class Structure { bvh, none };

/// What a Geometry holds itself, not its instances, laid out for the queries of isa/bvh.inl. Immutable once built.
class BvhScene {
 public:
  /// Throws Error when there is no memory.
  BvhScene(std::shared_ptr<const Geometry> geometry, Planeless planeless, Structure structure = Structure::bvh);

  const Geometry& geometry() const { return *geometry_; }
  const BvhJob& job() const { return job_; }
  std::size_t bytes() const;

  /// Whether the numbers of all primitives are such that queries may certify.
  bool moderate() const { return moderate_; }
  /// The place in Geometry::triangles of a leaf's i-th.
  std::uint32_t triangle(const BvhLeaf& leaf, std::uint32_t i) const {
    constexpr std::uint32_t width = TriangleBlock<float>::width;
    const std::uint32_t block = leaf.first_block + i / width;
    return job_.float_blocks ? job_.float_blocks[block].id[i % width] : job_.double_blocks[block].id[i % width];
  }

 private:
  template <class T>
  void fill(std::vector<TriangleBlock<T>>& blocks, Planeless planeless);
  void add_quadric(const Quadric& quadric);
  void bound_corners();
  BvhLeaf leaf(const Treelet& treelet, std::uint32_t& blocks) const;

  std::shared_ptr<const Geometry> geometry_;
  Treelets treelets_;
  std::vector<BvhLeaf> leaves_;  ///< by treelet; those without a box last
  std::vector<TriangleBlock<float>> float_blocks_;
  std::vector<TriangleBlock<double>> double_blocks_;
  std::vector<std::uint8_t> kinds_;
  std::vector<double> norms_;
  bool moderate_ = true;
  BvhJob job_{};
};

}  // namespace rayengine
