#include "engine/plan/verify.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "accel/frame.h"
#include "accel/random.h"
#include "cpu/bvh_tracer.h"
#include "engine/query.h"
#include "engine/render/camera.h"

namespace rayengine {
namespace {

constexpr int directions = 12, rings = 4;
constexpr std::size_t most_examples = 8;

/// Rays about one, up to a distance from it that grows along it as a pixel does, or does not.
std::vector<Ray> beside(const Ray& ray, double distance, Tolerance::Unit unit) {
  const glm::dmat3 frame = frame_about(ray.direction);
  std::vector<Ray> rays;
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < directions; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * (ring % 2)) / directions;
      const glm::dvec3 move = distance * ring / rings * (std::cos(angle) * frame[0] + std::sin(angle) * frame[1]);
      Ray other = ray;
      (unit == Tolerance::Unit::pixels ? other.direction : other.origin) += move;
      rays.push_back(other);
    }
  return rays;
}

class Verifier {
 public:
  Verifier(const Scene& scene, const Scene& model, const Tolerance& tolerance)
      : model_(model),
        tolerance_(tolerance),
        oracle_(make_bvh_tracer(scene.geometry, Precision::certified)),
        pixel_(pixel_angle(scene.camera)) {}

  Verification run(Tracer& tracer, std::span<const Ray> rays) {
    std::vector<Hit> hits(rays.size()), exact(rays.size());
    closest(tracer, rays, hits, RayClass::primary);
    closest(*oracle_, rays, exact, RayClass::primary);
    for (std::size_t i = 0; i < rays.size(); ++i) look_at(rays[i], hits[i], exact[i]);
    return result_;
  }

 private:
  void look_at(const Ray& ray, const Hit& hit, const Hit& exact) {
    ++result_.rays;
    result_.hits += hit.hit();
    if (tolerance_.value == 0 ? same(hit, exact) : agrees(ray, hit, ray, exact)) return;
    if (tolerance_.value > 0 && agrees_beside(ray, hit)) {
      ++result_.beside;
      return;
    }
    ++result_.broken;
    if (result_.examples.size() < most_examples) result_.examples.push_back({ray, hit, exact});
  }

  std::uint32_t object(const Hit& hit) const { return object_number(model_.object_numbers, hit.object); }

  bool same(const Hit& hit, const Hit& exact) const {
    return object(hit) == exact.object && hit.primitive == exact.primitive &&
           (!hit.hit() || std::abs(hit.t - exact.t) <= hit.error + exact.error);
  }

  /// Whether a hit lies on what the exact ray sees, within the tolerance of the plane that touches it there.
  bool agrees(const Ray& ray, const Hit& hit, const Ray& exact_ray, const Hit& exact) {
    if (object(hit) != exact.object) return false;
    if (!hit.hit()) return true;
    const glm::dvec3 offset = ray.at(hit.t) - exact_ray.at(exact.t);
    const double off = std::abs(glm::dot(offset, glm::dvec3(exact.normal))) / unit_at(exact.t);
    if (off <= tolerance_.value) result_.largest = std::max(result_.largest, off);
    return off <= tolerance_.value;
  }

  bool agrees_beside(const Ray& ray, const Hit& hit) {
    const double distance = tolerance_.value * unit_at(1);
    const std::vector<Ray> rays = beside(ray, distance, tolerance_.unit);
    std::vector<Hit> answers(rays.size());
    oracle_->closest(rays, answers, RayClass::primary);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (agrees(ray, hit, rays[i], answers[i])) return true;
    return false;
  }

  /// The tolerance's unit, as a length at a distance along a ray.
  double unit_at(double t) const { return tolerance_.unit == Tolerance::Unit::pixels ? pixel_ * t : 1; }

  const Scene& model_;
  Tolerance tolerance_;
  std::unique_ptr<Tracer> oracle_;
  double pixel_;
  Verification result_;
};

}  // namespace

Verification verify(const Scene& scene, const Scene& model, Tracer& tracer, const Tolerance& tolerance,
                    std::span<const Ray> rays) {
  check(tolerance);
  return Verifier(scene, model, tolerance).run(tracer, rays);
}

std::vector<Ray> random_camera_rays(const Camera& camera, std::size_t count, std::uint64_t seed) {
  const CameraFrame frame(camera);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, i);
    const double x = random.between(0, camera.size.x), y = random.between(0, camera.size.y);
    frame.start(rays.emplace_back(), x, y);
  }
  return rays;
}

}  // namespace rayengine
