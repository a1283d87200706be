#include "engine/load/decimate.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <cmath>

#include "accel/ray.h"
#include "engine/load/surface_distance.h"

namespace rayengine {
namespace {

constexpr int most_tries = 4;
constexpr int most_stages = 4;
constexpr double stage_share = 0.2;         // of the limit: OpenMesh looks at vertices, and triangles stray farther
constexpr double least_progress = 0.1;      // of a stage: triangles dropped
constexpr std::uint32_t most_absorbed = 8;  // vertices by another, in one stage

using TriangleList = std::vector<glm::uvec3>;

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::Status);
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Decimater = OpenMesh::Decimater::DecimaterT<HalfEdgeMesh>;

/// OpenMesh reports faces that it cannot hold on its error stream; they are no errors here.
class Quiet {
 public:
  Quiet() { omerr().disable(); }
  ~Quiet() { omerr().enable(); }
};

/// Lets each vertex absorb a few others only. The Hausdorff module tries all that were removed so far at every collapse
/// around them, which on flat ground takes time that grows with the square of their number.
template <class M>
class ModAbsorbT : public OpenMesh::Decimater::ModBaseT<M> {
 public:
  DECIMATING_MODULE(ModAbsorbT, M, Absorb);

  explicit ModAbsorbT(M& mesh) : Base(mesh, true) {}
  void initialize() override { absorbed_.assign(Base::mesh().n_vertices(), 0); }
  float collapse_priority(const CollapseInfo& info) override {
    return float(sum(info) < most_absorbed ? Base::LEGAL_COLLAPSE : Base::ILLEGAL_COLLAPSE);
  }
  void postprocess_collapse(const CollapseInfo& info) override { absorbed_[index(info.v1)] = sum(info) + 1; }

 private:
  static std::size_t index(OpenMesh::VertexHandle v) { return static_cast<std::size_t>(v.idx()); }
  std::uint32_t sum(const CollapseInfo& info) const { return absorbed_[index(info.v0)] + absorbed_[index(info.v1)]; }

  std::vector<std::uint32_t> absorbed_;
};

/// The mesh in OpenMesh's terms, beside the faces that it refuses.
class Collapsible {
 public:
  Collapsible(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
              const std::vector<char>& kept)
      : vertex_(positions.size()) {
    const Quiet quiet;
    for (const glm::uvec3& t : triangles)
      if (!mesh_.add_face(vertex(positions, t.x), vertex(positions, t.y), vertex(positions, t.z)).is_valid())
        refused_.push_back(t);
    for (const glm::uvec3& t : refused_)
      for (int k = 0; k < 3; ++k) mesh_.status(vertex_[t[k]]).set_locked(true);
    for (std::size_t i = 0; i < origin_.size(); ++i)
      if (kept[origin_[i]]) mesh_.status(OpenMesh::VertexHandle(static_cast<int>(i))).set_locked(true);
    mesh_.update_face_normals();
  }

  void collapse(double limit) {
    Decimater decimater(mesh_);
    OpenMesh::Decimater::ModQuadricT<HalfEdgeMesh>::Handle quadric;
    OpenMesh::Decimater::ModHausdorffT<HalfEdgeMesh>::Handle hausdorff;
    OpenMesh::Decimater::ModNormalFlippingT<HalfEdgeMesh>::Handle flipping;
    ModAbsorbT<HalfEdgeMesh>::Handle absorb;
    decimater.add(quadric), decimater.add(hausdorff), decimater.add(flipping), decimater.add(absorb);
    decimater.module(quadric).unset_max_err();  // its order alone: weighted by area, it is no distance
    decimater.module(hausdorff).set_tolerance(limit);
    if (decimater.initialize()) decimater.decimate();
  }

  TriangleList triangles() const {
    TriangleList list = refused_;
    for (const auto face : mesh_.faces()) {
      glm::uvec3 t;
      int k = 0;
      for (const auto v : mesh_.fv_range(face)) t[k++] = origin_[static_cast<std::size_t>(v.idx())];
      list.push_back(t);
    }
    return list;
  }

 private:
  OpenMesh::VertexHandle vertex(std::span<const glm::dvec3> positions, std::uint32_t i) {
    if (!vertex_[i].is_valid()) {
      const glm::dvec3& p = positions[i];
      vertex_[i] = mesh_.add_vertex({p.x, p.y, p.z});
      origin_.push_back(i);
    }
    return vertex_[i];
  }

  HalfEdgeMesh mesh_;
  TriangleList refused_;
  std::vector<OpenMesh::VertexHandle> vertex_;  // by ours
  std::vector<std::uint32_t> origin_;           // by OpenMesh's
};

void keep(std::vector<char>& kept, std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> strays) {
  for (const std::uint32_t i : strays)
    for (int k = 0; k < 3; ++k) kept[triangles[i][k]] = true;
}

/// Also the other vertices of triangles that have one that is kept.
void widen(std::vector<char>& kept, std::span<const glm::uvec3> triangles) {
  const std::vector<char> before = kept;
  for (const glm::uvec3& t : triangles)
    if (before[t.x] || before[t.y] || before[t.z]) kept[t.x] = kept[t.y] = kept[t.z] = true;
}

TriangleList collapsed(std::span<const glm::dvec3> positions, TriangleList triangles, double limit,
                       const std::vector<char>& kept) {
  for (int stage = 0; stage < most_stages; ++stage) {
    Collapsible mesh(positions, triangles, kept);
    mesh.collapse(stage_share * limit);
    TriangleList fewer = mesh.triangles();
    const bool goes_on = double(fewer.size()) < (1 - least_progress) * double(triangles.size());
    triangles = std::move(fewer);
    if (!goes_on) break;
  }
  return triangles;
}

}  // namespace

Coarser decimate(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles, double limit) {
  std::vector<char> kept(positions.size());
  const TriangleList all(triangles.begin(), triangles.end());
  const MeshSurface original(positions, all);
  for (int tries = 0; tries < most_tries; ++tries) {
    TriangleList coarse = collapsed(positions, all, std::ldexp(limit, -tries), kept);
    if (coarse.size() == triangles.size()) break;
    const Excursion out = excursion(positions, coarse, original, limit);
    const Excursion in = excursion(positions, triangles, MeshSurface(positions, coarse), limit);
    if (out.strays.empty() && in.strays.empty()) return {std::move(coarse), std::max(out.distance, in.distance)};
    keep(kept, coarse, out.strays);
    keep(kept, triangles, in.strays);
    widen(kept, triangles);
  }
  return {all, 0};
}

}  // namespace rayengine
