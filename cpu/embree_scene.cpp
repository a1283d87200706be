#include "cpu/embree_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "accel/norms.h"
#include "accel/rounding.h"
#include "accel/stopwatch.h"

namespace rayengine {
namespace {

/// Rays start within near_extents of the scene (see RayLoader) and are rounded to float there: their origins move by
/// near_extents 2^-24 of the extent, and on the way of at most some 20 extents their rounded directions lead them
/// astray by 10 2^-24 more. Boxes padded by this hold what the exact rays hit.
constexpr double padding_per_extent = 0x1p-19;

void quadric_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& bucket = *static_cast<const QuadricBucket*>(args->geometryUserPtr);
  const Geometry& geometry = *bucket.geometry;
  Box box = bounds(geometry, geometry.quadrics[bucket.quadrics[args->primID]]);
  // Rays from afar start at the box of what is finite, and may have passed an unbounded quadric by then: see RayLoader.
  if (!box.finite()) box = {glm::dvec3(-infinity), glm::dvec3(infinity)};
  const auto lower = [&](double a) { return float_below(std::max(a - bucket.padding, -bucket.reach)); };
  const auto upper = [&](double a) { return float_above(std::min(a + bucket.padding, bucket.reach)); };
  *args->bounds_o = {.lower_x = lower(box.lower.x),
                     .lower_y = lower(box.lower.y),
                     .lower_z = lower(box.lower.z),
                     .upper_x = upper(box.upper.x),
                     .upper_y = upper(box.upper.y),
                     .upper_z = upper(box.upper.z)};
}

Box finite_part(const Geometry& geometry) {
  Box box;
  for (const glm::vec3& v : geometry.vertices) box.add(glm::dvec3(v));
  const auto add = [&](const Box& b) {
    if (b.finite()) box.add(b);
  };
  for (const Quadric& q : geometry.quadrics) add(bounds(geometry, q));
  for (const Instance& i : geometry.instances) add(bounds(geometry, i));
  return box;
}

/// How far a cube about the origin may reach so that Embree takes the box of what the map makes of it, too: it leaves
/// out instances with larger ones.
double reach_before(const Affine& map) {
  return std::min(EmbreeScene::range, (EmbreeScene::range - largest_component(map.origin)) / norm_of(map.linear));
}

/// Embree's layout of an affine map: three columns, then the origin, in floats.
void set_transform(RTCGeometry instance, const Affine& map) {
  float columns[12];
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) columns[3 * c + r] = static_cast<float>(map.linear[c][r]);
  for (int r = 0; r < 3; ++r) columns[9 + r] = static_cast<float>(map.origin[r]);
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
}

bool count_bytes(void* total, ssize_t bytes, bool) {
  static_cast<std::atomic<std::ptrdiff_t>*>(total)->fetch_add(bytes);
  return true;
}

}  // namespace

EmbreeScene::EmbreeScene(std::shared_ptr<const Geometry> geometry, Precision precision, Build how, bool calls_filters)
    : geometry_(std::move(geometry)),
      precision_(precision),
      build_(how),
      calls_filters_(calls_filters),
      finite_bounds_(finite_part(*geometry_)) {
  if (!finite_bounds_.empty() && !(finite_bounds_.extent() < EmbreeScene::range))
    throw Error("the scene reaches beyond 1.8e18, which Embree's single precision cannot hold: scale it down");
  device_ = rtcNewDevice(nullptr);
  if (!device_) throw Error("Embree found no device to run on");
  std::atomic<std::ptrdiff_t> memory{0};
  rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &memory);
  if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) native_packet_ = 16;

  const Stopwatch watch;
  const double padding =
      precision_ == Precision::fast || finite_bounds_.empty() ? 0 : finite_bounds_.extent() * padding_per_extent;
  groups_.resize(geometry_->groups.size());
  const std::vector<Margins> margins = group_margins(padding);
  for (std::size_t i = 0; i < groups_.size(); ++i) build(groups_[i], *geometry_->groups[i], margins[i]);
  build(top_, *geometry_, {padding});
  build_seconds_ = watch.seconds();

  rtcSetDeviceMemoryMonitorFunction(device_, nullptr, nullptr);
  embree_bytes_ = memory;
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
    throw Error("Embree could not build the scene: it may be out of memory");
}

EmbreeScene::~EmbreeScene() {
  for (const Level& level : groups_) rtcReleaseScene(level.scene);
  rtcReleaseScene(top_.scene);
  rtcReleaseDevice(device_);
}

std::size_t EmbreeScene::bytes() const {
  std::size_t total =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(embree_bytes_, 0)) + groups_.capacity() * sizeof(Level);
  const auto add = [&](const Level& level) {
    for (const auto& bucket : level.buckets)
      total += sizeof(QuadricBucket) + bucket->quadrics.capacity() * sizeof(std::uint32_t);
  };
  add(top_);
  for (const Level& level : groups_) add(level);
  return total;
}

std::vector<EmbreeScene::Margins> EmbreeScene::group_margins(double padding) const {
  std::vector<Margins> result(geometry_->groups.size(), Margins{0});
  for (const Instance& i : geometry_->instances) {
    Margins& m = result[i.group];
    m.padding = std::max(m.padding, norm_of(i.to_group.linear) * padding);
    m.reach = std::min(m.reach, reach_before(object_to_world(i.to_group)));
  }
  return result;
}

void EmbreeScene::build(Level& level, const Geometry& geometry, const Margins& margins) {
  level.geometry = &geometry;
  level.scene = rtcNewScene(device_);
  if (build_ == Build::quick) rtcSetSceneBuildQuality(level.scene, RTC_BUILD_QUALITY_LOW);
  const int robust = precision_ == Precision::fast ? 0 : RTC_SCENE_FLAG_ROBUST;
  const int filters = calls_filters_ ? RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION : 0;
  rtcSetSceneFlags(level.scene, static_cast<RTCSceneFlags>(robust | filters));
  if (&level == &top_) attach_instances();
  attach_triangles(level);
  attach_quadrics(level, margins);
  rtcCommitScene(level.scene);
}

unsigned EmbreeScene::attach(const Level& level, RTCGeometry geometry) const {
  if (build_ == Build::quick) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(level.scene, geometry);
  rtcReleaseGeometry(geometry);
  return id;
}

void EmbreeScene::attach_instances() {
  for (const Instance& i : geometry_->instances) {
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, groups_[i.group].scene);
    rtcSetGeometryTimeStepCount(instance, 1);
    set_transform(instance, object_to_world(i.to_group));
    attach(top_, instance);
  }
}

void EmbreeScene::attach_triangles(Level& level) {
  const Geometry& g = *level.geometry;
  if (g.triangles.empty()) return;
  RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, g.vertices.data(), 0,
                             sizeof(glm::vec3), g.vertices.size());
  rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, g.triangles.data(), 0,
                             sizeof(glm::uvec3), g.triangles.size());
  level.triangles_id = attach(level, mesh);
  // Objects come in order, so that equal ends mean one object.
  if (g.triangle_object.front() == g.triangle_object.back()) level.only_mesh = g.triangle_object.front();
}

void EmbreeScene::attach_quadrics(Level& level, const Margins& margins) {
  const QuadricCallbacks& callbacks = quadric_callbacks(best_isa(), precision_);
  std::vector<std::vector<std::uint32_t>> by_kind(quadric_kind_count);
  for (std::size_t i = 0; i < level.geometry->quadrics.size(); ++i)
    by_kind[static_cast<std::size_t>(kind_of(level.geometry->quadrics[i]))].push_back(static_cast<std::uint32_t>(i));
  level.first_bucket = level.triangles_id == RTC_INVALID_GEOMETRY_ID
                           ? static_cast<unsigned>(&level == &top_ ? geometry_->instances.size() : 0)
                           : level.triangles_id + 1;
  for (std::size_t kind = 0; kind < by_kind.size(); ++kind) {
    if (by_kind[kind].empty()) continue;
    level.buckets.push_back(std::make_unique<QuadricBucket>(
        QuadricBucket{level.geometry, std::move(by_kind[kind]), margins.padding, margins.reach}));
    QuadricBucket& bucket = *level.buckets.back();
    RTCGeometry user = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(user, static_cast<unsigned>(bucket.quadrics.size()));
    rtcSetGeometryUserData(user, &bucket);
    rtcSetGeometryBoundsFunction(user, quadric_bounds, nullptr);
    rtcSetGeometryIntersectFunction(user, callbacks.intersect[kind]);
    rtcSetGeometryOccludedFunction(user, callbacks.occluded[kind]);
    attach(level, user);
  }
}

}  // namespace rayengine
