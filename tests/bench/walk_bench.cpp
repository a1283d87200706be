// What the CPU walk costs against tracing the same rays whole with Embree, one thread: a row for every K.
// Usage: walk_bench MESH [K...]

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "accel/geometry.h"
#include "accel/walk.h"
#include "engine/load/load.h"

namespace {

using namespace rayengine;

constexpr int side = 512;
constexpr int rounds = 7;

/// Rays of a camera that the scene's bounding sphere fills.
std::vector<Ray> primary_rays(const Box& box) {
  const double radius = 0.5 * glm::length(box.size());
  const glm::dvec3 eye = box.center() + glm::dvec3(0, 0, 2.5 * radius);
  std::vector<Ray> rays;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double u = (2 * x + 1.0) / side - 1, v = 1 - (2 * y + 1.0) / side;
      rays.push_back({eye, 0, glm::normalize(glm::dvec3(u * 0.44, v * 0.44, -1)), infinity});
    }
  return rays;
}

/// Rays between random points of the bounding sphere, as incoherent as can be.
std::vector<Ray> chords(const Box& box) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> z(-1, 1), angle(0, 2 * std::numbers::pi);
  const double radius = 0.5 * glm::length(box.size());
  const auto point = [&] {
    const double h = z(random), a = angle(random), r = std::sqrt(1 - h * h);
    return box.center() + radius * glm::dvec3(r * std::cos(a), r * std::sin(a), h);
  };
  std::vector<Ray> rays;
  for (int i = 0; i < side * side; ++i) {
    const glm::dvec3 from = point();
    rays.push_back({from, 0, glm::normalize(point() - from), infinity});
  }
  return rays;
}

class EmbreeScene {
 public:
  explicit EmbreeScene(const Geometry& g) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                             g.vertices.size());
    std::copy(g.vertices.begin(), g.vertices.end(), static_cast<glm::vec3*>(vertices));
    void* indices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                            g.triangles.size());
    std::copy(g.triangles.begin(), g.triangles.end(), static_cast<glm::uvec3*>(indices));
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  bool trace(const Ray& r) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const glm::vec3 o(r.origin), d(r.direction);
    RTCRayHit query{{o.x, o.y, o.z, float(r.tmin), d.x, d.y, d.z, 0, float(r.tmax), ~0u, 0, 0}, {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

/// Of this thread's processor time, so that other work on the machine counts little.
double seconds(const std::function<void()>& work) {
  const auto now = [] {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

std::size_t walk_all(const Treelets& treelets, const std::vector<Ray>& rays, std::uint32_t capacity) {
  constexpr std::size_t batch = 4096;
  std::vector<TreeletEntry> lists(batch * capacity);
  std::vector<std::uint32_t> counts(batch);
  std::size_t listed = 0;
  for (std::size_t i = 0; i < rays.size(); i += batch) {
    std::vector<WalkCursor> cursors(std::min(batch, rays.size() - i));
    walk(treelets, std::span(rays).subspan(i, cursors.size()), cursors, capacity, lists, counts);
    for (std::size_t k = 0; k < cursors.size(); ++k) listed += counts[k];
  }
  return listed;
}

/// Runs both in turn, so that a machine that slows down slows both.
void compare(const char* name, const EmbreeScene& embree, const Treelets& treelets, const std::vector<Ray>& rays,
             std::uint32_t capacity) {
  std::vector<double> whole, walked, share;
  std::size_t listed = 0, hits = 0;
  for (int round = 0; round < rounds; ++round) {
    whole.push_back(seconds([&] {
      hits = 0;
      for (const Ray& ray : rays) hits += embree.trace(ray);
    }));
    walked.push_back(seconds([&] { listed = walk_all(treelets, rays, capacity); }));
    share.push_back(walked.back() / whole.back());
  }
  const double ns = 1e9 / rays.size();
  std::printf("  %-9s %3u  %6.1f %6.1f  %5.2f  %5.2f  (hit %.2f)\n", name, capacity, median(walked) * ns,
              median(whole) * ns, median(share), double(listed) / rays.size(), double(hits) / rays.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: walk_bench MESH [K...]\n");
    return 2;
  }
  std::vector<std::string> notes;
  GeometryBuilder builder;
  builder.add(load_mesh(argv[1], notes));
  const auto geometry = builder.build();
  const EmbreeScene embree(*geometry);
  std::vector<std::uint32_t> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(std::strtoul(argv[i], nullptr, 10));
  if (sizes.empty()) sizes = {8, 16, 32, 64, 128, 256, 512, 1024};

  const auto primary = primary_rays(geometry->bounds), random = chords(geometry->bounds);
  std::printf("  rays      list  walk  Embree  share  treelets a ray  (ns a ray, medians of %d)\n", rounds);
  for (const std::uint32_t K : sizes) {
    Treelets treelets;
    const double build = seconds([&] { treelets = build_treelets(treelet_primitives(*geometry), K); });
    std::printf("K %u: %zu treelets of %.0f, %zu nodes, built in %.3f s\n", K, treelets.treelets.size(),
                double(treelets.triangles.size()) / treelets.treelets.size(), treelets.nodes.size(), build);
    compare("primary", embree, treelets, primary, 4);
    compare("chords", embree, treelets, random, 4);
    compare("chords", embree, treelets, random, 64);
  }
}
