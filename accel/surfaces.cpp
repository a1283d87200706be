#include <functional>

#include "accel/isa/isa.h"
#include "accel/isa/surface_batch.h"
#include "accel/surface.h"
#include "accel/unit_matrices.h"

namespace rayengine {
namespace {

const SurfaceSolvers& solvers() {
  static const SurfaceSolvers& best = [] {
    switch (best_isa()) {
      case Isa::avx512: return std::ref(avx512::surface_solvers);
      case Isa::avx2: return std::ref(avx2::surface_solvers);
      case Isa::sse2: break;
    }
    return std::ref(sse2::surface_solvers);
  }();
  return best;
}

template <class Vector>
void put(SurfaceRow* rows, int lane, const Vector& v) {
  rows[0][lane] = v.x, rows[1][lane] = v.y, rows[2][lane] = v.z;
}

glm::dvec3 get(const SurfaceRow* rows, int lane) { return {rows[0][lane], rows[1][lane], rows[2][lane]}; }

/// A batch and the hits in it.
template <class Batch>
struct Filling {
  Batch batch{};
  std::size_t hits[surface_batch];
  int count = 0;

  int add(std::size_t hit, const Ray& ray) {
    put(batch.origin, count, ray.origin);
    put(batch.direction, count, ray.direction);
    hits[count] = hit;
    return count++;
  }
};

/// Sorts hits by what they are on, and solves them when there are enough of a kind.
class Solving {
 public:
  Solving(const Geometry& geometry, std::span<const Ray> rays, std::span<const Hit> hits, std::span<Surface> surfaces)
      : geometry_(geometry), rays_(rays), hits_(hits), surfaces_(surfaces) {
    triangles_.batch.smooth = !geometry.normals.empty();
  }

  void add(std::size_t i) {
    const Hit& hit = hits_[i];
    const Object& object = geometry_.objects[hit.object];
    if (object.kind == Object::Kind::mesh) return add_triangle(i, geometry_.triangles[object.first + hit.primitive]);
    if (object.kind == Object::Kind::quadric && hit.primitive == 0)
      if (const Quadric& q = geometry_.quadrics[object.first]; q.type != QuadricType::general) return add_quadric(i, q);
    surfaces_[i] = surface_at(geometry_, rays_[i], hit);
  }

  void finish() {
    if (triangles_.count) solve_triangles();
    if (quadrics_.count) solve_quadrics();
  }

 private:
  void add_triangle(std::size_t i, const glm::uvec3& corners) {
    const int lane = triangles_.add(i, rays_[i]);
    for (int k = 0; k < 3; ++k) {
      put(triangles_.batch.corners[k], lane, geometry_.vertex(corners[k]));
      if (triangles_.batch.smooth) put(triangles_.batch.corner_normals[k], lane, geometry_.normals[corners[k]]);
    }
    if (triangles_.count == surface_batch) solve_triangles();
  }

  void add_quadric(std::size_t i, const Quadric& q) {
    const int lane = quadrics_.add(i, rays_[i]);
    QuadricBatch& batch = quadrics_.batch;
    const QuadricMatrix& m = unit_matrices[static_cast<std::size_t>(q.type)];
    const double form[5] = {m[0], m[4], m[7], m[8], m[9]};
    for (int k = 0; k < 5; ++k) batch.form[k][lane] = form[k];
    for (int c = 0; c < 3; ++c) put(batch.linear[c], lane, q.to_object.linear[c]);
    put(batch.map_origin, lane, q.to_object.origin);
    batch.t[lane] = hits_[i].t;
    if (quadrics_.count == surface_batch) solve_quadrics();
  }

  void solve_triangles() {
    solvers().triangles(triangles_.batch);
    take(triangles_, true);
  }
  void solve_quadrics() {
    solvers().quadrics(quadrics_.batch);
    take(quadrics_, false);
  }

  template <class Batch>
  void take(Filling<Batch>& filling, bool is_triangle) {
    const Batch& b = filling.batch;
    for (int lane = 0; lane < filling.count; ++lane) {
      const std::size_t i = filling.hits[lane];
      if (b.regular[lane] == 0)
        surfaces_[i] = surface_at(geometry_, rays_[i], hits_[i]);
      else
        surfaces_[i] = {get(b.position, lane),
                        get(b.normal, lane),
                        get(b.shading_normal, lane),
                        b.error[lane],
                        b.magnitude[lane],
                        b.spread[lane],
                        geometry_.objects[hits_[i].object].material,
                        is_triangle};
    }
    filling.count = 0;
  }

  const Geometry& geometry_;
  std::span<const Ray> rays_;
  std::span<const Hit> hits_;
  std::span<Surface> surfaces_;
  Filling<TriangleBatch> triangles_;
  Filling<QuadricBatch> quadrics_;
};

}  // namespace

void surfaces_at(const Geometry& geometry, std::span<const Ray> rays, std::span<const Hit> hits,
                 std::span<Surface> surfaces) {
  Solving solving(geometry, rays, hits, surfaces);
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits[i].hit()) solving.add(i);
  solving.finish();
}

}  // namespace rayengine
