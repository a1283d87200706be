#include "engine/measure/wood.h"

#include <algorithm>
#include <array>

#include "accel/stopwatch.h"
#include "cpu/bvh_tracer.h"
#include "cpu/ranges.h"
#include "engine/measure/rays.h"
#include "engine/render/cast.h"
#include "engine/render/optics.h"
#include "engine/tracers.h"
#include "gpu/device/context.h"
#include "gpu/objects/ray_caster.h"

namespace rayengine {
namespace {

constexpr std::array quadric_types{QuadricType::sphere,     QuadricType::cylinder,     QuadricType::cone,
                                   QuadricType::paraboloid, QuadricType::hyperboloid1, QuadricType::hyperboloid2};
constexpr float visible = 0.02f;

using Colors = std::vector<glm::vec3>;

/// The figure of scenes/make_sphereflake.py, without instances.
void add_flake(GeometryBuilder& builder, const Affine& place, int level, int levels) {
  builder.add(QuadricShape{}, static_cast<std::uint32_t>(level), place);
  if (level == levels) return;
  const auto add_child = [&](double around, double from_axis) {
    add_flake(builder,
              place * Affine::rotate({0, 0, 1}, around) * Affine::rotate({0, 1, 0}, from_axis) *
                  Affine::translate({0, 0, 4. / 3}) * Affine::scale(glm::dvec3(1. / 3)),
              level + 1, levels);
  };
  for (int i = 0; i < 6; ++i) add_child(60 * i, 90);
  for (int i = 0; i < 3; ++i) add_child(120 * i + 30, 35.264389682754654);
}

std::vector<Material> paints(int levels) {
  constexpr std::array<glm::vec3, 5> shades{
      {{1, .62f, .12f}, {.95f, .42f, .14f}, {.78f, .16f, .18f}, {.46f, .12f, .38f}, {.2f, .2f, .62f}}};
  std::vector<Material> result;
  for (int i = 0; i <= levels; ++i)
    result.push_back(
        {.color = shades[i % shades.size()], .ambient = .06f, .diffuse = .7f, .specular = .35f, .shininess = 60});
  return result;
}

Scene lit(GeometryBuilder& builder, int levels, const glm::ivec2& size) {
  Scene scene;
  scene.geometry = builder.build();
  scene.materials = paints(levels);
  scene.background.color = {.16f, .27f, .46f};
  scene.lights = {{.position = {6, -3, 7}, .color = {1, .94f, .82f}},
                  {.position = {-5, -7, 4}, .color = glm::vec3(.4f)}};
  scene.camera = {.from = {3.4, -5.2, 1.7}, .at = {0, 0, 0.22}, .fov = 38, .size = size};
  return scene;
}

Scene sphereflake(int level, const glm::ivec2& size) {
  GeometryBuilder builder;
  add_flake(builder, {}, 0, level);
  return lit(builder, level, size);
}

Scene unit_quadric(QuadricType type) {
  GeometryBuilder builder;
  builder.add(QuadricShape{.type = type});
  Scene scene = lit(builder, 0, {128, 128});
  scene.camera = framing_camera(scene.geometry->bounds, scene.camera);
  return scene;
}

RayCaster caster(const Scene& scene, int gpu) {
  return {scene.geometry, cast_lights(scene), cast_materials(scene), gpu};
}

Colors cast(const Scene& scene, RayCaster& caster, std::span<const Ray> rays) {
  Colors colors;
  for (const glm::vec4& c : caster.cast(rays)) colors.push_back(glm::vec3(c) + (1 - c.w) * scene.background.color);
  return colors;
}

/// What the device's shading pass works out, by the renderer's own formula.
glm::vec3 seen(const Scene& scene, const Ray& ray, const Hit& hit) {
  if (!hit.hit()) return scene.background.color;
  const Material& material = scene.materials[scene.geometry->objects[hit.object].material];
  const glm::vec3 view(-ray.direction), normal = glm::dot(hit.normal, view) < 0 ? -hit.normal : hit.normal;
  glm::vec3 color = material.ambient * material.color;
  for (const Light& light : scene.lights) {
    const glm::vec3 to_light(glm::normalize(light.position - ray.at(hit.t)));
    if (glm::dot(normal, to_light) > 0) color += light.color * reflected_light(material, normal, to_light, view);
  }
  return color;
}

Colors trace(const Scene& scene, Tracer& tracer, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  tracer.closest(rays, hits, RayClass::primary);
  Colors colors(rays.size());
  for_ranges(rays.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) colors[i] = seen(scene, rays[i], hits[i]);
  });
  return colors;
}

Image image(const Colors& colors, const glm::ivec2& size) {
  Image result(size.x, size.y, {"R", "G", "B"});
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (int c = 0; c < 3; ++c) result.pixels[3 * i + static_cast<std::size_t>(c)] = colors[i][c];
  return result;
}

double differing(const Colors& a, const Colors& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::vec3 difference = glm::abs(a[i] - b[i]);
    count += std::max({difference.x, difference.y, difference.z}) > visible;
  }
  return static_cast<double>(count) / static_cast<double>(a.size());
}

class Experiment {
 public:
  explicit Experiment(const WoodOptions& options) : options_(options) {}

  WoodFigures run() {
    figures_.primitives = scene_.geometry->primitive_count;
    for (const QuadricType type : quadric_types) show(type);
    expected_ = by(*make_loop_tracer(scene_.geometry));
    measure("gpu", [&] {
      RayCaster device = caster(scene_, options_.gpu);
      return cast(scene_, device, rays_);
    });
    measure("software", [&] { return by(*make_loop_tracer(scene_.geometry)); });
    measure("embree", [&] { return by(*make_tracer("embree", scene_.geometry)); });
    return std::move(figures_);
  }

 private:
  Colors by(Tracer& tracer) const { return trace(scene_, tracer, rays_); }

  void show(QuadricType type) {
    const Scene scene = unit_quadric(type);
    RayCaster device = caster(scene, options_.gpu);
    figures_.device = device.gpu().renderer;
    figures_.software = device.gpu().software;
    figures_.quadrics.push_back({type, image(cast(scene, device, primary_rays(scene.camera)), scene.camera.size)});
  }

  double clock() const { return figures_.software ? processor_seconds() : watch_.seconds(); }

  template <class Frame>
  void measure(const char* method, const Frame& frame) {
    double best = infinity;
    Colors colors;
    for (int i = 0; i < options_.runs; ++i) {
      const double start = clock();
      colors = frame();
      best = std::min(best, clock() - start);
      if (options_.progress) options_.progress(++done_ / (3. * options_.runs));
    }
    figures_.rows.push_back({method, 1 / best, differing(colors, expected_), image(colors, options_.size)});
  }

  const WoodOptions& options_;
  const Scene scene_ = sphereflake(options_.level, options_.size);
  const std::vector<Ray> rays_ = primary_rays(scene_.camera);
  const Stopwatch watch_;
  Colors expected_;
  WoodFigures figures_;
  int done_ = 0;
};

}  // namespace

WoodFigures wood(const WoodOptions& options) { return Experiment(options).run(); }

}  // namespace rayengine
