#include "engine/render/aov.h"

#include <glm/geometric.hpp>

namespace rayengine {
namespace {

std::vector<std::string> names_of(Aov aov) {
  switch (aov) {
    case Aov::depth: return {"Z"};
    case Aov::normal: return {"N.X", "N.Y", "N.Z"};
    case Aov::object: return {"object"};
    case Aov::primitive: return {"primitive"};
    case Aov::position: return {"P.X", "P.Y", "P.Z"};
    case Aov::error: return {"error"};
    case Aov::status: return {"status"};
  }
  return {};
}

float* put(float* out, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) *out++ = static_cast<float>(v[i]);
  return out;
}

float* put(float* out, double value) {
  *out++ = static_cast<float>(value);
  return out;
}

double id_value(std::uint32_t id) { return id == no_id ? -1.0 : id; }

}  // namespace

std::vector<std::string> channel_names(std::span<const Aov> aovs) {
  std::vector<std::string> names;
  for (const Aov aov : aovs)
    for (std::string& name : names_of(aov)) names.push_back(std::move(name));
  return names;
}

void write_aovs(std::span<const Aov> aovs, const Geometry& geometry, const Ray& ray, const Hit& hit,
                std::uint32_t object, float* out) {
  const Surface surface = hit.hit() ? surface_at(geometry, ray, hit) : Surface{};
  const double depth = hit.hit() ? glm::dot(surface.position - ray.origin, ray.direction) : infinity;
  for (const Aov aov : aovs) switch (aov) {
      case Aov::depth: out = put(out, depth); break;
      case Aov::normal: out = put(out, surface.shading_normal); break;
      case Aov::object: out = put(out, id_value(object)); break;
      case Aov::primitive: out = put(out, id_value(hit.primitive)); break;
      case Aov::position: out = put(out, surface.position); break;
      case Aov::error: out = put(out, hit.error); break;
      case Aov::status: out = put(out, static_cast<double>(hit.status)); break;
    }
}

}  // namespace rayengine
