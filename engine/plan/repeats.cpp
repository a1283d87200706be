#include "engine/plan/repeats.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <string>
#include <unordered_map>

#include "accel/cache_folder.h"
#include "accel/tracer.h"

namespace rayengine {
namespace {

constexpr std::size_t most_firsts = 8;     // of the same triangles, that an object is compared with
constexpr double flattest = 1e-6;          // height over length of a triangle that tells a rotation
constexpr double normal_tolerance = 1e-3;  // a quarter of a step in a picture of 8 bits

/// A mesh object's part of a geometry.
struct Part {
  const Geometry* geometry;
  std::uint32_t object;
  std::span<const glm::uvec3> triangles;
  std::uint32_t base, vertices;  // its vertices are base + [0, vertices)

  Part(const Geometry& g, std::uint32_t o) : geometry(&g), object(o), triangles(triangles_of(g, o)) {
    const auto [begin, end] = vertex_range(triangles);
    base = begin, vertices = end - begin;
  }

  glm::dvec3 position(std::uint32_t i) const { return geometry->vertex(base + i); }
  glm::dvec3 normal(std::uint32_t i) const {
    return geometry->normals.empty() ? glm::dvec3(0) : glm::dvec3(geometry->normals[base + i]);
  }
  std::uint32_t material() const { return geometry->objects[object].material; }
};

template <class T>
Bytes bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

ContentHash hash_of_triangles(const Part& part) {
  ContentHash hash;
  hash.add(bytes_of(part.material())).add(bytes_of(part.vertices));
  std::vector<glm::uvec3> local;
  for (const glm::uvec3& t : part.triangles) local.push_back(t - part.base);
  return hash.add(std::as_bytes(std::span(local)));
}

/// Equal for parts that are exact translations of each other: the differences round alike, and adding zero leaves
/// them one zero.
ContentHash hash_of_shape(const Part& part, ContentHash hash) {
  std::vector<glm::dvec3> offsets;
  for (std::uint32_t i = 0; i < part.vertices; ++i) offsets.push_back(part.position(i) - part.position(0) + 0.0);
  return hash.add(std::as_bytes(std::span(offsets)));
}

bool same_triangles(const Part& a, const Part& b) {
  if (a.triangles.size() != b.triangles.size() || a.vertices != b.vertices || a.material() != b.material())
    return false;
  for (std::size_t i = 0; i < a.triangles.size(); ++i)
    if (a.triangles[i] - a.base != b.triangles[i] - b.base) return false;
  return true;
}

/// Whether a - b is d without rounding: what subtracting lost is found exactly. Source: Knuth, "The Art of Computer
/// Programming", volume 2, section 4.2.2, theorem C.
bool differ_by(double a, double b, double d) {
  const double virtual_b = a - d, virtual_a = d + virtual_b;
  return a - b == d && (a - virtual_a) + (virtual_b - b) == 0;
}

std::optional<Repeat> exact_repeat(const Part& first, const Part& part) {
  if (!same_triangles(first, part)) return {};
  const glm::dvec3 by = part.position(0) - first.position(0);
  for (std::uint32_t i = 0; i < part.vertices; ++i) {
    const glm::dvec3 p = part.position(i), q = first.position(i);
    for (int k = 0; k < 3; ++k)
      if (!differ_by(p[k], q[k], by[k])) return {};
    if (part.normal(i) != first.normal(i)) return {};
  }
  return Repeat{first.object, part.object, Affine::translate(by), 0};
}

/// Three vertices that are far apart.
using Anchors = std::array<std::uint32_t, 3>;

Anchors find_anchors(const Part& part) {
  Anchors a{0, 0, 0};
  double most = 0;
  for (std::uint32_t i = 0; i < part.vertices; ++i)
    if (const double d = glm::length(part.position(i) - part.position(0)); d > most) most = d, a[1] = i;
  const glm::dvec3 along = part.position(a[1]) - part.position(0);
  most = 0;
  for (std::uint32_t i = 0; i < part.vertices; ++i)
    if (const double d = glm::length(glm::cross(part.position(i) - part.position(0), along)); d > most)
      most = d, a[2] = i;
  return a;
}

/// Orthonormal, by the triangle of the anchors; nothing where that is too flat to tell.
struct Frame {
  glm::dmat3 axes;
  double length;  // of the first side
};

std::optional<Frame> frame(const Part& part, const Anchors& a) {
  const glm::dvec3 x = part.position(a[1]) - part.position(a[0]), y = part.position(a[2]) - part.position(a[0]);
  const glm::dvec3 z = glm::cross(x, y);
  const double length = glm::length(x);
  if (!(glm::length(z) > flattest * length * length)) return {};
  const glm::dvec3 u = x / length, w = glm::normalize(z);
  return Frame{{u, glm::cross(w, u), w}, length};
}

std::optional<Affine> fit(const Part& first, const Part& part) {
  const Anchors anchors = find_anchors(first);
  const auto from = frame(first, anchors), to = frame(part, anchors);
  if (!from || !to) return {};
  Affine map{(to->length / from->length) * (to->axes * glm::transpose(from->axes)), glm::dvec3(0)};
  glm::dvec3 offset(0);
  for (const std::uint32_t a : anchors) offset += (part.position(a) - map.point(first.position(a))) / 3.;
  map.origin = offset;
  return map;
}

std::optional<Repeat> rigid_repeat(const Part& first, const Part& part, double tolerance) {
  if (!same_triangles(first, part)) return {};
  const std::optional<Affine> map = fit(first, part);
  if (!map) return {};
  const double per_scale = 1 / glm::length(map->linear[0]);
  double error = 0;
  for (std::uint32_t i = 0; i < part.vertices; ++i) {
    error = std::max(error, glm::length(map->point(first.position(i)) - part.position(i)));
    const glm::dvec3 off = per_scale * map->vector(first.normal(i)) - part.normal(i);
    if (!(error <= tolerance && glm::length(off) <= normal_tolerance)) return {};
  }
  return Repeat{first.object, part.object, *map, error};
}

/// What parts are sorted by.
struct Names {
  std::string triangles, shape;

  explicit Names(const Part& part) {
    const ContentHash hash = hash_of_triangles(part);
    triangles = hash.name(), shape = hash_of_shape(part, hash).name();
  }
};

class Finder {
 public:
  explicit Finder(double tolerance) : tolerance_(tolerance) {}

  /// The repeat that a part is; else it is a first.
  std::optional<Repeat> add(const Part& part, const Names& names) {
    const auto [same, is_new] = by_shape_.try_emplace(names.shape, part);
    if (!is_new)
      if (const auto repeat = exact_repeat(same->second, part)) return repeat;
    if (tolerance_ == 0) return {};
    std::vector<Part>& firsts = by_triangles_[names.triangles];
    for (const Part& first : firsts)
      if (const auto repeat = rigid_repeat(first, part, tolerance_)) {
        if (is_new) by_shape_.erase(same);
        return repeat;
      }
    if (firsts.size() < most_firsts) firsts.push_back(part);
    return {};
  }

 private:
  double tolerance_;
  std::unordered_map<std::string, Part> by_shape_;
  std::unordered_map<std::string, std::vector<Part>> by_triangles_;
};

}  // namespace

std::vector<Repeat> find_repeats(const Geometry& geometry, double tolerance, std::uint32_t min_triangles) {
  if (!(tolerance >= 0 && std::isfinite(tolerance)))
    throw Error("repeats cannot be found to a tolerance of " + std::to_string(tolerance) +
                ": give a finite number, 0 or above");
  std::vector<std::uint32_t> objects;
  for (std::uint32_t i = 0; i < geometry.objects.size(); ++i)
    if (geometry.objects[i].kind == Object::Kind::mesh && primitive_count(geometry, i) >= std::max(min_triangles, 1u))
      objects.push_back(i);
  std::vector<std::optional<std::pair<Part, Names>>> parts(objects.size());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    const Part part(geometry, objects[i]);
    parts[i].emplace(part, Names(part));
  });
  Finder finder(tolerance);
  std::vector<Repeat> repeats;
  for (const auto& entry : parts)
    if (const auto repeat = finder.add(entry->first, entry->second)) repeats.push_back(*repeat);
  return repeats;
}

}  // namespace rayengine
