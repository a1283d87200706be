#include "engine/render/waves.h"

#include <algorithm>
#include <numeric>

#include "engine/render/photons.h"
#include "engine/render/scatter.h"

namespace rayengine {
namespace {

/// Rays that bring less than this share of what they see are not traced: half a step of an 8-bit image, four times
/// over.
constexpr float least_weight = 1.0f / 2048;

/// Surfaces that are worked out before they are shaded: many, but no more than caches hold beside all else.
constexpr std::size_t surfaces_at_once = 256;

/// Places in the counts of rays.
enum Kind { primary_ray, shadow_ray, reflected_ray, refracted_ray };

float brightest(const glm::vec3& color) { return std::max({color.x, color.y, color.z}); }

bool matters(const glm::vec3& weight) { return brightest(weight) >= least_weight; }

}  // namespace

Waves::Waves(const Picture& picture, TracerGate& gate)
    : picture_(picture), gate_(gate), levels_(static_cast<std::size_t>(picture.depth) + 1) {
  for (const Light& light : picture.lights) brightest_light_ = std::max(brightest_light_, brightest(light.color));
}

void Waves::Queue::reserve(std::size_t more) {
  if (size + more <= rays.size()) return;
  rays.resize(size + more);
  paths.resize(size + more);
}

std::size_t Waves::Queue::wave_end(std::size_t first, std::size_t batch) const {
  if (size - first <= batch) return size;
  const auto sample_changes = [&](std::size_t i) { return i == size || paths[i].sample != paths[i - 1].sample; };
  std::size_t end = first + batch;
  while (end > first && !sample_changes(end)) --end;
  if (end > first) return end;
  for (end = first + batch; !sample_changes(end);) ++end;
  return end;
}

std::span<Ray> Waves::primary(std::size_t count) {
  Queue& queue = levels_.front();
  std::size_t known = queue.paths.size();  // every tile's first paths are alike
  queue.size = 0;
  queue.reserve(count);
  queue.size = count;
  for (; known < count; ++known) queue.paths[known] = {glm::vec3(1), static_cast<std::uint32_t>(known), false};
  return {queue.rays.data(), count};
}

std::span<const glm::vec3> Waves::radiance() {
  const std::size_t count = levels_.front().size;
  radiance_.assign(count, glm::vec3(0));
  rays_[primary_ray] += count;
  trace(0, levels_.front().wave(0, count));
  return radiance_;
}

/// Rays of one kind and into one octant run side by side with their neighbours more often than not, and are then traced
/// faster: they go to the tracer in this order, and their hits come back in that of the wave.
void Waves::trace_sorted(const Wave& wave) {
  const auto group = [&](std::size_t i) {
    const glm::dvec3& d = wave.rays[i].direction;
    return wave.paths[i].refracted << 3 | (d.x < 0) << 2 | (d.y < 0) << 1 | (d.z < 0);
  };
  const std::size_t count = wave.rays.size();
  std::array<std::uint32_t, 17> places{};
  for (std::size_t i = 0; i < count; ++i) ++places[group(i) + 1];
  std::partial_sum(places.begin(), places.end(), places.begin());
  Sorting& s = sorting_;
  s.rays.resize(std::max(s.rays.size(), count)), s.hits.resize(s.rays.size()), s.places.resize(s.rays.size());
  for (std::size_t i = 0; i < count; ++i) s.rays[s.places[i] = places[group(i)]++] = wave.rays[i];
  gate_.closest({s.rays.data(), count}, {s.hits.data(), count}, RayClass::bounce);
  for (std::size_t i = 0; i < count; ++i) hits_[i] = s.hits[s.places[i]];
}

void Waves::trace(std::size_t depth, const Wave& wave) {
  Queue* next = depth + 1 < levels_.size() ? &levels_[depth + 1] : nullptr;
  const std::size_t count = wave.rays.size();
  hits_.resize(std::max(hits_.size(), count));
  if (depth)
    trace_sorted(wave);
  else
    gate_.closest(wave.rays, {hits_.data(), count}, RayClass::primary);

  points_.resize(std::max(points_.size(), count));
  lit_ = 0;
  if (next) next->size = 0, next->reserve(2 * count);
  shade(wave, next);
  for (const Light& light : picture_.lights) shine(light, depth ? RayClass::bounce : RayClass::shadow);
  if (!next) return;
  for (std::size_t begin = 0, end; begin < next->size; begin = end) {
    end = next->wave_end(begin, picture_.limits.batch);
    trace(depth + 1, next->wave(begin, end));
  }
}

void Waves::shade(const Wave& wave, Queue* next) {
  surfaces_.resize(surfaces_at_once);
  for (std::size_t begin = 0; begin < wave.rays.size(); begin += surfaces_at_once) {
    const auto rays = wave.rays.subspan(begin, std::min(surfaces_at_once, wave.rays.size() - begin));
    const std::span<const Hit> hits(hits_.data() + begin, rays.size());
    surfaces_at(picture_.geometry, rays, hits, surfaces_);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Path& path = wave.paths[begin + i];
      if (hits[i].hit())
        shade(rays[i], surfaces_[i], path, points_[lit_], next);
      else
        leave(rays[i], hits[i], path);
    }
  }
}

void Waves::leave(const Ray& ray, const Hit& hit, const Path& path) {
  invalid_ += (hit.status & status_invalid) != 0;
  radiance_[path.sample] += path.weight * picture_.environment(ray.direction);
}

void Waves::shade(const Ray& ray, const Surface& surface, const Path& path, LitPoint& point, Queue* next) {
  const Material& material = picture_.materials[surface.material];
  radiance_[path.sample] += path.weight * (material.ambient * material.color);
  point.departure.set(surface, picture_.limits);
  point.normal = facing(surface.shading_normal, ray.direction);
  if (picture_.caustics && gathers(material))
    radiance_[path.sample] += path.weight * (material.diffuse * material.color) *
                              picture_.caustics->irradiance(surface.position, point.normal);
  point.view = glm::vec3(-ray.direction);
  point.material = surface.material;
  point.path = path;
  lit_ += matters(path.weight * (brightest_light_ * (material.diffuse * material.color + material.specular)));
  if (next && (material.reflect > 0 || material.transmit > 0)) scatter(ray, surface, point, *next);
}

void Waves::scatter(const Ray& ray, const Surface& surface, const LitPoint& point, Queue& next) {
  const Material& material = picture_.materials[point.material];
  glm::vec3 mirror = point.path.weight * material.reflect;
  const glm::vec3 glass = point.path.weight * material.transmit * material.color;
  if (matters(glass)) {
    if (const auto through = passed_through(ray.direction, surface, material))
      spawn(next, point, *through, glass, true);
    else
      mirror += glass;
  }
  if (matters(mirror)) spawn(next, point, mirrored(ray.direction, surface), mirror, false);
}

void Waves::spawn(Queue& next, const LitPoint& from, const glm::dvec3& direction, const glm::vec3& weight,
                  bool refracted) {
  next.add(from.departure, direction, infinity, weight, from.path.sample, refracted);
  ++rays_[refracted ? refracted_ray : reflected_ray];
}

/// The lit points that face a light, told apart before all else and without a branch, since they cannot be foretold.
template <class Way>
std::span<const std::uint32_t> Waves::turned_to(const Way& to_light) {
  facing_.resize(std::max(facing_.size(), lit_));
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < lit_; ++i) {
    facing_[count] = i;
    count += glm::dot(points_[i].normal, to_light(points_[i])) > 0;
  }
  return {facing_.data(), count};
}

void Waves::shine(const Light& light, RayClass ray_class) {
  const bool is_point = light.type == Light::Type::point;
  // t counts in lengths of the direction: at 1 the ray has reached a point light.
  const double tmax = is_point ? 1 : infinity;
  const auto to_light = [&](const LitPoint& p) {
    return is_point ? light.position - p.departure.position : -light.direction;
  };
  shadow_.size = 0;
  shadow_.reserve(lit_);
  for (const std::uint32_t i : turned_to(to_light)) {
    const LitPoint& p = points_[i];
    const glm::dvec3 way = to_light(p);
    const glm::vec3 unit(way * (1 / std::sqrt(glm::dot(way, way))));
    const Material& material = picture_.materials[p.material];
    const glm::vec3 share = p.path.weight * reflected_light(material, glm::vec3(p.normal), unit, p.view);
    const glm::vec3 seen = share * light.color;
    if (seen == glm::vec3(0)) continue;
    // Neither of a light as bright as white nor of this one: dim lights count against others that may be dim, too.
    if (matters(share) || matters(seen)) shadow_.add(p.departure, way, tmax, seen, p.path.sample);
  }
  if (shadow_.size > 0) add_unshadowed(ray_class);
}

void Waves::add_unshadowed(RayClass ray_class) {
  rays_[shadow_ray] += shadow_.size;
  shadow_status_.resize(std::max(shadow_status_.size(), shadow_.size));
  gate_.any({shadow_.rays.data(), shadow_.size}, {shadow_status_.data(), shadow_.size}, ray_class);
  for (std::size_t i = 0; i < shadow_.size; ++i) {
    if (!(shadow_status_[i] & status_hit)) radiance_[shadow_.paths[i].sample] += shadow_.paths[i].weight;
    invalid_ += (shadow_status_[i] & status_invalid) != 0;
  }
}

}  // namespace rayengine
