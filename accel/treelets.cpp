#include "accel/treelets.h"

#include <algorithm>
#include <numeric>

#include "accel/tracer.h"

namespace rayengine {
namespace {

constexpr double widest = 0x1p1000;  // what lies farther out would make a frame whose scale has no inverse

bool has_end(const Box& box) { return !box.empty() && box.extent() < widest; }

/// Room for the rounding of the bounds themselves, which are worked out in double.
Box padded(Box box) {
  const glm::dvec3 pad = 0x1p-48 * glm::max(glm::abs(box.lower), glm::abs(box.upper));
  box.lower -= pad;
  box.upper += pad;
  return box;
}

/// The vertices in both precisions, as either may be tested.
Box triangle_bounds(const Geometry& geometry, const glm::uvec3& triangle) {
  Box box;
  for (int corner = 0; corner < 3; ++corner) {
    box.add(glm::dvec3(geometry.vertices[triangle[corner]]));
    box.add(geometry.vertex(triangle[corner]));
  }
  return box;
}

bool before_in_treelet(const TreeletPrimitive& a, const TreeletPrimitive& b) {
  // Adding one takes triangles, which have the highest type, before all quadrics.
  return std::pair(a.type + 1, a.id) < std::pair(b.type + 1, b.id);
}

/// Which treelet each node of the BVH becomes, no_id above the cut and below it.
std::vector<std::uint32_t> cut(const BinaryBvh& bvh, std::uint32_t K) {
  std::vector<std::uint32_t> treelet_of(bvh.nodes.size(), no_id);
  std::vector<std::uint32_t> open;
  if (!bvh.nodes.empty()) open.push_back(0);
  std::uint32_t count = 0;
  while (!open.empty()) {
    const std::uint32_t i = open.back();
    open.pop_back();
    const BinaryBvh::Node& node = bvh.nodes[i];
    if (node.leaf() || node.count <= K) {
      treelet_of[i] = count++;
    } else {
      open.push_back(node.right);
      open.push_back(i + 1);
    }
  }
  return treelet_of;
}

}  // namespace

bool TreeletPrimitive::bounded() const { return has_end(bounds); }

std::vector<TreeletPrimitive> treelet_primitives(const Geometry& geometry) {
  std::vector<TreeletPrimitive> result;
  result.reserve(geometry.triangles.size() + geometry.quadrics.size());
  for (std::uint32_t i = 0; i < geometry.triangles.size(); ++i)
    result.push_back({triangle_bounds(geometry, geometry.triangles[i]), TreeletPrimitive::triangle, i});
  for (std::uint32_t i = 0; i < geometry.quadrics.size(); ++i)
    result.push_back(
        {padded(bounds(geometry, geometry.quadrics[i])), static_cast<std::uint32_t>(geometry.quadrics[i].type), i});
  return result;
}

Box frame_bounds(const Geometry& geometry) {
  Box all;
  for (const glm::uvec3& triangle : geometry.triangles)
    for (int corner = 0; corner < 3; ++corner) all.add(geometry.vertex(triangle[corner]));
  for (const Quadric& quadric : geometry.quadrics)
    if (const Box box = bounds(geometry, quadric); has_end(box)) all.add(box);
  return all.empty() || has_end(all) ? all : Box{};
}

std::size_t Treelets::bytes() const {
  return nodes.capacity() * sizeof(WideNode) + treelets.capacity() * sizeof(Treelet) +
         (triangles.capacity() + quadrics.capacity()) * sizeof(std::uint32_t);
}

Treelet append_treelet(Treelets& to, std::span<const TreeletPrimitive> primitives, std::span<std::uint32_t> members) {
  std::sort(members.begin(), members.end(),
            [&](std::uint32_t a, std::uint32_t b) { return before_in_treelet(primitives[a], primitives[b]); });
  Treelet t;
  t.first_triangle = static_cast<std::uint32_t>(to.triangles.size());
  t.first_quadric = static_cast<std::uint32_t>(to.quadrics.size());
  for (const std::uint32_t i : members) {
    const TreeletPrimitive& p = primitives[i];
    (p.type == TreeletPrimitive::triangle ? to.triangles : to.quadrics).push_back(p.id);
  }
  t.triangle_count = static_cast<std::uint32_t>(to.triangles.size()) - t.first_triangle;
  t.quadric_count = static_cast<std::uint32_t>(to.quadrics.size()) - t.first_quadric;
  return t;
}

Treelets build_treelets(std::span<const TreeletPrimitive> primitives, std::uint32_t K, const Box& about) {
  if (K == 0) throw Error("treelets of no primitives were asked for: K must be 1 or more");
  std::vector<Box> boxes;
  std::vector<std::uint32_t> bounded, unbounded;
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const bool fits = primitives[i].bounded();
    (fits ? bounded : unbounded).push_back(i);
    if (fits) boxes.push_back(primitives[i].bounds);
  }

  const BinaryBvh bvh = build_bvh(boxes, std::min(K, 8u), about);
  const std::vector<std::uint32_t> treelet_of = cut(bvh, K);
  Treelets result;
  result.frame = bvh.frame;
  result.nodes = widen(bvh, [&](std::uint32_t i) { return treelet_of[i]; });
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    if (treelet_of[i] == no_id) continue;
    std::vector<std::uint32_t> members;
    for (std::uint32_t k = 0; k < bvh.nodes[i].count; ++k)
      members.push_back(bounded[bvh.order[bvh.nodes[i].first + k]]);
    result.treelets.push_back(append_treelet(result, primitives, members));
  }
  result.unbounded = append_treelet(result, primitives, unbounded);
  return result;
}

Treelets list_all(const Geometry& g) {
  Treelets list;
  list.frame = LocalFrame(frame_bounds(g));
  list.triangles.resize(g.triangles.size());
  list.quadrics.resize(g.quadrics.size());
  std::iota(list.triangles.begin(), list.triangles.end(), 0u);
  std::iota(list.quadrics.begin(), list.quadrics.end(), 0u);
  std::stable_sort(list.quadrics.begin(), list.quadrics.end(),
                   [&](auto a, auto b) { return g.quadrics[a].type < g.quadrics[b].type; });
  list.unbounded.triangle_count = static_cast<std::uint32_t>(list.triangles.size());
  list.unbounded.quadric_count = static_cast<std::uint32_t>(list.quadrics.size());
  return list;
}

}  // namespace rayengine
