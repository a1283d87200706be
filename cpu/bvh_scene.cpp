#include "cpu/bvh_scene.h"

#include <algorithm>
#include <limits>

#include "accel/surface.h"
#include "cpu/moderate.h"
#include "cpu/quadric_kind.h"

namespace rayengine {
namespace {

constexpr std::uint32_t width = TriangleBlock<float>::width;

/// Triangles are tested a block at a time, quadrics one by one.
std::uint32_t leaf_size(const Geometry& geometry) {
  return geometry.triangles.size() > geometry.quadrics.size() ? width : 1;
}

/// Corners that are not numbers: no comparison lets them through.
template <class T>
TriangleBlock<T> empty_block() {
  TriangleBlock<T> block{};
  for (auto& corner : block.corners)
    for (auto& axis : corner) std::fill(std::begin(axis), std::end(axis), std::numeric_limits<T>::quiet_NaN());
  return block;
}

}  // namespace

const BvhQueries& bvh_queries() {
  switch (best_isa()) {
    case Isa::avx512: return avx512::bvh_queries;
    case Isa::avx2: return avx2::bvh_queries;
    case Isa::sse2: break;
  }
  return sse2::bvh_queries;
}

BvhLeaf BvhScene::leaf(const Treelet& treelet, std::uint32_t& blocks) const {
  const BvhLeaf leaf{blocks, treelet.triangle_count, treelet.first_quadric, treelet.quadric_count};
  blocks += (treelet.triangle_count + width - 1) / width;
  return leaf;
}

template <class T>
void BvhScene::fill(std::vector<TriangleBlock<T>>& blocks, Planeless planeless) {
  const BvhLeaf& last = leaves_.back();
  blocks.resize(last.first_block + (last.triangle_count + width - 1) / width, empty_block<T>());
  const std::uint32_t* id = treelets_.triangles.data();
  for (const BvhLeaf& leaf : leaves_) {
    for (std::uint32_t i = 0; i < leaf.triangle_count; ++i, ++id) {
      TriangleBlock<T>& block = blocks[leaf.first_block + i / width];
      block.id[i % width] = *id;
      if (planeless == Planeless::left_out && triangle_normal(*geometry_, *id) == glm::dvec3(0)) continue;
      for (int corner = 0; corner < 3; ++corner) {
        const glm::dvec3 p = geometry_->vertex(geometry_->triangles[*id][corner]);
        for (int axis = 0; axis < 3; ++axis) block.corners[corner][axis][i % width] = static_cast<T>(p[axis]);
      }
    }
  }
}

BvhScene::BvhScene(std::shared_ptr<const Geometry> geometry, Planeless planeless, Structure structure)
    : geometry_(std::move(geometry)) {
  treelets_ = structure == Structure::none
                  ? list_all(*geometry_)
                  : build_treelets(treelet_primitives(*geometry_), leaf_size(*geometry_), frame_bounds(*geometry_));
  std::uint32_t blocks = 0;
  for (const Treelet& treelet : treelets_.treelets) leaves_.push_back(leaf(treelet, blocks));
  leaves_.push_back(leaf(treelets_.unbounded, blocks));
  const bool exact = geometry_->exact_vertices.empty();
  exact ? fill(float_blocks_, planeless) : fill(double_blocks_, planeless);
  for (const std::uint32_t i : treelets_.quadrics) add_quadric(geometry_->quadrics[i]);
  bound_corners();

  if (!treelets_.treelets.empty()) static_cast<WalkSpace&>(job_) = walk_space(treelets_);
  job_.geometry = geometry_.get();
  job_.leaves = leaves_.data();
  job_.unbounded = treelets_.unbounded.size() ? &leaves_.back() : nullptr;
  job_.float_blocks = exact ? float_blocks_.data() : nullptr;
  job_.double_blocks = exact ? nullptr : double_blocks_.data();
  job_.quadrics = treelets_.quadrics.data();
  job_.kinds = kinds_.data();
  job_.norms = norms_.data();
}

void BvhScene::add_quadric(const Quadric& quadric) {
  kinds_.push_back(static_cast<std::uint8_t>(kind_of(quadric)));
  norms_.push_back(norm_of(quadric.to_object.linear));
  moderate_ = moderate_ && is_moderate(norms_.back()) &&
              largest_component(quadric.to_object.origin) <= moderate_limit &&
              (quadric.type != QuadricType::general || is_moderate(geometry_->forms[quadric.form]));
}

void BvhScene::bound_corners() {
  Box box;
  for (const glm::uvec3& triangle : geometry_->triangles)
    for (int corner = 0; corner < 3; ++corner) box.add(geometry_->vertex(triangle[corner]));
  if (box.empty()) box = {glm::dvec3(0), glm::dvec3(0)};
  moderate_ = moderate_ && box.extent() <= moderate_limit;
  for (int axis = 0; axis < 3; ++axis)
    job_.corner_lower[axis] = box.lower[axis], job_.corner_upper[axis] = box.upper[axis];
}

std::size_t BvhScene::bytes() const {
  return treelets_.bytes() + leaves_.capacity() * sizeof(BvhLeaf) +
         float_blocks_.capacity() * sizeof(TriangleBlock<float>) +
         double_blocks_.capacity() * sizeof(TriangleBlock<double>) + kinds_.capacity() +
         norms_.capacity() * sizeof(double);
}

}  // namespace rayengine
