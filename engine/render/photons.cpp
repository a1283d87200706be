#include "engine/render/photons.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "accel/frame.h"
#include "accel/random.h"
#include "accel/ray_cone.h"
#include "engine/query.h"
#include "engine/render/departure.h"
#include "engine/render/reversed_bits.h"
#include "engine/render/scatter.h"

namespace rayengine {
namespace {

constexpr std::size_t nearest = 64;        // photons in an estimate
constexpr float least_share = 0.25f;       // of the light, that a surface must pass on to be aimed at
constexpr std::size_t at_once = 1u << 18;  // photons on their way
constexpr double reach_share = 1.0 / 20;   // of the target's radius: how far they may lie

Sphere around(const Box& box) { return {box.center(), glm::length(box.size()) / 2}; }

float brightest(const glm::vec3& c) { return std::max({c.x, c.y, c.z}); }

/// Whether light is to be aimed at it.
bool bends(const Object& object, std::span<const Material> materials) {
  if (object.kind == Object::Kind::instance) return false;
  const Material& m = materials[object.material];
  return std::max(m.reflect, m.transmit * brightest(m.color)) >= least_share;
}

bool any_bends(const Geometry& geometry, std::span<const Material> materials) {
  return std::ranges::any_of(geometry.objects, [&](const Object& o) { return bends(o, materials); });
}

/// Spheres around all that is to be aimed at and has an end: balls by themselves, the rest by its bounds.
std::vector<Sphere> targets(const Geometry& g, std::span<const Material> materials) {
  std::vector<Sphere> spheres;
  Box meshes;
  for (std::size_t i = 0; i < g.triangles.size(); ++i)
    if (bends(g.objects[g.triangle_object[i]], materials))
      for (int corner = 0; corner < 3; ++corner) meshes.add(g.vertex(g.triangles[i][corner]));
  if (!meshes.empty()) spheres.push_back(around(meshes));
  for (const Quadric& q : g.quadrics)
    if (bounds(g, q).finite() && bends(g.objects[q.object], materials)) spheres.push_back(enclosing_sphere(g, q));
  for (const Instance& instance : g.instances)
    if (const Box b = bounds(g, instance); b.finite() && any_bends(*g.groups[instance.group], materials))
      spheres.push_back(around(b));
  return spheres;
}

/// One around all of them; of no size where there are none.
Sphere around(const std::vector<Sphere>& spheres) {
  Box box;
  for (const Sphere& s : spheres) box.add({s.center - s.radius, s.center + s.radius});
  Sphere all;
  if (!spheres.empty()) all.center = box.center();
  for (const Sphere& s : spheres) all.radius = std::max(all.radius, glm::distance(all.center, s.center) + s.radius);
  return all;
}

struct Flight {
  Ray ray;
  glm::vec3 power{0};
  double way = 0;        ///< the length it has come
  bool spreads = false;  ///< its power goes with the square of its way
  bool ended = false;
  std::uint32_t number = 0;  ///< among its light's
};

/// What a light sends towards a ball: evenly over the disc, or the solid angle, that holds it, by Hammersley's points.
class Beam {
 public:
  /// Directional light sets out `before` the ball's middle.
  Beam(const Light& light, const Sphere& target, double before, std::size_t photons)
      : light_(light), target_(target), before_(before), photons_(photons), spreads_(light.type == Light::Type::point) {
    const glm::dvec3 way = target.center - light.position;
    const double distance = glm::length(way);
    const bool within = spreads_ && distance <= target.radius;
    axis_ = !spreads_ ? glm::normalize(light.direction) : within ? glm::dvec3(0, 0, 1) : way / distance;
    cosine_ = within ? -1 : std::sqrt(std::max(0.0, 1 - std::pow(target.radius / distance, 2)));
    frame_ = frame_about(axis_);
    const double measure = spreads_ ? 2 * (1 - cosine_) : target.radius * target.radius;
    power_ = light.color * static_cast<float>(std::numbers::pi * measure / static_cast<double>(photons));
  }

  Flight photon(std::uint32_t i) const {
    const double share = (i + 0.5) / static_cast<double>(photons_),
                 turn = 0x1p-31 * std::numbers::pi * reversed_bits(i);
    const glm::dvec3 side = std::cos(turn) * frame_[0] + std::sin(turn) * frame_[1];
    const double cosine = 1 - share * (1 - cosine_), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    Flight f{.power = power_, .spreads = spreads_, .number = i};
    f.ray.direction = spreads_ ? glm::normalize(cosine * axis_ + sine * side) : axis_;
    f.ray.origin =
        spreads_ ? light_.position : target_.center + target_.radius * std::sqrt(share) * side - before_ * axis_;
    return f;
  }

 private:
  const Light& light_;
  Sphere target_;
  double before_;
  std::size_t photons_;
  bool spreads_;
  glm::dvec3 axis_{0};
  double cosine_ = 0;
  glm::dmat3 frame_{1};
  glm::vec3 power_{0};
};

/// Follows photons bounce by bounce.
class Tracing {
 public:
  Tracing(const Scene& scene, Tracer& tracer, const glm::dvec3& center, int depth)
      : scene_(scene), tracer_(tracer), limits_(tracer.limits()), center_(center), depth_(depth) {}

  void send(std::vector<Flight> flights) {
    for (int bounce = 0; bounce <= depth_ && !flights.empty(); ++bounce) {
      trace(flights, bounce);
      std::erase_if(flights, [](const Flight& f) { return f.ended; });
    }
  }

  std::vector<Photon> photons;
  std::uint64_t rays = 0;

 private:
  void trace(std::vector<Flight>& flights, int bounce) {
    std::vector<Ray> asked;
    for (const Flight& f : flights) asked.push_back(f.ray);
    std::vector<Hit> hits(flights.size());
    closest(tracer_, asked, hits, bounce == 0 ? RayClass::primary : RayClass::bounce);
    rays += flights.size();
    std::vector<Photon> landed(flights.size());
    tbb::parallel_for(std::size_t{0}, flights.size(),
                      [&](std::size_t i) { meet(flights[i], hits[i], bounce, landed[i]); });
    std::ranges::copy_if(landed, std::back_inserter(photons), [](const Photon& p) { return p.power != glm::vec3(0); });
  }

  void meet(Flight& flight, const Hit& hit, int bounce, Photon& landed) const {
    flight.ended = true;
    if (!hit.hit()) return;
    const Surface surface = surface_at(*scene_.geometry, flight.ray, hit);
    const Material& material = scene_.materials[surface.material];
    flight.way += hit.t;
    if (bounce > 0 && gathers(material)) {
      const float spread = flight.spreads ? static_cast<float>(flight.way * flight.way) : 1;
      landed = {glm::vec3(surface.position - center_), spread * flight.power,
                glm::vec3(facing(surface.shading_normal, flight.ray.direction))};
    }
    scatter(flight, surface, material, bounce);
  }

  /// Chance chooses between passing through and being mirrored, in proportion to what they leave of the light.
  void scatter(Flight& flight, const Surface& surface, const Material& material, int bounce) const {
    const glm::dvec3 direction = flight.ray.direction;
    const auto through = material.transmit > 0 ? passed_through(direction, surface, material) : std::nullopt;
    const glm::vec3 glass = material.transmit * material.color,
                    mirror = glm::vec3(material.reflect) + (through ? glm::vec3(0) : glass);
    const float passing = through ? brightest(glass) : 0, back = brightest(mirror);
    if (!(passing + back > 0)) return;
    const bool passes = Random(static_cast<std::uint64_t>(bounce), flight.number).unit() * (passing + back) < passing;
    flight.power *= (passes ? glass / passing : mirror / back) * (passing + back);
    Departure departure;
    departure.set(surface, limits_);
    departure.start(flight.ray, passes ? *through : mirrored(direction, surface), infinity);
    flight.ended = false;
  }

  const Scene& scene_;
  Tracer& tracer_;
  Limits limits_;
  glm::dvec3 center_;
  int depth_;
};

}  // namespace

bool gathers(const Material& material) { return material.diffuse >= 1.0f / 16; }

Caustics trace_caustics(const Scene& scene, Tracer& tracer, std::size_t photons, int depth) {
  const Sphere target = around(targets(*scene.geometry, scene.materials));
  const Box all = scene.geometry->bounds;
  const double before = target.radius + (all.finite() ? glm::length(all.size()) : 2 * target.radius);
  Tracing tracing(scene, tracer, target.center, depth);
  const std::size_t share = scene.lights.empty() || target.radius == 0 ? 0 : photons / scene.lights.size();
  for (const Light& light : scene.lights) {
    const Beam beam(light, target, before, share);
    for (std::size_t first = 0; first < share; first += at_once) {
      std::vector<Flight> flights(std::min(at_once, share - first));
      for (std::size_t i = 0; i < flights.size(); ++i) flights[i] = beam.photon(static_cast<std::uint32_t>(first + i));
      tracing.send(std::move(flights));
    }
  }
  return {PhotonMap(std::move(tracing.photons), target.center, nearest, reach_share * target.radius), tracing.rays};
}

}  // namespace rayengine
